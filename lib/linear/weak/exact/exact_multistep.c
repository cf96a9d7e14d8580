/* exact_multistep.c: backward differentiation in many digits, as long_multistep.c has it in long double.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include <nvector/nvector_serial.h>
#include <string.h>

enum { HIGHEST = 6, PAST = HIGHEST + 1 };

typedef struct multistep {
  stf_exact_run *run;
  int p, order;          /* order: of the factors; 0: none yet */
  stf_real alpha[PAST];  /* over h */
  stf_real weight[PAST]; /* Gregory's of order p */
  stf_real *past[PAST];  /* past[j] = x_{i-j} */
  stf_real_matrix matrix;
} multistep;

/* sum_j alpha_j z^j = sum_{j=1}^p (1 - z)^j / j */
static void coefficients(multistep *m, int p)
{
  const int L = m->run->limbs;
  for (int i = 0; i <= p; i++) {
    m->alpha[i] = (stf_real){0};
    for (int j = i > 1 ? i : 1; j <= p; j++) {
      long binomial = 1; /* C(j, i) */
      for (int k = 0; k < i; k++) binomial = binomial * (j - k) / (k + 1);
      const stf_real term = stf_real_ratio(L, i % 2 ? -binomial : binomial, j);
      stf_real_add(L, m->alpha + i, &term, m->alpha + i);
    }
    stf_real_divide(L, m->alpha + i, &m->run->h, m->alpha + i);
  }
}

/* The first weights of convolution quadrature of order p, then 1: numerators over one denominator. */
stf_real stf_exact_gregory(int limbs, int p, size_t i)
{
  static const struct {
    long of, w[STF_GREGORY];
  } known[PAST] = {{1, {1, 1, 1, 1, 1}},
                   {1, {0, 1, 1, 1, 1}},
                   {2, {1, 2, 2, 2, 2}},
                   {12, {5, 13, 12, 12, 12}},
                   {24, {9, 28, 23, 24, 24}},
                   {720, {251, 897, 633, 739, 720}},
                   {1440, {475, 1902, 1104, 1586, 1413}}};
  return stf_real_ratio(limbs, known[p].w[i], known[p].of);
}

static void gregory(multistep *m)
{
  for (size_t i = 0; i < STF_GREGORY; i++)
    m->weight[i] = stf_exact_gregory(m->run->limbs, m->p, i);
}

static int factor(multistep *m, int order)
{
  const stf_exact_run *r = m->run;
  const size_t size = (size_t)r->of.n * (size_t)r->of.n;
  if (m->order == order) return STEIF_OK;
  m->order = order;
  coefficients(m, order);
  for (size_t i = 0; i < size; i++) {
    m->matrix.a[i] = r->F[i];
    stf_real_gather(r->limbs, 1, m->alpha, r->E + i, m->matrix.a + i);
  }
  STEIF_CHECK(stf_real_factor(r->limbs, &m->matrix), r->of.ctx, STEIF_SINGULAR,
              "E alpha_0/h + F is singular at h = %Lg", r->of.h);
  return STEIF_OK;
}

/* past[0] = x_i from past[1], past[2], ...; weight NULL: 1. */
static int solve(multistep *m, size_t i, const stf_real *weight)
{
  stf_exact_run *r = m->run;
  stf_real *x = m->past[0];
  STEIF_TRY(i > 0 ? stf_exact_force(r, i - 1, 1, x) : stf_exact_force(r, 0, 0, x));
  for (int k = 0; k < r->of.n && weight; k++) stf_real_multiply(r->limbs, x + k, weight, x + k);
  for (int j = 1; j <= m->order; j++) {
    stf_real minus = m->alpha[j];
    minus.sign = -minus.sign;
    stf_real_apply(r->limbs, r->of.n, r->E, &minus, m->past[j], x);
  }
  stf_real_solve(r->limbs, &m->matrix, x);
  return STEIF_OK;
}

static int closed(multistep *m, size_t i)
{
  stf_longer *l = &m->run->of;
  const sunrealtype t = (sunrealtype)(l->from + (long double)i * l->h);
  STEIF_CHECK(!l->closed->exact(t, l->value, NULL, l->closed->user), l->ctx, STEIF_CALLBACK,
              "the closed solution of '%s' failed at t = %g", l->closed->name, t);
  const sunrealtype *x = N_VGetArrayPointer(l->value);
  for (int k = 0; k < l->n; k++) m->past[0][k] = stf_real_of(x[k] * stf_longer_shake(l));
  return STEIF_OK;
}

static void turn(multistep *m)
{
  stf_real *oldest = m->past[PAST - 1];
  for (int j = PAST - 1; j > 0; j--) m->past[j] = m->past[j - 1];
  m->past[0] = oldest;
}

/* x_0 of convolution quadrature: the source E x(0-) / h and w_0 f(0). */
static int first(multistep *m)
{
  stf_exact_run *r = m->run;
  STEIF_TRY(factor(m, m->p));
  const stf_real kept = m->alpha[1], minus = stf_real_of(-1);
  stf_real_divide(r->limbs, &minus, &r->h, m->alpha + 1);
  m->order = 1;
  memcpy(m->past[1], m->past[0], (size_t)r->of.n * sizeof **m->past);
  STEIF_TRY(solve(m, 0, m->weight));
  m->alpha[1] = kept, m->order = m->p;
  memset(m->past[1], 0, (size_t)r->of.n * sizeof **m->past);
  return STEIF_OK;
}

static int follow(multistep *m, const char *start)
{
  stf_exact_run *r = m->run;
  const bool cq = !strcmp(start, "cq"), exact = !strcmp(start, "exact"),
             constant = !strcmp(start, "constant");
  const size_t p = (size_t)m->p;
  for (int j = 0; j < PAST; j++) {
    stf_exact_begin(r, m->past[j]);
    if (j > 0 && !constant) memset(m->past[j], 0, (size_t)r->of.n * sizeof **m->past);
  }
  if (cq) STEIF_TRY(first(m));
  stf_exact_node(r, 0, m->past[0]);
  for (size_t i = 1; i <= r->of.steps; i++) {
    turn(m);
    if (exact && i < p)
      STEIF_TRY(closed(m, i));
    else {
      STEIF_TRY(factor(m, cq || constant || i > p ? m->p : (int)i));
      STEIF_TRY(solve(m, i, cq && i < STF_GREGORY ? m->weight + i : NULL));
    }
    stf_exact_node(r, i, m->past[0]);
  }
  stf_exact_end(r, m->past[0]);
  return STEIF_OK;
}

int stf_exact_multistep(stf_exact_run *run, int p, const char *start)
{
  const size_t n = (size_t)run->of.n;
  multistep m = {.run = run, .p = p};
  stf_real *room = stf_allocate(run->of.ctx, n * (n + PAST), sizeof *room);
  int *pivot = stf_allocate(run->of.ctx, n, sizeof *pivot);
  int code = room && pivot ? STEIF_OK : STEIF_NO_MEMORY;
  m.matrix = (stf_real_matrix){run->of.n, room, pivot};
  for (size_t j = 0; j < PAST && !code; j++) m.past[j] = room + n * (n + j);
  gregory(&m);
  if (!code) code = follow(&m, start ? start : "ramp");
  stf_release(run->of.ctx, room);
  stf_release(run->of.ctx, pivot);
  return code;
}
