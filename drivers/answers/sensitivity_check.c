/* sensitivity_check.c: S at the end of a run beside differences of runs on its mesh; where an event ends it, d tau/dp and
 * the derivative of y(tau(p); p), since runs of other p end at other times.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int sensitivity_note(steif_solver *s, double t, N_Vector y, void *user)
{
  struct sensitivity_answer *a = user;
  (void)s, (void)y;
  if (a->times && t <= a->mesh[a->times - 1]) return a->times--, 0; /* an event moves with p */
  return mesh_add(&a->mesh, &a->times, &a->room, t);
}

/* n + 1 numbers by parameter and as many sizes of what they are sums of: dy/dp at the end, or along with the event, and
 * dtau/dp or 0. */
static int columns(struct call *call, struct sensitivity_answer *a, steif_solver *s, double t,
                   double *S)
{
  const size_t n = (size_t)a->problem->n;
  N_Vector d = N_VClone(steif_solution(s));
  if (!d) return no_memory(call, "a column of S", "name fewer parameters");
  const double *v = N_VGetArrayPointer(d);
  int code = STEIF_OK;
  for (int k = 0; !code && k < a->count; k++, S += 2 * (n + 1)) {
    double *size = S + n + 1;
    S[n] = 0;
    code = steif_sensitivity_output(s, t, a->active[k], d);
    for (size_t i = 0; i < n; i++) S[i] = v[i], size[i] = fabs(v[i]);
    if (!code && a->by_event) code = steif_sensitivity_event(s, a->active[k], S + n, d);
    for (size_t i = 0; i < n; i++) size[i] += a->by_event ? fabs(v[i] - S[i]) : 0, S[i] = v[i];
    size[n] = fabs(S[n]);
  }
  N_VDestroy(d);
  return code ? fail(call) : EXIT_OK;
}

/* Does the run end as the one that is checked does? */
static int same_end(struct call *call, const struct sensitivity_answer *a, int came)
{
  if (came && came != STEIF_EVENT) return fail(call);
  if ((came == STEIF_EVENT) == a->by_event) return EXIT_OK;
  say(call, "a run with a parameter moved by a little %s",
      a->by_event ? "does not meet the event that ends this one"
                  : "is ended by an event that this one does not meet");
  return EXIT_FAILED;
}

/* y and its time at the end of a run of p on the mesh, or past breaks; with derivatives their columns. */
static int on_mesh(struct call *call, struct sensitivity_answer *a, const steif_problem *p,
                   bool derivatives, double *row)
{
  steif_options o = a->options;
  const double end = a->options.h > 0 || !p->break_count ? a->mesh[a->times - 1] : o.t1;
  o.observe = NULL, o.sensitivities = derivatives;
  if (p->break_count == 0 || o.h > 0)
    o.mesh = a->mesh, o.mesh_size = a->times, o.h = 0;
  else if (!derivatives)
    tighten(p, &o);
  char method[sizeof a->used];
  snprintf(method, sizeof method, "%.*s", (int)strcspn(a->used, " "), a->used);
  steif_solver *s = steif_solver_new(call->ctx, p, method, &o);
  int code = same_end(call, a, s ? steif_solve_to(s, end) : steif_status(call->ctx));
  if (!code && derivatives) code = columns(call, a, s, steif_time(s), row);
  if (!code && !derivatives) {
    const double *y = a->by_event ? a->before : N_VGetArrayPointer(steif_solution(s));
    memcpy(row, y, (size_t)p->n * sizeof *row);
    row[p->n] = steif_time(s);
  }
  steif_solver_free(&s);
  return code;
}

/* out += weight y(p_k + d). */
static int moved(struct call *call, struct sensitivity_answer *a, int k, double d,
                 double weight, double *y, double *out)
{
  steif_problem p;
  int code = moved_problem(call, a->problem, k, NULL, d, &p);
  if (code) return code;
  code = on_mesh(call, a, &p, false, y);
  steif_problem_clear(call->ctx, &p);
  for (sunindextype i = 0; i <= a->problem->n; i++) out[i] += weight * y[i];
  return code;
}

/* Central differences with d and d / 2, extrapolated: (8 (y(d/2) - y(-d/2)) - (y(d) - y(-d))) / 6 d. */
static int difference(struct call *call, struct sensitivity_answer *a, int k, double d,
                      double *y, double *out)
{
  const double by[] = {d / 2, -d / 2, d, -d}, weight[] = {8, -8, -1, 1};
  int code = EXIT_OK;
  for (sunindextype i = 0; i <= a->problem->n; i++) out[i] = 0;
  for (int j = 0; !code && j < 4; j++)
    code = moved(call, a, k, by[j], weight[j] / (6 * d), y, out);
  return code;
}

/* The largest |S - difference| / (size of S + atol / (rtol scale_k)), of tau / (|dtau/dp| + |tau - t0| / scale_k). */
static int compare(struct call *call, struct sensitivity_answer *a, double *S, double *y,
                   double *out)
{
  const size_t n = (size_t)a->problem->n;
  int code = on_mesh(call, a, a->problem, true, S);
  for (int k = 0; !code && k < a->count; k++, S += 2 * (n + 1)) {
    const double p = sensitivity_scale(a, k), d = 2e-3 * p, shift = fabs(S[n]) * d;
    const double floor = tolerance_ratio(a->problem, &a->options) / p;
    const double shorter = a->by_event && shift > a->reach ? d * a->reach / shift : d;
    code = difference(call, a, a->active[k], shorter, y, out);
    for (size_t i = 0; !code && i < n + a->by_event; i++) {
      const double least = i < n ? floor : (a->t_event - a->problem->t0) / p;
      a->disagreement = fmax(a->disagreement, fabs(S[i] - out[i]) / (S[n + 1 + i] + least));
    }
  }
  a->checked = !code;
  return code;
}

int sensitivity_check(struct call *call, struct sensitivity_answer *a)
{
  const size_t row = (size_t)a->problem->n + 1, width = 2 * row * (size_t)a->count;
  double *S = malloc((width + 2 * row) * sizeof *S);
  if (!S) return no_memory(call, "the comparison", "leave --check out");
  const double t0 = a->problem->t0, t1 = a->options.t1;
  if (a->by_event) a->reach = event_mesh(&a->mesh, &a->times, t0, a->t_event, t1);
  const int code = a->reach < 0 ? no_memory(call, "the mesh", "leave --check out")
                                : compare(call, a, S, S + width, S + width + row);
  free(S);
  return code;
}
