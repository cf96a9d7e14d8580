/* cooling.c: a problem of the test of extensions, y' = -y.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "collection.h"
#include <math.h>

static const sunrealtype start[] = {1};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  N_VScale(-1, y, ydot);
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  N_VConst(exp(-t), y);
  return yp ? f(t, y, yp, user) : 0;
}

const steif_problem steif_problem_cooling = {
  .about = "Newton's law of cooling",
  .n = 1,
  .t1 = 1,
  .y0 = start,
  .f = f,
  .autonomous = 1,
  .exact = exact,
};
