/* sensitivity_run.c: what `steif sensitivity` measures: S along a run, to its end or to an event that ends it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* t, y and the columns of S at a time of the last step, unknowns of index 2 and 3 computed from the others; where an
 * event has ended the run and changed y, y before that. */
static int keep(struct call *call, struct sensitivity_answer *a, steif_solver *s, double t,
                double *row)
{
  const size_t n = (size_t)a->problem->n, size = n * sizeof *row;
  N_Vector d = N_VClone(steif_solution(s));
  const bool other =
    a->by_event && memcmp(a->before, N_VGetArrayPointer(steif_solution(s)), size);
  int code = d ? STEIF_OK : STEIF_NO_MEMORY;
  row[0] = t;
  if (!code && !other) code = steif_output(s, t, d);
  if (!code) memcpy(row + 1, other ? a->before : N_VGetArrayPointer(d), size);
  for (int k = 0; !code && k < a->count; k++) {
    code = steif_sensitivity_output(s, t, a->active[k], d);
    if (!code) memcpy(row + 1 + n * (size_t)(k + 1), N_VGetArrayPointer(d), size);
  }
  if (d) N_VDestroy(d);
  return code == STEIF_NO_MEMORY ? no_memory(call, "a column of S", "name fewer parameters")
         : code                  ? fail(call)
                                 : EXIT_OK;
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
  for (size_t i = 1; !code && !a->by_event && i <= points; i++) {
    const double t = i < points ? t0 + (double)i / (double)points * span : a->options.t1;
    const int came = steif_solve_to(s, t);
    if (came && came != STEIF_EVENT) return ended(call, a);
    if (came) sensitivity_met(call, a, s);
    code = keep(call, a, s, came ? a->t_event : t, a->value + a->shown * a->width);
    if (code) return code;
    a->shown++;
    sensitivity_point(call, a);
  }
  return code || !a->by_event ? code : sensitivity_event(call, a, s);
}

/* Of --functional at the end. The integral up to an event grows by g where that comes later. */
static int integrals(struct call *call, struct sensitivity_answer *a, steif_solver *s)
{
  const steif_quadrature *q = a->problem->quadrature;
  const double t = a->by_event ? a->t_event : a->options.t1;
  double g = 0;
  if (!q) return EXIT_OK;
  int code = steif_quadrature_values(s, t, &a->integral);
  for (int k = 0; !code && k < a->count; k++)
    code = steif_quadrature_sensitivity(s, t, a->active[k], &a->gradient[k]);
  if (code) return fail(call);
  if (!a->by_event) return EXIT_OK;
  N_Vector y = N_VClone(steif_solution(s));
  if (!y) return no_memory(call, "the integrand", "leave --functional out");
  memcpy(N_VGetArrayPointer(y), a->value + (a->shown - 1) * a->width + 1,
         (size_t)a->problem->n * sizeof g);
  code = q->value(t, y, &g, q->user);
  N_VDestroy(y);
  for (int k = 0; k < a->count; k++) a->gradient[k] += code ? NAN : g * a->tau[k];
  return EXIT_OK;
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
    const bool moves = a->by_event && !(a->tau[k] == 0); /* the end alone */
    const char *said = most == 0 ? moves ? NULL : "has no influence"
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
  a->before = calloc((size_t)a->problem->n + 1, sizeof *a->before);
  if (!a->value || !a->before) return no_memory(call, "the values", "ask for fewer --points");
  if (given(call, "--check") && sensitivity_note(NULL, a->problem->t0, NULL, a))
    return no_memory(call, "the mesh", "leave --check out");
  a->options.sensitivities = 1, a->options.active = a->active,
  a->options.active_count = a->count;
  if (given(call, "--check")) a->options.observe = sensitivity_note;
  a->options.on_event = sensitivity_before, a->options.observer = a;
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
  const int checked = given(call, "--check") ? sensitivity_check(call, a) : EXIT_OK;
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
  free(a->total);
  free(a->before);
}
