/* consistent.c: consistent start values: by stages where the structure is certified, else from
 * the whole derivative array, in passes over the numbers of the unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "exact_start.h"
#include <math.h>
#include <string.h>

/* -- report ------------------------------------------------------------------------------ */

/* The order of the list: by size, then as they stand; `last` = n: before all. */
static bool moved_less(const steif_start *start, size_t n, size_t j, size_t last)
{
  const sunrealtype a = fabs(start->moved[j]);
  const sunrealtype b = last < n ? fabs(start->moved[last]) : INFINITY;
  return a < b || (a == b && j > last);
}

static void list_moved(const stf_start_task *task, char *text)
{
  const stf_point *s = task->point;
  const steif_start *start = task->start;
  enum { SHOWN = 6 };
  char room[STEIF_SPEC_WORD];
  size_t last = s->n;
  for (int shown = 0; shown < SHOWN; shown++) {
    size_t at = s->n;
    for (size_t j = 0; j < s->n; j++)
      if (fabs(start->moved[j]) > 1e-9 * (fabs(s->y0[j]) + 1e-3 * s->floor[j]) &&
          moved_less(start, s->n, j, last) && (at == s->n || moved_less(start, s->n, at, j)))
        at = j;
    if (at == s->n) {
      if (shown == 0) stf_point_say(text, "no component moved");
      return;
    }
    last = at;
    stf_point_say(text, "%s%s by %.3g", shown ? ", " : "moved ", stf_point_unknown(s, at, room),
                  start->moved[at]);
  }
  stf_point_say(text, " ...");
}

/* Largest violation of an equation without derivatives by the guess; the others become 0. */
static void find_violation(const stf_start_task *task, sunrealtype *residual)
{
  const stf_view *v = task->view;
  for (sunindextype k = 0; k < v->column[v->n]; k++)
    if (v->has[k] & 1) residual[v->row[k]] = 0;
  task->start->worst = -1;
  for (size_t i = 0; i < v->n; i++)
    if (fabs(residual[i]) > task->start->violation)
      task->start->violation = fabs(residual[i]), task->start->worst = (sunindextype)i;
}

static void report(const stf_start_task *task, sunrealtype *residual)
{
  const stf_point *s = task->point;
  steif_start *start = task->start;
  char room[STEIF_SPEC_WORD], *text = start->message;
  for (size_t j = 0; j < s->n; j++) {
    start->moved[j] = start->y[j] - s->y0[j];
    if (start->enforced[j] > start->levels) start->levels = start->enforced[j];
  }
  find_violation(task, residual);
  if (start->worst >= 0 && start->violation > 1e-6 * task->scale[start->worst])
    stf_point_say(text, "equation %s is violated by %.2e at the guess; ",
                  stf_point_equation(s, (size_t)start->worst, room), start->violation);
  list_moved(task, text);
  if (start->levels > 0) {
    stf_point_say(text, "; enforced with their derivatives: ");
    stf_point_list(s, text, true, start->enforced, 1, true);
  }
}

/* -- choice of the way ------------------------------------------------------------------- */

/* The best array that closes, with indices of the components as diagnosed. */
static int by_array(stf_start_task *task, const stf_evidence *e, const steif_diagnosis *d)
{
  const stf_derivative_array *best = NULL;
  STEIF_CHECK(task->point->n <= STEIF_DIAGNOSE_LARGEST, task->point->ctx, STEIF_UNSUPPORTED,
              "'%s' has %zu unknowns, and its structure does not determine the order of its "
              "equations, without which a consistent start is computed for at most %d: %s",
              task->point->problem.name, task->point->n, STEIF_DIAGNOSE_LARGEST, d->message);
  for (int k = e->arrays - 1; k >= 0; k--)
    if (e->at[k].array.closed && (!best || e->at[k].array.index >= best->index))
      best = &e->at[k].array;
  STEIF_CHECK(best && d->index >= 0, task->point->ctx, STEIF_SINGULAR,
              "no consistent start: %s", d->message);
  return stf_start_array(task, best, d->number);
}

static int choose(stf_start_task *task, stf_evidence *e, const steif_diagnosis *d)
{
  stf_point *s = task->point;
  task->view = &e->view;
  STEIF_TRY(stf_view_take(s, s->t, s->y0, s->yp0, &e->view));
  task->scale = stf_pool_array(s->pool, s->n, sizeof *task->scale);
  if (!task->scale) return STEIF_NO_MEMORY;
  const int code = stf_start_scale(task);
  STEIF_CHECK(
    code <= 0, s->ctx, STEIF_CALLBACK,
    "'%s' cannot be evaluated at the guess, t = %g: give one inside the domain of its "
    "functions",
    s->problem.name, s->t);
  STEIF_TRY(code);
  return stf_evidence_certified(e) ? stf_start_stages(task, &e->offsets) : by_array(task, e, d);
}

int stf_start_from(stf_evidence *e, const steif_diagnosis *d, const steif_request *request,
                   steif_start *start)
{
  return stf_start_with(e, d, request, NULL, start);
}

int stf_start_with(stf_evidence *e, const steif_diagnosis *d, const steif_request *request,
                   stf_start_nodes *nodes, steif_start *start)
{
  static const steif_request none = {0};
  stf_point *s = e->point;
  stf_start_task task = {
    .point = s, .request = request ? request : &none, .start = start, .nodes = nodes};
  task.most = task.request->iterations > 0 ? task.request->iterations : 60;
  sunrealtype *residual = stf_pool_array(s->pool, s->n, sizeof *residual);
  if (!residual) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_start_allocate(s->ctx, s->n, start));
  int code = choose(&task, e, d);
  if (!code) code = stf_point_residual(s, s->t, s->y0, s->yp0, residual);
  if (!code) report(&task, residual);
  if (code) steif_start_clear(start);
  return code;
}

void stf_start_inertia(const stf_view *v, sunrealtype *weight)
{
  for (size_t j = 0; j < v->n; j++) {
    sunrealtype top = 0;
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      top = fmax(top, fabs(v->e[k]));
    weight[j] = top > 0 ? sqrt(top) : 1;
  }
}

/* request NULL: weights by inertia. */
static int start_from(stf_point *s, stf_evidence *e, const steif_diagnosis *d,
                      const steif_request *request, steif_start *start)
{
  steif_request inertia = {0};
  if (!request) {
    sunrealtype *weight = stf_pool_array(s->pool, s->n, sizeof *weight);
    if (!weight) return STEIF_NO_MEMORY;
    stf_start_inertia(&e->view, weight);
    inertia.weight = weight;
    request = &inertia;
  }
  return stf_start_from(e, d, request, start);
}

/* By tests of the index, of which there is no report; brief: those that agree are enough. */
static int find_by(stf_point *s, bool brief, const steif_request *request, steif_start *start)
{
  stf_evidence evidence;
  steif_diagnosis d = {.index = -1};
  s->brief = brief;
  int code = stf_diagnose(s, &evidence, &d);
  if (!code) code = start_from(s, &evidence, &d, request, start);
  stf_evidence_free(&evidence);
  steif_diagnosis_clear(&d);
  return code;
}

/* Brief tests may agree on an array from which no start is found where the best of all lengths has one; few iterations
 * are a look. */
static int find_diagnosed(stf_point *s, const steif_request *request, steif_start *start)
{
  const int code = find_by(s, true, request, start);
  const bool look = request && request->iterations > 0;
  if (!code || code == STEIF_NO_MEMORY || look) return code;
  steif_forget(s->ctx);
  return find_by(s, false, request, start);
}

/* By stages where test S certifies the structure, at the start that is found too: the other tests have no say in it. */
static int find_certified(stf_point *s, const steif_request *request, steif_start *start,
                          bool *certified, bool *found)
{
  stf_evidence evidence = {.point = s};
  const steif_diagnosis none = {.index = -1};
  int code = stf_evidence_structure(&evidence);
  *certified = !code && stf_evidence_certified(&evidence);
  if (*certified) {
    code = start_from(s, &evidence, &none, request, start);
    if (!code) code = stf_evidence_certified_at(&evidence, start, found);
    if (code || !*found) steif_start_clear(start);
  }
  stf_evidence_free(&evidence);
  return code;
}

static bool may_move(const stf_point *s, const steif_request *r)
{
  for (size_t j = 0; j < s->n; j++)
    if (!r || !r->attribute || r->attribute[j] != STEIF_FIXED) return true;
  return false;
}

/* Exact derivatives may stay at a singular point, as z = 0 of z^2 = 1, which differences leave by their rounding. */
static int find(stf_point *s, const steif_request *request, steif_start *start)
{
  bool certified = false, found = false;
  int code = find_certified(s, request, start, &certified, &found);
  if ((found && !code) || code == STEIF_NO_MEMORY) return code;
  steif_forget(s->ctx);
  if (certified) s->taylor = NULL;
  code = find_diagnosed(s, request, start);
  if (!code || code == STEIF_NO_MEMORY || !s->taylor || !may_move(s, request)) return code;
  s->taylor = NULL;
  steif_forget(s->ctx);
  return find_diagnosed(s, request, start);
}

int stf_start_project(steif_context *ctx, const steif_problem *problem, const steif_point *at,
                      steif_start *start)
{
  stf_point point;
  *start = (steif_start){0};
  STEIF_TRY(stf_point_open(ctx, problem, at, &point));
  const int code = find(&point, NULL, start);
  stf_point_close(&point);
  if (!code) steif_forget(ctx);
  return code;
}

/* Structure and system Jacobian only. */
static int find_beside(stf_point *s, stf_start_nodes *nodes, steif_start *start, int *number)
{
  stf_evidence e = {.point = s};
  const steif_diagnosis none = {.index = -1};
  steif_request inertia = {0};
  sunrealtype *weight = stf_pool_array(s->pool, s->n, sizeof *weight);
  if (!weight) return STEIF_NO_MEMORY;
  int code = stf_evidence_points(&e);
  if (!code) code = stf_evidence_offsets(&e);
  if (!code) code = stf_evidence_regular(&e);
  if (!code && !stf_evidence_certified(&e)) code = STEIF_UNSUPPORTED;
  if (!code) {
    stf_start_inertia(&e.view, weight);
    inertia.weight = weight;
    code = stf_start_with(&e, &none, &inertia, nodes, start);
  }
  for (size_t j = 0; !code && number && j < s->n; j++)
    number[j] = e.offsets.component_index[j] < 1 ? 1 : e.offsets.component_index[j];
  stf_evidence_free(&e);
  return code;
}

int stf_start_beside(steif_context *ctx, const steif_problem *problem, const steif_point *at,
                     stf_start_nodes *nodes, steif_start *start, int *number)
{
  stf_point point;
  *start = (steif_start){0};
  STEIF_TRY(stf_point_open(ctx, problem, at, &point));
  const int code = find_beside(&point, nodes, start, number);
  stf_point_close(&point);
  return code;
}

static int check_request(steif_context *ctx, const steif_problem *p, const steif_request *r)
{
  for (sunindextype j = 0; r && r->weight && j < p->n; j++)
    STEIF_CHECK(r->weight[j] > 0 && isfinite(r->weight[j]), ctx, STEIF_BAD_INPUT,
                "weight[%lld] = %g of the start of '%s' must be positive", (long long)j,
                r->weight[j], p->name);
  return STEIF_OK;
}

int stf_consistent_along(steif_context *ctx, const steif_problem *problem,
                         const steif_point *inquiry, const steif_request *request,
                         stf_taylor_of taylor, steif_start *start)
{
  stf_point point;
  *start = (steif_start){0};
  STEIF_TRY(stf_point_open(ctx, problem, inquiry, &point));
  point.taylor = taylor;
  int code = check_request(ctx, problem, request);
  static const steif_request none = {0};
  if (!code) code = find(&point, request ? request : &none, start);
  stf_point_close(&point);
  if (!code) steif_forget(ctx);
  return code;
}

int steif_consistent(steif_context *ctx, const steif_problem *problem,
                     const steif_point *inquiry, const steif_request *request,
                     steif_start *start)
{
  STF_NAMED(problem);
  STEIF_CHECK(start, ctx, STEIF_BAD_INPUT, "a place for the start is needed, got NULL");
  return stf_consistent_along(ctx, problem, inquiry, request, NULL, start);
}
