/* discrete.c: schemes by name, the checks of their input, and the storage of their result.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include <math.h>
#include <string.h>

static const stf_rule rules[] = {
  {{"zoh", 1, "input held between samples"}, stf_exponential_build, {{0, 1}}, 0, false, {0}},
  {{"foh", 2, "input linear between samples"},
   stf_exponential_build,
   {{0, 1, -1}, {0}, {0, 0, 1}},
   0,
   true,
   {0}},
  {{"impulse", 1, "input as impulses at the samples"},
   stf_exponential_build,
   {{0}, {0}, {0, 0, 0, 1}},
   0,
   true,
   {0}},
  {{"bilinear", 2, "trapezoidal rule, Tustin; w=W is exact at the frequency W"},
   stf_bilinear_build,
   {{0}},
   0.5,
   false,
   {"w"}},
  {{"gbt", 1, "generalised bilinear, alpha=A from 0 to 1"},
   stf_bilinear_build,
   {{0}},
   -1,
   false,
   {"alpha"}},
  {{"forward", 1, "forward Euler"}, stf_bilinear_build, {{0}}, 0, false, {0}},
  {{"backward", 1, "backward Euler"}, stf_bilinear_build, {{0}}, 1, false, {0}},
  {{"matched", 1, "poles and zeros mapped; one input, one output"},
   stf_matched_build,
   {{0}},
   0,
   false,
   {0}},
  {{"exp-trapezoidal", 2, "as foh, with the state kept"},
   stf_exponential_build,
   {{0, 1, -1}, {0}, {0, 0, 1}},
   0,
   false,
   {0}},
  {{"exp-midpoint", 2, "input of the midpoint held"},
   stf_exponential_build,
   {{0}, {0, 1}, {0}},
   0,
   false,
   {0}},
  {{"averaged", 2, "mean of two samples held"},
   stf_exponential_build,
   {{0, 0.5}, {0}, {0, 0.5}},
   0,
   false,
   {0}},
  {{"quadrature", 2, "trapezoidal rule for the input, exact exponential"},
   stf_exponential_build,
   {{0.5}, {0}, {0, 0, 0, 0.5}},
   0,
   false,
   {0}},
};
enum { RULES = sizeof rules / sizeof *rules };

const steif_scheme *steif_scheme_at(size_t i) { return i < RULES ? &rules[i].scheme : NULL; }

static int find(steif_context *ctx, const char *text, steif_spec *spec, const stf_rule **rule)
{
  STEIF_CHECK(text, ctx, STEIF_BAD_INPUT, "no scheme is given; name one, such as zoh");
  STEIF_TRY(steif_spec_parse(ctx, text, spec));
  for (*rule = rules; *rule < rules + RULES; ++*rule)
    if (!strcmp(spec->name, (*rule)->scheme.name))
      return stf_spec_only(ctx, spec, (const char *const[]){(*rule)->key[0], NULL});
  char guess[STF_GUESS];
  return STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "no scheme '%s'%s", spec->name,
                    stf_guess(spec->name, rules, RULES, sizeof *rules, guess));
}

int stf_state_space_check(steif_context *ctx, const steif_state_space *s)
{
  STEIF_CHECK(s, ctx, STEIF_BAD_INPUT, "no system is given; hand over A and its size");
  STEIF_CHECK(s->n >= 1 && s->m >= 0 && s->p >= 0, ctx, STEIF_BAD_INPUT,
              "%d states, %d inputs, %d outputs: at least 1, 0 and 0 are needed", s->n, s->m,
              s->p);
  STEIF_TRY(stf_check_matrix(ctx, "A", s->n, s->n, s->A));
  STEIF_TRY(stf_check_matrix(ctx, "B", s->n, s->m, s->B));
  STEIF_TRY(stf_check_matrix(ctx, "C", s->p, s->n, s->C));
  return s->D ? stf_check_matrix(ctx, "D", s->p, s->m, s->D) : STEIF_OK;
}

void stf_product(int rows, int columns, int inner, double alpha, const double *A,
                 const double *B, double beta, double *C)
{
  if (rows && columns && inner)
    dgemm_("N", "N", &rows, &columns, &inner, &alpha, A, &rows, B, &inner, &beta, C, &rows, 1,
           1);
}

int stf_eigenvalues(steif_context *ctx, int n, const double *A, double *re, double *im)
{
  const size_t count = (size_t)n * (size_t)n, work = 16 * (size_t)n;
  double *copy = stf_allocate(ctx, count + work, sizeof *copy), none;
  if (!copy) return STEIF_NO_MEMORY;
  const int one = 1, lwork = (int)work;
  int info = 0;
  memcpy(copy, A, count * sizeof *copy);
  dgeev_("N", "N", &n, copy, &n, re, im, &none, &one, &none, &one, copy + count, &lwork, &info,
         1, 1);
  stf_release(ctx, copy);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "the QR iteration found %d of %d eigenvalues; balance or rescale the matrix",
              n - info, n);
  return STEIF_OK;
}

/* ---- the result ---- */

/* One block: Ad, Bd, Cd, Dd, three weights, eigenvalues. */
static int store(stf_plan *p, steif_discrete *d)
{
  const size_t n = (size_t)p->s->n, m = (size_t)p->s->m, o = (size_t)p->s->p;
  double *x = stf_allocate(p->ctx, n * n + 4 * n * m + o * n + o * m + 2 * n, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  d->memory = x;
  p->Ad = x, x += n * n;
  p->Bd = x, x += n * m;
  p->Cd = x, x += o * n;
  p->Dd = x, x += o * m;
  p->B0 = x, x += n * m;
  p->Bm = x, x += n * m;
  p->B1 = x, x += n * m;
  p->re = x, p->im = x + n;
  d->re = p->re, d->im = p->im;
  if (o) memcpy(p->Cd, p->s->C, o * n * sizeof *x);
  if (o && m && p->s->D) memcpy(p->Dd, p->s->D, o * m * sizeof *x);
  d->form = *p->s;
  d->form.A = p->Ad, d->form.B = p->Bd, d->form.C = p->Cd, d->form.D = p->Dd;
  d->B0 = p->B0, d->Bm = p->Bm, d->B1 = p->B1;
  return STEIF_OK;
}

static int spectra(const stf_plan *p, steif_discrete *d)
{
  const size_t n = (size_t)p->s->n;
  STEIF_TRY(stf_eigenvalues(p->ctx, p->s->n, p->s->A, p->re, p->im));
  for (size_t i = 0; i < n; i++) d->alias = fmax(d->alias, fabs(p->im[i]) * p->dt / STF_PI);
  return stf_eigenvalues(p->ctx, p->s->n, p->Ad, p->re, p->im);
}

static int build(stf_plan *p, steif_discrete *d)
{
  STEIF_TRY(store(p, d));
  STEIF_TRY(p->rule->build(p));
  const size_t n = (size_t)p->s->n, m = (size_t)p->s->m, o = (size_t)p->s->p;
  STEIF_TRY(stf_check_result(p->ctx, "the discrete system", n * n + 4 * n * m + o * n + o * m,
                             d->memory, p->dt * stf_norm1(p->s->n, p->s->A)));
  return spectra(p, d);
}

int steif_c2d(steif_context *ctx, const steif_state_space *s, const char *scheme, double dt,
              steif_discrete *d)
{
  steif_spec spec;
  stf_plan p = {.ctx = ctx, .s = s, .spec = &spec, .dt = dt};
  STEIF_CHECK(d, ctx, STEIF_BAD_INPUT, "no place for the discretisation: it is NULL");
  *d = (steif_discrete){.dt = dt};
  STEIF_TRY(stf_state_space_check(ctx, s));
  STEIF_CHECK(isfinite(dt) && dt > 0, ctx, STEIF_BAD_INPUT,
              "dt = %g: the step is a finite number above 0", dt);
  STEIF_TRY(find(ctx, scheme, &spec, &p.rule));
  d->scheme = p.rule->scheme.name;
  const int code = build(&p, d);
  if (code) steif_discrete_clear(ctx, d);
  return code;
}

void steif_discrete_clear(steif_context *ctx, steif_discrete *d)
{
  if (!d) return;
  stf_release(ctx, d->memory);
  *d = (steif_discrete){0};
}
