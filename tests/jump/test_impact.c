/* test_impact.c: an impact of a nonlinear system by the pencil frozen where it happens.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/systems.h"
#include <steif/consistent.h>
#include <steif/impulse.h>

/* f = user, of the same length. */
static int constant(sunrealtype t, int derivative, N_Vector out, void *user)
{
  const double *f = user;
  (void)t;
  for (sunindextype i = 0; i < N_VGetLength(out); i++) NV_Ith_S(out, i) = derivative ? 0 : f[i];
  return 0;
}

/* A pendulum at 0.6 below the horizontal is hit to v- = (1, 0.5), which its rod does not allow. With E and
 * F frozen there, lambda is Lambda delta and v+ = v- - Lambda q, Lambda = q . v-; what is elastic by e
 * takes 1 + e times as much. The smooth multiplier is that of a consistent point. */
static void a_hit_pendulum_keeps_what_its_rod_allows(void)
{
  const double q[] = {cos(0.6), -sin(0.6)}, v[] = {1, 0.5}, gravity = 9.81, e = 0.5;
  const double lambda = 6.0291426640052969, hit = 0.54301437821216062;
  const double x0[] = {q[0], q[1], v[0], v[1], lambda};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = SUNDenseMatrix(5, 5, steif_sundials(ctx)), F = SUNMatClone(E);
  SUNMatZero(E), SUNMatZero(F);
  for (int i = 0; i < 4; i++) SM_ELEMENT_D(E, i, i) = 1;
  for (int i = 0; i < 2; i++) { /* q' = v, v' = -lambda q - g, q . (q - q-) = 0 */
    SM_ELEMENT_D(F, i, i + 2) = -1;
    SM_ELEMENT_D(F, i + 2, i) = lambda, SM_ELEMENT_D(F, i + 2, 4) = q[i];
    SM_ELEMENT_D(F, 4, i) = q[i];
  }
  double f[] = {0, 0, lambda * q[0], lambda * q[1] - gravity, 1};
  steif_impulse i;
  CHECK(!steif_impulse_find(ctx, E, F, x0, 0, constant, f, NULL, NULL, &i));
  const double plus[] = {.5518308942534698, .80660898160278157};
  double after[2], energy[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    CLOSE(i.x_plus[k], q[k], 1e-12);
    CLOSE(i.x_plus[k + 2], plus[k], 1e-12);
    after[k] = v[k] + (1 + e) * (i.x_plus[k + 2] - v[k]);
    CLOSE(after[k], v[k] - 1.5 * hit * q[k], 1e-12);
    energy[0] += v[k] * v[k] / 2, energy[1] += after[k] * after[k] / 2;
  }
  CLOSE(i.c[4], hit, 1e-12);
  CLOSE(energy[0] - energy[1], .375 * hit * hit, 1e-12);
  steif_problem p;
  steif_start start;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
  const steif_point at = {.y = i.x_plus};
  CHECK(!steif_consistent(ctx, &p, &at, NULL, &start));
  for (int k = 0; k < 2; k++) CLOSE(start.y[k + 2], plus[k], 1e-12);
  CLOSE(start.y[4], 6.4942780490601574, 1e-12);
  steif_start_clear(&start);
  steif_problem_clear(ctx, &p);
  steif_impulse_clear(ctx, &i);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_impact[] = {
  {"a hit pendulum keeps what its rod allows", a_hit_pendulum_keeps_what_its_rod_allows},
  CU_TEST_INFO_NULL};
