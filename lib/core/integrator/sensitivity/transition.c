/* transition.c: transposed derivatives through events and breaks, found where they happen.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "transition.h"
#include "random.h"
#include <math.h>
#include <string.h>

/* ---- opening ------------------------------------------------------------------------------------ */

int stf_transitions_watch(steif_solver *s, const stf_transition_keeper *keeper)
{
  if (s->engine || !(s->problem->event || s->problem->break_count > 0)) return STEIF_OK;
  STEIF_TRY(stf_breaks_check(s));
  if (!s->saltation) STEIF_TRY(stf_saltation_claim(s));
  s->saltation->keeper = keeper;
  return stf_saltation_remember(s, "going back through them needs");
}

int stf_transition_claim(steif_context *ctx, sunindextype n, int P, int count,
                         stf_transition *w)
{
  const size_t rows = (size_t)n, all = 4 * rows + (size_t)P + (size_t)count + 1;
  w->numbers = stf_allocate(ctx, all, sizeof *w->numbers);
  if (!w->numbers) return STEIF_NO_MEMORY;
  w->gy = w->numbers, w->across = w->gy + rows, w->y = w->across + rows;
  w->slope = w->y + rows, w->gp = w->slope + rows, w->gap = w->gp + P;
  w->bytes = all * sizeof *w->numbers;
  return STEIF_OK;
}

void stf_transition_release(steif_context *ctx, stf_transition *w)
{
  stf_release(ctx, w->numbers);
  stf_release(ctx, w->entry);
  stf_release(ctx, w->memory);
  *w = (stf_transition){0};
}

static int begin(steif_solver *s, bool broken)
{
  stf_saltation *w = s->saltation;
  w->open = NULL;
  STEIF_TRY(w->keeper->add(w->keeper->of, broken, &w->open));
  w->open->t = w->t, w->open->kind = broken ? STF_BROKEN : STF_PASSED;
  if (broken || !w->bytes) return STEIF_OK;
  w->open->memory = stf_allocate(s->ctx, (size_t)w->size + 1, 1);
  if (!w->open->memory) return STEIF_NO_MEMORY;
  memcpy(w->open->memory, w->bytes, (size_t)w->size);
  w->open->memory_bytes = (size_t)w->size, w->open->bytes += (size_t)w->size + 1;
  return STEIF_OK;
}

int stf_transition_recall(steif_solver *s, const stf_transition *w)
{
  const steif_problem *p = s->problem;
  if (!w->memory) return STEIF_OK;
  const bool done =
    p->begin(p->t0, p->user) == 0 && p->restore(w->memory, w->memory_bytes, p->user) == 0;
  STEIF_CHECK(done, s->ctx, STEIF_CALLBACK,
              "begin and restore of problem '%s' did not take back what save had given at "
              "t = %.12g",
              p->name, w->t);
  return STEIF_OK;
}

/* ---- the function of the event ------------------------------------------------------------------- */

/* out := the derivative of g_i by unknown j, or with j < 0 by parameter k, or with k < 0 along the solution. */
static int slope_of(steif_solver *s, int i, sunindextype j, int k, sunrealtype *out)
{
  stf_saltation *w = s->saltation;
  const bool ahead = j < 0 && k < 0;
  N_VConst(0, w->direction);
  if (j >= 0) stf_array(w->direction)[j] = 1;
  const stf_line line = {.dt = ahead, .dy = ahead ? w->slope : w->direction, .k = k};
  const int code = stf_along(s, stf_saltation_values, &line, w->g[0], w->g + 1);
  if (code) return stf_undifferentiable(s, i, code);
  *out = stf_array(w->g[0])[i];
  return STEIF_OK;
}

/* Another function that fires at once moves in time with the first, for any y and p. */
static int agrees(steif_solver *s, int i, sunrealtype found, sunrealtype rate,
                  sunrealtype known, sunrealtype scale)
{
  const stf_transition *w = s->saltation->open;
  char name[64];
  const sunrealtype a = found / rate, b = known / w->rate;
  stf_event_name(s->problem, i, sizeof name, name);
  STEIF_CHECK(fabs(a - b) <= 1e-6 * (fabs(a) + fabs(b)) + 1e-9 / scale, s->ctx,
              STEIF_UNSUPPORTED,
              "two events of problem '%s' at once at t = %.12g, %s and one whose time has "
              "another derivative: what comes after them has none",
              s->problem->name, w->t, name);
  return STEIF_OK;
}

static int slopes_of(steif_solver *s, int i, bool first)
{
  stf_transition *w = s->saltation->open;
  const steif_parameters *q = s->problem->parameters;
  const sunrealtype *y = stf_array(s->saltation->y);
  sunrealtype rate = 0, here = 0;
  STEIF_TRY(slope_of(s, i, -1, -1, &rate));
  if (first) w->rate = rate;
  for (sunindextype j = 0; j < s->problem->n; j++) {
    STEIF_TRY(slope_of(s, i, j, -1, &here));
    if (!first)
      STEIF_TRY(agrees(s, i, here, rate, w->gy[j], fabs(y[j]) + s->step.system.scale));
    w->gy[j] = first ? here : w->gy[j];
  }
  for (int k = 0; q && k < q->count; k++) {
    const sunrealtype scale = q->scale ? q->scale[k] : fabs(q->value[k]);
    STEIF_TRY(slope_of(s, i, -1, k, &here));
    if (!first) STEIF_TRY(agrees(s, i, here, rate, w->gp[k], scale > 0 ? scale : 1));
    w->gp[k] = first ? here : w->gp[k];
  }
  return STEIF_OK;
}

static int function(steif_solver *s)
{
  bool first = true;
  for (int i = 0; i < s->problem->events; i++)
    if (s->events->fired[i]) {
      STEIF_TRY(slopes_of(s, i, first));
      first = false;
    }
  return STEIF_OK;
}

/* ---- what happens --------------------------------------------------------------------------------- */

static int undifferentiable(steif_solver *s, int code)
{
  if (code < 0 && code != STEIF_RETRY) return code;
  return STEIF_FAIL(s->ctx, STEIF_UNSUPPORTED,
                    "handle_event of problem '%s' has no derivative at t = %.12g: differences "
                    "of it disagree",
                    s->problem->name, s->saltation->t);
}

static int by_reset(steif_solver *s, N_Vector dy, sunrealtype dt, int k, N_Vector out)
{
  const steif_problem *p = s->problem;
  const stf_saltation *w = s->saltation;
  const int returned =
    p->parameters->reset(w->t, w->y, s->events->fired, dy, dt, k, out, p->user);
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "parameters.reset of problem '%s' returned %d at t = %.12g", p->name, returned,
              w->t);
  return STEIF_OK;
}

/* w->r[0] := R_y dy + R_t dt, with k >= 0 + R_p by p_k, less dy. reaction NULL: by parameters.reset, whose part by p_0 at
 * rest is in w->r[3]. */
static int along(steif_solver *s, stf_quantity_at reaction, N_Vector dy, sunrealtype dt, int k)
{
  stf_saltation *w = s->saltation;
  if (!reaction) {
    STEIF_TRY(by_reset(s, dy, dt, k < 0 ? 0 : k, w->r[0]));
    N_VLinearSum(1, w->r[0], -1, dy, w->r[0]);
    if (k < 0) N_VLinearSum(1, w->r[0], -1, w->r[3], w->r[0]);
    return STEIF_OK;
  }
  const stf_line line = {.dt = dt, .dy = dy, .k = k};
  const int code = stf_along(s, reaction, &line, w->r[0], w->r + 1);
  return code ? undifferentiable(s, code) : STEIF_OK;
}

/* The same where y_j, or with j < 0 p_k, moves, and the event with it: handlers that ask whether it is there agree. */
static int along_event(steif_solver *s, stf_quantity_at reaction, sunindextype j, int k)
{
  stf_saltation *w = s->saltation;
  const stf_transition *open = w->open;
  const sunrealtype tau = -(j < 0 ? open->gp[k] : open->gy[j]) / open->rate;
  N_VScale(tau, w->slope, w->direction);
  if (j >= 0) stf_array(w->direction)[j] += 1;
  return along(s, reaction, w->direction, tau, j < 0 ? k : -1);
}

/* The entries of w->r[0] that are not 0, into a column. */
static int enter(steif_solver *s, stf_transition *w, sunindextype column)
{
  const sunrealtype *v = stf_array(s->saltation->r[0]);
  for (sunindextype i = 0; i < s->problem->n; i++) {
    if (v[i] == 0) continue;
    if (w->entries == w->room) {
      const size_t room = w->room ? 2 * w->room : 16;
      stf_entry *more = stf_allocate(s->ctx, room, sizeof *more);
      if (!more) return STEIF_NO_MEMORY;
      if (w->entries) memcpy(more, w->entry, w->entries * sizeof *more);
      stf_release(s->ctx, w->entry);
      w->entry = more, w->bytes += (room - w->room) * sizeof *more, w->room = room;
    }
    w->entry[w->entries++] = (stf_entry){i, column, v[i]};
  }
  return STEIF_OK;
}

/* A reaction that leaves points around y where they are leaves all of them. */
static int leaves_alone(steif_solver *s, stf_quantity_at reaction, bool *alone)
{
  stf_saltation *w = s->saltation;
  stf_random random = {1};
  const sunrealtype *y = stf_array(w->y);
  *alone = reaction != NULL;
  for (int probe = 0; *alone && probe < 4; probe++) {
    sunrealtype *v = stf_array(w->point);
    for (sunindextype j = 0; j < s->problem->n; j++)
      v[j] = y[j] + stf_random_in(&random, -1, 1) / 256 * (fabs(y[j]) + s->step.system.scale);
    const int code = reaction(s, w->t, w->point, w->r[0]);
    if (code < 0) return code;
    *alone = !code && N_VMaxNorm(w->r[0]) == 0;
  }
  return STEIF_OK;
}

static int reaction_slopes(steif_solver *s, stf_quantity_at reaction)
{
  stf_saltation *w = s->saltation;
  stf_transition *open = w->open;
  const int P = s->problem->parameters ? s->problem->parameters->count : 0;
  const sunindextype n = s->problem->n;
  bool alone;
  N_VConst(0, w->direction);
  if (!reaction) STEIF_TRY(by_reset(s, w->direction, 0, 0, w->r[3]));
  for (int k = 0; k < P; k++) {
    STEIF_TRY(along_event(s, reaction, -1, k));
    STEIF_TRY(enter(s, open, n + k));
  }
  memcpy(open->across, stf_array(w->slope), (size_t)n * sizeof *open->across);
  STEIF_TRY(leaves_alone(s, reaction, &alone));
  for (sunindextype j = 0; !alone && j < n; j++) {
    STEIF_TRY(along_event(s, reaction, j, -1));
    STEIF_TRY(enter(s, open, j));
  }
  return STEIF_OK;
}

/* ---- events ----------------------------------------------------------------------------------------- */

int stf_transition_pass(steif_solver *s)
{
  if (s->saltation->bytes) STEIF_TRY(begin(s, false));
  s->saltation->open = NULL;
  return STEIF_OK;
}

int stf_transition_before(steif_solver *s, stf_quantity_at reaction)
{
  stf_saltation *w = s->saltation;
  const steif_parameters *q = s->problem->parameters;
  STEIF_TRY(begin(s, false));
  STEIF_TRY(function(s));
  STEIF_TRY(reaction_slopes(s, q && q->reset ? NULL : reaction));
  return w->keeper->gap(w->keeper->of, w->open, 1, w->t, w->y);
}

static void copy(N_Vector from, sunrealtype *to)
{
  memcpy(to, stf_array(from), (size_t)N_VGetLength(from) * sizeof *to);
}

int stf_transition_after(steif_solver *s, N_Vector y)
{
  stf_saltation *w = s->saltation;
  stf_transition *open = w->open;
  open->kind = STF_RESTARTED, open->behind = nextafter(w->t, INFINITY);
  copy(y, open->y), copy(w->after, open->slope);
  for (sunindextype i = 0; i < s->problem->n; i++) open->across[i] -= open->slope[i];
  w->open = NULL, w->gy = open->gy, w->gp = open->gp, w->rate = open->rate;
  return w->keeper->gap(w->keeper->of, open, -1, open->behind, y);
}

int stf_transition_end(steif_solver *s)
{
  stf_saltation *w = s->saltation;
  STEIF_CHECK(
    s->events->silent == false || !s->events->moved, s->ctx, STEIF_UNSUPPORTED,
    "handle_event of problem '%s' changes y where it ends the run, at t = %.12g: gradients "
    "need it as it was",
    s->problem->name, s->end);
  STEIF_TRY(stf_saltation_times(s, s->end));
  STEIF_TRY(w->keeper->add(w->keeper->of, false, &w->open));
  w->open->t = s->end, w->open->kind = STF_ENDED;
  STEIF_TRY(function(s));
  copy(w->slope, w->open->across);
  return w->keeper->gap(w->keeper->of, w->open, 1, s->end, w->y);
}

/* ---- breaks ------------------------------------------------------------------------------------------ */

static sunrealtype slope_of_break(const steif_solver *s, int i, int k)
{
  const steif_parameters *q = s->problem->parameters;
  sunrealtype slope = 0;
  return q->break_slope && q->break_slope(i, k, &slope, s->problem->user) ? NAN : slope;
}

bool stf_transition_together(const steif_solver *s, int i, int first)
{
  const stf_saltation *w = s->saltation;
  const steif_parameters *q = s->problem->parameters;
  bool same = true;
  for (sunindextype j = 0; first < 0 && j < s->problem->n; j++) same = same && w->gy[j] == 0;
  for (int k = 0; q && k < q->count; k++) {
    const sunrealtype own = slope_of_break(s, i, k);
    const sunrealtype to = first < 0 ? -w->gp[k] / w->rate : slope_of_break(s, first, k);
    const sunrealtype scale = q->scale ? q->scale[k] : fabs(q->value[k]);
    same = same && fabs(own - to) <= 1e-6 * fabs(own) + 1e-9 / (scale > 0 ? scale : 1);
  }
  return same;
}

int stf_transition_break(steif_solver *s, int i)
{
  stf_saltation *w = s->saltation;
  const steif_parameters *q = s->problem->parameters;
  STEIF_TRY(begin(s, true));
  w->open->t = s->step.t;
  for (int k = 0; i >= 0 && q && q->break_slope && k < q->count; k++) {
    STEIF_TRY(stf_break_slope(s, i, k, w->open->gp + k));
    if (w->open->gp[k] != 0) w->open->rate = 1;
  }
  if (w->open->rate == 0) return STEIF_OK;
  copy(w->slope, w->open->across);
  return w->keeper->gap(w->keeper->of, w->open, 1, w->open->t, w->y);
}

int stf_transition_broken(steif_solver *s)
{
  const stf_step *step = &s->step;
  stf_saltation *w = s->saltation;
  stf_transition *open = w->open;
  w->open = NULL, open->behind = step->t;
  copy(step->y, open->y);
  if (step->yp_known) copy(step->yp, open->slope);
  if (open->rate == 0) return STEIF_OK;
  for (sunindextype i = 0; i < s->problem->n; i++) open->across[i] -= stf_array(w->after)[i];
  return w->keeper->gap(w->keeper->of, open, -1, step->t, step->y);
}
