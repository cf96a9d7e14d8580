/* operator_stages.c: K^T w = r and K x = r where storage is Krylov, by GMRES for each shift of the stages.
 *
 * (s E - A)^T of the middle stage, complex shifts with the conjugate transpose, is known by its products: Etv and Atv, or
 * of matrices that Krylov storage keeps. Its preconditioner is precsolve_transposed, or the transposed ILU(0) of these. It
 * is made at every step, since steps that are made again leave another one: results do not depend on what is kept.
 *
 * Inner solves leave GAIN of their right-hand sides, and sweeps with the residual of the step's own equations the rest.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>

enum { DIMENSION = 60, RESTARTS = 20, SWEEPS = 30 };
static const sunrealtype GAIN = 1e-4, GAIN_ALONE = 1e-6; /* of several stages; of one */

/* ---- whose matrices ------------------------------------------------------------------------------ */

/* What a problem known by products can be stored as instead; Krylov: it fills no matrices. */
static enum steif_storage stored(const stf_system *s)
{
  const steif_problem *p = s->problem;
  const bool fills = p->jac || p->A || p->idajac;
  const bool whole = (s->form == STEIF_ODE || s->form == STEIF_IMPLICIT || p->E) &&
                     (s->form != STEIF_DESCRIPTOR || p->A);
  if (!whole) return STEIF_KRYLOV;
  switch (p->storage) {
  case STEIF_BAND: return STEIF_BAND;
  case STEIF_DENSE:
    if (fills) return STEIF_DENSE;
    break;
  default:
    if (fills && p->nnz > 0) return STEIF_SPARSE;
  }
  return p->pattern ? STEIF_SPARSE : STEIF_KRYLOV;
}

int stf_matrices_for(stf_backwards *B, bool second, stf_system **system)
{
  stf_system *own = &B->home->step.system;
  const steif_problem *p = own->problem;
  const stf_step *start = &B->home->step;
  *system = own;
  if (own->A || (stf_operator_transposes(own) && (p->Av || !second))) return STEIF_OK;
  const enum steif_storage storage = stored(own);
  STEIF_CHECK(
    storage != STEIF_KRYLOV, B->ctx, STEIF_UNSUPPORTED,
    "gradients go back with transposed matrices, and problem '%s' with Krylov storage "
    "has no %sproducts: give .%s (text models: sparse storage), fill matrices, or take "
    "sensitivities",
    p->name, stf_operator_transposes(own) ? "exact " : "transposed ",
    stf_operator_transposes(own)        ? "Av"
    : own->form == STEIF_ODE || !p->Atv ? (own->form == STEIF_ODE ? "Atv" : "Atv and .Etv")
                                        : "Etv");
  if (!(*system = stf_pool_array(B->pool, 1, sizeof **system))) return STEIF_NO_MEMORY;
  return stf_system_open(B->pool, B->ctx, p, own->form, storage, own->scale, own->floors,
                         start->y, start->yp, *system);
}

/* ---- the pencil of the middle stage ---------------------------------------------------------------- */

static int times_E(N_Vector x, N_Vector out, void *user)
{
  const stf_adjoint *a = user;
  return stf_matrices_at_product(&a->at, a->middle, 'E', x, out);
}

static int times_A(N_Vector x, N_Vector out, void *user)
{
  const stf_adjoint *a = user;
  return stf_matrices_at_product(&a->at, a->middle, 'A', x, out);
}

static int turned_E(N_Vector x, N_Vector out, void *user)
{
  const stf_adjoint *a = user;
  stf_zero(a->space, out);
  return stf_adjoint_add(a, a->middle, 'E', 1, x, out);
}

static int turned_A(N_Vector x, N_Vector out, void *user)
{
  const stf_adjoint *a = user;
  stf_zero(a->space, out);
  return stf_adjoint_add(a, a->middle, 'A', 1, x, out);
}

static const stf_operator_point *point_of(const stf_adjoint *a)
{
  return a->at.point + (a->at.system->linear ? 0 : a->middle);
}

static int prepare(sunrealtype shift, void *user)
{
  stf_adjoint *a = user;
  const steif_problem *p = a->at.system->problem;
  const stf_operator_point *at = a->at.point ? point_of(a) : NULL;
  if (at) return p->precsetup(at->t, at->y, at->yp, at->f, shift, p->user);
  STEIF_TRY(steif_pencil_update(a->incomplete));
  return steif_pencil_factor(a->incomplete, 1, &(steif_shift){shift, 0});
}

static int precondition(const stf_adjoint *a, bool transposed, sunrealtype shift, N_Vector r,
                        N_Vector z)
{
  const steif_problem *p = a->at.system->problem;
  const stf_operator_point *at = a->at.point ? point_of(a) : NULL;
  if (at)
    return (transposed ? p->precsolve_transposed : p->precsolve)(at->t, at->y, at->yp, at->f, r,
                                                                 z, shift, 0, p->user);
  stf_copy(a->space, r, z);
  return transposed ? steif_pencil_solve_transposed(a->incomplete, 0, 1, &z, NULL)
                    : steif_pencil_solve(a->incomplete, 0, 1, &z, NULL);
}

static int own_precondition(sunrealtype shift, N_Vector r, N_Vector z, sunrealtype tolerance,
                            void *user)
{
  (void)tolerance;
  return precondition(user, false, shift, r, z);
}

static int turned_precondition(sunrealtype shift, N_Vector r, N_Vector z, sunrealtype tolerance,
                               void *user)
{
  (void)tolerance;
  return precondition(user, true, shift, r, z);
}

static int open_incomplete(stf_adjoint *a)
{
  a->incomplete = steif_pencil_new_incomplete(a->ctx, a->at.E[a->middle], a->at.A[a->middle]);
  if (!a->incomplete) return steif_status(a->ctx);
  return stf_pool_adopt(a->pool, a->incomplete, stf_system_destroy_pencil);
}

int stf_lanes_open(stf_adjoint *a)
{
  const stf_system *s = a->at.system;
  const steif_problem *p = s->problem;
  const bool has_E = s->form != STEIF_ODE;
  const bool near = !a->at.point || p->precsolve_transposed;
  a->lanes = true;
  a->turned = stf_pool_vector(a->pool, s->space.like);
  if (!a->turned) return STEIF_NO_MEMORY;
  if (!a->at.point) STEIF_TRY(open_incomplete(a));
  const steif_operator op = {
    .E = has_E ? times_E : NULL,
    .A = times_A,
    .prepare = near && (a->incomplete || p->precsetup) ? prepare : NULL,
    .precondition = near && (a->incomplete || p->precsolve) ? own_precondition : NULL,
    .user = a,
    .dimension = a->n < DIMENSION ? (int)a->n : DIMENSION,
    .restarts = RESTARTS,
    .tolerance = a->m > 1 ? GAIN : GAIN_ALONE};
  a->pencil = steif_pencil_new_operator(a->ctx, &op, s->space.like);
  if (!a->pencil) return steif_status(a->ctx);
  STEIF_TRY(stf_pool_adopt(a->pool, a->pencil, stf_system_destroy_pencil));
  return steif_pencil_give_transposed(
    a->pencil, &(steif_transposed){.E = has_E ? turned_E : NULL,
                                   .A = turned_A,
                                   .precondition = near ? turned_precondition : NULL});
}

/* ---- solves ------------------------------------------------------------------------------------------ */

static sunrealtype size_of(N_Vector *x, int m)
{
  sunrealtype sum = 0;
  for (int j = 0; j < m; j++) sum += N_VDotProd(x[j], x[j]);
  return sqrt(sum);
}

/* w as it comes is where it begins. What a sweep leaves is told by its rate. */
int stf_lanes_refine(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  const sunrealtype rounding = 1e-11, doubt = 10;
  sunrealtype last = 0;
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    STEIF_TRY(stf_adjoint_residuals(a, r, w));
    STEIF_TRY(stf_adjoint_precondition(a, a->residual));
    a->sweeps++;
    const sunrealtype moved = size_of(a->residual, a->m);
    if (!(moved <= 1e300)) return 1;
    for (int j = 0; j < a->m; j++) stf_axpy(a->space, 1, a->residual[j], w[j]);
    const sunrealtype size = size_of(w, a->m), rate = last > 0 ? moved / last : 1;
    if (moved * fmin(doubt * rate, 1) <= a->tolerance * size) return STEIF_OK;
    if (sweep > 0 && rate > 0.5) return moved <= rounding * size ? STEIF_OK : 1;
    last = moved;
  }
  return 1;
}

int stf_lanes_short(const stf_adjoint *a)
{
  return STEIF_FAIL(
    a->ctx, STEIF_NO_CONVERGENCE,
    "the %s equations of a step of length %.6g of problem '%s' did not converge "
    "with GMRES: give a better preconditioner with its transpose, take smaller "
    "steps, or sparse storage",
    a->forward ? "differentiated" : "transposed", a->h, a->at.system->problem->name);
}
