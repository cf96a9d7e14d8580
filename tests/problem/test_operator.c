/* Systems known by products: the pencil of the four forms for the Krylov back end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* E = diag(1, 2, 3), A = [-2 1 0; 1 -2 1; 0 1 -2] at every point (linear),
 * f = A y + (t, 0, 0). */
static int apply_E(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < 3; i++) NV_Ith_S(out, i) = (i + 1) * NV_Ith_S(x, i);
  return 0;
}

static int apply_A(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  const double *v = NV_DATA_S(x), sum = v[0] + v[2];
  NV_Ith_S(out, 0) = v[1] - 2 * v[0], NV_Ith_S(out, 2) = v[1] - 2 * v[2];
  NV_Ith_S(out, 1) = sum - 2 * v[1];
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  apply_A(t, y, y, y, out, user);
  NV_Ith_S(out, 0) += t;
  return 0;
}

/* F = E y' - A y + 0.1 y0 y1 e_2. */
static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  double Ay[3];
  apply_A(t, y, yp, y, r, user);
  for (int i = 0; i < 3; i++) Ay[i] = NV_Ith_S(r, i);
  for (int i = 0; i < 3; i++) NV_Ith_S(r, i) = (i + 1) * NV_Ith_S(yp, i) - Ay[i];
  NV_Ith_S(r, 2) += 0.1 * NV_Ith_S(y, 0) * NV_Ith_S(y, 1);
  return 0;
}

static const double start[] = {0.9, -0.4, 1.6}, slope[] = {-1.1, 0.7, 0.2};

static steif_problem bare(void)
{
  return (steif_problem){.name = "products",
                         .n = 3,
                         .t0 = 0.5,
                         .t1 = 1,
                         .y0 = start,
                         .yp0 = slope,
                         .storage = STEIF_KRYLOV};
}

/* x of (2.5 E - A) x = b for b = (1, 2, 3), multiplied back by hand. */
static void solves(fixture *s, const double *diagonal, double corner, double tolerance)
{
  N_Vector x = s->r;
  for (int i = 0; i < 3; i++) NV_Ith_S(x, i) = i + 1;
  CHECK(!steif_pencil_factor(s->system.pencil, 1, &(steif_shift){2.5, 0}));
  CHECK(!steif_pencil_solve(s->system.pencil, 0, 1, &x, NULL));
  const double *v = NV_DATA_S(x);
  CLOSE((2.5 * diagonal[0] + 2) * v[0] - v[1], 1, tolerance);
  CLOSE((2.5 * diagonal[1] + 2) * v[1] - v[0] - v[2], 2, tolerance);
  CLOSE((2.5 * diagonal[2] + 2) * v[2] - (1 - corner * start[0]) * v[1] +
          corner * start[1] * v[0],
        3, tolerance);
}

static void forms_without_matrices(void)
{
  static const double one[] = {1, 1, 1}, E[] = {1, 2, 3};
  fixture s;
  steif_problem p = bare();
  p.f = f, p.Av = apply_A;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_KRYLOV));
  solves(&s, one, 0, 1e-9);
  fixture_close(&s);
  p.Ev = apply_E;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_KRYLOV));
  solves(&s, E, 0, 1e-9);
  CHECK(!stf_system_residual(&s.system, 0.5, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 1), 2 * 0.7 - (0.9 + 0.8 + 1.6), 1e-14);
  fixture_close(&s);
  p.f = NULL; /* descriptor */
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_KRYLOV));
  solves(&s, E, 0, 1e-9);
  CHECK(!stf_system_residual(&s.system, 0.5, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 2), 3 * 0.2 - (-0.4 - 3.2), 1e-14);
  fixture_close(&s);
}

/* Without .Av one difference along the direction stands for A x. */
static void differences_along_a_direction(void)
{
  static const double one[] = {1, 1, 1}, E[] = {1, 2, 3};
  fixture s;
  steif_problem p = bare();
  p.f = f;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_KRYLOV));
  solves(&s, one, 0, 1e-6);
  fixture_close(&s);
  p.f = NULL, p.F = F, p.Ev = apply_E;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_KRYLOV));
  solves(&s, E, 0.1, 1e-6);
  N_VConst(0, s.y);
  CHECK(!steif_pencil_product(s.system.pencil, 'A', s.y, s.r));
  CHECK(N_VMaxNorm(s.r) == 0); /* along nothing there is nothing */
  fixture_close(&s);
}

CU_TestInfo tests_of_operator[] = {
  {"forms without matrices", forms_without_matrices},
  {"differences along a direction", differences_along_a_direction},
  CU_TEST_INFO_NULL};
