/* looks.c: what is looked at before a method is opened: whether the mass matrix varies, the start of a DAE, and
 * its pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "integrator.h"
#include "varying_mass.h"
#include <string.h>

int stf_look_at_index(steif_solver *s)
{
  const steif_problem *p = s->problem;
  const N_Vector like = s->options.like;
  int most = 0;
  if (!p->index || p->dae_index > 0 || (like && stf_spread(like))) return STEIF_OK;
  for (sunindextype i = 0; i < p->n; i++) most = p->index[i] > most ? p->index[i] : most;
  if (most < 2) return STEIF_OK;
  steif_problem *copy = stf_pool_array(s->pool, 1, sizeof *copy);
  if (!copy) return STEIF_NO_MEMORY;
  *copy = *p;
  copy->dae_index = most;
  s->problem = copy;
  return STEIF_OK;
}

int stf_look_at_mass(steif_solver *s, int *form, N_Vector y, N_Vector yp)
{
  const steif_problem *p = s->problem;
  const steif_engine *engine = s->engine;
  int variation;
  if (*form != STEIF_MASS) return STEIF_OK;
  STEIF_TRY(stf_start_values(s->ctx, p, y, yp));
  STEIF_TRY(stf_mass_variation(s->ctx, p, s->t1, y, &variation));
  if (variation == STF_CONSTANT) return STEIF_OK;
  if (engine && !(engine->forms & STEIF_IMPLICIT)) {
    s->mass_of_time = engine->mass_of_time && !(variation & STF_OF_STATE);
    return s->mass_of_time ? STEIF_OK
                           : stf_constant_matrices(s->ctx, p, *form, s->t1, y, s->spec);
  }
  STEIF_TRY(stf_mass_lower(s->pool, s->ctx, p, variation, y, &s->problem));
  s->lowered = s->problem;
  *form = STEIF_IMPLICIT;
  return STEIF_OK;
}

/* Of a linear system the jump from x(0-) is the start; what is not certified is left to the first step. */
static int jump(stf_repair *r)
{
  const steif_engine *engine = stf_engine_find("descriptor");
  const size_t n = (size_t)r->given->n;
  sunrealtype *x = stf_pool_array(r->pool, n, sizeof *x);
  bool certified = false;
  if (!x) return STEIF_NO_MEMORY;
  memcpy(x, r->point.y0, n * sizeof *x);
  const int code = engine->jump(r->ctx, r->given, r->given->t0, x, &certified);
  if (code == STEIF_NO_MEMORY) return code;
  if (code || !certified) {
    steif_forget(r->ctx);
    return STEIF_OK;
  }
  stf_report_moved(r, x);
  if (!r->report.moved) return STEIF_OK;
  stf_point_say(
    r->report.message,
    "; this is the jump of a linear system from x(0-) to x(0+), which `steif impulse` "
    "shows with its impulses");
  STEIF_CHECK(r->policy == STEIF_REPAIR, r->ctx, STEIF_BAD_INPUT,
              "the start of '%s' is not consistent; it would have %.400s", r->given->name,
              r->report.message + strlen("start: "));
  r->problem.y0 = r->report.y = x;
  return STEIF_OK;
}

int stf_start_repaired(stf_repair *r)
{
  STEIF_TRY(stf_repair_start(r));
  return r->jumps ? jump(r) : STEIF_OK;
}

/* What hides the entries of matrices, or the start, from a look at it; NULL: nothing does. */
static const char *what_hides(const steif_options *o, const steif_problem *p)
{
  const enum steif_storage storage = o->force_storage ? o->storage : p->storage;
  return storage == STEIF_KRYLOV || p->storage == STEIF_KRYLOV ? "storage Krylov"
         : o->like                                             ? "options.like"
         : p->start                                            ? "problem.start"
                                                               : NULL;
}

/* The start of a DAE, for methods of ours with adaptive steps. */
int stf_look_at_start(steif_solver *s, int form)
{
  const steif_options *o = &s->options;
  const steif_problem *p = s->problem;
  const char *const hides = what_hides(o, p);
  if (form == STEIF_ODE || o->h > 0 || o->mesh) return STEIF_OK;
  STEIF_CHECK(!hides || o->initial != STEIF_CHECK, s->ctx, STEIF_UNSUPPORTED,
              "options.initial = STEIF_CHECK: with %s the start of '%s' cannot be checked, "
              "which takes start values and entries of matrices in arrays of one process; give "
              "these, or options.initial = STEIF_AS_GIVEN",
              hides, p->name);
  if (hides) return STEIF_OK;
  s->repair = (stf_repair){.ctx = s->ctx,
                           .pool = s->pool,
                           .given = p,
                           .policy = o->initial,
                           .attribute = o->attributes,
                           .rtol = o->rtol,
                           .atol = o->atol,
                           .atols = o->atols,
                           .judges = true};
  STEIF_TRY(stf_start_repaired(&s->repair));
  s->problem = &s->repair.problem;
  return STEIF_OK;
}

/* Steps of lengths that are given: the start stays, and a pencil that is singular is told. */
int stf_look_at_pencil(steif_solver *s, int form)
{
  const stf_step *step = &s->step;
  const bool other = step->adaptive || step->method->traits & STF_SEMILINEAR;
  stf_repair alone = {.ctx = s->ctx, .given = s->problem};
  if (form == STEIF_ODE || other || what_hides(&s->options, s->problem)) return STEIF_OK;
  if (!(alone.pool = stf_pool_new(s->ctx))) return STEIF_NO_MEMORY;
  const int code = stf_judge_system(&alone, &step->system, step->y, step->next);
  stf_pool_free(&alone.pool);
  return code;
}

/* Has it unknowns of index 2 and more, on some rank? */
static bool any_higher(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const N_Vector like = s->options.like;
  sunindextype rows;
  bool any = p->dae_index > 1;
  const bool here = p->index && stf_own_rows(s->dense, &rows);
  for (sunindextype i = 0; here && i < rows; i++) any |= p->index[i] > 1;
  if (like && stf_spread(like)) stf_agree_any(like, 1, &any);
  return any;
}

int stf_look_at_breaks(steif_solver *s)
{
  const steif_problem *p = s->problem;
  const steif_options *o = &s->options;
  const bool anew = !s->engine && !(o->h > 0) && !o->mesh;
  if (!stf_settled_by(s) || anew || !p->break_count || !(p->breaks[0] < s->t1)) return STEIF_OK;
  STEIF_CHECK(!any_higher(s), s->ctx, STEIF_UNSUPPORTED,
              "'%s' has unknowns of index 2 that may jump at its break t = %g, where '%s' does "
              "not restart%s: take radau or bdf with adaptive steps",
              p->name, p->breaks[0], s->spec, s->engine ? "" : " with prescribed steps");
  return STEIF_OK;
}

/* Unknowns of index 2 that are spread over ranks are shown as the method has them, unless the problem settles them: those
 * of stages of low order beside others, and of methods that are not stiffly accurate, have a few digits only (Hairer and
 * Wanner, Solving ODEs II, VII.4), which the estimates of their errors do not see. Where they are settled they
 * need not be right to the tolerance within the run. */
int stf_look_at_orders(steif_solver *s)
{
  const N_Vector like = s->options.like;
  const steif_table *T = s->step.table;
  const bool good =
    !T || T->s == 1 ||
    (T->claims & STEIF_STIFFLY_ACCURATE && (T->stage_order >= T->s || T->stage_order > 2));
  STEIF_TRY(stf_agreed_gate(s));
  s->settles = false;
  if (!like || !stf_spread(like) || (good && !stf_settled_by(s))) return STEIF_OK;
  const bool any = any_higher(s);
  STEIF_CHECK(good || !any, s->ctx, STEIF_UNSUPPORTED,
              "'%s' has unknowns of index 2 to a few digits only, and over ranks they are not "
              "computed anew: take radau or bdf",
              s->method);
  s->settles = any && stf_settled_by(s);
  return STEIF_OK;
}

const steif_repair *steif_initial_used(const steif_solver *s)
{
  return s ? &s->repair.report : NULL;
}
