/* low_orders.c: integrands of unknowns that a step knows to a few digits only. Stages of order 1 have those of index 2 and 3
 * so (Hairer and Wanner, Solving ODEs II, VII.4): no test of the integral would tell.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>
#include <steif/quadrature.h>

static bool low(const steif_solver *s)
{
  const steif_table *T = s->engine ? NULL : s->step.table;
  return T && T->stage_order < 2 && s->step.adaptive && s->problem->index &&
         s->problem->dae_index > 1 && s->step.system.form != STEIF_ODE;
}

int stf_quadrature_orders(steif_solver *s, stf_integrand value, N_Vector moved, int count,
                          sunrealtype *g, sunrealtype *other)
{
  static const sunrealtype part = 1.0 / 64;
  const steif_problem *p = s->problem;
  N_Vector y = stf_last(s);
  char name[STEIF_SPEC_WORD];
  if (!low(s)) return STEIF_OK;
  STEIF_TRY(value(s, s->end, y, g));
  for (sunindextype j = 0; j < p->n; j++) {
    if (p->index[j] < 2) continue;
    N_VScale(1, y, moved);
    stf_array(moved)[j] += part * (fabs(stf_array(y)[j]) + s->step.system.scale);
    STEIF_TRY(value(s, s->end, moved, other));
    for (int i = 0; i < count; i++)
      STEIF_CHECK(
        g[i] == other[i], s->ctx, STEIF_UNSUPPORTED,
        "integrand %d of problem '%s' reads unknown %s of index %d, which '%s' has to "
        "a few digits only inside its steps: take radau or bdf",
        i + 1, p->name, stf_unknown(p, j, name), p->index[j], s->method);
  }
  return STEIF_OK;
}
