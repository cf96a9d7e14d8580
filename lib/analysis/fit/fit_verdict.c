/* fit_verdict.c: is it a minimum where a descent has ended?
 *
 * J promises that chi2 falls by |U^T r|^2, U of its singular vectors. Where that is more than the tolerance, the errors of
 * the runs and half a standard deviation ask for, and no step has brought it, chi2 is no parabola
 * there: it falls towards 0 or infinity of a parameter, or into runs that fail, or J is not its derivative. Where a
 * column of J is 0 another place tells whether the parameter has no part in the data, or no slope here.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include <math.h>
#include <string.h>

static const sunrealtype nothing = 1e-14, /* of the residuals: a column is 0 */
  weak = 1e-8,                            /* of the longest column: likewise */
  far_log = 7, far_linear = 1e3,          /* a way in log p, and in units of p */
  vague_log = 10, vague_linear = 1e3,     /* sd of log p, and of p in p */
  sure = 100;                             /* error of a solution in tolerances */

/* ---- slopes and their errors ----------------------------------------------------------------- */

/* |r| that the tolerances of the runs leave open. */
static sunrealtype noise_of(const stf_descent *d)
{
  const steif_measurements *data = d->data;
  sunrealtype sum = 0;
  for (size_t j = 0; j < data->count; j++) {
    const sunrealtype sd = data->sd ? data->sd[j] : 1;
    const sunrealtype y = d->r[j] + data->value[j] / sd;
    const sunrealtype error = d->run.rtol * fabs(y) + d->run.atol / sd;
    sum += error * error;
  }
  return sure * sqrt(sum);
}

bool stf_fit_above_noise(const stf_descent *d, sunrealtype share)
{
  return share * d->chi2 > noise_of(d) * noise_of(d);
}

/* Where a descent from p0 has brought p, in theta. */
static sunrealtype way(const stf_descent *d, int i)
{
  return d->log ? log(d->p0[i] / d->from[i]) : (d->p0[i] - d->from[i]) / d->unit[i];
}

static bool flat(const stf_descent *d, int i)
{
  sunrealtype longest = 0;
  for (int k = 0; k < d->P; k++) longest = fmax(longest, d->column[k]);
  return d->column[i] <= fmax(nothing * sqrt(d->chi2), weak * longest);
}

static bool distant(const stf_descent *d, int i)
{
  return fabs(way(d, i)) > (d->log ? far_log : far_linear);
}

/* ---- other places ---------------------------------------------------------------------------- */

/* chi2 at theta_i + by, or at the bound before, less than what it is here: -1, more: 1, neither: 0. */
static int compared(stf_descent *d, int i, sunrealtype by, sunrealtype least, sunrealtype *x,
                    int *bound)
{
  const sunrealtype here = d->chi2;
  x[i] = by;
  stf_fit_value(d, x, i, bound);
  const bool run = !stf_fit_run(d, x);
  x[i] = 0;
  const sunrealtype change = run ? d->chi2 - here : 0;
  d->chi2 = here;
  return fabs(change) <= least ? 0 : change < 0 ? -1 : 1;
}

/* A parameter along which chi2 has no slope. At a bound it is found where chi2 is not less inside. */
static enum stf_fate look(stf_descent *d, int i, sunrealtype *x)
{
  static const sunrealtype by[] = {1, -1, 0.1, -0.1, 1e-2, -1e-2, 1e-3, -1e-3};
  const bool low = d->p0[i] <= d->low[i], high = d->p0[i] >= d->high[i];
  const sunrealtype least = 1e-6 * d->chi2 + noise_of(d) * noise_of(d);
  int sides = 0, more = 0; /* of the four longest, within the bounds */
  for (int k = 0; k < (int)(sizeof by / sizeof *by); k++) {
    if (by[k] > 0 ? high : low) continue;
    int bound;
    const int sign = compared(d, i, by[k], least, x, &bound);
    if (sign < 0) return STF_NO_SLOPE;
    sides += k < 4 && !bound, more += k < 4 && !bound && sign > 0;
  }
  return low || high ? STF_FOUND : sides > 0 && more == sides ? STF_AT_REST : STF_IDLE;
}

int stf_fit_look_around(stf_descent *d)
{
  sunrealtype *x = stf_pool_array(d->pool, (size_t)d->P, sizeof *x);
  bool *doubtful = stf_pool_array(d->pool, (size_t)d->P, sizeof *doubtful);
  const long failed = d->failed;
  bool moved = false;
  if (!x || !doubtful) return STEIF_NO_MEMORY;
  for (int i = 0; i < d->P; i++) moved |= doubtful[i] = flat(d, i) && !distant(d, i);
  for (int i = 0; i < d->P; i++)
    if (doubtful[i]) d->fate[i] = look(d, i, x);
  d->failed = failed;
  return moved ? stf_fit_run(d, x) : STEIF_OK;
}

const char *stf_fit_place(const stf_descent *d, int i)
{
  return fabs(way(d, i)) <= 1e-6 ? "where the fit begins" : "where it has ended";
}

/* ---- the verdict ----------------------------------------------------------------------------- */

static bool vague(const stf_descent *d, const steif_fit *f, int i)
{
  const bool told = d->data->sd || f->dof > 0;
  const sunrealtype sd = d->data->sd || !told ? 1 : sqrt(f->chi2 / (sunrealtype)f->dof);
  const sunrealtype theta = sd * sqrt(stf_fit_variance(f, i, i));
  return d->log ? theta > vague_log : theta * d->unit[i] > vague_linear * fabs(f->p[i]);
}

/* Has it gone to 0 or infinity? */
static bool escaped(const stf_descent *d, const steif_fit *f, int i, bool stopped)
{
  if (d->fate[i] != STF_FOUND || f->bound[i]) return false;
  return flat(d, i) ? distant(d, i) : stopped && vague(d, f, i) && (d->log || distant(d, i));
}

/* Does J promise more than tolerance and errors of the runs ask for, and so many standard deviations? */
static bool stopped_early(const stf_descent *d, const steif_fit *f, sunrealtype deviations)
{
  return sqrt(d->share * fmax(1, (sunrealtype)f->dof)) > deviations &&
         d->share > 100 * d->run.rtol && stf_fit_above_noise(d, d->share);
}

void stf_fit_end_of(stf_descent *d, const steif_fit *f, sunrealtype share)
{
  int away = 0, idle = 0, slopeless = 0, others = 0;
  d->share = share;
  const bool stopped = stopped_early(d, f, 0.1);
  for (int i = 0; i < f->count; i++) {
    if (escaped(d, f, i, stopped))
      d->fate[i] = way(d, i) < 0 && d->log ? STF_TO_ZERO : STF_TO_INFINITY;
    away += d->fate[i] >= STF_TO_ZERO;
    idle += d->fate[i] == STF_IDLE, slopeless += d->fate[i] == STF_NO_SLOPE;
    others += d->fate[i] == STF_AT_REST || (d->fate[i] == STF_FOUND && !f->bound[i]);
  }
  d->end = slopeless || (idle && !others && !away) ? STF_AT_A_FLAT
           : away                                  ? STF_AWAY
           : !stopped_early(d, f, 0.5)             ? STF_AT_A_MINIMUM
           : d->blocked                            ? STF_AT_A_WALL
                                                   : STF_AGAINST_SLOPES;
}
