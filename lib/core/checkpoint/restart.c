/* restart.c: another start for the same memory, matrices and analysis.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "varying_mass.h"
#include "checkpoint_file.h"
#include "pencil.h"
#include <math.h>
#include <string.h>

typedef struct start {
  sunrealtype t;
  N_Vector y, yp;
  steif_problem problem;
  steif_options options;
} start;

/* -- what is asked for ------------------------------------------------------------------------- */

/* Both set or none: what was decided by them stays. */
static bool alike(const steif_problem *p, const steif_problem *q)
{
  return !p->f == !q->f && !p->F == !q->F && !p->g == !q->g && !p->jac == !q->jac &&
         !p->idajac == !q->idajac && !p->E == !q->E && !p->A == !q->A && !p->Ev == !q->Ev &&
         !p->Av == !q->Av && !p->precsolve == !q->precsolve && !p->precsetup == !q->precsetup &&
         !p->precsolve_pair == !q->precsolve_pair && !p->L == !q->L && !p->Lv == !q->Lv &&
         !p->kick == !q->kick && !p->drift == !q->drift;
}

static int check_problem(steif_solver *s, const steif_problem *p)
{
  const steif_problem *q = s->given;
  STEIF_CHECK(p->n == q->n && p->name && q->name && !strcmp(p->name, q->name), s->ctx,
              STEIF_BAD_INPUT,
              "the solver is that of problem '%s' with %lld unknowns, not of '%s' with %lld",
              q->name, (long long)q->n, p->name ? p->name : "", (long long)p->n);
  STEIF_CHECK(alike(p, q) && p->storage == q->storage && p->pattern == q->pattern &&
                p->lower == q->lower && p->upper == q->upper && p->linear == q->linear &&
                p->positions == q->positions,
              s->ctx, STEIF_BAD_INPUT,
              "problem '%s' has callbacks in other members than before, or another storage or "
              "pattern: make a new solver for it",
              p->name);
  return STEIF_OK;
}

static int check_options(steif_solver *s, const steif_options *o)
{
  const steif_options *before = &s->options;
  STEIF_CHECK(!o->mesh == !before->mesh && (o->h > 0) == (before->h > 0) &&
                o->like == before->like &&
                (!o->force_storage || o->storage == s->step.system.storage ||
                 (before->force_storage && o->storage == before->storage)),
              s->ctx, STEIF_BAD_INPUT,
              "a restart keeps how steps are made (tolerance, h or mesh), vectors and storage: "
              "make a new solver for others");
  STEIF_CHECK(!o->atols || s->atols, s->ctx, STEIF_BAD_INPUT,
              "the solver was opened without atols: make a new one with them");
  return STEIF_OK;
}

static int check(steif_solver *s, start *a)
{
  STEIF_CHECK(!s->engine, s->ctx, STEIF_UNSUPPORTED,
              "'%s' cannot be restarted: make a new solver", s->spec);
  STEIF_CHECK(!s->agreed, s->ctx, STEIF_UNSUPPORTED,
              "a run over ranks cannot be restarted: make a new solver");
  STEIF_CHECK(!s->step.carry && !s->quadratures && !a->options.sensitivities, s->ctx,
              STEIF_UNSUPPORTED,
              "a run with sensitivities or quadratures is not restarted: make a new solver");
  STEIF_CHECK(!s->inside && !s->running, s->ctx, STEIF_BAD_INPUT,
              "a solver is restarted between two calls, not by a callback of a step");
  STEIF_CHECK(a->y && N_VGetLength(a->y) == s->given->n &&
                (!a->yp || N_VGetLength(a->yp) == s->given->n),
              s->ctx, STEIF_BAD_INPUT,
              "a start needs y with %lld components, and yp with as many or NULL",
              (long long)s->given->n);
  const stf_space *space = &s->step.system.space;
  STEIF_CHECK(isfinite(a->t) && stf_finite(space, a->y) && (!a->yp || stf_finite(space, a->yp)),
              s->ctx, STEIF_NOT_FINITE,
              "the start at t = %g has components that are not finite", a->t);
  STEIF_TRY(stf_reserved_check(s->ctx, "steif_problem", STF_COUNT(a->problem.reserved),
                               a->problem.reserved));
  STEIF_TRY(stf_reserved_check(s->ctx, "steif_options", STF_COUNT(a->options.reserved),
                               a->options.reserved));
  STEIF_TRY(check_problem(s, &a->problem));
  STEIF_TRY(check_options(s, &a->options));
  a->problem.t0 = a->t;
  return stf_options_complete(s->ctx, &a->problem, &a->options, a->problem.n);
}

/* -- and done ------------------------------------------------------------------------------------ */

/* What a repair has found of the index stays; the problem is our copy from now on. */
static void take_problem(steif_solver *s, const start *a)
{
  const steif_problem before = *s->problem;
  s->again = a->problem;
  if (s->lowered) stf_mass_lower_again(s->lowered, &s->again);
  if (!s->again.index) s->again.index = before.index;
  if (!s->again.dae_index) s->again.dae_index = before.dae_index;
  s->problem = s->step.problem = &s->again;
  if (s->step.method->traits & STF_SEMILINEAR) {
    s->semilinear = s->again;
    s->semilinear.linear = 1;
    if (s->again.L || s->again.Lv)
      s->semilinear.A = s->again.L, s->semilinear.Av = s->again.Lv, s->semilinear.jac = NULL;
  }
  s->step.system.problem = s->step.method->traits & STF_SEMILINEAR ? &s->semilinear : &s->again;
}

/* The method as it was before it was opened. */
static void clear_step(steif_solver *s)
{
  stf_step *step = &s->step;
  if (s->switching) stf_switching_leave(s);
  stf_pool_release(s->pool, s->opened);
  step->y = s->own[0], step->next = s->own[1];
  step->method = s->family, step->state = s->family_state;
  memset(step->state, 0, step->method->size);
  step->newton = (stf_newton){.system = NULL};
  step->h = step->h_try = step->h_equal = 0;
  step->count = 0;
  step->tries = step->undamped = 0;
  step->undamped_start = step->undamped_end = 0;
  step->factors = step->solves = 0;
  step->rejected = step->restart = step->end_slope_known = false;
}

static void clear_run(steif_solver *s)
{
  s->switching = NULL, s->events = NULL, s->rounding = NULL;
  s->final = NULL, s->invariants = NULL;
  s->finished = s->after_reject = s->failed = false;
  s->rejected = s->mesh_at = 0;
  s->next_break = s->constraint_moves = 0;
  s->h_old = s->h_tried = s->error_old = s->rounded = s->cpu_s = 0;
  s->constant = (stf_constant){0};
  s->fingerprint = 0;
}

/* y and yp may be vectors of the solver that are about to go. */
static void set_aside(steif_solver *s, const start *a)
{
  if (a->y != s->dense) N_VScale(1, a->y, s->dense);
  if (a->yp && a->yp != s->step.error) N_VScale(1, a->yp, s->step.error);
}

static void take_start(steif_solver *s, const start *a)
{
  stf_step *step = &s->step;
  s->options = a->options;
  s->t1 = s->t1_opened = a->options.t1;
  step->t0 = step->t = s->t_shown = s->end = a->t;
  N_VScale(1, s->dense, step->y);
  if (a->yp)
    N_VScale(1, step->error, step->yp);
  else
    N_VConst(0, step->yp);
  step->yp_known = a->yp;
  if (s->options.atols && s->atols)
    memcpy(stf_array(s->atols), s->options.atols, (size_t)s->problem->n * sizeof(sunrealtype));
}

static void clear_counts(stf_system *system)
{
  system->nfe = system->nje = 0;
  if (system->pencil) system->pencil->stats = (steif_pencil_stats){0};
}

/* Slopes and matrices at the start. */
static int evaluate(steif_solver *s)
{
  stf_step *step = &s->step;
  stf_system *system = &step->system;
  const steif_problem *p = s->problem;
  const int begun = p->begin ? p->begin(p->t0, p->user) : 0;
  STEIF_CHECK(begun == 0, s->ctx, STEIF_CALLBACK, "begin of problem '%s' returned %d", p->name,
              begun);
  clear_counts(system);
  system->scale = s->options.atol / s->options.rtol;
  for (sunindextype j = 0; s->floors && j < p->n; j++)
    s->floors[j] = STF_ARRAY(s->atols)[j] / s->options.rtol;
  system->filled = false;
  int code = STEIF_OK;
  if (!step->yp_known && system->form == STEIF_ODE) {
    code = stf_system_rhs(system, step->t, step->y, step->yp);
    step->yp_known = code == STEIF_OK;
  }
  if (!code && !(step->method->traits & STF_EXPLICIT))
    code = stf_system_linearise(system, step->t, step->y, step->yp);
  return code > 0 ? steif_status(s->ctx) : code;
}

static int begin(steif_solver *s)
{
  STEIF_TRY(evaluate(s));
  if (s->options.h > 0 && !s->options.mesh) {
    STEIF_TRY(stf_constant_steps(s->ctx, s->options.h, s->step.t, s->t1, &s->constant));
    s->step.h_equal = s->constant.h;
  }
  return stf_run_begin(s);
}

static int restart(steif_solver *s, start *a)
{
  set_aside(s, a);
  clear_step(s);
  clear_run(s);
  take_start(s, a);
  take_problem(s, a);
  s->shown = s->step.y;
  const int code = begin(s);
  if (!code) return STEIF_OK;
  s->failed = true, s->failure = code;
  strncpy(s->why, steif_message(s->ctx), sizeof s->why - 1);
  return code;
}

int steif_solver_restart_sized(size_t problem_bytes, size_t options_bytes, steif_solver *s,
                               sunrealtype t, N_Vector y, N_Vector yp,
                               const steif_problem *problem, const steif_options *options)
{
  if (!s) return STEIF_BAD_INPUT;
  start a = {.t = t, .y = y, .yp = yp, .problem = *s->given, .options = s->options};
  steif_problem room;
  const steif_problem *given = s->given;
  if (problem) STEIF_TRY(stf_whole_problem(s->ctx, problem, problem_bytes, &room, &given));
  a.problem = *given;
  if (options)
    STEIF_TRY(
      stf_whole(s->ctx, "steif_options", options, options_bytes, sizeof a.options, &a.options));
  STEIF_TRY(check(s, &a));
  if (given == &room) s->whole = room;
  s->given = given == &room ? &s->whole : given;
  return restart(s, &a);
}

int(steif_solver_restart)(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp,
                          const steif_problem *problem, const steif_options *options)
{
  return steif_solver_restart_sized(0, 0, s, t, y, yp, problem, options);
}
