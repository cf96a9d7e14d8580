/* period_search.c: the period of A(t) in E x' = A(t) x that nobody has told, and a test of one that was told.
 *
 * A sum s(t) of all entries with fixed weights is sampled in windows of the run, the shortest first. A lag at
 * which the mean of (s(t + lag) - s(t))^2 has a minimum near 0 is a candidate, and Newton's iteration on
 *   sum_j (s(t_j + k P) - s(t_j)) s'(t_j) = 0,   k = 1, 2, 4, .. as far as the run reaches,
 * makes it as sharp as t allows. It is the period if every entry comes back, but for the rounding of t and of
 * A, at STF_PERIOD_POINTS times that no division of the run chooses, after any number of periods. Sums of
 * oscillations without a common period come back nearly, which fails here, as a drift does.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "period_search.h"
#include "decay_thresholds.h"
#include "lyapunov_thresholds.h"
#include <math.h>

enum {
  SAMPLES = 2048, /* of a window; neighbouring windows have lengths of ratio RATIO */
  LONGEST = SAMPLES / 3,
  SHORTEST = 32,
  STRIDE = 5,
  RATIO = 8,
  TIMES = 64, /* of Newton's iteration */
  TRIES = 8   /* candidates of a window */
};

/* Fractions that fill [0, 1] evenly in one and in two dimensions. */
static const sunrealtype along = STF_GOLDEN, across = 0.7548776662466927;

typedef struct quest {
  stf_variation *v;
  sunrealtype t0, t1, range; /* of s */
  sunrealtype off;           /* the largest difference that passed for rounding */
  sunrealtype *s, *mismatch; /* SAMPLES, LONGEST + 2 */
} quest;

static sunrealtype fraction(int k, sunrealtype step) { return fmod((k + 1) * step, 1); }

/* NaN where A is not known. */
static sunrealtype signal_at(quest *q, sunrealtype t)
{
  sunrealtype sum = 0;
  if (stf_variation_matrix(q->v, 0, t, q->v->y, NULL)) return NAN;
  for (sunindextype j = 0; j < q->v->d; j++) {
    const stf_entries c = stf_jacobian_column(q->v->J[0], j);
    for (sunindextype e = 0; e < c.count; e++) {
      const sunrealtype i = (sunrealtype)stf_row_of(&c, e);
      sum += (0.25 + fmod(along * (i + 1) + across * (sunrealtype)(j + 1), 1)) * c.value[e];
    }
  }
  return sum;
}

/* The largest |A_ij(u) - A_ij(t)| and |A_ij|; infinite where one of them is not known. */
static sunrealtype apart(stf_variation *v, sunrealtype t, sunrealtype u, sunrealtype *size)
{
  sunrealtype most = 0;
  if (stf_variation_matrix(v, 0, t, v->y, NULL) || stf_variation_matrix(v, 1, u, v->y, NULL))
    return INFINITY;
  for (sunindextype j = 0; j < v->d; j++) {
    const stf_entries a = stf_jacobian_column(v->J[0], j), b = stf_jacobian_column(v->J[1], j);
    if (a.count != b.count) return INFINITY;
    for (sunindextype e = 0; e < a.count; e++) {
      const sunrealtype off = fabs(a.value[e] - b.value[e]);
      if (!(off < INFINITY) || stf_row_of(&a, e) != stf_row_of(&b, e)) return INFINITY;
      most = fmax(most, off), *size = fmax(*size, fabs(a.value[e]));
    }
  }
  return most;
}

/* Does every entry come back after any number of periods P? */
static bool comes_back(quest *q, sunrealtype P)
{
  const sunrealtype run = q->t1 - q->t0, tiny = P / 1000;
  sunrealtype size = 0, slope = 0;
  for (int k = 0; k < TIMES; k++) {
    const sunrealtype t = q->t0 + fraction(k, along) * (run - tiny);
    slope = fmax(slope, apart(q->v, t, t + tiny, &size) / tiny);
  }
  const sunrealtype room =
    STF_PERIOD_ROUNDING * STF_EPS * (size + slope * fmax(fabs(q->t0), fabs(q->t1)));
  sunrealtype most = 0;
  for (int k = 0; k < STF_PERIOD_POINTS; k++) {
    const sunrealtype t = q->t0 + fraction(k, along) * (run - P);
    const sunrealtype turns = 1 + floor(fraction(k, across) * (floor((q->t1 - t) / P) - 1));
    most = fmax(most, apart(q->v, t, t + fmax(1, turns) * P, &size));
    if (!(most <= room)) return false;
  }
  q->off = most;
  return true;
}

/* P after k of them, by at most `most` corrections; false: s does not come back there. */
static bool sharpen(quest *q, sunrealtype k, int most, sunrealtype *P)
{
  sunrealtype weight[TIMES], from[TIMES], time[TIMES], squares = 0;
  const sunrealtype d = *P / 1000, room = q->t1 - q->t0 - k * *P * 1.05 - 2 * d;
  if (!(room > 0)) return false;
  for (int j = 0; j < TIMES; j++) {
    const sunrealtype t = time[j] = q->t0 + d + fraction(j, along) * room;
    from[j] = signal_at(q, t);
    weight[j] = (signal_at(q, t + d) - signal_at(q, t - d)) / (2 * d);
    squares += weight[j] * weight[j];
  }
  if (!(squares > 0 && squares < INFINITY)) return false;
  sunrealtype rest = INFINITY;
  const sunrealtype begun = *P;
  for (int i = 0; i < most; i++) {
    sunrealtype sum = 0, off = 0;
    for (int j = 0; j < TIMES; j++) {
      const sunrealtype r = signal_at(q, time[j] + k * *P) - from[j];
      sum += r * weight[j], off += r * r;
    }
    rest = sqrt(off / TIMES);
    const sunrealtype change = sum / squares / k;
    if (!(fabs(*P - change - begun) < 0.04 * begun)) return false;
    *P -= change;
    if (fabs(change) * k <= 4 * STF_EPS * fmax(fabs(q->t0), fabs(q->t1))) break;
  }
  return rest <= STF_PERIOD_NEAR * q->range;
}

/* From a lag that is right to a part of it. */
static bool is_period(quest *q, sunrealtype *P)
{
  const sunrealtype run = q->t1 - q->t0;
  if (!sharpen(q, 1, 24, P)) return false;
  for (sunrealtype k = 2; k * *P * 2 <= run; k *= 2)
    if (!sharpen(q, k, 6, P)) return false;
  return comes_back(q, *P);
}

/* The whole of it may be several. */
static sunrealtype shortest(quest *q, sunrealtype P)
{
  static const int parts[] = {2, 3, 5, 7};
  for (int k = 0; k < 4; k++)
    while (comes_back(q, P / parts[k])) P /= parts[k];
  return P;
}

/* Mean squares for all lags; false: s is not known, or does little here of what it does in the run. */
static bool mismatches(quest *q, sunrealtype length)
{
  sunrealtype low = INFINITY, high = -INFINITY;
  for (int i = 0; i < SAMPLES; i++) {
    const sunrealtype s = q->s[i] = signal_at(q, q->t0 + i * (length / SAMPLES));
    if (isnan(s)) return false;
    low = fmin(low, s), high = fmax(high, s);
  }
  if (!(high - low > q->range / 2)) return false;
  for (int lag = 0; lag <= LONGEST + 1; lag++) {
    sunrealtype sum = 0;
    for (int i = 0; i + LONGEST + 1 < SAMPLES; i += STRIDE) {
      const sunrealtype off = q->s[i + lag] - q->s[i];
      sum += off * off;
    }
    q->mismatch[lag] = sum;
  }
  return true;
}

static sunrealtype in_window(quest *q, sunrealtype length)
{
  sunrealtype most = 0;
  const sunrealtype *m = q->mismatch;
  if (!mismatches(q, length)) return 0;
  for (int lag = 1; lag <= LONGEST; lag++) most = fmax(most, m[lag]);
  for (int lag = SHORTEST, tries = 0; lag <= LONGEST && tries < TRIES; lag++) {
    if (m[lag] > m[lag - 1] || m[lag] > m[lag + 1] || m[lag] > STF_PERIOD_MINIMUM * most)
      continue;
    sunrealtype P = lag * (length / SAMPLES);
    tries++;
    if (is_period(q, &P)) return shortest(q, P);
  }
  return 0;
}

/* What s does in the run; 0: nothing, or s is not known. */
static sunrealtype range_of(quest *q)
{
  sunrealtype low = INFINITY, high = -INFINITY;
  for (int k = 0; k < STF_PERIOD_POINTS; k++) {
    const sunrealtype s = signal_at(q, q->t0 + fraction(k, along) * (q->t1 - q->t0));
    if (isnan(s)) return 0;
    low = fmin(low, s), high = fmax(high, s);
  }
  const sunrealtype range = high - low;
  return range > STF_PERIOD_VARIES * fmax(fabs(low), fabs(high)) && range < INFINITY ? range
                                                                                     : 0;
}

int stf_period_search(stf_pool *pool, stf_variation *v, sunrealtype h, sunrealtype t1,
                      const volatile int *stop, sunrealtype *period, sunrealtype *off)
{
  quest q = {.v = v, .t0 = v->problem->t0, .t1 = t1};
  *period = 0;
  q.s = stf_pool_array(pool, SAMPLES + LONGEST + 2, sizeof *q.s);
  if (!q.s) return STEIF_NO_MEMORY;
  q.mismatch = q.s + SAMPLES;
  /* A callback that fails at a time of the search, and not of the steps, is no failure of the run. */
  const bool before = stf_silence(v->ctx, true);
  q.range = range_of(&q);
  sunrealtype length = t1 - q.t0;
  while (length / RATIO >= h) length /= RATIO;
  for (; q.range > 0 && length < 2 * (t1 - q.t0) && *period == 0 && !(stop && *stop);
       length *= RATIO)
    *period = in_window(&q, fmin(length, t1 - q.t0));
  *off = q.off;
  stf_silence(v->ctx, before);
  return STEIF_OK;
}

int stf_period_tested(stf_variation *v, sunrealtype t1, sunrealtype period)
{
  const sunrealtype t0 = v->problem->t0, room = fmax(t1 - t0 - period, period);
  sunrealtype size = 0, worst = 0, at = t0;
  for (int k = 0; k < TIMES; k++) {
    const sunrealtype t = t0 + fraction(k, along) * room;
    const sunrealtype off = apart(v, t, t + period, &size);
    if (isfinite(off) && off > worst) worst = off, at = t;
  }
  STEIF_CHECK(
    worst <= STF_PERIOD_TOLD * size, v->ctx, STEIF_BAD_INPUT,
    "%.10g is not a period of '%s': an entry of its matrix changes by %.3g from t = %.6g "
    "to t = %.6g (%.3g is the largest); without a period one is looked for",
    period, v->problem->name, worst, at, at + period, size);
  return STEIF_OK;
}
