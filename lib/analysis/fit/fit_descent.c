/* fit_descent.c: one descent by MINPACK's lmder, in x = theta - theta_0 with the unit matrix as scaling: the
 * first step changes p by a factor of e at most. Where so short a step changes chi2 by less than its tolerance, and
 * J promises more, longer ones follow.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include <math.h>
#include <string.h>

#ifdef STEIF_HAVE_CMINPACK
#include <cminpack.h>

enum { ROUNDS = 20 };

/* P more residuals, 1e-8 |J| x_i, keep x where the data do not: elsewhere they move the minimum by less than 1e-8 of
 * the largest singular value, in standard deviations. */
static const sunrealtype anchor = 1e-8;

static sunrealtype weight_of(const stf_descent *d)
{
  sunrealtype sum = 0;
  for (size_t i = 0; i < d->data->count * (size_t)d->P; i++) sum += d->J[i] * d->J[i];
  return anchor * sqrt(sum);
}

/* A failed run has residuals a hundred times those of the last good one: lmder takes a tenth of the step. */
static int residuals(stf_descent *d, const sunrealtype *x, sunrealtype *out)
{
  const size_t m = d->data->count, P = (size_t)d->P;
  const sunrealtype before = d->chi2;
  const int code = stf_fit_run(d, x);
  if (code && (d->stopped || !isfinite(before))) return -1;
  if (!code && d->hold == 0) d->hold = weight_of(d);
  for (size_t j = 0; j < m; j++)
    out[j] = code ? 100 * sqrt(before / (sunrealtype)m) + 1e-100 : d->r[j];
  for (size_t i = 0; i < P; i++) out[m + i] = d->hold * x[i];
  if (code) d->chi2 = before;
  return 0;
}

/* lmder asks for J where it has the residuals from, but for runs that were rejected since. */
static int derivatives(stf_descent *d, const sunrealtype *x, sunrealtype *out)
{
  const size_t m = d->data->count, P = (size_t)d->P;
  if ((!d->known || memcmp(x, d->at, P * sizeof *x)) && stf_fit_run(d, x)) return -1;
  memset(out, 0, (m + P) * P * sizeof *out);
  for (size_t k = 0; k < P; k++) {
    memcpy(out + k * (m + P), d->J + k * m, m * sizeof *out);
    out[k * (m + P) + m + k] = d->hold;
  }
  return 0;
}

static int evaluate(void *descent, int m, int n, const sunrealtype *x, sunrealtype *fvec,
                    sunrealtype *fjac, int ldfjac, int flag)
{
  (void)m, (void)n, (void)ldfjac;
  return flag == 1 ? residuals(descent, x, fvec) : derivatives(descent, x, fjac);
}

typedef struct work {
  sunrealtype *x, *r, *J, *diag, *qtf, *wa;
  int *pivot;
} work;

static int open(stf_descent *d, work *w)
{
  const size_t P = (size_t)d->P, m = d->data->count + P;
  w->x = stf_pool_array(d->pool, P, sizeof *w->x);
  w->r = stf_pool_array(d->pool, m, sizeof *w->r);
  w->J = stf_pool_array(d->pool, m * P, sizeof *w->J);
  w->diag = stf_pool_array(d->pool, P, sizeof *w->diag);
  w->qtf = stf_pool_array(d->pool, P, sizeof *w->qtf);
  w->wa = stf_pool_array(d->pool, 3 * P + m, sizeof *w->wa);
  w->pivot = stf_pool_array(d->pool, P, sizeof *w->pivot);
  if (!w->x || !w->r || !w->J || !w->diag || !w->qtf || !w->wa || !w->pivot)
    return STEIF_NO_MEMORY;
  for (size_t i = 0; i < P; i++) w->diag[i] = 1;
  return STEIF_OK;
}

/* One call of lmder from p0, with a first step of at most `radius`; its return value. */
static int round_of(stf_descent *d, work *w, sunrealtype radius, int evaluations)
{
  const int P = d->P, m = (int)d->data->count + P;
  const sunrealtype tolerance = d->run.rtol;
  int calls = 0, slopes = 0;
  const int info = lmder(evaluate, d, m, P, w->x, w->r, w->J, m, tolerance, tolerance, 0,
                         evaluations, w->diag, 2, radius, 0, &calls, &slopes, w->pivot, w->qtf,
                         w->wa, w->wa + P, w->wa + 2 * P, w->wa + 3 * P);
  d->iterations += slopes;
  return info;
}

/* p0 becomes what was found, on the bounds where it is beyond them. */
static void move(stf_descent *d, work *w)
{
  int bound;
  for (int i = 0; i < d->P; i++) d->p[i] = stf_fit_value(d, w->x, i, &bound);
  memcpy(d->p0, d->p, (size_t)d->P * sizeof *d->p);
  memset(w->x, 0, (size_t)d->P * sizeof *w->x);
}

/* How long the first step may be for another round; 0: along no single parameter chi2 would fall by more than its
 * tolerance. */
static sunrealtype longer(const stf_descent *d, sunrealtype radius)
{
  const size_t m = d->data->count;
  sunrealtype share = 0, square = 0;
  for (size_t k = 0; k < (size_t)d->P; k++) {
    sunrealtype slope = 0, size = 0;
    for (size_t j = 0; j < m; j++) {
      const sunrealtype entry = d->J[k * m + j];
      slope += entry * d->r[j], size += entry * entry;
    }
    if (size == 0) continue;
    share = fmax(share, slope * slope / size / d->chi2);
    square += slope * slope / size / size;
  }
  if (!(share > 10 * d->run.rtol) || !isfinite(square) || !stf_fit_above_noise(d, share))
    return 0;
  return fmax(1, fmin(sqrt(square), d->log ? 10 * radius : INFINITY));
}

/* Is there more to find: a bound that may be left, or did the anchors weigh too much where J became smaller? */
static bool unfinished(const stf_descent *d, const work *w)
{
  bool more = d->hold > 4 * weight_of(d);
  for (int i = 0; i < d->P; i++) {
    int bound;
    stf_fit_value(d, w->x, i, &bound);
    more |= bound != 0;
  }
  return more;
}

/* lmder again from where it has stopped, as long as that is unfinished and chi2 falls. */
static int rounds(stf_descent *d, work *w, int *exhausted)
{
  const long end = d->runs + d->evaluations;
  sunrealtype before = INFINITY, radius = 1;
  *exhausted = 0;
  for (int k = 0; k < ROUNDS; k++) {
    d->hold = 0;
    const int info = round_of(d, w, radius, (int)(end - d->runs));
    if (info < 0) return d->stopped ? d->stopped : STEIF_RETRY;
    move(d, w);
    STEIF_TRY(stf_fit_run(d, w->x));
    *exhausted = info == 5 || d->runs >= end;
    const sunrealtype next = longer(d, radius);
    if (*exhausted || !(unfinished(d, w) || next > 0) || d->chi2 >= before * (1 - d->run.rtol))
      return STEIF_OK;
    radius = fmax(1, next);
    before = d->chi2;
  }
  return STEIF_OK;
}

int stf_fit_descend(stf_descent *d, int *exhausted)
{
  const stf_pool_mark mark = stf_pool_here(d->pool);
  work w;
  steif_forget(d->ctx);
  d->known = false, d->chi2 = INFINITY, d->iterations = 0, d->stopped = 0;
  int code = open(d, &w);
  if (!code) code = rounds(d, &w, exhausted);
  stf_pool_release(d->pool, mark);
  return code;
}

#else

int stf_fit_descend(stf_descent *d, int *exhausted)
{
  *exhausted = 0;
  return STEIF_FAIL(d->ctx, STEIF_UNSUPPORTED,
                    "steif was built without cminpack, which fits; install it (Debian: "
                    "libcminpack-dev) and build again");
}

#endif
