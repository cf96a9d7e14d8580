/* long_multistep.c: backward differentiation of order p with constant steps in long double,
 *   E (1/h) sum_j alpha_j x_{i-j} + F x_i = w_i f(t_i),   sum_j alpha_j z^j = sum_{j=1}^p (1 - z)^j / j,
 * from the starts of bdf_fixed.c: orders 1, 2, .., p (ramp), x_i = x(0-) before 0 (constant), values of
 * the closed solution (exact), and an impulse source with Gregory's weights (cq).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "longer.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

enum { HIGHEST = 6, PAST = HIGHEST + 1 };

typedef struct multistep {
  stf_longer *run;
  int p, order; /* order: of the factors; 0: none yet */
  long double alpha[PAST];
  long double *past[PAST]; /* past[j] = x_{i-j} */
  stf_long_matrix matrix;
} multistep;

static void coefficients(int p, long double *alpha)
{
  for (int i = 0; i <= p; i++) {
    alpha[i] = 0;
    for (int j = i > 1 ? i : 1; j <= p; j++) {
      long double binomial = 1; /* C(j, i) */
      for (int k = 0; k < i; k++) binomial = binomial * (j - k) / (k + 1);
      alpha[i] += (i % 2 ? -binomial : binomial) / j;
    }
  }
}

static int factor(multistep *m, int order)
{
  const stf_longer *r = m->run;
  const size_t size = (size_t)r->n * (size_t)r->n;
  if (m->order == order) return STEIF_OK;
  m->order = order;
  coefficients(order, m->alpha);
  for (size_t i = 0; i < size; i++) m->matrix.a[i] = m->alpha[0] / r->h * r->E[i] + r->F[i];
  STEIF_CHECK(stf_long_factor(&m->matrix), r->ctx, STEIF_SINGULAR,
              "E alpha_0/h + F is singular at h = %Lg", r->h);
  return STEIF_OK;
}

/* past[0] = x_i from past[1], past[2], ... */
static int solve(multistep *m, size_t i, long double weight)
{
  stf_longer *r = m->run;
  long double *x = m->past[0];
  STEIF_TRY(i > 0 ? stf_longer_force(r, i - 1, 1, x) : stf_longer_force(r, 0, 0, x));
  for (int k = 0; k < r->n; k++) x[k] *= weight;
  for (int j = 1; j <= m->order; j++)
    stf_long_multiply(r->n, r->E, -m->alpha[j] / r->h, m->past[j], x);
  stf_long_solve(&m->matrix, x);
  return STEIF_OK;
}

static int closed(multistep *m, size_t i)
{
  stf_longer *r = m->run;
  const sunrealtype t = (sunrealtype)(r->from + (long double)i * r->h);
  STEIF_CHECK(!r->closed->exact(t, r->value, NULL, r->closed->user), r->ctx, STEIF_CALLBACK,
              "the closed solution of '%s' failed at t = %g", r->closed->name, t);
  const sunrealtype *x = N_VGetArrayPointer(r->value);
  for (int k = 0; k < r->n; k++) m->past[0][k] = x[k] * stf_longer_shake(r);
  return STEIF_OK;
}

static void turn(multistep *m)
{
  long double *oldest = m->past[PAST - 1];
  for (int j = PAST - 1; j > 0; j--) m->past[j] = m->past[j - 1];
  m->past[0] = oldest;
}

static int begin(multistep *m, bool cq, bool constant)
{
  stf_longer *r = m->run;
  for (int j = 0; j < PAST; j++)
    for (int k = 0; k < r->n; k++)
      m->past[j][k] = j > 0 && !constant ? 0
                      : r->continued     ? r->state[k]
                                         : (long double)r->x0[k];
  if (cq) {
    STEIF_TRY(factor(m, m->p));
    memcpy(m->past[1], m->past[0], (size_t)r->n * sizeof **m->past);
    const long double kept = m->alpha[1];
    m->alpha[1] = -1, m->order = 1; /* the source E x(0-) / h */
    STEIF_TRY(solve(m, 0, stf_gregory(m->p, 0)));
    m->alpha[1] = kept, m->order = m->p;
    memset(m->past[1], 0, (size_t)r->n * sizeof **m->past);
  }
  return stf_pairing_node(r->pairing, 0, m->past[0]);
}

static int follow(multistep *m, const char *start)
{
  stf_longer *r = m->run;
  const bool cq = !strcmp(start, "cq"), exact = !strcmp(start, "exact"),
             constant = !strcmp(start, "constant");
  const size_t p = (size_t)m->p;
  STEIF_TRY(begin(m, cq, constant));
  for (size_t i = 1; i <= r->steps; i++) {
    turn(m);
    if (exact && i < p)
      STEIF_TRY(closed(m, i));
    else {
      STEIF_TRY(factor(m, cq || constant || i > p ? m->p : (int)i));
      STEIF_TRY(solve(m, i, cq ? stf_gregory(m->p, i) : 1));
    }
    STEIF_TRY(stf_pairing_node(r->pairing, i, m->past[0]));
  }
  if (r->state) memcpy(r->state, m->past[0], (size_t)r->n * sizeof *r->state);
  return STEIF_OK;
}

int stf_longer_multistep(stf_longer *run, int p, const char *start)
{
  const size_t n = (size_t)run->n;
  multistep m = {.run = run, .p = p};
  long double *room = stf_allocate(run->ctx, n * (n + PAST), sizeof *room);
  int *pivot = stf_allocate(run->ctx, n, sizeof *pivot);
  int code = room && pivot ? STEIF_OK : STEIF_NO_MEMORY;
  m.matrix = (stf_long_matrix){run->n, room, pivot};
  for (size_t j = 0; j < PAST && !code; j++) m.past[j] = room + n * (n + j);
  if (!code) code = follow(&m, start ? start : "ramp");
  stf_release(run->ctx, room);
  stf_release(run->ctx, pivot);
  return code;
}
