/* After: the program of cvode_before.c with steif. The callbacks are the same, to the letter.
 *
 * Vector, matrix, linear solver and their settings are gone; "cvode" still calls CVODE itself, and any other
 * method is a word away. Known are the values of the Test Set for IVP Solvers at t = 1e11.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = -0.04 * c[0] + 1e4 * c[1] * c[2];
  NV_Ith_S(ydot, 2) = 3e7 * c[1] * c[1];
  NV_Ith_S(ydot, 1) = -NV_Ith_S(ydot, 0) - NV_Ith_S(ydot, 2);
  return 0;
}

static int jacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                    N_Vector b, N_Vector d)
{
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)d;
  SM_ELEMENT_D(J, 0, 0) = -0.04;
  SM_ELEMENT_D(J, 0, 1) = 1e4 * c[2];
  SM_ELEMENT_D(J, 0, 2) = 1e4 * c[1];
  SM_ELEMENT_D(J, 1, 0) = 0.04;
  SM_ELEMENT_D(J, 1, 1) = -1e4 * c[2] - 6e7 * c[1];
  SM_ELEMENT_D(J, 1, 2) = -1e4 * c[1];
  SM_ELEMENT_D(J, 2, 1) = 6e7 * c[1];
  return 0;
}

int main(void)
{
  static const double start[] = {1, 0, 0};
  static const char *const methods[] = {"cvode", "radau:s=3", "auto"};
  const steif_problem p = {
    .name = "robertson", .n = 3, .t1 = 1e11, .y0 = start, .f = f, .jac = jacobian};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-8, opt.atol = 1e-20;
  steif_context *ctx = steif_context_new(NULL);
  int wrong = 0;
  for (int i = 0; i < 3; i++) {
    steif_solver *s = steif_solver_new(ctx, &p, methods[i], &opt);
    const int code = steif_solve_to(s, p.t1);
    const double y1 = code ? NAN : NV_Ith_S(steif_solution(s), 0);
    printf("%-9s  %s, %ld steps, y1 = %.6e, known 2.083340e-08\n", methods[i],
           steif_message(ctx), steif_statistics(s)->steps, y1);
    wrong += !(fabs(y1 / 2.083340149701e-8 - 1) < 1e-4);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
  return wrong;
}
