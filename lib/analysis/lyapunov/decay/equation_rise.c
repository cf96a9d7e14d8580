/* equation_rise.c: how far x' = A(t) x takes a solution at most above what it was: ln max |X(t, s)|, s < t.
 *
 * The 2-norm over all directions, from 16 times s of a period, or of the run, at no common phase: solutions of a method turn
 * through all directions in time, and what the equation itself does to one of them is no fault of theirs.
 * A start is left once |X(t, s)| K < 1 with the K so far: it rises above 1 no more.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "decay.h"
#include <math.h>
#include <string.h>

enum { STARTS = 16 };

/* |X| from below: |X v| / |v|, v = X^T x for the largest column x, which is exact for d = 1. */
static sunrealtype norm(int d, const sunrealtype *X, sunrealtype *v)
{
  sunrealtype most = 0, up = 0, down = 0;
  int column = 0;
  for (int j = 0; j < d; j++) {
    sunrealtype size = 0;
    for (int i = 0; i < d; i++) size = hypot(size, X[i * d + j]);
    if (size > most) most = size, column = j;
  }
  for (int j = 0; j < d; j++) {
    v[j] = 0;
    for (int i = 0; i < d; i++) v[j] += X[i * d + j] * (X[i * d + column] / most);
    down = hypot(down, v[j]);
  }
  for (int i = 0; i < d; i++) {
    sunrealtype sum = 0;
    for (int j = 0; j < d; j++) sum += X[i * d + j] * (v[j] / down);
    up = hypot(up, sum);
  }
  return fmax(most, up);
}

static int from(stf_variation *v, sunrealtype s, sunrealtype t1, sunrealtype *work,
                sunrealtype *rise)
{
  const int d = v->d;
  sunrealtype scale = 0;
  v->t = v->t0 = s, v->count = 0;
  memset(v->X, 0, (size_t)(d * d) * sizeof *v->X);
  for (int i = 0; i < d; i++) v->X[i * (d + 1)] = 1;
  while (v->t < t1) {
    STEIF_TRY(stf_variation_step(v));
    const sunrealtype size = norm(d, v->X, work), ln = scale + log(size);
    *rise = fmax(*rise, ln);
    if (!(ln >= -*rise - 1)) return STEIF_OK;
    for (int i = 0; i < d * d; i++) v->X[i] /= size;
    scale = ln;
  }
  return STEIF_OK;
}

int stf_equation_rise(const stf_question *q, sunrealtype h, sunrealtype t1, sunrealtype *rise)
{
  const int d = (int)q->problem->n;
  const sunrealtype t0 = q->problem->t0, span = q->period > 0 ? q->period : t1 - t0;
  stf_variation v;
  stf_pool *pool = stf_pool_new(q->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = stf_variation_open(pool, q->ctx, q->problem, q->exact, h, t1, d, 1, &v);
  v.stop = q->stop;
  sunrealtype *work = code ? NULL : stf_pool_array(pool, (size_t)d, sizeof *work);
  if (!code && !work) code = STEIF_NO_MEMORY;
  *rise = 0;
  for (int k = 0; k < STARTS && !code; k++)
    code = from(&v, t0 + span * fmod(k * STF_GOLDEN, 1), t1, work, rise);
  stf_pool_free(&pool);
  return code > 0 ? steif_status(q->ctx) : code;
}
