/* operator.c: the pencil of a problem known by products, and its preconditioner: callbacks, or the
 * incomplete factors of the matrices of a sparse problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "problem.h"
#include <math.h>

int stf_operator_point_open(stf_pool *pool, const stf_system *s, stf_operator_point *point)
{
  N_Vector *const all[] = {&point->y, &point->yp, &point->f};
  for (int i = 0; i < 3; i++)
    if (!(*all[i] = stf_pool_vector(pool, s->space.like))) return STEIF_NO_MEMORY;
  return STEIF_OK;
}

int stf_operator_point_set(stf_system *s, stf_operator_point *at, sunrealtype t, N_Vector y,
                           N_Vector yp)
{
  const steif_problem *p = s->problem;
  at->t = t, at->size = -1;
  stf_copy(&s->space, y, at->y);
  stf_copy(&s->space, yp, at->yp);
  return p->Av && !p->precsolve ? STEIF_OK : stf_system_residual(s, t, y, yp, at->f);
}

int stf_operator_remember(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  return stf_operator_point_set(s, &s->at, t, y, yp);
}

/* -- products by callbacks --------------------------------------------------------------------- */

static sunrealtype length(const stf_system *s, N_Vector x)
{
  stf_count_sum(&s->space);
  return sqrt(N_VDotProd(x, x));
}

/* A x = -F_y x by one difference along x, of any length where F is linear; by one on both sides where it is more than
 * a preconditioner. */
static int difference_A(stf_system *s, stf_operator_point *at, N_Vector x, N_Vector out)
{
  const sunrealtype size = length(s, x);
  if (!(size > 0)) {
    stf_zero(&s->space, out);
    return 0;
  }
  if (at->size < 0) at->size = length(s, at->y);
  const bool both = at != &s->at && !s->linear;
  const sunrealtype part = s->linear ? 1 : both ? cbrt(STF_EPS) : sqrt(STF_EPS);
  const sunrealtype step = part * (s->scale + at->size) / size;
  N_Vector before = at->f;
  int code = 0;
  if (both) {
    stf_sum(&s->space, 1, at->y, -step, x, s->work[4]);
    code = stf_system_residual(s, at->t, s->work[4], at->yp, before = s->work[3]);
  }
  stf_sum(&s->space, 1, at->y, step, x, s->work[4]);
  if (!code) code = stf_system_residual(s, at->t, s->work[4], at->yp, s->work[5]);
  const sunrealtype apart = both ? 2 * step : step;
  stf_sum(&s->space, 1 / apart, before, -1 / apart, s->work[5], out);
  return code;
}

int stf_operator_product(stf_system *s, stf_operator_point *at, char which, N_Vector x,
                         N_Vector out)
{
  const steif_problem *p = s->problem;
  if (which == 'A' && !p->Av) return difference_A(s, at, x, out);
  return (which == 'E' ? p->Ev : p->Av)(at->t, at->y, at->yp, x, out, p->user);
}

bool stf_operator_transposes(const stf_system *s)
{
  const steif_problem *p = s->problem;
  return p->Atv && (p->Etv || s->form == STEIF_ODE);
}

int stf_operator_transposed(stf_system *s, stf_operator_point *at, char which, N_Vector x,
                            N_Vector out)
{
  const steif_problem *p = s->problem;
  return (which == 'E' ? p->Etv : p->Atv)(at->t, at->y, at->yp, x, out, p->user);
}

static int product_E(N_Vector x, N_Vector out, void *user)
{
  stf_system *s = user;
  return stf_operator_product(s, &s->at, 'E', x, out);
}

static int product_A(N_Vector x, N_Vector out, void *user)
{
  stf_system *s = user;
  return stf_operator_product(s, &s->at, 'A', x, out);
}

static int prepare_again(sunrealtype shift, void *user)
{
  stf_system *s = user;
  const steif_problem *p = s->problem;
  if (!p->precsetup) return 0;
  return p->precsetup(s->made.t, s->made.y, s->made.yp, s->made.f, shift, p->user);
}

static int prepare(sunrealtype shift, void *user)
{
  stf_system *s = user;
  s->made.t = s->at.t;
  stf_copy(&s->space, s->at.y, s->made.y);
  stf_copy(&s->space, s->at.yp, s->made.yp);
  stf_copy(&s->space, s->at.f, s->made.f);
  return prepare_again(shift, user);
}

static int precondition(sunrealtype shift, N_Vector r, N_Vector z, sunrealtype tolerance,
                        void *user)
{
  stf_system *s = user;
  const steif_problem *p = s->problem;
  (void)tolerance;
  return p->precsolve(s->made.t, s->made.y, s->made.yp, s->made.f, r, z, shift, 0, p->user);
}

static int precondition_pair(steif_shift c, N_Vector *r, N_Vector *z, void *user)
{
  stf_system *s = user;
  const steif_problem *p = s->problem;
  return p->precsolve_pair(s->made.t, s->made.y, s->made.yp, s->made.f, r, z, c.re, c.im, 0,
                           p->user);
}

static int claim(stf_pool *pool, stf_system *s, const steif_operator *op)
{
  s->pencil = steif_pencil_new_operator(s->ctx, op, s->space.like);
  if (!s->pencil) return steif_status(s->ctx);
  return stf_pool_adopt(pool, s->pencil, stf_system_destroy_pencil);
}

int stf_operator_open(stf_pool *pool, stf_system *s)
{
  const steif_problem *p = s->problem;
  const bool has_E = s->form != STEIF_ODE;
  STEIF_CHECK(!has_E || p->Ev, s->ctx, STEIF_UNSUPPORTED,
              "problem '%s' of form %s needs the product .Ev for Krylov storage", p->name,
              steif_form_name(s->form));
  STEIF_CHECK(s->form != STEIF_DESCRIPTOR || p->Av, s->ctx, STEIF_UNSUPPORTED,
              "problem '%s' of form descriptor needs the product .Av for Krylov storage",
              p->name);
  STEIF_TRY(stf_operator_point_open(pool, s, &s->at));
  STEIF_TRY(claim(pool, s,
                  &(steif_operator){.E = has_E ? product_E : NULL,
                                    .A = product_A,
                                    .prepare = p->precsolve ? prepare : NULL,
                                    .precondition = p->precsolve ? precondition : NULL,
                                    .user = s}));
  if (!p->precsolve) return STEIF_OK;
  if (p->precsetup) s->pencil->prepare_again = prepare_again;
  if (p->precsolve_pair) s->pencil->precondition_pair = precondition_pair;
  return stf_operator_point_open(pool, s, &s->made);
}

void stf_operator_defer(stf_system *s, stf_deferred *deferred)
{
  if (s->krylov && s->pencil) s->pencil->deferred = deferred;
}

static stf_deferred *deferred_of(const stf_system *s)
{
  return s->pencil && s->krylov ? s->pencil->deferred : NULL;
}

void stf_operator_hold(stf_system *s)
{
  stf_deferred *d = deferred_of(s);
  if (d) d->on = true;
}

int stf_operator_release(stf_system *s)
{
  stf_deferred *d = deferred_of(s);
  const char *name;
  if (!d) return STEIF_OK;
  d->on = false, s->sums++;
  const int returned = stf_deferred_settle(s->space.like, d, &name);
  if (!returned) return STEIF_OK;
  return (returned > 0 ? stf_recover : stf_fail)(
    s->ctx, STEIF_CALLBACK, "%s of problem '%s' returned %d on one of the ranks", name,
    s->problem->name, returned);
}

/* -- products and preconditioner by matrices ----------------------------------------------------- */

bool stf_operator_has_near(const stf_system *s)
{
  const steif_problem *p = s->problem;
  const bool fills_A =
    p->A || p->pattern || (s->form == STEIF_IMPLICIT ? p->idajac != NULL : p->jac != NULL);
  const bool fills_E = s->form == STEIF_ODE || p->E || (s->form == STEIF_IMPLICIT && fills_A);
  return s->krylov && p->storage == STEIF_SPARSE && !p->precsolve && fills_A && fills_E &&
         (s->space.serial || stf_array(s->space.like));
}

static int near_E(N_Vector x, N_Vector out, void *user)
{
  return steif_pencil_product(((stf_system *)user)->near, 'E', x, out);
}

static int near_A(N_Vector x, N_Vector out, void *user)
{
  return steif_pencil_product(((stf_system *)user)->near, 'A', x, out);
}

static int near_prepare(sunrealtype shift, void *user)
{
  return steif_pencil_factor(((stf_system *)user)->near, 1, &(steif_shift){shift, 0});
}

static int near_solve(sunrealtype shift, N_Vector r, N_Vector z, sunrealtype tolerance,
                      void *user)
{
  stf_system *s = user;
  (void)shift, (void)tolerance;
  stf_copy(&s->space, r, z);
  return steif_pencil_solve(s->near, 0, 1, &z, NULL);
}

int stf_operator_open_near(stf_pool *pool, stf_system *s)
{
  s->near = steif_pencil_new_incomplete(s->ctx, s->E, s->A);
  if (!s->near) return steif_status(s->ctx);
  STEIF_TRY(stf_pool_adopt(pool, s->near, stf_system_destroy_pencil));
  return claim(pool, s,
               &(steif_operator){.E = s->E ? near_E : NULL,
                                 .A = near_A,
                                 .prepare = near_prepare,
                                 .precondition = near_solve,
                                 .user = s});
}
