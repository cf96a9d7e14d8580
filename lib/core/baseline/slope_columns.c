/* slope_columns.c: the linear equations of derivatives by parameters, with matrices of the problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_columns.h"
#include <math.h>
#include <steif/parameters.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype shortest =
  1e-9; /* of the interval: the step that tells S' at the start */

static void free_matrix(void *M) { SUNMatDestroy(M); }

int stf_slope_open(stf_slope_columns *c, stf_baseline *base, bool *exact)
{
  stf_run *run = base->run;
  const bool ode = run->form == STEIF_ODE;
  c->base = base;
  STEIF_CHECK(base->J, run->ctx, STEIF_UNSUPPORTED,
              "%s carries sensitivities with matrices, and Krylov storage of problem '%s' has "
              "none: take dense or sparse storage",
              base->package, run->problem->name);
  *exact = (ode ? stf_baseline_has_jac(base) : stf_lower_has_jac(base));
  if (*exact)
    STEIF_TRY(
      stf_slopes_open(run->pool, run->ctx, run->problem, run->form, run->like, &c->slopes));
  for (int i = 0; i < 3; i++)
    if (!(c->work[i] = stf_pool_vector(run->pool, run->like))) return STEIF_NO_MEMORY;
  for (int i = 0; i < 2 && *exact; i++) {
    c->J[i] = SUNMatClone(base->J);
    STEIF_CHECK(c->J[i], run->ctx, STEIF_NO_MEMORY, "no memory for a matrix of derivatives");
    STEIF_TRY(stf_pool_adopt(run->pool, c->J[i], free_matrix));
  }
  return STEIF_OK;
}

int stf_slope_unbroken(const stf_baseline *base)
{
  const stf_run *run = base->run;
  STEIF_CHECK(
    !run->columns.count || !base->restart, run->ctx, STEIF_UNSUPPORTED,
    "%s carries no sensitivities through the break of problem '%s' at t = %.12g: take "
    "radau:s=3",
    base->package, run->problem->name, run->t);
  return STEIF_OK;
}

static int add_slope(stf_slope_columns *c, int k, sunrealtype t, N_Vector y, N_Vector yp,
                     sunrealtype sign, N_Vector out)
{
  stf_run *run = c->base->run;
  const int parameter = run->columns.parameter[k];
  int code = stf_slopes_at(c->slopes, parameter, t, y, yp, c->work[0]);
  if (!code && stf_not_finite(c->work[0]) >= 0)
    code = stf_slopes_not_finite(c->slopes, parameter, t, c->work[0]);
  if (code) return code < 0 ? -1 : 1;
  N_VLinearSum(1, out, sign, c->work[0], out);
  return 0;
}

int stf_slope_rhs(stf_slope_columns *c, sunrealtype t, N_Vector y, N_Vector fy, N_Vector *S,
                  N_Vector *out)
{
  c->made++;
  SUNMatZero(c->J[0]);
  const int seen =
    stf_baseline_jac(t, y, fy, c->J[0], c->base, c->work[0], c->work[1], c->work[2]);
  if (seen) return seen;
  for (int k = 0; k < c->base->run->columns.count; k++) {
    N_VConst(0, out[k]);
    stf_matrix_times(c->J[0], 1, stf_array(S[k]), stf_array(out[k]));
    const int said = add_slope(c, k, t, y, fy, -1, out[k]);
    if (said) return said;
  }
  return 0;
}

static int fill(stf_slope_columns *c, int which, sunrealtype factor, sunrealtype t, N_Vector y,
                N_Vector yp)
{
  stf_baseline *b = c->base;
  N_Vector r = b->start ? b->start : c->work[0];
  SUNMatZero(c->J[which]);
  return stf_lower_jac(t, factor, y, yp, r, c->J[which], b, c->work[0], c->work[1], c->work[2]);
}

/* J_0 (S - S') + J_1 S' = F_y S + F_y' S'. */
int stf_slope_residual(stf_slope_columns *c, sunrealtype t, N_Vector y, N_Vector yp,
                       N_Vector *S, N_Vector *Sp, N_Vector *out)
{
  c->made++;
  int seen = fill(c, 0, 0, t, y, yp);
  if (!seen && Sp) seen = fill(c, 1, 1, t, y, yp);
  for (int k = 0; !seen && k < c->base->run->columns.count; k++) {
    sunrealtype *r = stf_array(out[k]);
    N_VConst(0, out[k]);
    if (Sp) N_VLinearSum(1, S[k], -1, Sp[k], c->work[1]);
    stf_matrix_times(c->J[0], 1, stf_array(Sp ? c->work[1] : S[k]), r);
    if (Sp) stf_matrix_times(c->J[1], 1, stf_array(Sp[k]), r);
    seen = add_slope(c, k, t, y, yp, 1, out[k]);
  }
  return seen;
}

static int solve(stf_slope_columns *c, sunrealtype factor, N_Vector *Sp)
{
  stf_baseline *b = c->base;
  stf_run *run = b->run;
  int seen = fill(c, 1, factor, run->t, run->y, run->yp);
  if (!seen) seen = SUNMatCopy(c->J[1], b->J);
  if (!seen) seen = SUNLinSolInitialize(b->solver);
  if (!seen) seen = SUNLinSolSetup(b->solver, b->J);
  for (int k = 0; !seen && k < run->columns.count; k++) {
    seen = SUNLinSolSolve(b->solver, b->J, c->work[1], Sp[k], 0);
    N_VScale(-factor, c->work[1], Sp[k]);
  }
  return seen;
}

int stf_slope_start(stf_slope_columns *c, N_Vector *S, N_Vector *Sp)
{
  stf_run *run = c->base->run;
  const sunrealtype factor = 1 / (shortest * (run->options->t1 - run->t));
  int seen = stf_slope_residual(c, run->t, run->y, run->yp, S, NULL, Sp);
  if (!seen && run->form == STEIF_ODE)
    for (int k = 0; k < run->columns.count; k++) N_VScale(-1, Sp[k], Sp[k]);
  else if (!seen)
    seen = solve(c, factor, Sp);
  c->made = 0;
  STEIF_CHECK(!seen, run->ctx, STEIF_CALLBACK,
              "derivatives by parameters could not be evaluated at the start, t = %g", run->t);
  return STEIF_OK;
}
