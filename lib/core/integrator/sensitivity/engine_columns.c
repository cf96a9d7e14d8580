/* engine_columns.c: derivatives by parameters that a baseline carries: what is served, and their start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

#define REFUSE(condition, ...) STEIF_CHECK(!(condition), s->ctx, STEIF_UNSUPPORTED, __VA_ARGS__)

static int check(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const steif_parameters *q = p->parameters;
  STEIF_CHECK(q && q->count > 0 && q->value, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' has no parameters: set .parameters", p->name);
  const bool broken = p->break_count > 0 && p->breaks[0] <= s->t1;
  REFUSE((p->events > 0 && p->handle_event) || broken,
         "'%s' carries no sensitivities through breaks and handled events such as those of "
         "problem '%s': take radau:s=3",
         s->spec, p->name);
  REFUSE(s->options.ewt, "sensitivities need tolerances, not options.ewt");
  REFUSE(N_VGetVectorID(s->run.y) != SUNDIALS_NVEC_SERIAL,
         "sensitivities of problem '%s' need serial vectors", p->name);
  STEIF_CHECK(!s->options.active || s->options.active_count > 0, s->ctx, STEIF_BAD_INPUT,
              "active_count = %d must be positive", s->options.active_count);
  return STEIF_OK;
}

static int choose(steif_solver *s, int i)
{
  const steif_parameters *q = s->problem->parameters;
  stf_engine_columns *c = &s->run.columns;
  const int k = s->options.active ? s->options.active[i] : i;
  STEIF_CHECK(k >= 0 && k < q->count, s->ctx, STEIF_BAD_INPUT,
              "active[%d] = %d must lie in 0 .. %d, the parameters of problem '%s'", i, k,
              q->count - 1, s->problem->name);
  for (int j = 0; j < i; j++)
    STEIF_CHECK(c->parameter[j] != k, s->ctx, STEIF_BAD_INPUT,
                "active names parameter %d twice", k);
  const sunrealtype typical = q->scale ? q->scale[k] : fabs(q->value[k]);
  STEIF_CHECK(isfinite(typical) && isfinite(q->value[k]), s->ctx, STEIF_NOT_FINITE,
              "parameter %d of problem '%s' is %g with the scale %g", k + 1, s->problem->name,
              q->value[k], typical);
  c->parameter[i] = k, c->scale[i] = typical > 0 ? typical : 1;
  const int code = steif_parameter_start(s->ctx, s->problem, k, c->S[i]);
  if (code) return code > 0 ? steif_status(s->ctx) : code;
  return stf_probe_start(s->ctx, s->problem, k, c->S[i]);
}

int stf_engine_carry(steif_solver *s)
{
  stf_engine_columns *c = &s->run.columns;
  STEIF_TRY(check(s));
  const int count = s->options.active ? s->options.active_count : s->problem->parameters->count;
  c->value = s->problem->parameters->value;
  c->parameter = stf_pool_array(s->pool, (size_t)count, sizeof *c->parameter);
  c->scale = stf_pool_array(s->pool, (size_t)count, sizeof *c->scale);
  c->S = stf_pool_vectors(s->pool, count, s->run.y);
  if (!c->parameter || !c->scale || !c->S) return STEIF_NO_MEMORY;
  for (int i = 0; i < count; i++) STEIF_TRY(choose(s, i));
  c->count = count;
  return s->engine->carry(&s->run, s->engine_state);
}

int stf_engine_carried(steif_solver *s, sunrealtype t, int k, N_Vector dy)
{
  const stf_engine_columns *c = &s->run.columns;
  int i = 0;
  STEIF_CHECK(dy && N_VGetLength(dy) == s->problem->n, s->ctx, STEIF_BAD_INPUT,
              "a vector of %lld components is needed for dy/dp", (long long)s->problem->n);
  while (i < c->count && c->parameter[i] != k) i++;
  STEIF_CHECK(i < c->count, s->ctx, STEIF_BAD_INPUT,
              "the derivative by parameter %d is not carried by this run", k);
  if (s->run.stats.steps > 0) return s->engine->carried(&s->run, s->engine_state, t, i, dy);
  STEIF_CHECK(t == s->run.t, s->ctx, STEIF_BAD_INPUT,
              "t = %.17g lies outside the start, t = %.17g", t, s->run.t);
  N_VScale(1, c->S[i], dy);
  return STEIF_OK;
}
