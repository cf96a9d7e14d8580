/* trace.c: a run with equal steps on a Jordan block of the collection, recorded step by step.
 * SPDX-License-Identifier: BSD-3-Clause */
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

static sunrealtype component(const stf_trace *trace, int m, N_Vector y)
{
  const sunrealtype *value = N_VGetArrayPointer(y);
  return trace->apart ? stf_apart_component(trace->apart, m, value) : value[m];
}

static void keep(const stf_trace *trace, size_t i, sunrealtype t, N_Vector y)
{
  trace->t[i] = t;
  for (int m = 0; m < trace->count; m++)
    trace->x[i * (size_t)trace->count + (size_t)m] = component(trace, trace->first + m, y);
}

/* h sum_j b_j X_j g(t_n + c_j h) of the step just made from t. */
static int pair_stages(steif_context *ctx, steif_solver *s, const char *method, sunrealtype t,
                       sunrealtype h, stf_trace *trace)
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
    const sunrealtype g = steif_test_function(t + c[j] * h, 0);
    const long double term = (long double)h * b[j] * g * component(trace, trace->first, X[j]);
    trace->stage += term;
    trace->stage_size += fabsl(term);
  }
  return STEIF_OK;
}

static int follow(steif_context *ctx, steif_solver *s, const char *method, sunrealtype h,
                  stf_trace *trace)
{
  keep(trace, 0, steif_time(s), steif_solution(s));
  for (size_t i = 1; i <= trace->steps; i++) {
    STEIF_TRY(steif_solve_step(s));
    const sunrealtype t = steif_time(s), made = t - trace->t[i - 1];
    STEIF_CHECK(fabs(made - h) <= 1e-6 * h, ctx, STEIF_UNSUPPORTED,
                "%s made a step of %g at t = %g where %g was asked for; weak convergence is "
                "measured with equal steps",
                method, made, t, h);
    keep(trace, i, t, steif_solution(s));
    if (trace->stages) STEIF_TRY(pair_stages(ctx, s, method, trace->t[i - 1], h, trace));
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
  options.h = h;
  options.t1 = problem->t0 + h * (sunrealtype)trace->steps;
  options.start = start;
  options.max_steps = (long)trace->steps + 1;
  trace->stage = trace->stage_size = 0;
  steif_solver *s = steif_solver_new(ctx, problem, method, &options);
  if (!s) return steif_status(ctx);
  const int code = follow(ctx, s, method, h, trace);
  steif_solver_free(&s);
  return code;
}
