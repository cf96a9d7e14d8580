/* fit_run.c: residuals and their derivatives by one run with its sensitivities.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include <math.h>
#include <stdio.h>
#include <steif/model.h>
#include <steif/sensitivity.h>
#include <string.h>

/* ---- parameters ------------------------------------------------------------------------------ */

sunrealtype stf_fit_value(const stf_descent *d, const sunrealtype *x, int i, int *bound)
{
  const sunrealtype p = d->log ? d->p0[i] * exp(x[i]) : d->p0[i] + x[i] * d->unit[i];
  *bound = p <= d->low[i] ? -1 : p >= d->high[i] ? 1 : 0;
  return *bound < 0 ? d->low[i] : *bound > 0 ? d->high[i] : p;
}

static int set(stf_descent *d, int k, sunrealtype value)
{
  steif_parameters *q = (steif_parameters *)d->problem->parameters;
  sunrealtype unused;
  if (q->value[k] == value) return STEIF_OK;
  if (steif_model_parameter(d->problem, 0, &unused))
    return steif_model_set(d->ctx, d->problem, q->name[k], value);
  return steif_parameter_set(d->ctx, d->problem, k, value);
}

int stf_fit_restore(stf_descent *d)
{
  for (int i = 0; i < d->P; i++) STEIF_TRY(set(d, d->parameter[i], d->values[d->parameter[i]]));
  return STEIF_OK;
}

/* ---- a run ----------------------------------------------------------------------------------- */

/* Of what is measured, y[i] or an output: its value, or its derivative. */
static sunrealtype part(const stf_descent *d, sunindextype i, const sunrealtype *y,
                        const sunrealtype *output)
{
  return i < d->problem->n ? y[i] : output[i - d->problem->n];
}

/* The derivatives of the outputs by parameter k, dy/dp_k in d->S. */
static int output_slopes(stf_descent *d, sunrealtype t, N_Vector y, int k)
{
  if (!d->outputs) return STEIF_OK;
  d->toward[k] = 1;
  const int code =
    steif_model_output_tangent(d->ctx, d->problem, t, y, d->S, d->toward, d->slope);
  d->toward[k] = 0;
  return code;
}

/* Residuals of the measurements sorted[from .. to-1], all at t, which the solver shows, and their rows of J. */
static int take(stf_descent *d, steif_solver *s, sunrealtype t, size_t from, size_t to)
{
  const steif_measurements *data = d->data;
  const sunrealtype *y = N_VGetArrayPointer(steif_solution(s)), *S = N_VGetArrayPointer(d->S);
  if (d->outputs) steif_model_outputs(d->problem, t, steif_solution(s), d->output);
  for (size_t i = from; i < to; i++) {
    const size_t j = d->sorted[i].place;
    d->r[j] = (part(d, data->component[j], y, d->output) - data->value[j]) /
              (data->sd ? data->sd[j] : 1);
  }
  for (int k = 0; k < d->P; k++) {
    const sunrealtype slope = d->log ? d->p[k] : d->unit[k];
    STEIF_TRY(steif_sensitivity(s, t, d->parameter[k], d->S));
    STEIF_TRY(output_slopes(d, t, steif_solution(s), d->parameter[k]));
    for (size_t i = from; i < to; i++) {
      const size_t j = d->sorted[i].place;
      d->J[(size_t)k * data->count + j] =
        slope * part(d, data->component[j], S, d->slope) / (data->sd ? data->sd[j] : 1);
    }
  }
  return STEIF_OK;
}

static int arrive(stf_descent *d, steif_solver *s, sunrealtype t)
{
  const int code = steif_solve_to(s, t);
  STEIF_CHECK(code != STEIF_EVENT, d->ctx, STEIF_NOT_CERTIFIED,
              "an event ends the run at t = %.9g, before the measurement at t = %.9g",
              steif_time(s), t);
  return code;
}

static int follow(stf_descent *d, steif_solver *s)
{
  const size_t count = d->data->count;
  for (size_t from = 0, to; from < count; from = to) {
    const sunrealtype t = d->sorted[from].t;
    for (to = from; to < count && d->sorted[to].t == t;) to++;
    if (t > d->problem->t0) STEIF_TRY(arrive(d, s, t));
    STEIF_TRY(take(d, s, t, from, to));
  }
  return STEIF_OK;
}

static int attempt(stf_descent *d)
{
  for (int i = 0; i < d->P; i++) STEIF_TRY(set(d, d->parameter[i], d->p[i]));
  steif_solver *s = steif_solver_new(d->ctx, d->problem, d->method, &d->run);
  const int code = s ? follow(d, s) : steif_status(d->ctx);
  if (!code) snprintf(d->used, sizeof d->used, "%s", steif_method_used(s));
  steif_solver_free(&s);
  return code;
}

/* A failure that other values of the parameters do not cure. */
static bool final(int code)
{
  return code == STEIF_NO_MEMORY || code == STEIF_UNKNOWN_NAME || code == STEIF_UNSUPPORTED ||
         code == STEIF_TIME_LIMIT || code == STEIF_STOPPED || code == STEIF_BAD_INPUT;
}

static int finite(const stf_descent *d)
{
  const size_t m = d->data->count;
  for (size_t i = 0; i < m * (size_t)d->P; i++)
    STEIF_CHECK(isfinite(d->J[i]) && isfinite(d->r[i % m]), d->ctx, STEIF_NOT_FINITE,
                "the solution or its derivatives at t = %g are not finite", d->data->t[i % m]);
  return STEIF_OK;
}

/* Lengths of columns. Those of parameters beyond their bounds, and of those at a bound that chi2 descends through, are 0. */
static void project(stf_descent *d, const sunrealtype *x)
{
  const size_t m = d->data->count;
  for (int k = 0; k < d->P; k++) {
    int bound;
    const sunrealtype p = stf_fit_value(d, x, k, &bound);
    const sunrealtype raw = d->log ? d->p0[k] * exp(x[k]) : d->p0[k] + x[k] * d->unit[k];
    sunrealtype *column = d->J + (size_t)k * m, slope = 0, square = 0;
    for (size_t j = 0; j < m; j++)
      slope += column[j] * d->r[j], square += column[j] * column[j];
    d->column[k] = sqrt(square);
    if (bound && (raw != p || bound * slope <= 0)) memset(column, 0, m * sizeof *column);
  }
}

/* The best run from its store, or into it. */
static void exchange(stf_descent *d, bool store)
{
  const size_t m = d->data->count, P = (size_t)d->P;
  sunrealtype *const part[] = {d->p, d->r, d->J}, *best = d->best;
  const size_t count[] = {P, m, m * P};
  for (int i = 0; i < 3; best += count[i++])
    memcpy(store ? best : part[i], store ? part[i] : best, count[i] * sizeof *best);
}

static void remember(stf_descent *d)
{
  if (!(d->chi2 < d->least)) return;
  d->least = d->chi2, d->best_descent = d->descent;
  exchange(d, true);
}

void stf_fit_recall(stf_descent *d)
{
  d->chi2 = d->least;
  exchange(d, false);
}

int stf_fit_run(stf_descent *d, const sunrealtype *x)
{
  int bound;
  d->known = false;
  d->runs++;
  for (int i = 0; i < d->P; i++) d->p[i] = stf_fit_value(d, x, i, &bound);
  int code = attempt(d);
  if (!code) code = finite(d);
  if (code && final(code)) d->stopped = code;
  if (code) {
    d->failed++;
    snprintf(d->failure, sizeof d->failure, "%s", steif_message(d->ctx));
    return STEIF_RETRY;
  }
  project(d, x);
  d->chi2 = 0;
  for (size_t j = 0; j < d->data->count; j++) d->chi2 += d->r[j] * d->r[j];
  memcpy(d->at, x, (size_t)d->P * sizeof *x);
  d->known = true;
  remember(d);
  return STEIF_OK;
}
