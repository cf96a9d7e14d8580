/* made_flow.c: linear flows in blocks of order 1 and 2, bent by a change of variables.
 *
 *   y_i = x_i + c_i x_{i+1}^2,  y_n = x_n,  so that x follows from y from the last component on, and
 *   y'_i = x'_i + 2 c_i x_{i+1} x'_{i+1}.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "made.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

/* First of a block of order 2? */
static bool turns(const made *m, int i) { return i + 1 < m->n && m->A[i][i + 1] != 0; }

static void solution(const made *m, sunrealtype t, sunrealtype *x)
{
  for (int i = 0; i < m->n; i++) {
    const sunrealtype size = exp(m->A[i][i] * t);
    x[i] = size * m->start[i];
    if (!turns(m, i)) continue;
    const sunrealtype c = cos(m->A[i][i + 1] * t), s = sin(m->A[i][i + 1] * t);
    const sunrealtype u = m->start[i], v = m->start[i + 1];
    x[i] = size * (c * u + s * v);
    x[++i] = size * (c * v - s * u);
  }
}

static void slopes(const made *m, const sunrealtype *x, sunrealtype *w)
{
  for (int i = 0; i < m->n; i++) {
    w[i] = m->A[i][i] * x[i];
    if (i > 0) w[i] += m->A[i][i - 1] * x[i - 1];
    if (i + 1 < m->n) w[i] += m->A[i][i + 1] * x[i + 1];
  }
}

/* out = derivative of the change of variables at x times w. */
static void push(const made *m, const sunrealtype *x, const sunrealtype *w, sunrealtype *out)
{
  for (int i = 0; i < m->n; i++)
    out[i] = w[i] + (i + 1 < m->n ? 2 * m->c[i] * x[i + 1] * w[i + 1] : 0);
}

static void straighten(const made *m, const sunrealtype *y, sunrealtype *x)
{
  for (int i = m->n; i-- > 0;) x[i] = y[i] - (i + 1 < m->n ? m->c[i] * x[i + 1] * x[i + 1] : 0);
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const made *m = user;
  sunrealtype x[MADE_MOST], w[MADE_MOST];
  solution(m, t, x);
  slopes(m, x, w);
  for (int i = 0; i < m->n; i++)
    NV_Ith_S(y, i) = x[i] + (i + 1 < m->n ? m->c[i] * x[i + 1] * x[i + 1] : 0);
  if (yp) push(m, x, w, NV_DATA_S(yp));
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const made *m = user;
  sunrealtype x[MADE_MOST], w[MADE_MOST];
  (void)t;
  straighten(m, NV_DATA_S(y), x);
  slopes(m, x, w);
  push(m, x, w, NV_DATA_S(out));
  return 0;
}

/* d (P(x) A x) / dx times dx/dy, where dy/dx is unit upper bidiagonal. */
static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const made *m = user;
  const int n = m->n;
  sunrealtype x[MADE_MOST], w[MADE_MOST];
  (void)t, (void)fy, (void)a, (void)b, (void)c;
  straighten(m, NV_DATA_S(y), x);
  slopes(m, x, w);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      SM_ELEMENT_D(J, i, j) = m->A[i][j];
      if (i + 1 == n) continue;
      SM_ELEMENT_D(J, i, j) +=
        2 * m->c[i] * (x[i + 1] * m->A[i + 1][j] + (j == i + 1 ? w[i + 1] : 0));
    }
  for (int j = 1; j < n; j++)
    for (int i = 0; i < n; i++)
      SM_ELEMENT_D(J, i, j) -= SM_ELEMENT_D(J, i, j - 1) * 2 * m->c[j - 1] * x[j];
  return 0;
}

void made_flow(made *m, stf_random *r)
{
  const sunrealtype decades = stf_random_in(r, 0, 6);
  for (int i = 0; i < m->n; i++) {
    m->A[i][i] = -pow(10, stf_random_in(r, -1.5, i ? decades : 0));
    m->start[i] = stf_random_in(r, 0.3, 1.5);
    m->c[i] = m->kind == MADE_BENT ? stf_random_in(r, -0.5, 0.5) : 0;
    if (i + 1 == m->n || stf_random_in(r, 0, 1) < 0.5) continue;
    const sunrealtype turn = pow(10, stf_random_in(r, -0.5, 0.8));
    m->A[i][i + 1] = turn;
    m->A[i + 1][i] = -turn;
    m->A[i + 1][i + 1] = m->A[i][i] = fmax(m->A[i][i], -0.3 * turn);
    m->start[i + 1] = stf_random_in(r, 0.3, 1.5);
    m->c[i + 1] = m->kind == MADE_BENT ? stf_random_in(r, -0.5, 0.5) : 0;
    i++;
  }
  m->differential = m->n;
  m->problem.f = f;
  m->problem.jac = jac;
  m->problem.start = m->problem.exact = exact;
  m->problem.linear = m->kind == MADE_FLOW;
}
