/* event_passages.c: events and breaks on the way forward, and lambda and mu back through them (transition.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "journey.h"
#include <math.h>
#include <string.h>

/* ---- forward --------------------------------------------------------------------------------- */

static int grow(stf_journey *J)
{
  const long room = J->passages_most ? 2 * J->passages_most : 8;
  stf_passed *more = stf_allocate(J->back.ctx, (size_t)room, sizeof *more);
  if (!more) return STEIF_NO_MEMORY;
  if (J->passages) memcpy(more, J->passed, (size_t)J->passages * sizeof *more);
  stf_release(J->back.ctx, J->passed);
  J->on_passages += (size_t)(room - J->passages_most) * sizeof *more;
  J->passed = more, J->passages_most = room;
  return STEIF_OK;
}

/* A break is met when the next step begins. */
static int add(void *of, bool broken, stf_transition **out)
{
  stf_journey *J = of;
  const stf_backwards *B = &J->back;
  if (J->passages == J->passages_most) STEIF_TRY(grow(J));
  stf_passed *p = &J->passed[J->passages];
  *p = (stf_passed){.step = J->steps - broken};
  STEIF_TRY(stf_transition_claim(B->ctx, B->n, B->P, B->count, &p->change));
  J->passages++;
  *out = &p->change;
  return STEIF_OK;
}

/* Before, integrands may have other values than at the time itself. */
static int gap(void *of, stf_transition *w, sunrealtype sign, sunrealtype t, N_Vector y)
{
  if (sign > 0) t = nextafter(t, -INFINITY);
  return stf_functional_add(&((stf_journey *)of)->back, sign, t, y, w->gap);
}

int stf_passages_open(stf_journey *J)
{
  stf_backwards *B = &J->back;
  const steif_problem *p = B->problem;
  if (p->event && B->functional->integrand) {
    const int rows = B->kind == STF_TRACE_BDF ? STF_PAST : B->table->s;
    B->extra = stf_pool_vectors(B->pool, (rows + 1) * B->count, B->space.like);
    if (!B->extra) return STEIF_NO_MEMORY;
  }
  J->keeper = (stf_transition_keeper){.of = J, .add = add, .gap = gap};
  return stf_transitions_watch(J->back.home, &J->keeper);
}

/* Gauss' nodes and weights up to x. */
static void nodes(stf_passed *p, sunrealtype x)
{
  long double node[STF_INSIDE], weight[STF_INSIDE];
  stf_gauss(STF_INSIDE, node, weight);
  for (int i = 0; i < STF_INSIDE; i++)
    p->x[i] = x * (sunrealtype)node[i], p->c[i] = x * (sunrealtype)weight[i];
  p->x[STF_INSIDE] = x;
}

/* y there, while the step is at hand. */
static int look_inside(stf_journey *J, stf_passed *p)
{
  stf_backwards *B = &J->back;
  steif_solver *s = J->runner;
  if (!B->functional->integrand) return STEIF_OK;
  const size_t n = (size_t)B->n;
  if (!(p->inside = stf_allocate(B->ctx, STF_INSIDE * n, sizeof *p->inside)))
    return STEIF_NO_MEMORY;
  J->on_passages += STF_INSIDE * n * sizeof *p->inside;
  for (int i = 0; i < STF_INSIDE; i++) {
    STEIF_TRY(stf_dense(s, s->step.t - s->step.h + p->x[i] * s->step.h, B->work));
    memcpy(p->inside + (size_t)i * n, STF_ARRAY(B->work), n * sizeof *p->inside);
  }
  return STEIF_OK;
}

/* Where in its step y was taken from dense output. */
static int cut(stf_journey *J, stf_passed *p)
{
  const stf_step *step = &J->runner->step;
  const sunrealtype from = step->t - step->h;
  stf_trace now = {0};
  if (p->change.t == step->t) return STEIF_OK;
  STEIF_TRY(step->method->trace(step, &now));
  p->cut = true;
  nodes(p, (p->change.t - from) / step->h);
  STEIF_TRY(look_inside(J, p));
  for (int i = 0; now.kind == STF_TRACE_BDF && i <= STF_INSIDE; i++) {
    const sunrealtype t = i < STF_INSIDE ? from + p->x[i] * step->h : p->change.t;
    sunrealtype node[STF_PAST];
    for (int j = 0; j <= now.order; j++) node[j] = now.t[j] - t;
    stf_interpolate(now.order, node, 0, p->weight[i]);
  }
  return STEIF_OK;
}

/* Where handle_event has ended the run it is the event before that which counts. */
static int end(stf_journey *J)
{
  const stf_passed *last = J->passages ? &J->passed[J->passages - 1] : NULL;
  if (last && last->step == J->steps)
    STEIF_TRY(stf_transition_recall(J->runner, &last->change));
  return stf_transition_end(J->runner);
}

int stf_passages_see(stf_journey *J)
{
  const long before = J->left;
  if (J->runner->finished) STEIF_TRY(end(J));
  for (; J->left < J->passages; J->left++) {
    stf_passed *p = &J->passed[J->left];
    J->on_passages += p->change.bytes;
    if (p->step == J->steps && p->change.kind != STF_PASSED) STEIF_TRY(cut(J, p));
  }
  STEIF_CHECK(J->left == before || J->on_passages <= J->limit, J->back.ctx, STEIF_BAD_INPUT,
              "a limit of %zu bytes is too small for the gradient of problem '%s': its %ld "
              "events and breaks to t = %.12g need %zu; raise .memory",
              J->limit, J->back.problem->name, J->passages, J->runner->end, J->on_passages);
  return STEIF_OK;
}

void stf_passages_close(stf_journey *J)
{
  for (long i = 0; i < J->passages; i++)
    stf_release(J->back.ctx, J->passed[i].inside),
      stf_transition_release(J->back.ctx, &J->passed[i].change);
  stf_release(J->back.ctx, J->passed);
  J->passed = NULL, J->passages = 0;
}

/* ---- back -------------------------------------------------------------------------------------- */

static sunrealtype dot(const stf_backwards *B, const sunrealtype *x, N_Vector v)
{
  const sunrealtype *y = STF_ARRAY(v);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < B->n; i++) sum += x[i] * y[i];
  return sum;
}

/* What has come to the slope at which steps began anew goes to y there. */
static int begun(stf_backwards *B, const stf_transition *w)
{
  const size_t size = (size_t)B->n * sizeof *w->y;
  memcpy(STF_ARRAY(B->Y[0]), w->y, size);
  memcpy(STF_ARRAY(B->Yp[0]), w->slope, size);
  return stf_pull_start(B, w->behind, B->Y[0], B->Yp[0]);
}

/* lambda := lambda + E_y^T lambda + sigma g_y^T, mu likewise, of one functional. */
static void react(stf_backwards *B, const stf_transition *w, int i, sunrealtype sigma)
{
  sunrealtype *lambda = STF_ARRAY(B->lambda[i]), *mu = B->mu + i * B->P;
  const sunrealtype *behind = STF_ARRAY(B->error);
  stf_copy(&B->space, B->lambda[i], B->error);
  for (size_t e = 0; e < w->entries; e++) {
    const stf_entry *a = &w->entry[e];
    sunrealtype *to = a->column < B->n ? lambda + a->column : mu + (a->column - B->n);
    *to += a->value * behind[a->row];
  }
  for (sunindextype j = 0; j < B->n; j++) lambda[j] += sigma * w->gy[j];
  for (int k = 0; k < B->P; k++) mu[k] += sigma * w->gp[k];
}

int stf_pull_passage(stf_backwards *B, const stf_transition *w)
{
  if (w->kind == STF_PASSED) return STEIF_OK;
  if (w->kind != STF_ENDED) STEIF_TRY(begun(B, w));
  if (w->kind == STF_ENDED)
    STEIF_TRY(stf_functional_by_time(B, w->t, B->before));
  else
    for (int i = 0; i < B->count; i++) B->g[i] = 0;
  for (int i = 0; i < B->count; i++) {
    const sunrealtype moved = dot(B, w->across, B->lambda[i]) + w->gap[i] + B->g[i];
    if (w->kind != STF_BROKEN)
      react(B, w, i, -moved / w->rate);
    else
      for (int k = 0; k < B->P; k++) B->mu[i * B->P + k] += w->gp[k] * moved;
  }
  return STEIF_OK;
}

static int pull_one(stf_journey *J)
{
  const stf_passed *p = &J->passed[--J->left];
  if (p->change.kind == STF_ENDED)
    stf_copy(&J->back.space, stf_last(J->runner), J->back.before);
  STEIF_TRY(stf_pull_passage(&J->back, &p->change));
  return stf_transition_recall(J->runner, &p->change);
}

int stf_passages_pull(stf_journey *J, long step, const sunrealtype *record)
{
  J->back.cut = NULL;
  while (J->left > 0 && J->passed[J->left - 1].step == step) {
    const stf_passed *p = &J->passed[J->left - 1];
    STEIF_TRY(pull_one(J));
    if (p->cut) J->back.cut = p;
  }
  return stf_pull(&J->back, record);
}

int stf_passages_first(stf_journey *J)
{
  while (J->left > 0) STEIF_TRY(pull_one(J));
  return STEIF_OK;
}
