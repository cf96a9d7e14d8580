/* layer_run.c: measure a layer, run another integrator beside it, collect its errors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layer.h"
#include <stdlib.h>

int layer_measure(steif_context *ctx, struct layer *l, const char *method, const char *start)
{
  const size_t rows = l->steps + 1;
  l->t = calloc(rows * (2 + 2 * l->k), sizeof *l->t);
  if (!l->t) return STEIF_NO_MEMORY;
  l->error = l->t + rows, l->x = l->error + rows, l->exact = l->x + rows * l->k;
  return l->system
           ? steif_layer_linear(ctx, method, &l->system->system, l->system->x0, start, l->h,
                                l->steps, l->t, l->x, l->exact, l->error, &l->result)
           : steif_layer_measure(ctx, method, l->problem, start, l->h, l->steps, l->t, l->x,
                                 l->exact, l->error, &l->result);
}

void layer_free(struct layer *l) { free(l->t); }

static int follow(steif_solver *s, const struct layer *l, double *error)
{
  int code = STEIF_OK;
  for (size_t i = 1; i <= l->steps && code == STEIF_OK; i++) {
    code = steif_solve_to(s, l->t[i]);
    const sunrealtype *x = N_VGetArrayPointer(steif_solution(s));
    for (size_t m = 0; m < l->k && code == STEIF_OK; m++) {
      const double d = x[m] - l->exact[i * l->k + m], size = d < 0 ? -d : d;
      if (!(size <= *error)) *error = size;
    }
  }
  return code;
}

outcome layer_against(steif_context *ctx, const struct layer *l, const char *method,
                      double rtol, double *error)
{
  steif_problem p;
  steif_options options = steif_defaults();
  options.rtol = rtol, options.t1 = l->t[l->steps];
  const struct linear *q = l->system;
  const bool found = !q && steif_problem_find(ctx, l->problem, &p) == STEIF_OK;
  const bool made =
    q && steif_linear_problem(ctx, &q->system, q->x0, 0, options.t1, &p) == STEIF_OK;
  outcome o = {0};
  steif_solver *s = found || made ? steif_solver_new(ctx, &p, method, &options) : NULL;
  *error = 0;
  o.code = s ? follow(s, l, error) : steif_status(ctx);
  snprintf(o.message, sizeof o.message, "%s", o.code == STEIF_OK ? "ok" : steif_message(ctx));
  steif_solver_free(&s);
  if (found) steif_problem_clear(ctx, &p);
  steif_forget(ctx);
  return o;
}

/* Row 0 holds x(0-), which is no value of the solution on t > 0. */
void layer_errors(const struct layer *l, const char *label, error_curves *errors)
{
  errors_open(errors, label);
  for (size_t i = 1; i <= l->steps; i++) errors_add(errors, l->t[i], l->error[i]);
}

int layer_plot(const struct call *call, const struct layer *l, const char *method)
{
  char title[160];
  snprintf(title, sizeof title, "%s on %s, h = %g", method, l->problem, l->h);
  error_curves errors = {.title = title, .y_label = LAYER_ERROR, .over_time = true};
  layer_errors(l, method, &errors);
  return errors_plot(call, &errors, call->plot);
}
