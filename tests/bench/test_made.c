/* test_made.c: random problems have the solution that they say, and its Jacobian.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "made.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { TIMES = 5, SEEDS = 6 };

/* Largest |M y' - f(t, y)| on the solution, relative to the terms. */
static double defect(made *m, double t, N_Vector y, N_Vector yp, N_Vector f)
{
  double most = 0;
  m->problem.exact(t, y, yp, m);
  m->problem.f(t, y, f, m);
  for (int i = 0; i < m->n; i++) {
    const double slope = i < m->differential ? NV_Ith_S(yp, i) : 0;
    most = fmax(most, fabs(slope - NV_Ith_S(f, i)) / (1 + fabs(slope)));
  }
  return most;
}

/* Largest difference of a column of the Jacobian and the central difference of f, relative to the column. */
static double off(made *m, double t, N_Vector y, N_Vector above, N_Vector below, SUNMatrix J)
{
  const double d = 1e-5;
  double most = 0;
  SUNMatZero(J);
  m->problem.jac(t, y, NULL, J, m, NULL, NULL, NULL);
  for (int j = 0; j < m->n; j++) {
    double size = 1, distance = 0;
    NV_Ith_S(y, j) += d;
    m->problem.f(t, y, above, m);
    NV_Ith_S(y, j) -= 2 * d;
    m->problem.f(t, y, below, m);
    NV_Ith_S(y, j) += d;
    for (int i = 0; i < m->n; i++) {
      const double slope = (NV_Ith_S(above, i) - NV_Ith_S(below, i)) / (2 * d);
      size = fmax(size, fabs(slope));
      distance = fmax(distance, fabs(slope - SM_ELEMENT_D(J, i, j)));
    }
    most = fmax(most, distance / size);
  }
  return most;
}

static void made_problems_have_their_solution(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int kind = 0; kind < MADE_KINDS; kind++)
    for (long seed = 1; seed <= SEEDS; seed++) {
      made m;
      made_new(&m, (enum made_kind)kind, seed);
      N_Vector v[4];
      for (int k = 0; k < 4; k++) v[k] = N_VNew_Serial(m.n, steif_sundials(ctx));
      SUNMatrix J = SUNDenseMatrix(m.n, m.n, steif_sundials(ctx));
      for (int k = 0; k < TIMES; k++) {
        const double t = m.problem.t1 * (k + 0.3) / TIMES;
        CHECK(defect(&m, t, v[0], v[1], v[2]) < 1e-12);
        m.problem.exact(t, v[0], NULL, &m);
        NV_Ith_S(v[0], 0) += 0.1; /* off the solution, where terms do not cancel */
        CHECK(off(&m, t, v[0], v[2], v[3], J) < 1e-6);
      }
      SUNMatDestroy(J);
      for (int k = 0; k < 4; k++) N_VDestroy(v[k]);
    }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_made[] = {
  {"made problems have their solution", made_problems_have_their_solution}, CU_TEST_INFO_NULL};
