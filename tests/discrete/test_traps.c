/* test_traps.c: what is often said wrongly of the schemes, measured.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"

static const double pi = 3.14159265358979323846;

/* Eigenvalue of x' = A x, 2 x 2, with Im >= 0 under the scheme: modulus and phase. */
static void polar(const double *A, const char *scheme, double dt, double *modulus,
                  double *phase)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = {.n = 2, .A = A};
  steif_discrete d = {0};
  CHECK(steif_c2d(ctx, &s, scheme, dt, &d) == STEIF_OK);
  *modulus = hypot(d.re[0], d.im[0]);
  *phase = atan2(fabs(d.im[0]), d.re[0]);
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
}

/* zoh: phase 2 dt; bilinear: 2 atan(dt). Both are seen modulo 2 pi and up to the sign. */
static void imaginary_eigenvalues_stay_on_the_circle(void)
{
  static const double A[] = {0, -2, 2, 0}, step[] = {0.1, 1, 5};
  for (int i = 0; i < 3; i++) {
    double modulus, phase;
    polar(A, "zoh", step[i], &modulus, &phase);
    CLOSE(modulus, 1, 2e-15);
    CLOSE(phase, fabs(remainder(2 * step[i], 2 * pi)), 2e-14);
    polar(A, "bilinear", step[i], &modulus, &phase);
    CLOSE(modulus, 1, 2e-15);
    CLOSE(phase, 2 * atan(step[i]), 2e-15);
  }
}

/* (1 + z/2)/(1 - z/2) for z = -10, -100, -10000, where e^z is below 1e-4. */
static void fast_modes_ring_under_the_bilinear_rule(void)
{
  static const double z[] = {-10, -100, -1e4}, kept[] = {-4. / 6, -49. / 51, -4999. / 5001};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) {
    const steif_state_space s = {.n = 1, .A = &z[i]};
    steif_discrete tustin, hold, backward;
    CHECK(steif_c2d(ctx, &s, "bilinear", 1, &tustin) == STEIF_OK);
    CHECK(steif_c2d(ctx, &s, "zoh", 1, &hold) == STEIF_OK);
    CHECK(steif_c2d(ctx, &s, "backward", 1, &backward) == STEIF_OK);
    CLOSE(tustin.form.A[0], kept[i], 1e-15);
    CLOSE_FLOOR(hold.form.A[0], exp(z[i]), 4e-16, 1e-300);
    CLOSE(backward.form.A[0], 1 / (1 - z[i]), 1e-15);
    steif_discrete_clear(ctx, &tustin);
    steif_discrete_clear(ctx, &hold);
    steif_discrete_clear(ctx, &backward);
  }
  steif_context_free(&ctx);
}

static void bilinear_keeps_the_half_plane_forward_does_not(void)
{
  double A[4], modulus, phase;
  oscillator(4, A);
  static const double step[] = {0.01, 0.1, 0.5, 1, 40};
  for (int i = 0; i < 5; i++) {
    polar(A, "bilinear", step[i], &modulus, &phase);
    CHECK(modulus < 1);
    polar(A, "averaged", step[i], &modulus, &phase);
    CLOSE(modulus, exp(-step[i] / 4), 1e-14);
  }
  polar(A, "forward", 0.1249, &modulus, &phase); /* the limit is -2 Re l/|l|^2 = 1/8 */
  CHECK(modulus < 1);
  polar(A, "forward", 0.1251, &modulus, &phase);
  CHECK(modulus > 1);
}

/* Beyond Im l dt = pi the logarithm finds another system: frequency |Im l - 2 pi/dt|. */
static void slow_sampling_aliases(void)
{
  static const double expected[] = {-0.39580347, 2.33285553, -0.58321388, -0.10419653};
  double A[4], back[4], input[2];
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(4, A);
  steif_discrete d;
  CHECK(steif_c2d(ctx, &s, "zoh", 2, &d) == STEIF_OK);
  CLOSE(d.alias, 2 / 1.583213882, 1e-9);
  CHECK(steif_d2c(ctx, 2, 1, d.form.A, d.form.B, 2, back, input) == STEIF_OK);
  for (int i = 0; i < 4; i++) CLOSE(back[i], expected[i], 1e-7);
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
}

/* The state of foh is h - B1 u; in h it is the recurrence of exp-trapezoidal. */
static void foh_is_the_exponential_trapezoidal_rule(void)
{
  double A[4], x[2] = {0.3, -1.7}, h[2];
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(4, A);
  steif_discrete foh, trap;
  CHECK(steif_c2d(ctx, &s, "foh", 0.27, &foh) == STEIF_OK);
  CHECK(steif_c2d(ctx, &s, "exp-trapezoidal", 0.27, &trap) == STEIF_OK);
  double u = 1;
  for (int i = 0; i < 2; i++) h[i] = x[i] + foh.B1[i] * u;
  for (int k = 0; k < 30; k++) {
    const double next = sin(1.7 * (k + 1)) + 0.4, *F = foh.form.A, *G = trap.form.A;
    const double x0 = F[0] * x[0] + F[2] * x[1] + foh.form.B[0] * u;
    x[1] = F[1] * x[0] + F[3] * x[1] + foh.form.B[1] * u, x[0] = x0;
    const double h0 = G[0] * h[0] + G[2] * h[1] + trap.form.B[0] * u + trap.B1[0] * (next - u);
    h[1] = G[1] * h[0] + G[3] * h[1] + trap.form.B[1] * u + trap.B1[1] * (next - u), h[0] = h0;
    u = next;
    CLOSE_FLOOR(foh.form.C[0] * x[0] + foh.form.C[1] * x[1] + foh.form.D[0] * u, h[0], 1e-14,
                1);
  }
  steif_discrete_clear(ctx, &foh);
  steif_discrete_clear(ctx, &trap);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_traps[] = {
  {"imaginary eigenvalues stay on the circle", imaginary_eigenvalues_stay_on_the_circle},
  {"fast modes ring under the bilinear rule", fast_modes_ring_under_the_bilinear_rule},
  {"bilinear keeps the half plane, forward does not",
   bilinear_keeps_the_half_plane_forward_does_not},
  {"slow sampling aliases", slow_sampling_aliases},
  {"foh is the exponential trapezoidal rule", foh_is_the_exponential_trapezoidal_rule},
  CU_TEST_INFO_NULL};
