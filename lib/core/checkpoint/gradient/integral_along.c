/* integral_along.c: integrals by BDF beside the same along its dense output. BDF takes an integral as one more unknown, whose
 * error no test of the steps sees: free flight lets them grow as long as they like, an integral does not. Its gradient asks
 * for those of dg/dy, which may differ where y is 0: so does g at y moved by a 64th of its size.
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

static int shift(stf_journey *J)
{
  stf_backwards *B = &J->back;
  B->shifted = stf_pool_array(B->pool, (size_t)B->count, sizeof *B->shifted);
  B->shift = stf_pool_vectors(B->pool, 2, B->work);
  if (!B->shift || !B->shifted) return STEIF_NO_MEMORY;
  const sunrealtype *y = STF_ARRAY(J->runner->step.y);
  sunrealtype *v = STF_ARRAY(B->shift[0]);
  for (sunindextype j = 0; j < B->n; j++)
    v[j] = (fabs(y[j]) + J->runner->step.system.scale) / 64;
  return STEIF_OK;
}

/* Adds the integrals of a step, and their sizes, to sum and size. */
static int add(stf_journey *J, bool moved, sunrealtype c, sunrealtype t, sunrealtype *sum)
{
  stf_backwards *B = &J->back;
  sunrealtype *size = sum + B->count, *one = J->along + 4 * B->count,
              *all = B->other + 2 * B->count;
  for (int i = 0; i < B->count; i++) one[i] = 0, all[i] = c;
  STEIF_TRY(moved ? stf_functional_shifted(B, all, t, B->work, one)
                  : stf_functional_add(B, c, t, B->work, one));
  for (int i = 0; i < B->count; i++) sum[i] += one[i], size[i] += fabs(one[i]);
  return STEIF_OK;
}

int stf_along_open(stf_journey *J)
{
  const size_t count = (size_t)J->back.count;
  J->end = stf_pool_array(J->back.pool, count, sizeof *J->end);
  if (!J->end) return STEIF_NO_MEMORY;
  if (!wanted(J)) return STEIF_OK;
  J->along = stf_pool_array(J->back.pool, 5 * count, sizeof *J->along);
  return J->along ? shift(J) : STEIF_NO_MEMORY;
}

/* Of the step at hand, up to what has cut it. */
int stf_along_step(stf_journey *J)
{
  stf_backwards *B = &J->back;
  steif_solver *s = J->runner;
  if (!J->along) return STEIF_OK;
  const sunrealtype from = s->step.t - s->step.h;
  sunrealtype to = s->step.t;
  for (long i = 0; i < J->left; i++)
    if (J->passed[i].step == J->steps && J->passed[i].cut) to = J->passed[i].change.t;
  long double node[NODES], weight[NODES];
  stf_gauss(NODES, node, weight);
  for (int j = 0; j < NODES; j++) {
    const sunrealtype t = from + (to - from) * (sunrealtype)node[j];
    const sunrealtype c = (to - from) * (sunrealtype)weight[j];
    STEIF_TRY(stf_dense(s, t, B->work));
    STEIF_TRY(add(J, false, c, t, J->along));
    STEIF_TRY(add(J, true, c, t, J->along + 2 * B->count));
  }
  return STEIF_OK;
}

static int check(const stf_journey *J, int i, sunrealtype by_bdf, const sunrealtype *along)
{
  const stf_backwards *B = &J->back;
  const sunrealtype most = fmax(100 * J->options.rtol, 1e-12), size = along[B->count + i];
  STEIF_CHECK(!(fabs(by_bdf - along[i]) > most * size), B->ctx, STEIF_NOT_CERTIFIED,
              "integral %d of problem '%s'%s is %.6g by the quadrature of '%s', %.6g along its "
              "dense output: the steps follow y, not the integral, and its gradient would be "
              "off as much; take radau:s=3 or a smaller h_max",
              i + 1, B->problem->name,
              along == J->along ? "" : ", of the solution moved by a 64th,", by_bdf, J->method,
              along[i]);
  return STEIF_OK;
}

int stf_along_check(const stf_journey *J)
{
  const stf_backwards *B = &J->back;
  for (int i = 0; J->along && i < B->count; i++) {
    STEIF_TRY(check(J, i, B->value[i] - J->end[i], J->along));
    if (B->shift) STEIF_TRY(check(J, i, B->shifted[i], J->along + 2 * B->count));
  }
  return STEIF_OK;
}
