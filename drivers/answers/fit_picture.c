/* fit_picture.c: measurements with error bars and the fitted solution, a panel for each component measured.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fitted.h"
#include <math.h>
#include <stdlib.h>

enum { PANELS = 8, POINTS = 401, CURVES = 3 };
static const double decades = 1000; /* a wider span of times has a logarithmic axis */

struct picture {
  sunindextype component[PANELS];
  size_t panels;
  bool log_t;
  double t[POINTS], y[PANELS][POINTS];
  double *bar_t, *bar, *at, *value; /* of one panel after another */
  double *output;                   /* of a model; NULL: it has none */
  char label[PANELS][STEIF_SPEC_WORD];
  steif_curve curve[PANELS][CURVES];
  steif_plot panel[PANELS];
};

static void measured_components(const steif_measurements *data, struct picture *x)
{
  for (size_t j = 0; j < data->count && x->panels < PANELS; j++) {
    size_t k = 0;
    while (k < x->panels && x->component[k] != data->component[j]) k++;
    if (k == x->panels) x->component[x->panels++] = data->component[j];
  }
}

static void times(const struct fitted *a, struct picture *x)
{
  const steif_measurements *data = &a->data;
  double first = INFINITY, last = -INFINITY;
  for (size_t j = 0; j < data->count; j++)
    first = fmin(first, data->t[j]), last = fmax(last, data->t[j]);
  x->log_t = first > 0 && last > decades * first;
  if (!x->log_t) first = a->problem->t0;
  for (int i = 0; i < POINTS; i++) {
    const double u = (double)i / (POINTS - 1);
    x->t[i] = i == POINTS - 1 ? last
              : x->log_t      ? first * pow(last / first, u)
                              : first + u * (last - first);
  }
}

/* What is measured, at point i; of an output, component n + its number. */
static void take(const steif_problem *p, struct picture *x, int i, N_Vector y)
{
  if (x->output) steif_model_outputs(p, x->t[i], y, x->output);
  for (size_t k = 0; k < x->panels; k++)
    x->y[k][i] = x->component[k] < p->n ? N_VGetArrayPointer(y)[x->component[k]]
                 : x->output            ? x->output[x->component[k] - p->n]
                                        : NAN;
}

/* The problem with the parameters found, and its solution. */
static int solution(const struct call *call, struct fitted *a, struct picture *x)
{
  steif_options o = a->run;
  o.t1 = x->t[POINTS - 1];
  steif_solver *s = steif_solver_new(call->ctx, a->problem, a->method, &o);
  int code = s ? STEIF_OK : STEIF_BAD_INPUT;
  for (int i = 0; !code && i < POINTS; i++) {
    if (x->t[i] > a->problem->t0) code = steif_solve_to(s, x->t[i]);
    if (!code) take(a->problem, x, i, steif_solution(s));
  }
  steif_solver_free(&s);
  return code ? fail(call) : EXIT_OK;
}

static int set(const struct call *call, struct fitted *a)
{
  double unused;
  for (int i = 0; i < a->count; i++) {
    const steif_parameters *q = a->problem->parameters;
    const int k = a->parameter[i];
    if (!steif_model_parameter(a->problem, 0, &unused))
      q->value[k] = a->fit.p[i];
    else if (steif_model_set(call->ctx, a->problem, q->name[k], a->fit.p[i]))
      return fail(call);
  }
  return EXIT_OK;
}

/* Bars d - sd .. d + sd with gaps between, and points, of the measurements of a panel; returns how many. */
static size_t points(const steif_measurements *data, sunindextype component, double *bar_t,
                     double *bar, double *t, double *value)
{
  size_t count = 0;
  for (size_t j = 0; j < data->count; j++) {
    if (data->component[j] != component) continue;
    const double sd = data->sd ? data->sd[j] : NAN;
    for (size_t i = 0; i < 3; i++) {
      bar_t[3 * count + i] = data->t[j];
      bar[3 * count + i] = i == 2 ? NAN : data->value[j] + (i ? sd : -sd);
    }
    t[count] = data->t[j], value[count++] = data->value[j];
  }
  return count;
}

static void panels(const struct fitted *a, struct picture *x)
{
  const steif_names *names = a->problem->names;
  size_t used = 0;
  for (size_t k = 0; k < x->panels; k++) {
    const long long i = x->component[k];
    double *bar_t = x->bar_t + 3 * used, *bar = x->bar + 3 * used;
    const size_t count = points(&a->data, i, bar_t, bar, x->at + used, x->value + used);
    const char *output =
      i < a->problem->n ? NULL : steif_model_output(a->problem, (size_t)(i - a->problem->n));
    if (output)
      snprintf(x->label[k], sizeof x->label[k], "%s", output);
    else if (names && names->unknown)
      snprintf(x->label[k], sizeof x->label[k], "%s", names->unknown[i]);
    else
      snprintf(x->label[k], sizeof x->label[k], "y%lld", i + 1);
    x->curve[k][0] = (steif_curve){"fit", POINTS, x->t, x->y[k], 0};
    x->curve[k][1] = (steif_curve){"measured", count, x->at + used, x->value + used, 2};
    x->curve[k][2] = (steif_curve){"+- sd", 3 * count, bar_t, bar, 0};
    x->panel[k] = (steif_plot){.y_label = x->label[k],
                               .log_x = x->log_t,
                               .count = a->data.sd ? 3 : 2,
                               .curve = x->curve[k]};
    used += count;
  }
}

static int draw(const struct call *call, struct fitted *a, struct picture *x)
{
  char title[160];
  measured_components(&a->data, x);
  times(a, x);
  int code = set(call, a);
  if (!code) code = solution(call, a, x);
  if (code) return code;
  panels(a, x);
  snprintf(title, sizeof title, "Fit: %s, chi2 = %.4g, dof = %ld", call->word[0], a->fit.chi2,
           a->fit.dof);
  x->panel[0].title = title, x->panel[x->panels - 1].x_label = "t";
  return steif_panels_save(call->ctx, x->panels, x->panel, call->plot) ? fail(call) : EXIT_OK;
}

int fitted_plot(const struct call *call, struct fitted *a)
{
  const size_t m = a->data.count;
  if (!call->plot) return EXIT_OK;
  struct picture *x = calloc(1, sizeof *x);
  size_t outputs = 0;
  while (steif_model_output(a->problem, outputs)) outputs++;
  double *room = malloc(8 * m * sizeof *room);
  int code = EXIT_OK;
  if (x && outputs) x->output = malloc(outputs * sizeof *x->output);
  if (x && room) {
    x->bar_t = room, x->bar = room + 3 * m, x->at = room + 6 * m, x->value = room + 7 * m;
    code = draw(call, a, x);
  } else
    code = no_memory(call, "the picture", "leave --plot out");
  if (x) free(x->output);
  free(x);
  free(room);
  return code;
}
