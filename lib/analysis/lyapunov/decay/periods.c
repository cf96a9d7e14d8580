/* periods.c: the leading multiplier of a method's map over whole periods of A(t).
 *
 * From n columns W_0 = Q_0 the steps make W_m = Q_m R_m .. R_1 with QR after every one, so the map is
 * Phi = Q_m T Q_0^{-1}, T = R_m .. R_1 scaled as it grows. A second stretch begins from other columns: what
 * differs between the two is rounding, and history of the start that has not died away.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "decay.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

enum { WORK = 8 }; /* dgeev's, per row */

typedef struct map {
  stf_variation v;
  int d;
  sunrealtype *Q0, *Q, *R, *T, *spare, *eigen; /* d x d; eigen: (2 + WORK) d */
  sunrealtype scale;                           /* ln of what T was divided by */
} map;

static int open(stf_pool *pool, const stf_question *q, const char *method, sunrealtype h,
                map *a)
{
  const size_t d = (size_t)q->problem->n;
  a->d = (int)d;
  STEIF_TRY(stf_variation_open(pool, q->ctx, q->problem, method, h, q->problem->t0 + h, a->d, 1,
                               &a->v));
  a->v.stop = q->stop;
  a->Q0 = stf_pool_array(pool, 5 * d * d + (2 + WORK) * d, sizeof *a->Q0);
  if (!a->Q0) return STEIF_NO_MEMORY;
  a->Q = a->Q0 + d * d, a->R = a->Q + d * d, a->T = a->R + d * d, a->spare = a->T + d * d;
  a->eigen = a->spare + d * d;
  return STEIF_OK;
}

/* X <- X R^{-1}, and R. */
static int straighten(map *a)
{
  stf_variation *v = &a->v;
  stf_variation_principal(v, a->Q);
  STEIF_CHECK(stf_triangle(a->d, a->d, a->Q, a->Q, a->R, &v->algebra), v->ctx, STEIF_NOT_FINITE,
              "a direction of '%s' vanished or overflowed in the step of %s to t = %.12g",
              v->problem->name, v->method, v->t);
  stf_renormalise(v->g->k * a->d, a->d, a->R, v->X, &v->algebra);
  return STEIF_OK;
}

/* T <- R T. */
static void gather(map *a)
{
  const int d = a->d;
  sunrealtype most = 0;
  for (int i = 0; i < d; i++)
    for (int j = 0; j < d; j++) {
      sunrealtype sum = 0;
      for (int k = i; k < d; k++) sum += a->R[i * d + k] * a->T[k * d + j];
      a->T[i * d + j] = sum; /* row i of the old T is not needed below */
      most = fmax(most, fabs(sum));
    }
  if (!(most > 0)) return;
  for (int i = 0; i < d * d; i++) a->T[i] /= most;
  a->scale += log(most);
}

/* ln of the largest |eigenvalue| of Q0^{-1} Q T. */
static int leading(map *a, sunrealtype *ln)
{
  const int d = a->d, one = 1, length = WORK * d;
  sunrealtype *re = a->eigen, *im = re + d, none, most = 0;
  int info;
  for (int i = 0; i < d; i++)
    for (int j = 0; j < d; j++) {
      a->spare[i * d + j] = 0;
      for (int k = 0; k < d; k++) a->spare[i * d + j] += a->Q[i * d + k] * a->T[k * d + j];
    }
  const bool good = stf_factor(d, a->Q0, &a->v.algebra);
  if (good) stf_substitute(d, d, a->Q0, a->spare, &a->v.algebra);
  dgeev_("N", "N", &d, a->spare, &d, re, im, &none, &one, &none, &one, im + d, &length, &info,
         1, 1);
  for (int i = 0; i < d; i++) most = fmax(most, hypot(re[i], im[i]));
  STEIF_CHECK(good && info == 0 && most > 0 && isfinite(most), a->v.ctx, STEIF_NO_CONVERGENCE,
              "the multipliers of '%s' by %s were not found (dgeev: %d)", a->v.problem->name,
              a->v.method, info);
  *ln = log(most) + a->scale;
  return STEIF_OK;
}

static int stretch(map *a, long steps, sunrealtype *ln)
{
  const size_t bytes = (size_t)(a->d * a->d) * sizeof *a->Q;
  stf_variation_principal(&a->v, a->Q0);
  memset(a->T, 0, bytes);
  for (int i = 0; i < a->d; i++) a->T[i * (a->d + 1)] = 1;
  a->scale = 0;
  for (long n = 0; n < steps; n++) {
    STEIF_TRY(stf_variation_step(&a->v));
    STEIF_TRY(straighten(a));
    gather(a);
  }
  stf_variation_principal(&a->v, a->Q);
  return leading(a, ln);
}

static int measure(stf_pool *pool, const stf_question *q, const char *method, long turns,
                   long steps, stf_rate *rate)
{
  map a;
  const sunrealtype span = (sunrealtype)turns * q->period;
  sunrealtype first, second;
  STEIF_TRY(open(pool, q, method, span / (sunrealtype)steps, &a));
  const long burn = a.v.g->k > 1 ? stf_burn_in(a.v.g) : 0;
  STEIF_TRY(straighten(&a));
  for (long n = 0; n < burn; n++) {
    STEIF_TRY(stf_variation_step(&a.v));
    STEIF_TRY(straighten(&a));
  }
  STEIF_TRY(stretch(&a, steps, &first));
  STEIF_TRY(stretch(&a, steps, &second));
  const sunrealtype rounding = STF_EPS * sqrt((sunrealtype)steps) * 4;
  *rate = (stf_rate){.value = second / span,
                     .error = (fabs(second - first) + rounding) / span + q->off,
                     .steps = 2 * steps + burn};
  return STEIF_OK;
}

int stf_rate_of_periods(const stf_question *q, const char *method, long turns, long steps,
                        stf_rate *rate)
{
  stf_pool *pool = stf_pool_new(q->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = measure(pool, q, method, turns, steps, rate);
  stf_pool_free(&pool);
  return code > 0 ? steif_status(q->ctx) : code;
}
