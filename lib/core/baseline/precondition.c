/* precondition.c: preconditioners of SUNDIALS' Krylov solvers: the problem's own callbacks, or for
 * CVODE and ARKODE the incomplete factors that steif's methods take for sparse problems.
 * I - gamma J is gamma (c I - J) with c = 1 / gamma, of the last setup.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include "pencil.h"

static void free_pencil(void *pencil)
{
  steif_pencil *p = pencil;
  steif_pencil_free(&p);
}

int stf_baseline_near(stf_baseline *base)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  if (base->storage != STEIF_KRYLOV || base->preconditioned || p->storage != STEIF_SPARSE ||
      !stf_baseline_has_jac(base) || !stf_array(base->work))
    return STEIF_OK;
  STEIF_TRY(stf_baseline_native(base));
  base->near = steif_pencil_new_incomplete(run->ctx, NULL, base->A);
  if (!base->near) return steif_status(run->ctx);
  base->preconditioned = true;
  return stf_pool_adopt(run->pool, base->near, free_pencil);
}

int stf_baseline_precsetup(sunrealtype t, N_Vector y, N_Vector fy, sunbooleantype jok,
                           sunbooleantype *jcur, sunrealtype gamma, void *user)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  const long failures = stf_failures(base->run->ctx);
  *jcur = base->near ? !jok : 1;
  base->c = 1 / gamma;
  if (!base->near)
    return p->precsetup
             ? stf_baseline_tells(base, failures,
                                  p->precsetup(t, y, base->run->yp, fy, base->c, p->user))
             : 0;
  if (*jcur) {
    N_Vector w = base->work;
    const int seen = stf_baseline_jac(t, y, fy, base->A, base, w, w, w);
    if (seen) return seen;
    if (steif_pencil_update(base->near)) return -1;
  }
  return steif_pencil_factor(base->near, 1, &(steif_shift){base->c, 0}) ? 1 : 0;
}

int stf_baseline_precsolve(sunrealtype t, N_Vector y, N_Vector fy, N_Vector r, N_Vector z,
                           sunrealtype gamma, sunrealtype delta, int side, void *user)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  const long failures = stf_failures(base->run->ctx);
  (void)side, (void)gamma;
  int code = 0;
  if (!base->near)
    code = stf_baseline_tells(
      base, failures, p->precsolve(t, y, base->run->yp, fy, r, z, base->c, delta, p->user));
  else {
    N_VScale(1, r, z);
    code = steif_pencil_solve(base->near, 0, 1, &z, NULL);
  }
  sunrealtype *x = stf_array(z);
  if (!x) N_VScale(base->c, z, z);
  const sunindextype n = x ? N_VGetLength(z) : 0;
  for (sunindextype i = 0; i < n; i++) x[i] *= base->c;
  return code;
}
