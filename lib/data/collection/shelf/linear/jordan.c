/* jordan.c: q N x' + x = f(t), index k: N the k x k Jordan block with ones above a zero diagonal, q = 1 a parameter.
 *
 * Smooth part x_s = sum_{i<k} (-q)^i N^i f^(i), whatever the start; x(0-) off it adds impulses.
 *
 *   case       f_m, m = 1..k     x(0-)
 *   H-inc      0                 (1, ..., k)
 *   N-inc      cos(t + m)        (1, ..., k)
 *   N-cons     cos(t + m)        x_s(0)
 *   sin-inc    sin(m t)          x_s(0) + (0.1, ..., 0.1 k)
 *   sin-cons   sin(m t)          x_s(0)
 *
 * S. L. Campbell, Distributional convergence of BDF approximations to solutions of descriptor
 * systems, Circuits Systems Signal Process. 8 (1989).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/parameters.h>
#include <string.h>

enum { LARGEST = 12 };

enum forcing { ZERO, COSINE, SINE };

typedef struct variant {
  const char *name;
  enum forcing forcing;
  sunrealtype smooth, ramp; /* x(0-)_m = smooth * x_s(0)_m + ramp * m */
  sunrealtype t1;
} variant;

static const variant variants[] = {{"N-cons", COSINE, 1, 0, 1},
                                   {"N-inc", COSINE, 0, 1, 1},
                                   {"H-inc", ZERO, 0, 1, 1},
                                   {"sin-cons", SINE, 1, 0, 2},
                                   {"sin-inc", SINE, 1, 0.1, 2}};
enum { VARIANTS = sizeof variants / sizeof *variants };

static const char *const names_of_parameters[] = {"q"};

typedef struct block {
  int k;
  const variant *kind;
  int index[LARGEST];
  sunrealtype start[LARGEST], slope[LARGEST];
  sunrealtype q;
  steif_parameters parameters;
} block;

/* f_m^(q)(t), m = 1 .. k. */
static sunrealtype force(enum forcing kind, int m, int q, sunrealtype t)
{
  if (kind == ZERO) return 0;
  const sunrealtype phase = kind == COSINE ? t + m : m * t;
  const sunrealtype wave[] = {cos(phase), -sin(phase), -cos(phase), sin(phase)};
  return kind == COSINE ? wave[q % 4] : pow(m, q) * wave[(q + 3) % 4];
}

/* Derivative q of component m of the smooth part. */
static sunrealtype smooth(const block *b, int m, int q, sunrealtype t)
{
  sunrealtype sum = 0;
  for (int i = b->k - m; i >= 0; i--)
    sum += pow(-b->q, i) * force(b->kind->forcing, m + i, q + i, t);
  return sum;
}

/* x(0-) and the slope of the smooth part there. */
static int follow(void *user)
{
  block *b = user;
  for (int m = 1; m <= b->k; m++) {
    b->start[m - 1] = b->kind->smooth * smooth(b, m, 0, 0) + b->kind->ramp * m;
    b->slope[m - 1] = smooth(b, m, 1, 0);
  }
  return 0;
}

/* d x(0-)/dq and d(E x')/dq. */
static int begin_slope(int k, N_Vector S0, void *user)
{
  const block *b = user;
  (void)k;
  for (int m = 1; m <= b->k; m++) {
    sunrealtype sum = 0;
    for (int i = b->k - m; i > 0; i--)
      sum -= i * pow(-b->q, i - 1) * force(b->kind->forcing, m + i, i, 0);
    N_VGetArrayPointer(S0)[m - 1] = b->kind->smooth * sum;
  }
  return 0;
}

static int slope_by_q(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const block *b = user;
  const sunrealtype *d = N_VGetArrayPointer(yp);
  (void)t, (void)y, (void)k;
  for (int m = 1; m <= b->k; m++) N_VGetArrayPointer(out)[m - 1] = m < b->k ? d[m] : 0;
  return 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  const block *b = user;
  sunrealtype *value = N_VGetArrayPointer(out);
  if (derivative < 0) return -1;
  for (int m = 1; m <= b->k; m++) value[m - 1] = force(b->kind->forcing, m, derivative, t);
  return 0;
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp;
  return stf_collection_toeplitz(M, 1, 1, &((const block *)user)->q);
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  static const sunrealtype minus[] = {-1};
  (void)t, (void)y, (void)yp, (void)user;
  return stf_collection_toeplitz(M, 0, 0, minus);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const block *b = user;
  for (int m = 1; m <= b->k; m++) {
    N_VGetArrayPointer(y)[m - 1] = smooth(b, m, 0, t);
    if (yp) N_VGetArrayPointer(yp)[m - 1] = smooth(b, m, 1, t);
  }
  return 0;
}

static int choose(steif_context *ctx, const steif_spec *spec, const variant **kind)
{
  const char *word = stf_spec_word(spec, "case");
  *kind = variants;
  if (!word) return STEIF_OK;
  for (*kind = variants; *kind < variants + VARIANTS; ++*kind)
    if (!strcmp((*kind)->name, word)) return STEIF_OK;
  char guess[STF_GUESS];
  return STEIF_FAIL(
    ctx, STEIF_UNKNOWN_NAME,
    "case=%s of '%s' is not one of H-inc, N-inc, N-cons, sin-inc and sin-cons%s", word,
    spec->name, stf_guess(word, variants, VARIANTS, sizeof *variants, guess));
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int k;
  const variant *kind;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"k", "case", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "k", 1, LARGEST, 3, &k));
  STEIF_TRY(choose(ctx, spec, &kind));
  STEIF_TRY(stf_collection_storage(ctx, spec, self));
  block *b = stf_collection_allocate(ctx, self, sizeof *b, 0);
  if (!b) return STEIF_NO_MEMORY;
  b->k = k;
  b->kind = kind;
  b->q = 1;
  b->parameters = (steif_parameters){.count = 1,
                                     .value = &b->q,
                                     .name = names_of_parameters,
                                     .dFdp = slope_by_q,
                                     .start = begin_slope,
                                     .moved = follow};
  self->parameters = &b->parameters;
  for (int m = 1; m <= k; m++) b->index[m - 1] = k - m < 2 ? k - m + 1 : 3;
  follow(b);
  self->n = self->dae_index = k;
  self->index = b->index;
  self->y0 = b->start;
  self->yp0 = kind->ramp > 0 ? NULL : b->slope;
  self->t1 = kind->t1;
  self->upper = k > 1;
  self->nnz = k;
  self->nnz_E = stf_collection_count(k, 1, 1);
  return STEIF_OK;
}

const steif_problem steif_problem_jordan = {
  .about =
    "N x' + x = f, N nilpotent of index k=3, case=N-cons; S. L. Campbell, Distributional "
    "convergence of BDF approximations to solutions of descriptor systems, 1989",
  .E = E,
  .A = A,
  .g = g,
  .linear = 1,
  .exact = exact,
  .build = build,
  .destroy = stf_collection_release,
};
