/* observed_order.c: the observed order of a method on a problem whose end value is known.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "region_thresholds.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static int at_end(steif_context *ctx, const steif_problem *problem, sunrealtype t1,
                  N_Vector exact)
{
  const int code = problem->exact(t1, exact, NULL, problem->user);
  STEIF_CHECK(code == 0, ctx, STEIF_CALLBACK,
              "the exact solution of '%s' returned %d at t = %g", problem->name, code, t1);
  return STEIF_OK;
}

/* max_i |y_i - exact_i| through the operations of the vector. */
static int exact_error(steif_context *ctx, const steif_problem *problem, sunrealtype t1,
                       N_Vector y, sunrealtype *error)
{
  N_Vector exact = N_VClone(y);
  STEIF_CHECK(exact, ctx, STEIF_NO_MEMORY, "no memory for the exact solution");
  const int code = at_end(ctx, problem, t1, exact);
  if (code == STEIF_OK) {
    N_VLinearSum(1, y, -1, exact, exact);
    *error = N_VMaxNorm(exact);
  }
  N_VDestroy(exact);
  return code;
}

static int reference_error(steif_context *ctx, const steif_problem *problem, sunrealtype t1,
                           N_Vector y, sunrealtype *error)
{
  const steif_reference *ref = problem->reference;
  STEIF_CHECK(ref && fabs(ref->t - t1) <= STF_TIME_ROUNDING * fmax(1, fabs(t1)), ctx,
              STEIF_UNSUPPORTED,
              "'%s' has neither an exact solution nor a reference value at t = %g: %s",
              problem->name, t1, ref ? "end the run at the time of its reference" : "give one");
  const sunrealtype *value = N_VGetArrayPointer(y);
  STEIF_CHECK(value, ctx, STEIF_UNSUPPORTED,
              "the reference of '%s' needs vectors with a host array", problem->name);
  const sunindextype count = ref->count ? ref->count : problem->n;
  *error = 0;
  for (sunindextype i = 0; i < count; i++) {
    const sunindextype at = ref->component ? ref->component[i] : i;
    *error = fmax(*error, fabs(value[at] - ref->value[i]));
  }
  return STEIF_OK;
}

static int run(steif_context *ctx, const steif_problem *problem, const char *method,
               const steif_options *options, sunrealtype *error)
{
  steif_solver *s = steif_solver_new(ctx, problem, method, options);
  if (!s) return steif_status(ctx);
  int code = steif_solve_to(s, options->t1);
  if (code == STEIF_OK)
    code = (problem->exact ? exact_error : reference_error)(ctx, problem, options->t1,
                                                            steif_solution(s), error);
  steif_solver_free(&s);
  return code;
}

/* High orders reach rounding errors soon: they begin with longer steps. These divide the interval. */
static int usual_step(steif_context *ctx, const char *method, sunrealtype span, sunrealtype *h)
{
  steif_method_info m;
  STEIF_TRY(steif_method_find(ctx, method, &m));
  const sunrealtype most = m.order > 5 ? 0.5 : m.order > 2 ? 0.25 : 0.0625;
  *h = span / ceil(span / most * (1 - STF_TIME_ROUNDING));
  return STEIF_OK;
}

/* The method with compensated sums, where these are its family's and the spec does not say. */
static const char *compensated(steif_context *ctx, const steif_problem *problem,
                               const char *method, size_t room, char *spec)
{
  const bool sums = !strncmp(method, "gauss:", 6) && !strstr(method, "compensated") &&
                    steif_problem_form(ctx, problem) != STEIF_DESCRIPTOR;
  const int length = sums ? snprintf(spec, room, "%s,compensated=1", method) : 0;
  return length > 0 && (size_t)length < room ? spec : method;
}

int steif_order_measure(steif_context *ctx, const steif_problem *problem, const char *method,
                        const steif_options *options, sunrealtype h, size_t rows,
                        steif_order_row *row)
{
  STF_NAMED(problem);
  steif_options o = options ? *options : steif_defaults();
  STEIF_CHECK(problem && method, ctx, STEIF_BAD_INPUT, "a problem and a method are needed");
  if (o.t1 == 0) o.t1 = problem->t1;
  if (h == 0) STEIF_TRY(usual_step(ctx, method, o.t1 - problem->t0, &h));
  STEIF_CHECK(rows >= 1 && rows <= 40, ctx, STEIF_BAD_INPUT,
              "%zu rows were asked for: give 1 to 40", rows);
  stf_constant whole;
  STEIF_TRY(stf_constant_steps(ctx, h, problem->t0, o.t1, &whole));
  STEIF_CHECK(
    problem->exact || !(whole.rest > 0), ctx, STEIF_BAD_INPUT,
    "%ld steps of h = %.12g end at t = %.12g, and '%s' has its reference at %.12g alone: take "
    "h = %.12g, which divides the interval",
    whole.whole, h, whole.end, problem->name, o.t1,
    (o.t1 - problem->t0) / (sunrealtype)(whole.whole + 1));
  o.t1 = whole.end;
  o.mesh = NULL;
  o.mesh_size = 0;
  char spec[2 * STEIF_SPEC_WORD];
  const char *used = compensated(ctx, problem, method, sizeof spec, spec);
  for (size_t i = 0; i < rows; i++)
    row[i] = (steif_order_row){ldexp(h, -(int)i), NAN, NAN, o.t1, used != method, NAN};
  for (size_t i = 0; i < rows; i++) {
    o.h = row[i].h;
    STEIF_TRY(run(ctx, problem, used, &o, &row[i].error));
    if (i > 0) row[i].order = log2(row[i - 1].error / row[i].error);
  }
  return STEIF_OK;
}

/* ---- rounding ---- */

/* y - exact at the end of a run, and the largest |exact|. */
static int error_of(steif_context *ctx, const steif_problem *problem, const char *method,
                    const steif_options *options, N_Vector *error, sunrealtype *size)
{
  steif_solver *s = steif_solver_new(ctx, problem, method, options);
  if (!s) return steif_status(ctx);
  int code = steif_solve_to(s, options->t1);
  if (code == STEIF_OK && !(*error = N_VClone(steif_solution(s))))
    code = STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for the error");
  if (code == STEIF_OK) code = at_end(ctx, problem, options->t1, *error);
  if (code == STEIF_OK) {
    *size = N_VMaxNorm(*error);
    N_VLinearSum(1, steif_solution(s), -1, *error, *error);
  }
  steif_solver_free(&s);
  return code;
}

static int rounding_of(steif_context *ctx, const steif_problem *problem, const char *method,
                       steif_options *o, steif_order_row *row)
{
  enum { RUNS = 3 };
  N_Vector error[RUNS] = {NULL};
  const sunrealtype t0 = problem->t0, steps = round((row->end - t0) / row->h);
  int code = STEIF_OK;
  sunrealtype most = 0, size = 0;
  for (int k = 0; k < RUNS && code == STEIF_OK; k++) {
    o->h = row->h * (1 + (k == 0 ? 0 : k == 1 ? 1 : -1) * STF_SHAKEN_STEP);
    o->t1 = t0 + steps * o->h;
    code = error_of(ctx, problem, method, o, &error[k], &size);
    if (code || k == 0) continue;
    N_VLinearSum(1, error[k], -1, error[0], error[k]);
    most = fmax(most, N_VMaxNorm(error[k]));
  }
  for (int k = 0; k < RUNS; k++)
    if (error[k]) N_VDestroy(error[k]);
  if (code == STEIF_OK) row->rounding = STF_SHAKEN_MORE * most + STF_EPS * size;
  return code;
}

int steif_order_rounding(steif_context *ctx, const steif_problem *problem, const char *method,
                         const steif_options *options, size_t rows, steif_order_row *row)
{
  STF_NAMED(problem);
  steif_options o = options ? *options : steif_defaults();
  STEIF_CHECK(problem && method && row, ctx, STEIF_BAD_INPUT,
              "a problem, a method and its rows are needed");
  char spec[2 * STEIF_SPEC_WORD];
  const char *used = compensated(ctx, problem, method, sizeof spec, spec);
  o.mesh = NULL;
  o.mesh_size = 0;
  for (size_t i = 0; i < rows && problem->exact; i++)
    STEIF_TRY(rounding_of(ctx, problem, used, &o, &row[i]));
  return STEIF_OK;
}
