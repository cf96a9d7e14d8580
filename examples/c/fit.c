/* Parameters from measurements: the reactions A -> B -> C, of which B was measured at nine times.
 *
 *   A' = -k1 A,   B' = k1 A - k2 B,   A(0) = 1, B(0) = 0.
 *
 * The measurements were made of B = k1/(k2 - k1) (e^-k1t - e^-k2t) (H. Bateman, 1910) with k1 = 0.9, k2 = 0.25 and
 * errors of standard deviation 0.005. With df/dk given, every run of the fit carries the derivatives of the
 * solution; without it, differences are taken.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/fit.h>
#include <steif/steif.h>

enum { TIMES = 9 };

static int reaction(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *k = user, *c = N_VGetArrayPointer(y);
  (void)t;
  NV_Ith_S(ydot, 0) = -k[0] * c[0];
  NV_Ith_S(ydot, 1) = k[0] * c[0] - k[1] * c[1];
  return 0;
}

/* Derivatives of the residual y' - f. */
static int by_k(sunrealtype t, N_Vector y, N_Vector yp, int i, N_Vector out, void *user)
{
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = i == 0 ? c[0] : 0;
  NV_Ith_S(out, 1) = i == 0 ? -c[0] : c[1];
  return 0;
}

int main(void)
{
  static const double start[] = {1, 0}, truth[] = {0.9, 0.25};
  static const double error[TIMES] = {3, -7, 1, 6, -2, -5, 4, 2, -3}; /* in thousandths */
  double k[] = {0.3, 0.1}, t[TIMES], value[TIMES], sd[TIMES];
  sunindextype component[TIMES];
  for (int j = 0; j < TIMES; j++) {
    t[j] = j + 1, component[j] = 1, sd[j] = 0.005;
    value[j] =
      truth[0] / (truth[1] - truth[0]) * (exp(-truth[0] * t[j]) - exp(-truth[1] * t[j]));
    value[j] += 1e-3 * error[j];
  }
  steif_parameters parameters = {.count = 2, .value = k, .dFdp = by_k};
  steif_problem p = {.name = "chain",
                     .n = 2,
                     .t1 = TIMES,
                     .y0 = start,
                     .f = reaction,
                     .user = k,
                     .parameters = &parameters};
  const steif_measurements data = {
    .count = TIMES, .t = t, .value = value, .sd = sd, .component = component};
  steif_context *ctx = steif_context_new(NULL);
  steif_fit fit;
  int wrong = 0;
  if (steif_fit_find(ctx, &p, "radau:s=3", &data, NULL, &fit) != STEIF_OK) {
    puts(steif_message(ctx));
    return 1;
  }
  for (int i = 0; i < 2; i++) {
    printf("k%d = %.4f +- %.4f, between %.4f and %.4f; known %.2f\n", i + 1, fit.p[i],
           fit.sd[i], fit.low[i], fit.high[i], truth[i]);
    wrong += !(fit.low[i] < truth[i] && truth[i] < fit.high[i]);
  }
  puts(fit.message);
  steif_fit_free(ctx, &fit);
  steif_context_free(&ctx);
  return wrong;
}
