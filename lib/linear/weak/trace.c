/* trace.c: a run with constant steps on a descriptor system, recorded
 * step by step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "engine.h"
#include "weak_inside.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

bool stf_trace_is_cq(steif_context *ctx, const char *method, const char *start)
{
  steif_spec spec;
  if (start) return !strcmp(start, "cq");
  if (steif_spec_parse(ctx, method, &spec) != STEIF_OK) return false;
  const char *word = stf_spec_word(&spec, "start");
  return word && !strcmp(word, "cq");
}

/* Rows of components of the problem, and what is paired in the coordinates of the run. */
static int keep(const stf_trace *trace, long double *room, size_t i, sunrealtype t, N_Vector y)
{
  const sunrealtype *value = N_VGetArrayPointer(y);
  if (trace->t) trace->t[i] = t;
  for (int m = 0; trace->x && m < trace->count; m++)
    trace->x[i * (size_t)trace->count + (size_t)m] =
      trace->apart ? stf_apart_component(trace->apart, m, value) : value[m];
  if (!trace->pairing) return STEIF_OK;
  for (int m = 0; m < trace->pairing->n; m++) room[m] = value[m];
  return stf_pairing_node(trace->pairing, i, room);
}

/* The stages of step i + 1. */
static int pair_stages(steif_context *ctx, steif_solver *s, const char *method, size_t i,
                       const stf_trace *trace, long double *room)
{
  int count;
  const sunrealtype *b, *c;
  N_Vector *X;
  STEIF_TRY(steif_stages(s, &count, &c, &b, &X));
  STEIF_CHECK(
    count > 0 && b, ctx, STEIF_UNSUPPORTED,
    "%s has no stages with weights to pair with the test function: use convention R, P or C",
    method);
  for (int j = 0; j < count; j++) {
    const sunrealtype *value = N_VGetArrayPointer(X[j]);
    for (int m = 0; m < trace->pairing->n; m++) room[m] = value[m];
    STEIF_TRY(stf_pairing_stage(trace->pairing, i, c[j], b[j], room));
  }
  return STEIF_OK;
}

static int follow(steif_context *ctx, steif_solver *s, const char *method, sunrealtype h,
                  stf_trace *trace, long double *room)
{
  const bool stages = trace->pairing && trace->pairing->convention == STEIF_STAGE;
  sunrealtype t = steif_time(s);
  const sunrealtype t0 = t;
  STEIF_TRY(keep(trace, room, 0, t, steif_solution(s)));
  for (size_t i = 1; i <= trace->steps; i++) {
    if (trace->sides) stf_sides_step(trace->sides, t, t0 + (sunrealtype)i * h, STF_STEP_END);
    STEIF_TRY(stf_step_untimed(s));
    const sunrealtype made = steif_time(s) - t;
    STEIF_CHECK(fabs(made - h) <= 1e-6 * h, ctx, STEIF_UNSUPPORTED,
                "%s made a step of %g at t = %g where %g was asked for; weak convergence is "
                "measured with a constant step size",
                method, made, t, h);
    t = steif_time(s);
    STEIF_TRY(keep(trace, room, i, t, steif_solution(s)));
    if (stages) STEIF_TRY(pair_stages(ctx, s, method, i - 1, trace, room));
  }
  return STEIF_OK;
}

int stf_trace_run(steif_context *ctx, const steif_problem *problem, const char *method,
                  const char *start, sunrealtype h, stf_trace *trace)
{
  steif_problem apart;
  steif_options options = steif_defaults();
  if (trace->apart) {
    STEIF_TRY(stf_apart_problem(trace->apart, problem, &apart));
    problem = &apart;
  }
  steif_problem from = *problem;
  if (trace->continued) from.y0 = trace->state;
  options.h = h;
  options.t1 = problem->t0 + h * (sunrealtype)trace->steps;
  options.start = start;
  options.max_steps = (long)trace->steps + 1;
  long double *room = stf_allocate(ctx, (size_t)problem->n, sizeof *room);
  if (!room) return STEIF_NO_MEMORY;
  if (trace->sides) stf_sides_step(trace->sides, problem->t0, problem->t0 + h, STF_STEP_END);
  steif_solver *s = steif_solver_new(ctx, &from, method, &options);
  const int code = s ? follow(ctx, s, method, h, trace, room) : steif_status(ctx);
  if (!code && trace->state)
    memcpy(trace->state, N_VGetArrayPointer(steif_solution(s)),
           (size_t)problem->n * sizeof *trace->state);
  if (trace->sides) stf_sides_step(trace->sides, 0, 0, 0);
  steif_solver_free(&s);
  stf_release(ctx, room);
  return code;
}
