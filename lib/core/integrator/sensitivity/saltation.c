/* saltation.c: S through events and breaks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "transition.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- opening ---------------------------------------------------------------------------------- */

static void destroy(void *v) { N_VDestroy(v); }

static int claim_values(steif_solver *s, stf_saltation *w)
{
  for (int i = 0; s->problem->events > 0 && i < 4; i++) {
    w->g[i] = N_VNew_Serial(s->problem->events, steif_sundials(s->ctx));
    STEIF_CHECK(w->g[i], s->ctx, STEIF_NO_MEMORY, "no memory for %d values of events",
                s->problem->events);
    STEIF_TRY(stf_pool_adopt(s->pool, w->g[i], destroy));
  }
  return STEIF_OK;
}

/* By parameters.reset, where that is the whole of it. */
static bool by_reset(const steif_solver *s)
{
  const steif_parameters *q = s->problem->parameters;
  return q && q->reset && !s->options.reinitialise;
}

/* What handle_event does is found out by calling it: what it remembers must be put back. */
int stf_saltation_remember(steif_solver *s, const char *who)
{
  const steif_problem *p = s->problem;
  stf_saltation *w = s->saltation;
  if (!p->handle_event || !p->begin || w->bytes) return STEIF_OK;
  STEIF_CHECK(p->save && p->restore, s->ctx, STEIF_UNSUPPORTED,
              "problem '%s' remembers something at its events: %s save and restore", p->name,
              who);
  w->size = p->save(NULL, p->user);
  STEIF_CHECK(w->size >= 0, s->ctx, STEIF_CALLBACK, "save of problem '%s' returned %ld",
              p->name, w->size);
  w->bytes = stf_pool_array(s->pool, (size_t)w->size + 1, 1);
  return w->bytes ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_saltation_claim(steif_solver *s)
{
  const int count = stf_columns(s);
  stf_saltation *w = stf_pool_array(s->pool, 1, sizeof *w);
  if (!w) return STEIF_NO_MEMORY;
  N_Vector *one[] = {&w->y,    &w->slope, &w->after, &w->r[0],     &w->r[1],
                     &w->r[2], &w->r[3],  &w->point, &w->direction};
  for (size_t i = 0; i < sizeof one / sizeof *one; i++)
    if (!(*one[i] = stf_pool_vector(s->pool, s->step.y))) return STEIF_NO_MEMORY;
  w->tau = stf_pool_array(s->pool, 2 * (size_t)count + 1, sizeof *w->tau);
  if (!w->tau) return STEIF_NO_MEMORY;
  if (count > 0) {
    w->S = stf_pool_vectors(s->pool, count, s->step.y);
    w->jump = stf_pool_vectors(s->pool, count, s->step.y);
    if (!w->S || !w->jump) return STEIF_NO_MEMORY;
  }
  w->other = w->tau + count;
  s->saltation = w, w->t = w->renewed = NAN;
  STEIF_TRY(stf_saltation_jumps_claim(s));
  return claim_values(s, w);
}

int stf_saltation_open(steif_solver *s)
{
  s->saltation = NULL;
  if (!s->step.carry) return STEIF_OK;
  if (!s->problem->event && s->problem->break_count == 0) return STEIF_OK;
  STEIF_TRY(stf_breaks_check(s));
  STEIF_TRY(stf_saltation_claim(s));
  return by_reset(s) ? STEIF_OK
                     : stf_saltation_remember(s, "sensitivities need parameters.reset, or");
}

void stf_saltation_forget(steif_solver *s, sunrealtype t)
{
  if (s->saltation) s->saltation->t = t, s->saltation->known = false;
}

/* ---- what happens at an event ----------------------------------------------------------------- */

static int put_back(steif_solver *s)
{
  const steif_problem *p = s->problem;
  const stf_saltation *w = s->saltation;
  if (!w->bytes) return STEIF_OK;
  const bool done =
    p->begin(p->t0, p->user) == 0 && p->restore(w->bytes, (size_t)w->size, p->user) == 0;
  STEIF_CHECK(done, s->ctx, STEIF_CALLBACK,
              "begin and restore of problem '%s' did not take back what save had given at "
              "t = %.12g",
              p->name, w->t);
  return STEIF_OK;
}

static int settled(steif_solver *s, sunrealtype t, N_Vector y)
{
  if (!s->options.reinitialise) return STEIF_OK;
  N_VConst(0, s->saltation->after);
  return s->options.reinitialise(s->ctx, s->problem, t, s->options.rtol, y,
                                 s->saltation->after);
}

/* out = R(t, y) - y: exactly 0 where nothing happens. */
static int reaction(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out)
{
  const steif_problem *p = s->problem;
  stf_saltation *w = s->saltation;
  N_VScale(1, y, out);
  const int wish = p->handle_event(t, out, s->events->fired, p->user);
  int code = wish < 0 || (w->asked && wish != w->wish) ? STEIF_RETRY : STEIF_OK;
  if (!code) w->wish = wish, w->asked = true;
  if (!code && wish == STEIF_RESTART) code = settled(s, t, out);
  STEIF_TRY(put_back(s));
  N_VLinearSum(1, out, -1, y, out);
  return code;
}

int stf_saltation_projection(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out)
{
  N_VScale(1, y, out);
  STEIF_TRY(settled(s, t, out));
  N_VLinearSum(1, out, -1, y, out);
  return STEIF_OK;
}

static int no_derivative(steif_solver *s, int code, int k, const char *what)
{
  if (code < 0 && code != STEIF_RETRY) return code;
  return STEIF_FAIL(s->ctx, STEIF_UNSUPPORTED,
                    "%s of problem '%s' has no derivative by parameter %d at t = %.12g: "
                    "differences of it disagree",
                    what, s->problem->name, k + 1, s->saltation->t);
}

int stf_saltation_through(steif_solver *s, stf_quantity_at what, int k, const char *name)
{
  stf_saltation *w = s->saltation;
  const stf_carry *T = s->step.carry;
  N_VLinearSum(1, w->S[k], w->tau[k], w->slope, w->direction);
  const stf_line line = {.dt = w->tau[k], .dy = w->direction, .k = T->parameter[k]};
  const int code = stf_along(s, what, &line, w->r[0], w->r + 1);
  if (code) return no_derivative(s, code, T->parameter[k], name);
  N_VLinearSum(1, w->direction, 1, w->r[0], w->jump[k]);
  return STEIF_OK;
}

static int by_callback(steif_solver *s, int k)
{
  const steif_problem *p = s->problem;
  const stf_saltation *w = s->saltation;
  const int number = s->step.carry->parameter[k];
  N_VLinearSum(1, w->S[k], w->tau[k], w->slope, w->direction);
  const int returned = p->parameters->reset(w->t, w->y, s->events->fired, w->direction,
                                            w->tau[k], number, w->jump[k], p->user);
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "parameters.reset of problem '%s' returned %d at t = %.12g", p->name, returned,
              w->t);
  return STEIF_OK;
}

/* What is the wish of the handler? It tells when it is called; STEIF_CONTINUE: nothing is to be differentiated. */
static int ask_wish(steif_solver *s, sunrealtype t, int *wish)
{
  stf_saltation *w = s->saltation;
  w->asked = false, w->t = t;
  const int code = reaction(s, t, s->events->after, w->r[0]);
  *wish = code ? STEIF_CONTINUE : w->wish;
  return code == STEIF_RETRY ? STEIF_OK : code; /* it fails: its own call will say so */
}

/* Timers that fire have gone on to their next time behind the handler. A time without a derivative is told when somebody
 * asks for it. */
static int final_times(steif_solver *s, sunrealtype t)
{
  const bool before = stf_silence(s->ctx, true);
  const int code = stf_saltation_times(s, t);
  stf_silence(s->ctx, before);
  if (code != STEIF_UNSUPPORTED) return code;
  s->saltation->known = false;
  steif_forget(s->ctx);
  return STEIF_OK;
}

int stf_saltation_before(steif_solver *s, sunrealtype t)
{
  const steif_problem *p = s->problem;
  stf_saltation *w = s->saltation;
  const bool callback = by_reset(s);
  int wish = STEIF_RESTART;
  if ((!callback || w->keeper) && w->bytes)
    STEIF_CHECK(p->save(w->bytes, p->user) == w->size, s->ctx, STEIF_CALLBACK,
                "save of problem '%s' changed its length at t = %.12g", p->name, t);
  if (!callback) STEIF_TRY(ask_wish(s, t, &wish));
  if (wish == STEIF_FINISH) STEIF_TRY(final_times(s, t));
  if (wish != STEIF_RESTART) return w->keeper ? stf_transition_pass(s) : STEIF_OK;
  STEIF_TRY(stf_saltation_times(s, t));
  STEIF_TRY(stf_quadrature_before(s, t, w->y));
  for (int k = 0; k < stf_columns(s); k++)
    STEIF_TRY(callback ? by_callback(s, k)
                       : stf_saltation_through(s, reaction, k, "handle_event"));
  return w->keeper ? stf_transition_before(s, reaction) : STEIF_OK;
}

/* out = what puts y where the equations behind the event hold. */
static int placed(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out)
{
  N_VScale(1, y, out);
  STEIF_TRY(stf_mode_exactly(s, t, out));
  N_VLinearSum(1, out, -1, y, out);
  return STEIF_OK;
}

int stf_saltation_place(steif_solver *s, const sunrealtype *y)
{
  stf_saltation *w = s->saltation;
  const stf_carry *T = s->step.carry;
  STEIF_CHECK(
    !w->keeper, s->ctx, STEIF_UNSUPPORTED,
    "at t = %.12g unknowns of '%s' jump to fulfil the equations that hold from then on: "
    "gradients do not pass such a jump; take sensitivities",
    w->t, s->problem->name);
  memcpy(stf_array(w->y), y, (size_t)s->problem->n * sizeof *y);
  for (int k = 0; k < stf_columns(s); k++) {
    N_VScale(1, w->jump[k], w->direction);
    const stf_line line = {.dt = w->tau[k], .dy = w->direction, .k = T->parameter[k]};
    const int code = stf_along(s, placed, &line, w->r[0], w->r + 1);
    if (code) return no_derivative(s, code, T->parameter[k], "the jump to the new equations");
    N_VLinearSum(1, w->direction, 1, w->r[0], w->jump[k]);
  }
  return STEIF_OK;
}

/* S of dense output is off the constraints differentiated by its errors, which the first steps of index 2 and 3 divide by
 * their lengths. Where differences do not tell it stays so. */
int stf_saltation_recompute(steif_solver *s, const sunrealtype *y)
{
  stf_saltation *w = s->saltation;
  const stf_carry *T = s->step.carry;
  memcpy(stf_array(w->y), y, (size_t)s->problem->n * sizeof *y);
  for (int k = 0; k < stf_columns(s); k++) {
    const stf_line line = {.dt = w->tau[k], .dy = w->jump[k], .k = T->parameter[k]};
    const int code = stf_along(s, stf_recomputed, &line, w->r[0], w->r + 1);
    if (code == STEIF_RETRY)
      steif_forget(s->ctx);
    else if (code)
      return code;
    else
      N_VScale(1, w->r[0], w->jump[k]);
  }
  return STEIF_OK;
}

/* ---- behind it -------------------------------------------------------------------------------- */

/* y' of all components of a DAE that starts from y. */
static int consistent_slope(steif_solver *s, sunrealtype t, N_Vector y, N_Vector slope)
{
  const steif_point at = {.y = stf_array(y), .t = t};
  steif_start start = {0};
  const int code = steif_consistent(s->ctx, s->problem, &at, NULL, &start);
  if (!code) memcpy(stf_array(slope), start.yp, (size_t)s->problem->n * sizeof *start.yp);
  steif_start_clear(&start);
  return code;
}

/* out := a step of backward Euler over its length h, M (y' - s) = 0 and what the algebraic equations ask for. */
static int small_step(steif_solver *s, N_Vector residual, sunrealtype h, N_Vector out)
{
  steif_pencil *p = s->step.system.pencil;
  const int code = steif_pencil_factor(p, 1, &(steif_shift){1 / h, 0});
  if (code) return code == STEIF_SINGULAR ? STEIF_RETRY : code;
  N_VScale(-1, residual, out);
  STEIF_TRY(steif_pencil_solve(p, 0, 1, &out, NULL));
  N_VScale(1 / h, out, out);
  return STEIF_OK;
}

/* Of unknowns without a derivative, which S gets by stf_saltation_jumps. */
static void leave_algebraic(const steif_solver *s, N_Vector slope)
{
  for (sunindextype j = 0; s->repair.algebraic && j < s->problem->n; j++)
    if (s->repair.algebraic[j]) stf_array(slope)[j] = 0;
}

/* y' where M y' = f is of index 1: two lengths of such steps extrapolated, and shorter ones until they agree. f may jump
 * at t in time: nothing is evaluated elsewhere. STEIF_RETRY: they do not. */
static int slope_by_steps(steif_solver *s, sunrealtype t, N_Vector y, N_Vector slope)
{
  const stf_saltation *w = s->saltation;
  stf_system *system = &s->step.system;
  N_Vector residual = w->r[0], found = w->r[1], before = w->r[2];
  sunrealtype h = 1e-3 * (s->t1 - s->problem->t0);
  if (system->form != STEIF_MASS || s->problem->dae_index != 1 || system->krylov)
    return STEIF_RETRY;
  N_VConst(0, slope);
  STEIF_TRY(stf_system_residual(system, t, y, slope, residual));
  STEIF_TRY(stf_system_linearise(system, t, y, slope));
  system->filled = false;
  for (int attempt = 0; attempt < 7; attempt++, h /= 64) {
    STEIF_TRY(small_step(s, residual, h, found));
    STEIF_TRY(small_step(s, residual, h / 2, slope));
    N_VLinearSum(2, slope, -1, found, slope);
    leave_algebraic(s, slope);
    N_VLinearSum(1, slope, -1, before, found);
    if (attempt > 0 && N_VMaxNorm(found) <= 1e-8 * N_VMaxNorm(slope)) return STEIF_OK;
    N_VScale(1, slope, before);
  }
  return STEIF_RETRY;
}

int stf_saltation_slope(steif_solver *s, sunrealtype t, N_Vector y, N_Vector slope)
{
  stf_system *system = &s->step.system;
  if (system->form != STEIF_ODE) {
    const int by_steps = slope_by_steps(s, t, y, slope);
    return by_steps == STEIF_RETRY ? consistent_slope(s, t, y, slope) : by_steps;
  }
  const int code = stf_system_rhs(system, t, y, slope);
  return code > 0 ? steif_status(s->ctx) : code;
}

int stf_saltation_behind(steif_solver *s, sunrealtype t, N_Vector y, N_Vector known)
{
  stf_saltation *w = s->saltation;
  if (!known) return stf_saltation_slope(s, nextafter(t, INFINITY), y, w->after);
  stf_copy(&s->step.system.space, known, w->after);
  return STEIF_OK;
}

int stf_saltation_after(steif_solver *s, sunrealtype t)
{
  stf_saltation *w = s->saltation;
  const stf_detector *d = s->events;
  STEIF_TRY(stf_saltation_behind(s, t, d->after, d->settled ? d->slope : NULL));
  for (int k = 0; k < stf_columns(s); k++)
    stf_axpy(&s->step.system.space, -w->tau[k], w->after, w->jump[k]);
  STEIF_TRY(stf_saltation_jumps(s, nextafter(t, INFINITY), d->after));
  if (s->problem->dae_index > 1 && !s->step.system.krylov)
    STEIF_TRY(stf_columns_constrain(s, nextafter(t, INFINITY), d->after, w->after, w->jump));
  w->pending = true;
  if (w->keeper) STEIF_TRY(stf_transition_after(s, d->after));
  return stf_quadrature_after(s, t, d->after, w->tau);
}

void stf_saltation_renew(steif_solver *s)
{
  stf_saltation *w = s->saltation;
  const stf_carry *T = s->step.carry;
  if (!w->pending) return;
  for (int k = 0; k < stf_columns(s); k++) stf_copy(&s->step.system.space, w->jump[k], T->S[k]);
  w->pending = false, w->renewed = w->t;
}
