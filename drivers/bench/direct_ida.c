/* direct_ida.c: IDA on y' - f(t, y) = 0, called as its guide says.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direct.h"
#include <ida/ida.h>
#include <ida/ida_ls.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const steif_problem *p = user;
  const int seen = p->f(t, y, r, p->user);
  const sunrealtype *slope = NV_DATA_S(yp);
  sunrealtype *x = NV_DATA_S(r);
  for (sunindextype i = 0; i < p->n; i++) x[i] = slope[i] - x[i];
  return seen;
}

/* c I - df/dy; the pattern of df/dy holds the diagonal. */
static int jacobian(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                    SUNMatrix J, void *user, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  const steif_problem *p = user;
  const int seen = p->jac(t, y, r, J, p->user, tmp1, tmp2, tmp3);
  (void)yp;
  if (p->storage == STEIF_DENSE) {
    sunrealtype *x = SM_DATA_D(J);
    for (sunindextype i = 0; i < p->n * p->n; i++) x[i] = -x[i];
    for (sunindextype i = 0; i < p->n; i++) x[i * (p->n + 1)] += c;
    return seen;
  }
  for (sunindextype j = 0; j < p->n; j++)
    for (sunindextype k = SM_INDEXPTRS_S(J)[j]; k < SM_INDEXPTRS_S(J)[j + 1]; k++)
      SM_DATA_S(J)[k] = (SM_INDEXVALS_S(J)[k] == j ? c : 0) - SM_DATA_S(J)[k];
  return seen;
}

static int configure(void *m, direct *d, sunrealtype rtol)
{
  const steif_problem *p = d->p;
  const sunrealtype scale = p->rtol_scale > 0 ? p->rtol_scale : 1;
  int flag = p->f(p->t0, d->y, d->yp, p->user);
  if (!flag) flag = IDAInit(m, residual, p->t0, d->y, d->yp);
  if (!flag) flag = IDASStolerances(m, rtol, rtol * scale);
  if (!flag) flag = IDASetUserData(m, (void *)(uintptr_t)p);
  if (!flag) flag = IDASetLinearSolver(m, d->solver, d->J);
  if (!flag) flag = IDASetJacFn(m, jacobian);
  if (!flag) flag = IDASetMaxNumSteps(m, 1000000);
  return flag;
}

static int restart(void *m, direct *d, sunrealtype t)
{
  const int seen = d->p->f(t, d->y, d->yp, d->p->user);
  return seen ? -1 : IDAReInit(m, t, d->y, d->yp);
}

long direct_ida(SUNContext sun, const steif_problem *p, sunrealtype rtol)
{
  direct d;
  long steps = 0, more = 0;
  void *m = IDACreate(sun);
  int flag = !m || direct_open(sun, p, &d) ? -1 : configure(m, &d, rtol);
  for (int k = 0; flag >= 0 && k <= p->break_count; k++) {
    const sunrealtype until = direct_until(p, k);
    sunrealtype t;
    flag = IDASetStopTime(m, until);
    if (flag >= 0) flag = IDASolve(m, until, &t, d.y, d.yp, IDA_NORMAL);
    IDAGetNumSteps(m, &more);
    steps += more;
    if (flag >= 0 && k < p->break_count)
      flag = restart(m, &d, nextafter(p->breaks[k], INFINITY));
  }
  if (m) IDAFree(&m);
  direct_close(&d);
  return flag < 0 ? -1 : steps;
}
