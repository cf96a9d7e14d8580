/* exact_run.c: a run in many digits, by the family of the method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

/* Digits beyond those of the powers of h that cancel: h^-(2 k) for methods with |R(infinity)| = 1 and their
 * sums over the steps. */
enum { SPARE = 8, BITS = 32 };

int stf_exact_limbs(int index, size_t steps)
{
  const double lost = (2.0 * index + 3) * log2((double)steps + 2);
  return (int)fmin(STF_LIMBS, SPARE + ceil(lost / BITS));
}

int stf_exact_force(stf_exact_run *r, size_t i, long double c, stf_real *out)
{
  STEIF_TRY(stf_longer_force(&r->of, i, c, r->f));
  for (int k = 0; k < r->of.n; k++) out[k] = stf_real_of(r->f[k]);
  return STEIF_OK;
}

static void add(stf_exact_run *r, const stf_real *weight, const stf_real *x)
{
  for (int m = 0; m < r->of.n && weight->sign; m++)
    stf_real_gather(r->limbs, 1, weight, x + m, r->sum + m);
}

/* from + (i + c) h, c NULL: 0. */
static stf_real time_of(const stf_exact_run *r, size_t i, const stf_real *c)
{
  stf_real t = stf_real_of((long double)i);
  if (c) stf_real_add(r->limbs, &t, c, &t);
  stf_real_multiply(r->limbs, &r->h, &t, &t);
  stf_real_add(r->limbs, &t, &r->from, &t);
  return t;
}

/* x is the density on the step that ends at node i. */
static void box(stf_exact_run *r, size_t i, const stf_real *x)
{
  const stf_real t = time_of(r, i, NULL);
  stf_real upto, weight;
  if (r->integrals) stf_integrals_density(r->integrals, &t, x);
  if (!r->g) return;
  stf_spline_integral(r->g, r->limbs, &t, &upto);
  stf_real_subtract(r->limbs, &upto, &r->before, &weight);
  r->before = upto;
  add(r, &weight, x);
}

/* There is the mass weight x at t. */
static void mass(stf_exact_run *r, const stf_real *t, const stf_real *weight, const stf_real *x)
{
  stf_real g;
  if (r->integrals) stf_integrals_mass(r->integrals, t, weight, x);
  if (!r->g) return;
  stf_spline_at(r->g, r->limbs, t, &g);
  stf_real_multiply(r->limbs, &g, weight, &g);
  add(r, &g, x);
}

static void comb(stf_exact_run *r, size_t i, const stf_real *x)
{
  const stf_real t = time_of(r, i, NULL);
  stf_real w = r->h;
  if (r->ends && r->of.steps - i < STF_GREGORY) {
    const stf_real end = stf_exact_gregory(r->limbs, r->ends, r->of.steps - i);
    stf_real_multiply(r->limbs, &w, &end, &w);
  }
  mass(r, &t, &w, x);
}

void stf_exact_node(stf_exact_run *r, size_t i, const stf_real *x)
{
  if (r->convention == STEIF_P && i < r->of.steps) box(r, i + 1, x);
  if (r->convention == STEIF_R && i > 0) box(r, i, x);
  if (r->convention == STEIF_C && (i > 0 || r->solved)) comb(r, i, x);
}

void stf_exact_stage(stf_exact_run *r, size_t i, const stf_real *c, const stf_real *b,
                     const stf_real *X)
{
  const stf_real t = time_of(r, i, c);
  stf_real w;
  if (r->convention != STEIF_STAGE) return;
  stf_real_multiply(r->limbs, &r->h, b, &w);
  mass(r, &t, &w, X);
}

void stf_exact_begin(const stf_exact_run *r, stf_real *x)
{
  for (int k = 0; k < r->of.n; k++)
    x[k] = r->of.continued ? r->state[k] : stf_real_of(r->of.x0[k]);
}

void stf_exact_end(stf_exact_run *r, const stf_real *x)
{
  if (r->state) memcpy(r->state, x, (size_t)r->of.n * sizeof *x);
}

static int dispatch(stf_exact_run *r)
{
  steif_spec spec;
  const stf_longer *l = &r->of;
  STEIF_TRY(steif_spec_parse(l->ctx, l->method, &spec));
  const bool euler = !strcmp(spec.name, "be");
  if (!euler && strcmp(spec.name, "bdf")) return stf_exact_stages(r);
  int p;
  STEIF_TRY(stf_spec_int(l->ctx, &spec, "p", 1, 6, euler ? 1 : 2, &p));
  return stf_exact_multistep(r, p, l->start ? l->start : stf_spec_word(&spec, "start"));
}

static int claim(stf_exact_run *r)
{
  stf_longer *l = &r->of;
  const size_t n = (size_t)l->n, size = n * n;
  l->value = N_VNew_Serial(l->n, steif_sundials(l->ctx));
  STEIF_CHECK(l->value, l->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  r->f = stf_allocate(l->ctx, n + size, sizeof *r->f);
  r->E = stf_allocate(l->ctx, 2 * size, sizeof *r->E);
  if (!r->f || !r->E) return STEIF_NO_MEMORY;
  r->F = r->E + size;
  for (int which = 0; which < 2; which++) {
    stf_long_entries(which ? l->linear->F : l->linear->E, l->n, r->f + n);
    for (size_t i = 0; i < size; i++) (which ? r->F : r->E)[i] = stf_real_of(r->f[n + i]);
  }
  return STEIF_OK;
}

int stf_exact_run_make(stf_exact_run *r)
{
  stf_longer *l = &r->of;
  if (l->random.state == 0) l->random.state = 1;
  r->from = stf_real_of(l->from);
  if (r->g) stf_spline_integral(r->g, r->limbs, &r->from, &r->before);
  int code = claim(r);
  if (!code) code = dispatch(r);
  if (l->value) N_VDestroy(l->value);
  stf_release(l->ctx, r->f);
  stf_release(l->ctx, r->E);
  l->value = NULL, r->E = r->F = NULL, r->f = NULL;
  return code;
}
