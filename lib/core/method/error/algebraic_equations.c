/* algebraic_equations.c: what the error test does with algebraic equations of index 1.
 *
 * What Newton's iteration or rounding left in them at the start of a step is no error of the step: its end does not
 * depend on it. Between the stages they hold to the accuracy of the polynomial of collocation, unless something has
 * happened there that no stage has seen, such as a diode that conducted.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "step_error.h"
#include <stdint.h>

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
  return has_rows(s) && s->tries >= STF_STUBBORN && s->count > 0;
}

int stf_without_residuals(stf_step *s, N_Vector probe, N_Vector Ep, N_Vector residual)
{
  if (!stf_residuals_remain(s)) return STEIF_OK;
  stf_row_probe(&s->system.space, probe);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', probe, Ep));
  return stf_keep_rows(&s->system.space, Ep, false, residual), STEIF_OK;
}

static bool grown(const stf_step *s, sunrealtype h)
{
  const sunrealtype much = 1.5;
  return has_rows(s) && !s->system.linear && s->count > 0 && h > much * s->h;
}

/* Rows of E that are 0 do not depend on y'. */
static int off_at(stf_step *s, sunrealtype h, sunrealtype x, const stf_look *look)
{
  const sunrealtype t = s->t + x * h;
  STEIF_TRY(look->inside(s, x, look->y));
  STEIF_TRY(s->system.form == STEIF_MASS
              ? stf_system_rhs(&s->system, t, look->y, look->off)
              : stf_system_residual(&s->system, t, look->y, look->Ep, look->off));
  stf_keep_rows(&s->system.space, look->Ep, true, look->off);
  return look->solve(s, h, look->off);
}

int stf_look_between(stf_step *s, sunrealtype h, const stf_look *look)
{
  const stf_space *space = &s->system.space;
  const sunrealtype most = 0.03;
  if (!grown(s, h)) return STEIF_OK;
  stf_row_probe(space, look->y);
  STEIF_TRY((look->product ? look->product : stf_product_by_pencil)(s, look->y, look->Ep));
  for (int k = 0; k < look->points; k++) {
    STEIF_TRY(off_at(s, h, look->x[k], look));
    if (stf_norm(space, look->off, s->weights) * s->options->rtol <= most) continue;
    stf_copy(space, look->off, s->error);
    s->error_norm = -1;
    break;
  }
  return STEIF_OK;
}

int stf_between_nodes(const steif_table *T, sunrealtype *x)
{
  for (int k = 0; k < T->s; k++) x[k] = ((k ? T->c[k - 1] : 0) + T->c[k]) / 2;
  return T->s;
}
