/* sensitivity_run.c: what `steif sensitivity` measures: S along a run, and by differences of runs on its mesh.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* t, y and the columns of S at a time of the last step, unknowns of index 2 and 3 computed from the others. */
static int keep(struct call *call, struct sensitivity_answer *a, steif_solver *s, double t,
                double *row)
{
  const size_t n = (size_t)a->problem->n;
  N_Vector d = N_VClone(steif_solution(s));
  int code = d ? STEIF_OK : STEIF_NO_MEMORY;
  row[0] = t;
  if (!code) code = steif_output(s, t, d);
  if (!code) memcpy(row + 1, N_VGetArrayPointer(d), n * sizeof *row);
  for (int k = 0; !code && k < a->count; k++) {
    code = steif_sensitivity_output(s, t, a->active[k], d);
    if (!code) memcpy(row + 1 + n * (size_t)(k + 1), N_VGetArrayPointer(d), n * sizeof *row);
  }
  if (d) N_VDestroy(d);
  return code == STEIF_NO_MEMORY ? no_memory(call, "a column of S", "name fewer parameters")
         : code                  ? fail(call)
                                 : EXIT_OK;
}

static int note(steif_solver *s, double t, N_Vector y, void *user)
{
  struct sensitivity_answer *a = user;
  (void)s, (void)y;
  if (a->times && t <= a->mesh[a->times - 1]) return a->times--, 0; /* an event moves with p */
  if (a->times == a->room) {
    double *more = realloc(a->mesh, 2 * (a->room + 64) * sizeof *more);
    if (!more) return 1;
    a->mesh = more, a->room = 2 * (a->room + 64);
  }
  a->mesh[a->times++] = t;
  return 0;
}

/* y at the end of a run of p on the mesh; with derivatives a row. */
static int on_mesh(struct call *call, struct sensitivity_answer *a, const steif_problem *p,
                   bool derivatives, double *row)
{
  steif_options o = a->options;
  o.mesh = a->mesh, o.mesh_size = a->times, o.h = 0, o.observe = NULL;
  o.sensitivities = derivatives;
  char method[sizeof a->used];
  snprintf(method, sizeof method, "%.*s", (int)strcspn(a->used, " "), a->used);
  steif_solver *s = steif_solver_new(call->ctx, p, method, &o);
  const double end = a->mesh[a->times - 1];
  int code = s && !steif_solve_to(s, end) ? EXIT_OK : fail(call);
  if (!code && derivatives) code = keep(call, a, s, end, row);
  if (!code && !derivatives)
    memcpy(row, N_VGetArrayPointer(steif_solution(s)), (size_t)p->n * sizeof *row);
  steif_solver_free(&s);
  return code;
}

/* out += weight y(p_k + d), of the problem found once more: a model makes start and form follow. */
static int moved(struct call *call, struct sensitivity_answer *a, int k, double d,
                 double weight, double *y, double *out)
{
  steif_problem p;
  double value = a->problem->parameters->value[k] + d, old;
  int code = find_problem(call, call->word[0], &p);
  if (code) return code;
  if (!steif_model_parameter(&p, 0, &old))
    code = steif_parameter_set(call->ctx, &p, k, value) ? fail(call) : EXIT_OK;
  else if (steif_model_set(call->ctx, &p, p.parameters->name[k], value))
    code = fail(call);
  if (!code) code = on_mesh(call, a, &p, false, y);
  steif_problem_clear(call->ctx, &p);
  for (sunindextype i = 0; i < a->problem->n; i++) out[i] += weight * y[i];
  return code;
}

/* Central differences with d and d / 2, extrapolated: (8 (y(d/2) - y(-d/2)) - (y(d) - y(-d))) / 6 d. */
static int difference(struct call *call, struct sensitivity_answer *a, int k, double d,
                      double *y, double *out)
{
  const double by[] = {d / 2, -d / 2, d, -d}, weight[] = {8, -8, -1, 1};
  int code = EXIT_OK;
  for (sunindextype i = 0; i < a->problem->n; i++) out[i] = 0;
  for (int j = 0; !code && j < 4; j++)
    code = moved(call, a, k, by[j], weight[j] / (6 * d), y, out);
  return code;
}

/* The largest |S - difference| / (|S| + atol / (rtol scale_k)). */
static int compare(struct call *call, struct sensitivity_answer *a, double *row, double *y,
                   double *out)
{
  const size_t n = (size_t)a->problem->n;
  int code = on_mesh(call, a, a->problem, true, row);
  for (int k = 0; !code && k < a->count; k++) {
    const double *S = row + 1 + n * (size_t)(k + 1), p = sensitivity_scale(a, k);
    code = difference(call, a, a->active[k], 2e-3 * p, y, out);
    const double floor = tolerance_ratio(a->problem, &a->options) / p;
    for (size_t i = 0; !code && i < n; i++)
      a->disagreement = fmax(a->disagreement, fabs(S[i] - out[i]) / (fabs(S[i]) + floor));
  }
  a->checked = !code;
  return code;
}

static int check(struct call *call, struct sensitivity_answer *a)
{
  const size_t n = (size_t)a->problem->n;
  double *row = malloc((a->width + 2 * n) * sizeof *row);
  if (!row) return no_memory(call, "the comparison", "leave --check out");
  const int code = compare(call, a, row, row + a->width, row + a->width + n);
  free(row);
  return code;
}

/* A run that stopped: by a signal after some rows, these are presented. */
static int ended(struct call *call, struct sensitivity_answer *a)
{
  a->outcome.code = steif_status(call->ctx);
  if (a->outcome.code != STEIF_STOPPED || !a->shown) return fail(call);
  snprintf(a->outcome.message, sizeof a->outcome.message, "%s", steif_message(call->ctx));
  return exit_of(a->outcome.code);
}

static int follow(struct call *call, struct sensitivity_answer *a, steif_solver *s,
                  size_t points)
{
  const double t0 = a->problem->t0, span = a->options.t1 - t0;
  int code = EXIT_OK;
  for (size_t i = 1; !code && i <= points; i++) {
    const double t = i < points ? t0 + (double)i / (double)points * span : a->options.t1;
    if (steif_solve_to(s, t)) return ended(call, a);
    code = keep(call, a, s, t, a->value + a->shown * a->width);
    if (code) return code;
    a->shown++;
    sensitivity_point(call, a);
  }
  return code;
}

/* Of --functional at the end. */
static int integrals(struct call *call, struct sensitivity_answer *a, steif_solver *s)
{
  if (!a->problem->quadrature) return EXIT_OK;
  int code = steif_quadrature_values(s, a->options.t1, &a->integral);
  for (int k = 0; !code && k < a->count; k++)
    code = steif_quadrature_sensitivity(s, a->options.t1, a->active[k], &a->gradient[k]);
  return code ? fail(call) : EXIT_OK;
}

static double size_of(const double *v, size_t n)
{
  double most = 0;
  for (size_t i = 0; i < n; i++) most = fmax(most, fabs(v[i]));
  return most;
}

/* After the message: a parameter whose column is 0, or which is 0 itself, columns that have outgrown y, and differences at
 * their rounding. */
static void remark(struct sensitivity_answer *a)
{
  const size_t n = (size_t)a->problem->n, room = sizeof a->outcome.message;
  const double *y = a->value + (a->shown - 1) * a->width + 1, much = 1e8;
  const steif_parameters *q = a->problem->parameters;
  const double floor = tolerance_ratio(a->problem, &a->options);
  char *to = a->outcome.message, name[STEIF_SPEC_WORD];
  for (int k = 0; k < a->count; k++) {
    const double most = size_of(y + (size_t)(k + 1) * n, n), p = sensitivity_scale(a, k);
    const char *said = most == 0 ? "has no influence"
                       : p * most > much * fmax(size_of(y, n), floor)
                         ? "changes y by more than 1e8 of itself: the solution forgets its past"
                       : q->value[a->active[k]] == 0 && !q->scale
                         ? "is 0: its scale is taken for 1"
                         : NULL;
    const size_t used = strlen(to);
    if (said) snprintf(to + used, room - used, "; %s %s", sensitivity_name(a, k, name), said);
  }
  const size_t used = strlen(to);
  if (a->cost.noise > 1)
    snprintf(
      to + used, room - used,
      "; differences by parameters are off by %.2g tolerances, which were raised to that",
      a->cost.noise);
}

static int stopped(struct call *call, struct sensitivity_answer *a, int code)
{
  const int shown = sensitivity_present(call, a);
  say(call, "%s", a->outcome.message);
  return shown ? shown : code;
}

int sensitivity_measure(struct call *call, struct sensitivity_answer *a)
{
  const size_t points = (size_t)whole_of(call, "--points");
  a->width = 1 + (size_t)a->problem->n * (size_t)(a->count + 1);
  a->value = malloc(points * a->width * sizeof *a->value);
  if (!a->value) return no_memory(call, "the values", "ask for fewer --points");
  if (given(call, "--check") && note(NULL, a->problem->t0, NULL, a))
    return no_memory(call, "the mesh", "leave --check out");
  a->options.sensitivities = 1, a->options.active = a->active,
  a->options.active_count = a->count;
  if (given(call, "--check")) a->options.observe = note, a->options.observer = a;
  a->report = steif_report_new(call->ctx);
  if (!a->report) return fail(call);
  sensitivity_begin(call, a);
  progress(call, "%s on %s", call->word[1], a->problem->name);
  snprintf(a->outcome.message, sizeof a->outcome.message, "ok");
  steif_solver *s = steif_solver_new(call->ctx, a->problem, call->word[1], &a->options);
  int code = s ? follow(call, a, s, points) : fail(call);
  if (!code) code = integrals(call, a, s);
  if (s) a->outcome.stats = *steif_statistics(s);
  if (s) snprintf(a->used, sizeof a->used, "%s", steif_method_used(s));
  steif_sensitivity_costs(s, &a->cost);
  if (!code) remark(a);
  steif_solver_free(&s);
  if (code && a->outcome.code == STEIF_STOPPED && a->shown) return stopped(call, a, code);
  if (code) return code;
  const int checked = given(call, "--check") ? check(call, a) : EXIT_OK;
  if (checked)
    say(call,
        "so ends a run on the same mesh, with a parameter moved: nothing is compared; the "
        "derivatives are those of a run that went well");
  const int shown = sensitivity_present(call, a);
  return checked ? checked : shown;
}

void sensitivity_close(struct sensitivity_answer *a)
{
  steif_report_free(&a->report);
  free(a->value);
  free(a->mesh);
}
