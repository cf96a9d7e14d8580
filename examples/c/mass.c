/* A DAE with a mass matrix, M y' = f(t, y): the Chemical Akzo Nobel problem.
 *
 * Five concentrations follow differential equations; the sixth is in equilibrium with them:
 *   0 = Ks y1 y4 - y6,
 * so M = diag(1, 1, 1, 1, 1, 0) is singular and the index is 1. The start value of y6 follows from that
 * equation; here 0 is given on purpose, and steif says what it computed instead.
 * The end values are those of the Test Set for IVP Solvers (F. Mazzia, C. Magherini, 2008).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>

static int chemistry(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double k1 = 18.7, k2 = 0.58, k3 = 0.09, k4 = 0.42, K = 34.4, klA = 3.3, Ks = 115.83,
               pressure = 0.9, H = 737;
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)user;
  if (c[1] < 0) return 1; /* no root of it: the solver tries a smaller step */
  const double r1 = k1 * pow(c[0], 4) * sqrt(c[1]), r2 = k2 * c[2] * c[3],
               r3 = k2 / K * c[0] * c[4], r4 = k3 * c[0] * c[3] * c[3],
               r5 = k4 * c[5] * c[5] * sqrt(c[1]), inflow = klA * (pressure / H - c[1]);
  NV_Ith_S(r, 0) = -2 * r1 + r2 - r3 - r4;
  NV_Ith_S(r, 1) = -0.5 * r1 - r4 - 0.5 * r5 + inflow;
  NV_Ith_S(r, 2) = r1 - r2 + r3;
  NV_Ith_S(r, 3) = -r2 + r3 - 2 * r4;
  NV_Ith_S(r, 4) = r2 - r3 + r5;
  NV_Ith_S(r, 5) = Ks * c[0] * c[3] - c[5];
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < 5; i++) SM_ELEMENT_D(M, i, i) = 1;
  return 0;
}

int main(void)
{
  static const double start[] = {0.444, 0.00123, 0, 0.007, 0, 0};
  static const double known[] = {0.1150794920661702,    0.1203831471567715e-2,
                                 0.1611562887407974,    0.3656156421249283e-3,
                                 0.1708010885264404e-1, 0.4873531310307455e-2};
  const steif_problem p = {
    .name = "akzo", .n = 6, .t1 = 180, .y0 = start, .f = chemistry, .E = mass};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-9, opt.atol = 1e-12;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &opt);
  int wrong = steif_solve_to(s, p.t1) != STEIF_OK;
  if (!wrong) {
    printf("%s\nmethod: %s\n", steif_initial_used(s)->message, steif_method_used(s));
    for (int i = 0; i < 6; i++) {
      const double y = NV_Ith_S(steif_solution(s), i);
      printf("y%d(180) = %.12f, known %.12f\n", i + 1, y, known[i]);
      wrong += !(fabs(y - known[i]) < 1e-7 * known[i]);
    }
  }
  puts(steif_message(ctx));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return wrong;
}
