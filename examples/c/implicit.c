/* Equations as they stand, F(t, y, y') = 0: a pendulum in Cartesian coordinates, index 3.
 *
 *   0 = x' - u,  0 = y' - v,  0 = m u' + T x,  0 = m v' + T y + m g,  0 = x^2 + y^2 - l^2
 *
 * T l is the force in the rod. The constraint does not hold T, nor does its first derivative: that is what
 * index 3 means. steif finds the index by itself, and computes T(0) whatever is given. Names
 * make its sentences readable.
 * The values at t = 2 are from the equation of the angle, by mpmath in 30 digits.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

static int pendulum(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const double m = 1, g = 9.81, l = 1;
  const sunrealtype *z = N_VGetArrayPointer(y), *d = N_VGetArrayPointer(yp);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = d[0] - z[2];
  NV_Ith_S(r, 1) = d[1] - z[3];
  NV_Ith_S(r, 2) = m * d[2] + z[4] * z[0];
  NV_Ith_S(r, 3) = m * d[3] + z[4] * z[1] + m * g;
  NV_Ith_S(r, 4) = z[0] * z[0] + z[1] * z[1] - l * l;
  return 0;
}

int main(void)
{
  static const char *const unknown[] = {"x", "y", "u", "v", "T"};
  static const char *const equation[] = {"velocity x", "velocity y", "force x", "force y",
                                         "rod"};
  static const steif_names names = {equation, unknown};
  static const double start[] = {1, 0, 0, 0, 5}; /* T = 5 is wrong: it is computed */
  static const double known[] = {0.793566195343322, -0.608483930443792, 2.10243787443613,
                                 2.74193539301051, 17.9076820729608};
  const steif_problem p = {
    .name = "pendulum", .n = 5, .t1 = 2, .y0 = start, .F = pendulum, .names = &names};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-9, opt.atol = 1e-9;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &opt);
  int wrong = steif_solve_to(s, p.t1) != STEIF_OK;
  if (!wrong) {
    printf("method: %s\n%s\n", steif_method_used(s), steif_initial_used(s)->message);
    for (int i = 0; i < 5; i++) {
      const double z = NV_Ith_S(steif_solution(s), i);
      printf("%s(2) = %.9f, known %.9f\n", unknown[i], z, known[i]);
      wrong += !(fabs(z - known[i]) < 1e-6 * fabs(known[i]));
    }
  }
  puts(steif_message(ctx));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return wrong;
}
