/* failure.c: a failed run once more with its points kept, and what stopped it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "causes.h"
#include "integrator.h"
#include <ctype.h>
#include <math.h>
#include <steif/failure.h>
#include <string.h>

/* Points; the last quarter is not thinned. Large problems keep fewer, of so many numbers in all. */
enum { KEPT = 400, FEWEST = 24, NUMBERS = 20000000 };

typedef struct record {
  const steif_problem *problem;
  size_t n, count, room;
  sunrealtype *t, *y, *yp; /* room times, room x n values by rows */
  bool ode, restarted;     /* the last point came a second time */
  N_Vector slope;
} record;

/* Every other point of those older than the recent ones goes. */
static void thin(record *r)
{
  size_t to = 0;
  for (size_t k = 0; k < r->count; k++) {
    if (k + r->room / 4 < r->count && k % 2) continue;
    r->t[to] = r->t[k];
    memmove(r->y + to * r->n, r->y + k * r->n, r->n * sizeof *r->y);
    memmove(r->yp + to * r->n, r->yp + k * r->n, r->n * sizeof *r->yp);
    to++;
  }
  r->count = to;
}

/* y' = f, or the difference to the point before. */
static void slope(record *r, sunrealtype t, N_Vector y, size_t k)
{
  const size_t n = r->n;
  sunrealtype *yp = r->yp + k * n;
  if (r->ode && !r->problem->f(t, y, r->slope, r->problem->user))
    memcpy(yp, N_VGetArrayPointer(r->slope), n * sizeof *yp);
  else if (k > 0) {
    const sunrealtype *now = r->y + k * n, *last = now - n, h = t - r->t[k - 1];
    for (size_t j = 0; j < n; j++) yp[j] = (now[j] - last[j]) / h;
    if (k == 1) memcpy(r->yp, yp, n * sizeof *yp);
  }
}

static int keep(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  record *r = user;
  (void)s;
  r->restarted = r->count > 0 && !(t > r->t[r->count - 1]);
  if (r->restarted) r->count--; /* the same time anew */
  if (r->count == r->room) thin(r);
  const size_t k = r->count++;
  r->t[k] = t;
  memcpy(r->y + k * r->n, N_VGetArrayPointer(y), r->n * sizeof *r->y);
  slope(r, t, y, k);
  return 0;
}

static int open_record(stf_pool *pool, const steif_problem *p, int form, N_Vector y, record *r)
{
  const size_t n = (size_t)p->n;
  const size_t room = NUMBERS / n > KEPT ? KEPT : NUMBERS / n < FEWEST ? FEWEST : NUMBERS / n;
  *r = (record){.problem = p, .n = n, .room = room, .ode = form == STEIF_ODE};
  r->t = stf_pool_array(pool, room, sizeof *r->t);
  r->y = stf_pool_array(pool, room * n, sizeof *r->y);
  r->yp = stf_pool_array(pool, room * n, sizeof *r->yp);
  r->slope = stf_pool_vector(pool, y);
  return r->t && r->y && r->yp && r->slope ? STEIF_OK : STEIF_NO_MEMORY;
}

/* -- facts ------------------------------------------------------------------------------- */

/* The components with the largest share of the error test, by insertion. */
static void worst(steif_failure *f, const stf_step *step, size_t n)
{
  sunrealtype share[STEIF_WORST];
  const sunrealtype *error = N_VGetArrayPointer(step->error);
  const sunrealtype *w = N_VGetArrayPointer(step->weights);
  for (size_t i = 0; i < n; i++) {
    const sunrealtype part = fabs(error[i]) * w[i];
    int at = f->count < STEIF_WORST ? f->count++ : STEIF_WORST - 1;
    if (at == STEIF_WORST - 1 && i >= STEIF_WORST && part <= share[at]) continue;
    for (; at > 0 && part > share[at - 1]; at--)
      share[at] = share[at - 1], f->worst[at] = f->worst[at - 1];
    share[at] = part;
    f->worst[at].component = (sunindextype)i;
    f->worst[at].error = error[i], f->worst[at].allowed = 1 / w[i];
  }
}

static void facts(const steif_solver *s, steif_failure *f)
{
  const stf_step *step = &s->step;
  f->t = s->engine ? s->run.t : step->t;
  f->steps = s->engine ? s->run.stats.steps : step->count;
  f->h = s->engine ? s->run.stats.h_last : step->adaptive ? s->h_tried : step->h_equal;
  if (s->engine || !step->adaptive) return;
  f->order = step->control.order;
  if (step->system.space.serial) worst(f, step, (size_t)s->problem->n);
}

/* Where F cannot be had there are none. */
static int residuals(steif_context *ctx, const record *r, const steif_point *q,
                     steif_failure *f)
{
  stf_point point;
  const int opened = stf_point_open(ctx, r->problem, q, &point);
  for (int k = 0; k < f->count && opened; k++) f->worst[k].residual = NAN;
  if (opened) return opened == STEIF_NO_MEMORY ? opened : STEIF_OK;
  sunrealtype *F = stf_pool_array(point.pool, r->n, sizeof *F);
  const int code =
    F ? stf_point_residual(&point, point.t, point.y0, point.yp0, F) : STEIF_NO_MEMORY;
  for (int k = 0; k < f->count && !code; k++) f->worst[k].residual = F[f->worst[k].component];
  stf_point_close(&point);
  return code < 0 ? code : STEIF_OK;
}

static void say(steif_failure *f, const steif_problem *p)
{
  const bool named = p->names && p->names->unknown;
  char *m = f->message;
  size_t used = 0;
  const size_t room = sizeof f->message;
  used += (size_t)snprintf(m, room, "Stopped at t = %.9g after %ld steps", f->t, f->steps);
  if (f->h > 0) used += (size_t)snprintf(m + used, room - used, ", last tried h = %.3g", f->h);
  if (f->order > 0)
    used += (size_t)snprintf(m + used, room - used, " with an estimate of order %d", f->order);
  for (int k = 0; k < f->count; k++) {
    const sunindextype i = f->worst[k].component;
    char name[STEIF_SPEC_WORD];
    snprintf(name, sizeof name, "y%lld", (long long)i + 1);
    used +=
      (size_t)snprintf(m + used, room - used, "%s %s (error %.2g, allowed %.2g, residual %.2g)",
                       k ? "," : "; worst", named ? p->names->unknown[i] : name,
                       f->worst[k].error, f->worst[k].allowed, f->worst[k].residual);
  }
  snprintf(m + used, room - used, ". %s", f->cause.message);
}

/* -- the run ------------------------------------------------------------------------------- */

static int explain(steif_solver *s, const record *r, steif_failure *f)
{
  const size_t last = r->count - 1;
  const steif_point q = {.y = r->y + last * r->n, .yp = r->yp + last * r->n, .t = r->t[last]};
  const stf_step *step = &s->step;
  const steif_history scene = {.h = f->h > 0 ? f->h : s->stats.h_last,
                               .count = r->count,
                               .t = r->t,
                               .y = r->y,
                               .yp = r->yp,
                               .steps = f->steps,
                               .t0 = s->problem->t0,
                               .rtol = s->options.rtol,
                               .atol = s->options.atol,
                               .atols = s->options.atols,
                               .error = f->count ? N_VGetArrayPointer(step->error) : NULL,
                               .explicit_method =
                                 !s->engine && (step->method->traits & STF_EXPLICIT),
                               .prescribed = !s->engine && !step->adaptive,
                               .weighted = s->problem->index != NULL,
                               .method = s->method,
                               .restarted = r->restarted && r->count > 1};
  STEIF_TRY(residuals(s->ctx, r, &q, f));
  STEIF_TRY(steif_explain(s->ctx, s->problem, &q, &scene, &f->cause));
  say(f, s->problem);
  return STEIF_OK;
}

/* The sentence of the run says all there is to say. */
static void take_sentence(steif_solver *s, steif_failure *f)
{
  char *m = f->cause.message;
  snprintf(m, sizeof f->cause.message, "%s", steif_message(s->ctx));
  m[0] = (char)toupper((unsigned char)m[0]);
  say(f, s->problem);
}

static int repeat(steif_solver *s, record *r, steif_failure *f)
{
  const steif_problem *p = s->problem;
  const bool looked = p->storage != STEIF_KRYLOV;
  keep(s, p->t0, s->shown, r);
  f->code = steif_solve_to(s, s->t1);
  steif_statistics(s);
  STEIF_CHECK(f->code < 0, s->ctx, STEIF_BAD_INPUT,
              "the run of problem '%s' does not fail: there is nothing to explain", p->name);
  facts(s, f);
  const bool crowded = stf_event_crowded(s);
  if (crowded) {
    f->cause.kind = STEIF_CAUSE_EVENTS;
    f->cause.t = f->t;
  }
  if (looked && !crowded) return explain(s, r, f);
  take_sentence(s, f);
  return STEIF_OK;
}

int steif_failure_find(steif_context *ctx, const steif_problem *problem, const char *method,
                       const steif_options *options, steif_failure *failure)
{
  STF_NAMED(problem);
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_CHECK(problem && failure, ctx, STEIF_BAD_INPUT,
              "a problem and a place for the failure are needed, got NULL");
  *failure = (steif_failure){.cause = {.t = NAN, .equation = -1, .unknown = -1}};
  steif_options o = options ? *options : steif_defaults();
  record r;
  o.observe = keep, o.on_event = NULL, o.jump = NULL, o.observer = &r;
  steif_solver *s = steif_solver_new(ctx, problem, method, &o);
  if (!s) return steif_status(ctx);
  const int form = steif_problem_form(ctx, problem);
  int code = STEIF_OK;
  if (!N_VGetArrayPointer(s->shown))
    code =
      STEIF_FAIL(ctx, STEIF_UNSUPPORTED, "failures are explained on vectors with a host array");
  if (!code) code = open_record(s->pool, problem, form, s->shown, &r);
  if (!code) code = repeat(s, &r, failure);
  steif_solver_free(&s);
  if (!code) steif_forget(ctx);
  return code;
}
