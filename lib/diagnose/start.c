/* start.c: consistent start values: by stages where the structure is certified, else from
 * the whole derivative array, in passes over the numbers of the unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "diagnose.h"
#include <math.h>
#include <string.h>

int stf_start_claim(steif_context *ctx, size_t n, steif_start *start)
{
  stf_pool *pool = stf_pool_new(ctx);
  *start = (steif_start){.memory = pool};
  if (!pool) return STEIF_NO_MEMORY;
  start->y = stf_claim(pool, 3 * n, sizeof *start->y);
  start->enforced = stf_claim(pool, n, sizeof *start->enforced);
  if (!start->y || !start->enforced) {
    steif_start_clear(start);
    return STEIF_NO_MEMORY;
  }
  start->yp = start->y + n, start->moved = start->y + 2 * n;
  return STEIF_OK;
}

void steif_start_clear(steif_start *start)
{
  if (!start) return;
  stf_pool *pool = start->memory;
  stf_pool_free(&pool);
  *start = (steif_start){0};
}

enum steif_attribute stf_start_attribute(const stf_task *task, size_t j)
{
  return task->request->attribute ? task->request->attribute[j] : STEIF_GUESS;
}

sunrealtype stf_start_weight(const stf_task *task, size_t j)
{
  return task->request->weight ? task->request->weight[j] : 1;
}

int stf_start_scale(stf_task *task)
{
  stf_lens *s = task->lens;
  const stf_view *v = task->view;
  memset(task->scale, 0, s->n * sizeof *task->scale);
  for (size_t j = 0; j < s->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      task->scale[v->row[k]] +=
        fabs(v->e[k] * s->yp0[j]) + fabs(v->b[k]) * fmax(fabs(s->y0[j]), s->floor[j]);
  STEIF_TRY(stf_diagnose_residual(s, s->t, s->y0, s->yp0, s->scratch));
  for (size_t i = 0; i < s->n; i++) {
    task->scale[i] = fmax(task->scale[i], fabs(s->scratch[i]));
    if (!(task->scale[i] > 0)) task->scale[i] = 1;
  }
  return STEIF_OK;
}

/* -- report ------------------------------------------------------------------------------ */

static void list_moved(const stf_task *task, char *text)
{
  const stf_lens *s = task->lens;
  const steif_start *start = task->start;
  enum { SHOWN = 6 };
  char room[STEIF_SPEC_WORD];
  bool done[STEIF_DIAGNOSE_LARGEST] = {false};
  for (int shown = 0; shown < SHOWN; shown++) {
    size_t at = s->n;
    for (size_t j = 0; j < s->n; j++)
      if (!done[j] && fabs(start->moved[j]) > 1e-9 * (fabs(s->y0[j]) + 1e-3 * s->floor[j]) &&
          (at == s->n || fabs(start->moved[j]) > fabs(start->moved[at])))
        at = j;
    if (at == s->n) {
      if (shown == 0) stf_diagnose_say(text, "no component moved");
      return;
    }
    done[at] = true;
    stf_diagnose_say(text, "%s%s by %.3g", shown ? ", " : "moved ",
                     stf_diagnose_unknown(s, at, room), start->moved[at]);
  }
  stf_diagnose_say(text, " ...");
}

/* Largest violation of an equation without derivatives by the guess. */
static void find_violation(const stf_task *task, const sunrealtype *residual)
{
  const stf_view *v = task->view;
  bool differential[STEIF_DIAGNOSE_LARGEST] = {false};
  for (sunindextype k = 0; k < v->column[v->n]; k++)
    if (v->has[k] & 1) differential[v->row[k]] = true;
  task->start->worst = -1;
  for (size_t i = 0; i < v->n; i++)
    if (!differential[i] && fabs(residual[i]) > task->start->violation)
      task->start->violation = fabs(residual[i]), task->start->worst = (sunindextype)i;
}

static void report(const stf_task *task, const sunrealtype *residual)
{
  const stf_lens *s = task->lens;
  steif_start *start = task->start;
  char room[STEIF_SPEC_WORD], *text = start->message;
  for (size_t j = 0; j < s->n; j++) {
    start->moved[j] = start->y[j] - s->y0[j];
    if (start->enforced[j] > start->levels) start->levels = start->enforced[j];
  }
  find_violation(task, residual);
  if (start->worst >= 0 && start->violation > 1e-6 * task->scale[start->worst])
    stf_diagnose_say(text, "equation %s is violated by %.2e at the guess; ",
                     stf_diagnose_equation(s, (size_t)start->worst, room), start->violation);
  list_moved(task, text);
  if (start->levels > 0) {
    stf_diagnose_say(text, "; enforced with their derivatives: ");
    stf_diagnose_list(s, text, true, start->enforced, 1, true);
  }
}

/* -- choice of the way ------------------------------------------------------------------- */

/* The best array that closes, with numbers by growth or else its own. */
static int by_array(stf_task *task, const stf_evidence *e)
{
  const stf_array *best = NULL;
  for (int k = e->arrays - 1; k >= 0; k--)
    if (e->at[k].array.closed && (!best || e->at[k].array.index >= best->index))
      best = &e->at[k].array;
  steif_diagnosis d;
  STEIF_TRY(stf_diagnosis_claim(task->lens->ctx, task->lens->n, &d));
  stf_verdict(e, &d);
  int code = STEIF_OK;
  if (!best || d.index < 0)
    code = STEIF_FAIL(task->lens->ctx, STEIF_SINGULAR, "no consistent start: %s", d.message);
  else
    code = stf_start_array(task, best, d.number);
  steif_diagnosis_clear(&d);
  return code;
}

static int choose(stf_task *task, stf_evidence *e)
{
  stf_lens *s = task->lens;
  task->view = &e->view;
  STEIF_TRY(stf_view_take(s, s->t, s->y0, s->yp0, &e->view));
  task->scale = stf_claim(s->pool, s->n, sizeof *task->scale);
  if (!task->scale) return STEIF_NO_MEMORY;
  const int code = stf_start_scale(task);
  STEIF_CHECK(
    code <= 0, s->ctx, STEIF_CALLBACK,
    "'%s' cannot be evaluated at the guess, t = %g: give one inside the domain of its "
    "functions",
    s->problem.name, s->t);
  STEIF_TRY(code);
  return stf_evidence_certified(e) ? stf_start_stages(task, &e->structure) : by_array(task, e);
}

int stf_start_from(stf_evidence *e, const steif_request *request, steif_start *start)
{
  static const steif_request none = {0};
  stf_lens *s = e->lens;
  stf_task task = {.lens = s, .request = request ? request : &none, .start = start};
  task.most = task.request->iterations > 0 ? task.request->iterations : 60;
  sunrealtype *residual = stf_claim(s->pool, s->n, sizeof *residual);
  if (!residual) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_start_claim(s->ctx, s->n, start));
  int code = choose(&task, e);
  if (!code) code = stf_diagnose_residual(s, s->t, s->y0, s->yp0, residual);
  if (!code) report(&task, residual);
  if (code) steif_start_clear(start);
  return code;
}

static int find(stf_lens *s, const steif_request *request, steif_start *start)
{
  stf_evidence evidence;
  int code = stf_evidence_gather(s, &evidence);
  if (!code) code = stf_start_from(&evidence, request, start);
  stf_evidence_free(&evidence);
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

int steif_consistent(steif_context *ctx, const steif_problem *problem,
                     const steif_inquiry *inquiry, const steif_request *request,
                     steif_start *start)
{
  stf_lens lens;
  STEIF_CHECK(start, ctx, STEIF_BAD_INPUT, "a place for the start is needed, got NULL");
  *start = (steif_start){0};
  STEIF_TRY(stf_diagnose_open(ctx, problem, inquiry, &lens));
  int code = STEIF_OK;
  if (lens.n > STEIF_DIAGNOSE_LARGEST)
    code = STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
                      "'%s' has %zu unknowns: a consistent start is computed for at most %d",
                      problem->name, lens.n, STEIF_DIAGNOSE_LARGEST);
  if (!code) code = check_request(ctx, problem, request);
  if (!code) code = find(&lens, request, start);
  stf_diagnose_close(&lens);
  if (!code) steif_forget(ctx);
  return code;
}
