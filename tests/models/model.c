/* model.c: a small DAE as a problem, with exact E and A by complex steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models/models.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

const model *model_find(const char *name)
{
  const model *const all[] = {models, troubles};
  for (int k = 0; k < 2; k++)
    for (const model *m = all[k]; m->name; m++)
      if (!strcmp(m->name, name)) return m;
  return NULL;
}

static void widen(N_Vector v, sunindextype n, cplx *x)
{
  for (sunindextype i = 0; i < n; i++) x[i] = NV_Ith_S(v, i);
}

static int residual(sunrealtype t, N_Vector yy, N_Vector yyp, N_Vector rr, void *user)
{
  const model *m = user;
  cplx y[MODEL_LARGEST], yp[MODEL_LARGEST], r[MODEL_LARGEST];
  widen(yy, m->n, y), widen(yyp, m->n, yp);
  m->F(t, y, yp, r);
  for (sunindextype i = 0; i < m->n; i++) NV_Ith_S(rr, i) = creal(r[i]);
  return 0;
}

static int fill(int which, sunrealtype t, N_Vector yy, N_Vector yyp, SUNMatrix M,
                const model *m)
{
  const double h = 1e-30;
  cplx y[MODEL_LARGEST], yp[MODEL_LARGEST], r[MODEL_LARGEST];
  widen(yy, m->n, y), widen(yyp, m->n, yp);
  for (sunindextype j = 0; j < m->n; j++) {
    cplx *x = which == 'E' ? yp + j : y + j;
    *x += h * I;
    m->F(t, y, yp, r);
    *x = creal(*x);
    for (sunindextype i = 0; i < m->n; i++)
      SM_ELEMENT_D(M, i, j) = (which == 'E' ? 1 : -1) * cimag(r[i]) / h;
  }
  return 0;
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return fill('E', t, y, yp, M, user);
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return fill('A', t, y, yp, M, user);
}

steif_problem model_problem(const model *m, int jacobian)
{
  return (steif_problem){.name = m->name,
                         .n = m->n,
                         .t0 = m->t0,
                         .t1 = m->t0 + 1,
                         .y0 = m->y0,
                         .yp0 = m->yp0,
                         .F = residual,
                         .E = jacobian ? fill_E : NULL,
                         .A = jacobian ? fill_A : NULL,
                         .user = (void *)m};
}

steif_point model_inquiry(const model *m)
{
  return (steif_point){.t = m->t0,
                       .equation = m->equation[0] ? m->equation : NULL,
                       .unknown = m->unknown[0] ? m->unknown : NULL,
                       .size = m->size[0] > 0 ? m->size : NULL};
}
