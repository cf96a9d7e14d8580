/* direct_cvode.c: CVODE called as its guide says.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direct.h"
#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <math.h>

static int configure(void *m, direct *d, sunrealtype rtol)
{
  const steif_problem *p = d->p;
  const sunrealtype scale = p->rtol_scale > 0 ? p->rtol_scale : 1;
  int flag = CVodeInit(m, p->f, p->t0, d->y);
  if (!flag) flag = CVodeSStolerances(m, rtol, rtol * scale);
  if (!flag) flag = CVodeSetUserData(m, p->user);
  if (!flag) flag = CVodeSetLinearSolver(m, d->solver, d->J);
  if (!flag) flag = CVodeSetJacFn(m, p->jac);
  if (!flag) flag = CVodeSetMaxNumSteps(m, 1000000);
  if (!flag) flag = CVodeSetMaxHnilWarns(m, -1);
  return flag;
}

long direct_cvode(SUNContext sun, const steif_problem *p, sunrealtype rtol)
{
  direct d;
  long steps = 0, more = 0;
  void *m = CVodeCreate(CV_BDF, sun);
  int flag = !m || direct_open(sun, p, &d) ? -1 : configure(m, &d, rtol);
  for (int k = 0; flag >= 0 && k <= p->break_count; k++) {
    const sunrealtype until = direct_until(p, k);
    sunrealtype t;
    flag = CVodeSetStopTime(m, until);
    if (flag >= 0) flag = CVode(m, until, d.y, &t, CV_NORMAL);
    CVodeGetNumSteps(m, &more);
    steps += more;
    if (flag >= 0 && k < p->break_count)
      flag = CVodeReInit(m, nextafter(p->breaks[k], INFINITY), d.y);
  }
  if (m) CVodeFree(&m);
  direct_close(&d);
  return flag < 0 ? -1 : steps;
}
