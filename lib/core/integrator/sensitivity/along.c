/* along.c: derivatives of event functions and of what happens at events along lines in (t, y, p).
 *
 * The points of a difference lie 2^-8 of the size of what moves most from the event, half and a quarter of
 * that; the quotients extrapolated have an error of the sixth order, below rounding for functions that vary over their own
 * size: of index 3 what S is off its constraints is divided by the square of the first step. Where the first two do not
 * agree shorter ones are tried.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include <math.h>

/* Largest of the movements, in sizes of what moves. */
static sunrealtype largest(const steif_solver *s, const stf_line *line)
{
  const stf_saltation *w = s->saltation;
  const steif_parameters *q = s->problem->parameters;
  const sunrealtype span = 1e-2 * (s->t1 - s->problem->t0), floor = s->step.system.scale;
  const sunrealtype *y = stf_array(w->y), *dy = stf_array(line->dy);
  sunrealtype most = fabs(line->dt) / span;
  for (sunindextype i = 0; i < s->problem->n; i++)
    most = fmax(most, fabs(dy[i]) / (fabs(y[i]) + floor));
  if (line->k < 0) return most;
  const sunrealtype typical = q->scale ? q->scale[line->k] : fabs(q->value[line->k]);
  return fmax(most, 1 / (typical > 0 ? typical : 1));
}

int stf_set_parameter(const steif_solver *s, int k, sunrealtype value)
{
  const steif_parameters *q = s->problem->parameters;
  q->value[k] = value;
  return q->moved ? q->moved(s->problem->user) : 0;
}

static int at(steif_solver *s, stf_quantity_at what, const stf_line *line, sunrealtype x,
              N_Vector out)
{
  const stf_saltation *w = s->saltation;
  const sunrealtype p = line->k < 0 ? 0 : s->problem->parameters->value[line->k];
  N_VLinearSum(1, w->y, x, line->dy, w->point);
  int code = line->k < 0 ? 0 : stf_set_parameter(s, line->k, p + x);
  if (!code) code = what(s, w->t + x * line->dt, w->point, out);
  const int back = line->k < 0 ? 0 : stf_set_parameter(s, line->k, p);
  return code ? code : back;
}

/* out = (q(x) - q(-x)) / 2 x; *size: of the values. */
static int quotient(steif_solver *s, stf_quantity_at what, const stf_line *line, sunrealtype x,
                    N_Vector out, N_Vector other, sunrealtype *size)
{
  STEIF_TRY(at(s, what, line, x, out));
  STEIF_TRY(at(s, what, line, -x, other));
  *size = fmax(N_VMaxNorm(out), N_VMaxNorm(other));
  N_VLinearSum(0.5 / x, out, -0.5 / x, other, out);
  return isfinite(*size) ? STEIF_OK : STEIF_RETRY;
}

/* Quotients at x, x/2 and x/4 extrapolated to the sixth order; *off: how far the first two lie apart. */
static int extrapolated(steif_solver *s, stf_quantity_at what, const stf_line *line,
                        sunrealtype x, N_Vector out, N_Vector *work, sunrealtype *off,
                        sunrealtype *size)
{
  STEIF_TRY(quotient(s, what, line, x, work[0], work[2], size));
  STEIF_TRY(quotient(s, what, line, x / 2, work[1], work[2], size));
  N_VLinearSum(1, work[1], -1, work[0], work[2]);
  *off = N_VMaxNorm(work[2]);
  N_VLinearSum(-20.0 / 45, work[1], 1.0 / 45, work[0], work[1]);
  STEIF_TRY(quotient(s, what, line, x / 4, out, work[2], size));
  N_VLinearSum(64.0 / 45, out, 1, work[1], out);
  return STEIF_OK;
}

int stf_along(steif_solver *s, stf_quantity_at what, const stf_line *line, N_Vector out,
              N_Vector *work)
{
  const sunrealtype most = largest(s, line);
  int code = STEIF_OK;
  if (most == 0) return N_VConst(0, out), STEIF_OK;
  for (sunrealtype x = 1.0 / 256 / most, tries = 0; tries < 5; x /= 8, tries++) {
    sunrealtype off, size;
    code = extrapolated(s, what, line, x, out, work, &off, &size);
    if (code < 0) return code;
    if (code) continue;
    if (off <= 1e-4 * N_VMaxNorm(out) + 1e3 * STF_EPS * size / x) return STEIF_OK;
    code = STEIF_RETRY;
  }
  return code;
}
