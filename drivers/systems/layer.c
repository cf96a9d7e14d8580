/* layer.c: measure a layer, run another integrator beside it, show its errors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "layer.h"
#include "members.h"
#include "output.h"
#include "settings.h"
#include <stdlib.h>
#include <string.h>

int layer_measure(steif_context *ctx, struct layer *l, const char *method, const char *start)
{
  const size_t rows = l->steps + 1;
  l->t = calloc(rows * (2 + 2 * l->k), sizeof *l->t);
  if (!l->t) return STEIF_NO_MEMORY;
  l->error = l->t + rows;
  l->x = l->error + rows;
  l->exact = l->x + rows * l->k;
  return l->system
           ? steif_layer_linear(ctx, method, &l->system->system, l->system->x0, start, l->h,
                                l->steps, l->t, l->x, l->exact, l->error, &l->result)
           : steif_layer_measure(ctx, method, l->problem, start, l->h, l->steps, l->t, l->x,
                                 l->exact, l->error, &l->result);
}

void layer_free(struct layer *l) { free(l->t); }

outcome layer_against(steif_context *ctx, const struct layer *l, const char *method,
                      double rtol, double *error)
{
  const struct descriptor *q = l->system;
  steif_problem p;
  steif_options options = steif_defaults();
  outcome o = {0};
  *error = 0;
  options.rtol = rtol;
  options.max_steps = 300000;
  options.max_seconds = 10;
  options.t1 = l->t[l->steps];
  o.code = q ? steif_linear_problem(ctx, &q->system, q->x0, 0, options.t1, &p)
             : steif_problem_find(ctx, l->problem, &p);
  const bool found = !q && o.code == STEIF_OK;
  if (o.code == STEIF_OK)
    o.code =
      steif_deviation(ctx, &p, method, &options, l->steps, l->t + 1, l->exact + l->k, error);
  snprintf(o.message, sizeof o.message, "%s", o.code == STEIF_OK ? "ok" : steif_message(ctx));
  speak(o.message, sizeof o.message);
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

/* ---- the report ---- */

/* The setting of least error, of those that come to the end. */
static outcome best_against(const struct call *call, const struct layer *l, const char *method,
                            const char **spec, double *error)
{
  const double rtol = real_of(call, "--rtol");
  outcome best = layer_against(call->ctx, l, method, rtol, error);
  for (size_t i = 1; !strcmp(method, "ida") && settings_at(i); i++) {
    double off;
    const outcome o = layer_against(call->ctx, l, settings_at(i), rtol, &off);
    if (o.code || (!best.code && off >= *error)) continue;
    best = o;
    *error = off;
    *spec = settings_at(i);
  }
  return best;
}

static void arrays(steif_report *r, const struct layer *l)
{
  steif_report_list(r, "t", l->steps + 1, l->t);
  steif_report_matrix(r, "x", l->steps + 1, l->k, l->x);
  steif_report_matrix(r, "exact", l->steps + 1, l->k, l->exact);
  steif_report_list(r, "error", l->steps + 1, l->error);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct layer *l = result;
  const char *other = word_of(call, "--vs");
  const size_t n = given(call, "--component") ? 1 : l->k;
  const size_t first =
    given(call, "--component") ? (size_t)whole_of(call, "--component") - 1 : 0;
  steif_report_whole(r, "index", l->result.index);
  steif_report_real(r, "h", l->h);
  steif_report_whole(r, "layer_steps", l->result.layer_steps);
  for (size_t i = 0; i <= l->steps; i++) {
    steif_report_row(r, "rows");
    steif_report_whole(r, "rows.i", (long)i);
    steif_report_real(r, "rows.t", l->t[i]);
    steif_report_list(r, "rows.x", n, l->x + i * l->k + first);
    steif_report_list(r, "rows.exact", n, l->exact + i * l->k + first);
    steif_report_real(r, "rows.error", l->error[i]);
  }
  if (wants_arrays(call)) arrays(r, l);
  if (!other) return;
  double error;
  const char *spec = other;
  const outcome o = best_against(call, l, other, &spec, &error);
  steif_report_text(r, "ida.method", other);
  steif_report_text(r, "ida.settings", spec);
  report_status(r, "ida.", &o);
  report_maybe(r, "ida.", "error", o.code == STEIF_OK, error);
}

int layer_follow(struct call *call, struct layer *l)
{
  const size_t most = 10000000; /* numbers */
  if (l->steps > most / l->k)
    return bad_usage(call,
                     "%zu components with --steps %zu are too many numbers; take fewer steps",
                     l->k, l->steps);
  if (given(call, "--component") && whole_of(call, "--component") > (long)l->k)
    return bad_usage(call, "--component %s is not one of 1 .. %zu",
                     word_of(call, "--component"), l->k);
  int code = layer_measure(call->ctx, l, call->word[0], word_of(call, "--start"))
               ? descriptor_fail(call)
               : present_result(call, fill, l);
  if (!code) code = layer_plot(call, l, call->word[0]);
  layer_free(l);
  return code;
}
