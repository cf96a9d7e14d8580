/* sensitivity.c: derivatives by parameters beside a run: what is served, their start, and what is shown.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "probe.h"
#include "saltation.h"
#include <math.h>
#include <stdio.h>

/* ---- what is refused ------------------------------------------------------------------------ */

#define REFUSE(condition, ...) STEIF_CHECK(!(condition), s->ctx, STEIF_UNSUPPORTED, __VA_ARGS__)

static int check_method(const steif_solver *s)
{
  REFUSE(s->engine || !s->step.method->carrier,
         "'%s' carries no sensitivities: take collocation (radau:s=3), dirk:hw43 or bdf:p=5",
         s->spec);
  return STEIF_OK;
}

static int check_problem(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const steif_options *o = &s->options;
  REFUSE(p->dae_index > 3,
         "sensitivities of problem '%s' of index %d are not served: index 0 to 3", p->name,
         p->dae_index);
  REFUSE(p->constraint,
         "sensitivities are not served beside the constraints of problem '%s', which "
         "move the solution",
         p->name);
  REFUSE(o->ewt, "sensitivities need tolerances, not options.ewt");
  REFUSE(!s->step.system.space.serial, "sensitivities of problem '%s' need serial vectors",
         p->name);
  return STEIF_OK;
}

static int check_parameters(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const steif_parameters *q = p->parameters;
  STEIF_CHECK(q && q->count > 0 && q->value, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' has no parameters: set .parameters", p->name);
  REFUSE(q->obstacle, "sensitivities of problem '%s' cannot be had: %s", p->name, q->obstacle);
  for (int k = 0; k < q->count; k++) {
    STEIF_CHECK(!q->name || q->name[k], s->ctx, STEIF_BAD_INPUT,
                "parameter %d of %d of problem '%s' has no name: give all, or .name = NULL",
                k + 1, q->count, p->name);
    STEIF_CHECK(isfinite(q->value[k]), s->ctx, STEIF_NOT_FINITE,
                "parameter %d of problem '%s' is %g", k + 1, p->name, q->value[k]);
    STEIF_CHECK(!q->scale || (q->scale[k] > 0 && isfinite(q->scale[k])), s->ctx,
                STEIF_BAD_INPUT, "scale %g of parameter %d of problem '%s' must be positive",
                q->scale[k], k + 1, p->name);
  }
  return STEIF_OK;
}

/* ---- opening -------------------------------------------------------------------------------- */

static int choose(steif_solver *s, int count, int **parameter, sunrealtype **scale)
{
  const steif_options *o = &s->options;
  const steif_parameters *q = s->problem->parameters;
  *parameter = stf_pool_array(s->pool, (size_t)count, sizeof **parameter);
  *scale = stf_pool_array(s->pool, (size_t)count, sizeof **scale);
  if (!*parameter || !*scale) return STEIF_NO_MEMORY;
  for (int i = 0; i < count; i++) {
    const int k = o->active ? o->active[i] : i;
    STEIF_CHECK(k >= 0 && k < q->count, s->ctx, STEIF_BAD_INPUT,
                "active[%d] = %d must lie in 0 .. %d, the parameters of problem '%s'", i, k,
                q->count - 1, s->problem->name);
    for (int j = 0; j < i; j++)
      STEIF_CHECK((*parameter)[j] != k, s->ctx, STEIF_BAD_INPUT,
                  "parameter %d%s%.40s%s is named twice", k + 1, q->name ? " ('" : "",
                  q->name ? q->name[k] : "", q->name ? "')" : "");
    const sunrealtype typical = q->scale ? q->scale[k] : fabs(q->value[k]);
    (*parameter)[i] = k, (*scale)[i] = typical > 0 ? typical : 1;
  }
  return STEIF_OK;
}

/* A times |S_j| sqrt(2 + j): what the terms of A S are as large as; with a part of y/p, which differences may leave. */
static int size_of_terms(stf_carry *T, int k, N_Vector x, N_Vector out)
{
  static const sunrealtype part = 1e-5;
  sunrealtype *v = stf_array(x);
  const sunrealtype *S = stf_array(T->S[k]), *y = stf_array(T->step->y);
  for (sunindextype i = 0; i < T->step->problem->n; i++)
    v[i] = (fabs(S[i]) + part * fabs(y[i]) / T->scale[k]) * sqrt(2 + (sunrealtype)i);
  return stf_matrices_at_product(&T->at, 0, 'A', x, out);
}

/* Rows of E without entries, where E applied to a vector of no particular direction is exactly 0, are equations
 * that S fulfils at the start: A S = dF/dp, up to the accuracy of a start that was computed. Linear systems that begin as
 * they are given jump, and S as they do. */
static int check_start(steif_solver *s, stf_carry *T)
{
  const stf_step *step = &s->step;
  N_Vector Ex = T->Y, r = T->Yp, x = T->error[0];
  const bool linear = step->system.form == STEIF_DESCRIPTOR && step->system.linear;
  if (step->system.form == STEIF_ODE || (linear && !s->repair.pool)) return STEIF_OK;
  sunrealtype *v = stf_array(x);
  for (sunindextype i = 0; i < s->problem->n; i++) v[i] = sqrt(2 + (sunrealtype)i);
  int code = stf_carry_point(T, 0, step->t, step->y, step->yp);
  if (!code) code = stf_matrices_at_product(&T->at, 0, 'E', x, Ex);
  for (int k = 0; !code && k < T->count; k++) {
    code = stf_carry_residual(T, 0, k, T->S[k], NULL, r);
    if (!code) code = size_of_terms(T, k, x, T->next[k]);
    const sunrealtype *a = stf_array(T->next[k]), *e = stf_array(Ex), *d = stf_array(r),
                      *f = stf_array(T->slope[0][k]);
    for (sunindextype i = 0; !code && i < s->problem->n; i++) {
      char row[STEIF_SPEC_WORD];
      STEIF_CHECK(e[i] != 0 || fabs(d[i]) <= 1e-6 * fmax(fabs(f[i]), fabs(a[i])) + 1e-12,
                  s->ctx, STEIF_UNSUPPORTED,
                  "dy0/dp of parameter %d of problem '%s' does not fulfil the derivative of "
                  "algebraic equation %s (%.3g is left): give parameters.start",
                  T->parameter[k] + 1, s->problem->name, stf_equation(s->problem, i, row),
                  d[i]);
    }
  }
  return code > 0 ? steif_status(s->ctx) : code;
}

/* Memory for the columns, and what to do without. */
static int claim(steif_solver *s, int count, int *parameter, sunrealtype *scale, stf_carry **T)
{
  *T = stf_pool_array(s->pool, 1, sizeof **T);
  const int code = *T ? stf_carry_open(&s->step, count, parameter, scale, *T) : STEIF_NO_MEMORY;
  if (code != STEIF_NO_MEMORY) return code;
  return STEIF_FAIL(
    s->ctx, STEIF_NO_MEMORY,
    "no memory for derivatives of %lld unknowns of problem '%s' by %d parameters "
    "in '%s': name fewer in options.active, or take a gradient (gradient.h)",
    (long long)s->problem->n, s->problem->name, count, s->spec);
}

int stf_sensitivity_open(steif_solver *s)
{
  const steif_options *o = &s->options;
  int *parameter;
  sunrealtype *scale;
  s->step.carry = NULL, s->saltation = NULL;
  if (!o->sensitivities) return STEIF_OK;
  if (s->engine && s->engine->carry) return stf_engine_carry(s);
  STEIF_TRY(check_method(s));
  STEIF_TRY(check_problem(s));
  STEIF_TRY(check_parameters(s));
  STEIF_CHECK(!o->active || o->active_count > 0, s->ctx, STEIF_BAD_INPUT,
              "active_count = %d must be positive", o->active_count);
  const int count = o->active ? o->active_count : s->problem->parameters->count;
  STEIF_TRY(choose(s, count, &parameter, &scale));
  stf_carry *T;
  STEIF_TRY(claim(s, count, parameter, scale, &T));
  for (int k = 0; k < count; k++) {
    const int code = steif_parameter_start(s->ctx, s->problem, parameter[k], T->S[k]);
    if (code) return code > 0 ? steif_status(s->ctx) : code;
    STEIF_CHECK(stf_finite(&s->step.system.space, T->S[k]), s->ctx, STEIF_NOT_FINITE,
                "dy0/dp of parameter %d of problem '%s' is not finite", parameter[k] + 1,
                s->problem->name);
  }
  STEIF_TRY(stf_probe_open(s->pool, &s->step.system, T->slopes, parameter, count, &T->probe));
  STEIF_TRY(stf_probe_look(T->probe, s));
  STEIF_TRY(stf_probe_starts(s, T));
  STEIF_TRY(stf_start_derivatives(s, T));
  STEIF_TRY(stf_start_jumps(s, T));
  STEIF_TRY(check_start(s, T));
  s->step.carry = T;
  return stf_saltation_open(s);
}

/* ---- what is shown -------------------------------------------------------------------------- */

/* The place of parameter k in the list. */
int stf_column(const steif_solver *s, int k, int *i)
{
  if (!s) return STEIF_BAD_INPUT;
  const stf_carry *T = s->step.carry;
  STEIF_CHECK(T, s->ctx, STEIF_BAD_INPUT,
              "this run carries no sensitivities: set options.sensitivities");
  for (*i = 0; *i < T->count && T->parameter[*i] != k;) ++*i;
  STEIF_CHECK(*i < T->count, s->ctx, STEIF_BAD_INPUT,
              "the derivative by parameter %d is not carried by this run", k);
  return STEIF_OK;
}

int stf_column_dense(steif_solver *s, int k, sunrealtype t, N_Vector S)
{
  stf_carry *T = s->step.carry;
  return stf_event_passed(s) ? stf_event_recall(s, k, t, S) : T->carrier->dense(T, k, t, S);
}

int steif_sensitivity(steif_solver *s, sunrealtype t, int k, N_Vector dy)
{
  int i = 0;
  if (s && s->run.columns.count) return stf_engine_carried(s, t, k, dy);
  STEIF_TRY(stf_column(s, k, &i));
  const stf_carry *T = s->step.carry;
  STEIF_CHECK(dy && N_VGetLength(dy) == s->problem->n, s->ctx, STEIF_BAD_INPUT,
              "a vector of %lld components is needed for dy/dp", (long long)s->problem->n);
  const stf_step *step = &s->step;
  const sunrealtype slack = 1e-12 * (fabs(step->t) + step->h);
  STEIF_CHECK(t >= step->t - step->h - slack && t <= s->end + slack, s->ctx, STEIF_BAD_INPUT,
              "t = %.17g lies outside the last step [%.17g, %.17g]", t, step->t - step->h,
              s->end);
  const bool behind = s->saltation && s->saltation->pending && t >= s->end;
  if (t != step->t && !behind) return stf_column_dense(s, i, t, dy);
  N_VScale(1, behind ? s->saltation->jump[i] : T->S[i], dy);
  return STEIF_OK;
}

int steif_sensitivity_event(steif_solver *s, int k, sunrealtype *dt, N_Vector dy)
{
  int i = 0;
  STEIF_TRY(stf_column(s, k, &i));
  stf_saltation *w = s->saltation;
  STEIF_CHECK(w && isfinite(w->t), s->ctx, STEIF_BAD_INPUT, "no event has happened yet");
  STEIF_CHECK(
    w->known || w->t >= s->step.t - s->step.h, s->ctx, STEIF_BAD_INPUT,
    "the event at t = %.12g lies before the last step: ask in on_event, or before the "
    "next step",
    w->t);
  if (!w->known) STEIF_TRY(stf_saltation_times(s, w->t));
  if (dt) *dt = w->tau[i];
  if (dy) N_VLinearSum(1, w->S[i], w->tau[i], w->slope, dy);
  return STEIF_OK;
}

int steif_sensitivity_costs(const steif_solver *s, steif_sensitivity_cost *cost)
{
  if (!s || !cost) return STEIF_BAD_INPUT;
  const stf_carry *T = s->step.carry;
  *cost = (steif_sensitivity_cost){0};
  if (s->run.columns.count) s->engine->cost(&s->run, s->engine_state, cost);
  if (!T) return STEIF_OK;
  const bool tested = s->step.adaptive && !s->options.untested_sensitivities;
  *cost = (steif_sensitivity_cost){T->count, tested, T->sweeps, T->at.made, T->noise};
  return STEIF_OK;
}
