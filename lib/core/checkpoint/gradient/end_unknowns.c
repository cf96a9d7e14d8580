/* end_unknowns.c: functionals whose unknowns a step does not have at its end, or inside. Algebraic unknowns of methods that are not
 * stiffly accurate swing from step to step, and so do their derivatives back (Hairer and Wanner, Solving ODEs II, VI.1);
 * stages of order 1 find those of index 2 and 3 to a few digits only (VII.4).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include "integrator.h"

static bool badly_known(const steif_solver *s, sunindextype j, bool at_end)
{
  const steif_table *T = s->step.table;
  const int *index = s->problem->index;
  if (!T || !s->step.adaptive || s->step.system.form == STEIF_ODE) return false;
  if (!at_end || (T->claims & STEIF_STIFFLY_ACCURATE))
    return stf_low_stages(T) && index && index[j] > 1;
  return s->repair.algebraic && s->repair.algebraic[j];
}

static int check(stf_backwards *B, const steif_solver *s, bool at_end)
{
  char name[STEIF_SPEC_WORD];
  for (int i = 0; i < B->count; i++)
    for (sunindextype j = 0; j < B->n; j++)
      STEIF_CHECK(stf_array(B->gy[i])[j] == 0 || !badly_known(s, j, at_end), B->ctx,
                  STEIF_UNSUPPORTED,
                  "functional %d of problem '%s' asks for unknown %s%s, which '%s' does "
                  "not have there with its derivatives: take radau or bdf",
                  i + 1, B->problem->name, stf_unknown(s->problem, j, name),
                  at_end ? " at the end" : " inside steps", s->method);
  return STEIF_OK;
}

int stf_check_inside_unknowns(stf_backwards *B, const steif_solver *s)
{
  if (!B->functional->integrand || !B->space.serial || !stf_low_stages(s->step.table))
    return STEIF_OK;
  STEIF_TRY(stf_functional_at(B, 0, s->end, stf_last(s)));
  return check(B, s, false);
}

int stf_check_end_unknowns(stf_backwards *B, const steif_solver *s)
{
  return B->space.serial ? check(B, s, true) : STEIF_OK;
}
