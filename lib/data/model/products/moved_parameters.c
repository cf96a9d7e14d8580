/* moved_parameters.c: what a model keeps of its parameters, in the midst of a run, and times that depend on them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrands.h"
#include "products.h"
#include "model_file.h"
#include "reactions.h"
#include <math.h>

int stf_model_follow(void *user)
{
  stf_model *m = user;
  const stf_quantity *all[] = {&m->f,          &m->A.quantity,        &m->E.quantity,
                               &m->invariants, &m->outputs,           &m->output_slopes,
                               &m->events,     &m->products->tangent, &m->products->adjoint};
  for (size_t i = 0; i < m->symbols.count; i++) {
    stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind == STF_IS_PARAMETER && s->which >= 0) s->value = m->p[s->which];
  }
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_quantity_prepare(m, all[i]);
  stf_integrands_follow(m);
  return stf_reactions_follow(m) ? -1 : 0;
}

/* By the breaks of the model made with another value; slope[i] += weight breaks[i]. */
static int add_breaks(const stf_model *m, int k, double value, double weight, double *slope)
{
  steif_problem moved;
  STEIF_TRY(stf_model_moved(m, m->parameter_name[k], value, &moved));
  const int count = moved.break_count;
  for (int i = 0; i < count && i < m->break_count; i++) slope[i] += weight * moved.breaks[i];
  stf_model_close(m->ctx, &moved);
  STEIF_CHECK(count == m->break_count, m->ctx, STEIF_UNSUPPORTED,
              "the model has %d breaks, and %d with %s = %.17g: some lie at one time, or come "
              "and go, and "
              "their times have no derivatives; move one of them a little",
              m->break_count, count, m->parameter_name[k], value);
  return STEIF_OK;
}

/* By central differences, all at once. */
static int find_slopes(stf_model *m)
{
  const size_t count = (size_t)m->given.count * (size_t)m->break_count;
  double *all = stf_pool_array(m->pool, count, sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  for (int k = 0; k < m->given.count; k++) {
    const double at = m->p[k], d = cbrt(STF_EPS) * (at != 0 ? fabs(at) : 1);
    const volatile double up = at + d, down = at - d;
    double *of = all + (size_t)k * (size_t)m->break_count;
    STEIF_TRY(add_breaks(m, k, up, 1 / (up - down), of));
    STEIF_TRY(add_breaks(m, k, down, -1 / (up - down), of));
  }
  m->break_slope = all;
  return STEIF_OK;
}

int stf_model_break_slope(int i, int k, sunrealtype *slope, void *user)
{
  stf_model *m = user;
  if (!m->break_slope && find_slopes(m)) return -1;
  *slope = m->break_slope[k * m->break_count + i];
  return 0;
}
