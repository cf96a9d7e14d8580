/* integral_along.c: integrals by BDF beside the same along its dense output. BDF takes an integral as one more unknown, whose
 * error no test of the steps sees: free flight lets them grow as long as they like, an integral does not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "journey.h"
#include "table.h"
#include <math.h>

enum { NODES = 3 };

static bool wanted(const stf_journey *J)
{
  const stf_backwards *B = &J->back;
  return B->kind == STF_TRACE_BDF && B->adaptive && B->functional->integrand;
}

int stf_along_open(stf_journey *J)
{
  const size_t count = (size_t)J->back.count;
  J->end = stf_pool_array(J->back.pool, count, sizeof *J->end);
  if (!J->end) return STEIF_NO_MEMORY;
  if (!wanted(J)) return STEIF_OK;
  J->along = stf_pool_array(J->back.pool, 3 * count, sizeof *J->along);
  return J->along ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Of the step at hand, up to what has cut it. */
int stf_along_step(stf_journey *J)
{
  stf_backwards *B = &J->back;
  steif_solver *s = J->runner;
  if (!J->along) return STEIF_OK;
  const sunrealtype from = s->step.t - s->step.h;
  sunrealtype to = s->step.t, *sum = J->along, *size = sum + B->count, *one = size + B->count;
  for (long i = 0; i < J->left; i++)
    if (J->passed[i].step == J->steps && J->passed[i].cut) to = J->passed[i].change.t;
  long double node[NODES], weight[NODES];
  stf_gauss(NODES, node, weight);
  for (int j = 0; j < NODES; j++) {
    const sunrealtype t = from + (to - from) * (sunrealtype)node[j];
    for (int i = 0; i < B->count; i++) one[i] = 0;
    STEIF_TRY(stf_dense(s, t, B->work));
    STEIF_TRY(stf_functional_add(B, (to - from) * (sunrealtype)weight[j], t, B->work, one));
    for (int i = 0; i < B->count; i++) sum[i] += one[i], size[i] += fabs(one[i]);
  }
  return STEIF_OK;
}

int stf_along_check(const stf_journey *J)
{
  const stf_backwards *B = &J->back;
  const sunrealtype most = fmax(100 * J->options.rtol, 1e-12);
  for (int i = 0; J->along && i < B->count; i++) {
    const sunrealtype by_bdf = B->value[i] - J->end[i], along = J->along[i],
                      size = J->along[B->count + i];
    STEIF_CHECK(!(fabs(by_bdf - along) > most * size), B->ctx, STEIF_NOT_CERTIFIED,
                "integral %d of problem '%s' is %.6g by the quadrature of '%s', %.6g along its "
                "dense output: the steps follow y, not the integral, and its gradient would be "
                "off as much; take radau:s=3 or a smaller h_max",
                i + 1, B->problem->name, by_bdf, J->method, along);
  }
  return STEIF_OK;
}
