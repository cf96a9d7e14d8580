/* Gradients by all parameters and start values, in one run and one sweep back: Robertson's kinetics,
 *
 *   y1' = -k1 y1 + k2 y2 y3,   y2' = k1 y1 - k2 y2 y3 - k3 y2^2,   y3' = k3 y2^2,   y(0) = (1, 0, 0).
 *
 * Asked for are two functionals at once, the integral of y3 from 0 to 40 and the amount of y1 left at 40. What they
 * cost does not depend on the number of parameters. The known values are from runs in 113-bit arithmetic.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

static double k[] = {0.04, 1e4, 3e7};

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  const double slow = k[0] * x[0], back = k[1] * x[1] * x[2], fast = k[2] * x[1] * x[1];
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = back - slow;
  NV_Ith_S(ydot, 1) = slow - back - fast;
  NV_Ith_S(ydot, 2) = fast;
  return 0;
}

/* dF/dk_i of F = y' - f, which is -df/dk_i. */
static int slope(sunrealtype t, N_Vector y, N_Vector yp, int i, N_Vector out, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  const double term = i == 0 ? x[0] : i == 1 ? x[1] * x[2] : x[1] * x[1];
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = i == 0 ? term : i == 1 ? -term : 0;
  NV_Ith_S(out, 1) = i == 0 ? -term : term;
  NV_Ith_S(out, 2) = i == 2 ? -term : 0;
  return 0;
}

/* All integrands, and all values at the end: a functional is the sum of both. */
static int integrand(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 2), g[1] = 0;
  return 0;
}

static int end(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = 0, g[1] = NV_Ith_S(y, 0);
  return 0;
}

int main(void)
{
  static const double start[] = {1, 0, 0},
                      known[] = {129.776482861602,  -3.62638337322859e-4, 6.04429342100946e-8,
                                 -4.24755877170573, 1.37308079734462e-5,  -2.28835508890567e-9};
  steif_parameters parameters = {.count = 3, .value = k, .dFdp = slope};
  const steif_problem p = {
    .name = "robertson", .n = 3, .t1 = 40, .y0 = start, .f = f, .parameters = &parameters};
  const steif_functional J = {.count = 2, .integrand = integrand, .end = end};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-9, opt.atol = 1e-15;
  steif_context *ctx = steif_context_new(NULL);
  steif_gradient g = {.memory = 60000}; /* bytes */
  if (steif_gradient_find(ctx, &p, "radau:s=3", &opt, &J, &g)) {
    puts(steif_message(ctx));
    return 1;
  }
  int wrong = 0;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 3; j++) {
      const double found = g.dp[3 * i + j], off = fabs(found / known[3 * i + j] - 1);
      printf("dJ%d/dk%d = %17.10e, known to %.1e\n", i + 1, j + 1, found, off);
      wrong += !(off < 1e-6);
    }
  printf("J1 = %.9f, dJ1/dy(0) = (%.7f, %.7f, %.7f)\n", g.value[0], g.dy0[0], g.dy0[1],
         g.dy0[2]);
  printf("%ld steps, %ld of them made again\n", g.cost.steps, g.cost.recomputed_steps);
  steif_gradient_free(ctx, &g), steif_context_free(&ctx);
  return wrong;
}
