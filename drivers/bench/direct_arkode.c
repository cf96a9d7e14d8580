/* direct_arkode.c: ARKODE's diagonally implicit methods of order 4, called as its guide says.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direct.h"
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_ls.h>
#include <math.h>
#include <sundials/sundials_config.h>

/* Functions common to all of ARKODE's steppers have one name since 7.1. */
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
#define ARK(name) ARKode##name
#else
#define ARK(name) ARKStep##name
#endif

static int configure(void *m, direct *d, sunrealtype rtol)
{
  const steif_problem *p = d->p;
  const sunrealtype scale = p->rtol_scale > 0 ? p->rtol_scale : 1;
  int flag = ARK(SStolerances)(m, rtol, rtol * scale);
  if (!flag) flag = ARK(SetUserData)(m, p->user);
  if (!flag) flag = ARK(SetLinearSolver)(m, d->solver, d->J);
  if (!flag) flag = ARK(SetJacFn)(m, p->jac);
  if (!flag) flag = ARK(SetMaxNumSteps)(m, 1000000);
  if (!flag) flag = ARK(SetMaxHnilWarns)(m, -1);
  if (!flag) flag = ARK(SetOrder)(m, 4);
  return flag;
}

long direct_arkode(SUNContext sun, const steif_problem *p, sunrealtype rtol)
{
  direct d;
  long steps = 0, more = 0;
  int flag = direct_open(sun, p, &d);
  void *m = flag ? NULL : ARKStepCreate(NULL, p->f, p->t0, d.y, sun);
  flag = m ? configure(m, &d, rtol) : -1;
  for (int k = 0; flag >= 0 && k <= p->break_count; k++) {
    const sunrealtype until = direct_until(p, k);
    sunrealtype t;
    flag = ARK(SetStopTime)(m, until);
    if (flag >= 0) flag = ARK(Evolve)(m, until, d.y, &t, ARK_NORMAL);
    ARK(GetNumSteps)(m, &more);
    steps += more;
    if (flag >= 0 && k < p->break_count)
      flag = ARKStepReInit(m, NULL, p->f, nextafter(p->breaks[k], INFINITY), d.y);
  }
  if (m) ARK(Free)(&m);
  direct_close(&d);
  return flag < 0 ? -1 : steps;
}
