/* layer_run.c: measure a layer, run another integrator beside it, draw it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layer.h"
#include <stdlib.h>

int layer_measure(steif_context *ctx, struct layer *l, const char *method, const char *start)
{
  const size_t rows = l->steps + 1;
  l->t = calloc(rows * (2 + 2 * l->k), sizeof *l->t);
  if (!l->t) return STEIF_NO_MEMORY;
  l->error = l->t + rows, l->x = l->error + rows, l->exact = l->x + rows * l->k;
  return steif_layer_measure(ctx, method, l->problem, start, l->h, l->steps, l->t, l->x,
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
  outcome o = {.code = steif_problem_find(ctx, l->problem, &p)};
  const bool found = o.code == STEIF_OK;
  steif_solver *s = found ? steif_solver_new(ctx, &p, method, &options) : NULL;
  *error = 0;
  o.code = s ? follow(s, l, error) : steif_status(ctx);
  snprintf(o.message, sizeof o.message, "%s", o.code == STEIF_OK ? "ok" : steif_message(ctx));
  steif_solver_free(&s);
  if (found) steif_problem_clear(ctx, &p);
  steif_forget(ctx);
  return o;
}

/* Row 0 holds x(0-), which is no value of the solution on t > 0. */
int layer_plot(const struct call *call, const struct layer *l, const char *method,
               const char *path)
{
  enum { SHOWN = 4 };
  const size_t curves = l->k < SHOWN ? l->k : SHOWN, rows = l->steps;
  double *y = path ? malloc(2 * curves * rows * sizeof *y) : NULL;
  char label[2 * SHOWN][32], title[160];
  steif_curve curve[2 * SHOWN];
  for (size_t m = 0; y && m < 2 * curves; m++) {
    const bool own = m < curves;
    for (size_t i = 0; i < rows; i++)
      y[m * rows + i] = (own ? l->x : l->exact)[(i + 1) * l->k + m % curves];
    snprintf(label[m], sizeof label[m], "x%zu%s", m % curves + 1, own ? "" : " exact");
    curve[m] = (steif_curve){label[m], rows, l->t + 1, y + m * rows, own};
  }
  snprintf(title, sizeof title, "%s on %s, h = %g", method, l->problem, l->h);
  const steif_plot plot = {title, "t", "x", 0, 0, 0, 2 * curves, curve};
  if (path && !y) say(call, "no memory for the picture; leave it out");
  const int code = path && !y ? EXIT_FAILED : save_plot(call, &plot, path);
  free(y);
  return code;
}
