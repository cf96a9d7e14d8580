/* operators.c: E x and A x of a model and the transposed products, for storage without matrices.
 *
 * A = -F_y, which is f_y of the forms with f: there y' is taken as 0, so that a mass matrix has no part in it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "products.h"

static const double *slopes(const stf_model *m, N_Vector yp)
{
  const bool of_f = m->form == STEIF_ODE || m->form == STEIF_MASS;
  return of_f || !yp ? m->products->none : stf_array(yp);
}

static int times_E(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  stf_model *m = user;
  STEIF_TRY(stf_products_ready(m));
  return stf_tangent(m, t, stf_array(y), slopes(m, yp), NULL, stf_array(x), NULL,
                     stf_array(out));
}

static int times_A(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  stf_model *m = user;
  STEIF_TRY(stf_products_ready(m));
  STEIF_TRY(
    stf_tangent(m, t, stf_array(y), slopes(m, yp), stf_array(x), NULL, NULL, stf_array(out)));
  N_VScale(-1, out, out);
  return 0;
}

/* The part of the gradient from `first` on, times `by`. */
static int transposed(stf_model *m, sunrealtype t, N_Vector y, N_Vector yp, N_Vector x,
                      int32_t first, sunrealtype by, N_Vector out)
{
  STEIF_TRY(stf_products_ready(m));
  STEIF_TRY(stf_adjoint(m, t, stf_array(y), slopes(m, yp), stf_array(x)));
  for (int32_t i = 0; i < m->n; i++) stf_array(out)[i] = by * m->products->gradient[first + i];
  return 0;
}

static int transposed_E(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out,
                        void *user)
{
  stf_model *m = user;
  return transposed(m, t, y, yp, x, m->n, 1, out);
}

static int transposed_A(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out,
                        void *user)
{
  return transposed(user, t, y, yp, x, 0, -1, out);
}

void stf_operators(const stf_model *m, steif_problem *p)
{
  p->Av = times_A, p->Atv = transposed_A;
  if (m->form == STEIF_ODE) return;
  p->Ev = times_E, p->Etv = transposed_E;
}
