/* unfit_integrands.c: integrals that no test of theirs would find wrong: of unknowns that stages of low order have to a few
 * digits only, and of multipliers where velocities or charges jump, whose values do not tell their impulses.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"

int stf_quadrature_orders(steif_solver *s)
{
  const steif_problem *p = s->problem;
  char name[STEIF_SPEC_WORD];
  int which;
  if (s->engine || !s->step.adaptive || !p->index || !stf_low_stages(s->step.table) ||
      s->step.system.form == STEIF_ODE)
    return STEIF_OK;
  if (s->agreed) {
    STEIF_TRY(stf_quadrature_reads(s, s->end, stf_last(s), -1, &which));
    STEIF_CHECK(
      which < 0, s->ctx, STEIF_UNSUPPORTED,
      "integrand %d of problem '%s' reads unknowns of index 2 or 3, which '%s' has to "
      "a few digits only inside its steps: take radau or bdf",
      which + 1, p->name, s->method);
    return STEIF_OK;
  }
  for (sunindextype j = 0; j < p->n; j++) {
    int i;
    if (p->index[j] < 2) continue;
    STEIF_TRY(stf_quadrature_reads(s, s->end, stf_last(s), j, &i));
    STEIF_CHECK(i < 0, s->ctx, STEIF_UNSUPPORTED,
                "integrand %d of problem '%s' reads unknown %s of index %d, which '%s' has to "
                "a few digits only inside its steps: take radau or bdf",
                i + 1, p->name, stf_unknown(p, j, name), p->index[j], s->method);
  }
  return STEIF_OK;
}

int stf_quadrature_impulses(steif_solver *s, sunrealtype t, N_Vector y, const bool *algebraic,
                            const int *index)
{
  const steif_problem *p = s->problem;
  char name[STEIF_SPEC_WORD];
  if (!s->quadratures || !index) return STEIF_OK;
  for (sunindextype j = 0; j < p->n; j++) {
    int i;
    if (!algebraic[j] || index[j] < 2) continue;
    STEIF_TRY(stf_quadrature_reads(s, t, y, j, &i));
    STEIF_CHECK(i < 0, s->ctx, STEIF_UNSUPPORTED,
                "integral %d of problem '%s' is of %s, and at t = %.12g unknowns jump by "
                "impulses, which values of such a multiplier do not tell: take what jumps, a "
                "charge or a momentum, at the end instead",
                i + 1, p->name, stf_unknown(p, j, name), t);
  }
  return STEIF_OK;
}
