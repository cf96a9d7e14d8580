/* algebraic_equations.c: what the error test does with algebraic equations of index 1.
 *
 * What Newton's iteration or rounding left in them at the start of a step is no error of the step: its end does not
 * depend on it. Between the stages they hold to the accuracy of the polynomial of collocation, unless something has
 * happened there that no stage has seen, such as a diode that conducted.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "stage_polynomial.h"
#include "step_error.h"
#include <stdint.h>

/* So many rejected steps have not cured what is no error of theirs. */
enum { STUBBORN = 2 };

void stf_row_probe(const stf_space *space, N_Vector v)
{
  sunrealtype *p = STF_ARRAY(v);
  uint32_t bits = 1;
  for (sunindextype i = 0; i < space->n; i++) {
    bits = bits * 1664525u + 1013904223u; /* Knuth, TAOCP 2, 3.3.4 */
    p[i] = 1 + (sunrealtype)bits / UINT32_MAX;
  }
}

void stf_keep_rows(const stf_space *space, N_Vector Ep, bool algebraic, N_Vector r)
{
  const sunrealtype *rows = STF_ARRAY(Ep);
  sunrealtype *x = STF_ARRAY(r);
  for (sunindextype i = 0; i < space->n; i++)
    if ((rows[i] == 0) != algebraic) x[i] = 0;
}

/* Are there algebraic equations of index 1 here, and rows of them at hand? */
static bool has_rows(const stf_step *s)
{
  return s->system.form != STEIF_ODE && s->problem->dae_index < 2 && !s->system.krylov &&
         s->system.space.serial;
}

bool stf_residuals_remain(const stf_step *s)
{
  return has_rows(s) && s->tries >= STUBBORN && s->count > 0;
}

int stf_without_residuals(stf_step *s, N_Vector probe, N_Vector Ep, N_Vector residual)
{
  if (!stf_residuals_remain(s)) return STEIF_OK;
  stf_row_probe(&s->system.space, probe);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', probe, Ep));
  return stf_keep_rows(&s->system.space, Ep, false, residual), STEIF_OK;
}

bool stf_looks_between(const stf_step *s, sunrealtype h)
{
  const sunrealtype grown = 1.5;
  return has_rows(s) && !s->system.linear && h > grown * s->h;
}

sunrealtype stf_between(const steif_table *T, int k)
{
  return ((k ? T->c[k - 1] : 0) + T->c[k]) / 2;
}

bool stf_off_between(stf_step *s, N_Vector off)
{
  const stf_space *space = &s->system.space;
  const sunrealtype most = 0.03;
  if (stf_norm(space, off, s->weights) * s->options->rtol <= most) return false;
  stf_copy(space, off, s->error);
  s->error_norm = -1;
  return true;
}

int stf_look_between(stf_step *s, const stf_stage_polynomial *u, sunrealtype h, N_Vector *Z,
                     bool pair, N_Vector slope, N_Vector off)
{
  const stf_space *space = &s->system.space;
  N_Vector y = s->newton.Y;
  bool right = stf_looks_between(s, h);
  for (int k = 0; right && k < u->s; k++) {
    const sunrealtype x = stf_between(u->table, k);
    STEIF_TRY(stf_stage_polynomial_at(u, space, x, s->y, Z, y));
    stf_zero(space, slope);
    STEIF_TRY(stf_system_residual(&s->system, s->t + x * h, y, slope, off));
    stf_row_probe(space, y);
    STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', y, slope));
    stf_keep_rows(space, slope, true, off);
    if (pair) stf_zero(space, y);
    STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &off, pair ? &y : NULL));
    right = !stf_off_between(s, off);
  }
  return STEIF_OK;
}
