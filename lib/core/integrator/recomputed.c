/* recomputed.c: the solution shown, put on all constraints: positions and velocities move least, and unknowns of
 * index 2 and 3 are computed from them instead of from stages, which have lower orders for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "integrator.h"
#include <math.h>
#include <string.h>

/* What y_j may err by. */
static sunrealtype tolerance(const steif_solver *s, const sunrealtype *y, size_t j)
{
  const steif_options *o = &s->options;
  return o->rtol * fabs(y[j]) + (o->atols ? o->atols[j] : o->atol);
}

static void measure(const steif_solver *s, const steif_start *start, sunrealtype *drift,
                    sunrealtype *corrected)
{
  const sunrealtype *y = N_VGetArrayPointer(s->shown);
  const int *index = s->problem->index;
  sunrealtype most[2] = {0, 0};
  for (size_t j = 0; j < (size_t)s->problem->n; j++) {
    const bool high = index && index[j] > 1;
    most[high] = fmax(most[high], fabs(start->moved[j]) / tolerance(s, y, j));
  }
  if (drift) *drift = most[0];
  if (corrected) *corrected = most[1];
}

int steif_recompute(steif_solver *s, N_Vector y, sunrealtype *drift, sunrealtype *corrected)
{
  if (!s) return STEIF_BAD_INPUT;
  const size_t n = (size_t)s->problem->n;
  STEIF_CHECK(y && N_VGetArrayPointer(y) && N_VGetLength(y) == s->problem->n &&
                N_VGetArrayPointer(s->shown),
              s->ctx, STEIF_BAD_INPUT, "a vector of %zu components with a host array is needed",
              n);
  steif_start start;
  const steif_point at = {.y = N_VGetArrayPointer(s->shown), .t = s->t_shown};
  STEIF_TRY(stf_start_project(s->ctx, s->problem, &at, &start));
  measure(s, &start, drift, corrected);
  memcpy(N_VGetArrayPointer(y), start.y, n * sizeof *start.y);
  steif_start_clear(&start);
  return STEIF_OK;
}
