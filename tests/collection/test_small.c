/* test_small.c: Jacobians, storages and right-hand sides of the small and sized problems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <stdlib.h>

/* A point near the start with no symmetry. */
static void shake(const steif_problem *p, N_Vector y, double size)
{
  for (sunindextype i = 0; i < p->n; i++)
    NV_Ith_S(y, i) = p->y0[i] + size * sin(1.7 * (double)i + 0.3);
}

/* Column j of dF/dy + c dF/dy' by central differences of the residual, into s->w. */
static void column(fixture *s, double t, double c, sunindextype j, double h)
{
  const double y = NV_Ith_S(s->y, j), yp = NV_Ith_S(s->yp, j);
  N_Vector sum = N_VClone(s->r);
  N_VConst(0, sum);
  for (int sign = -1; sign <= 1; sign += 2) {
    NV_Ith_S(s->y, j) = y + sign * h, NV_Ith_S(s->yp, j) = yp + sign * c * h;
    CHECK(fixture_residual(s, t) == 0);
    N_VLinearSum(1, sum, sign / (2 * h), s->r, sum);
  }
  NV_Ith_S(s->y, j) = y, NV_Ith_S(s->yp, j) = yp;
  N_VScale(1, sum, s->w);
  N_VDestroy(sum);
}

static void jacobian_agrees(const char *spec, double t)
{
  const double c = 2.9;
  fixture s;
  if (fixture_open(&s, spec)) return;
  shake(&s.p, s.y, 0.21);
  SUNMatrix J = fixture_matrix(&s, s.p.nnz);
  const int code = s.p.idajac ? s.p.idajac(t, c, s.y, s.yp, s.r, J, s.p.user, s.r, s.r, s.r)
                              : s.p.jac(t, s.y, s.r, J, s.p.user, s.r, s.r, s.r);
  CHECK(code == 0);
  for (sunindextype j = 0; j < s.p.n; j++) {
    column(&s, t, c, j, 1e-5);
    const double scale = 1 + N_VMaxNorm(s.w);
    for (sunindextype i = 0; i < s.p.n; i++) {
      const double declared = fixture_element(J, i, j);
      const double expected = s.p.idajac ? declared : (i == j ? c : 0) - declared;
      CLOSE_FLOOR(NV_Ith_S(s.w, i) / scale, expected / scale, 1e-8, 1);
    }
  }
  SUNMatDestroy(J);
  fixture_close(&s);
}

static void jacobians_agree_with_differences(void)
{
  static const char *const specs[] = {"stiffpair",
                                      "forced:k=7,c=0.3",
                                      "harmonic",
                                      "pendulum",
                                      "pendulum3",
                                      "pendulum3:index=2",
                                      "pendulum3:index=1",
                                      "pendulum3:index=ggl",
                                      "kepler",
                                      "lorenz",
                                      "lorenz96",
                                      "lorenz96:n=4,F=5",
                                      "lorenz96:n=4,storage=sparse",
                                      "lorenz96:n=7,storage=sparse",
                                      "roessler",
                                      "heat:n=6",
                                      "heat:n=6,storage=dense",
                                      "heat:n=6,storage=sparse",
                                      "heat:n=1",
                                      "bruss2d:n=3",
                                      "bruss2d:n=4",
                                      "parabolic:n=6",
                                      "parabolic:n=6,storage=dense",
                                      "parabolic:n=6,storage=sparse",
                                      "allencahn:n=6",
                                      "allencahn:n=1,storage=sparse",
                                      "prothero:lambda=-37",
                                      "dahlquist:re=-3,im=5"};
  for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) jacobian_agrees(specs[i], 1.3);
}

/* Taylor series: x_{m+1}, y_{m+1}, z_{m+1} from Cauchy products. */
static void taylor(double *v, double h)
{
  enum { ORDER = 24 };
  double x[ORDER + 1] = {v[0]}, y[ORDER + 1] = {v[1]}, z[ORDER + 1] = {v[2]};
  for (int m = 0; m < ORDER; m++) {
    double xy = 0, xz = 0;
    for (int i = 0; i <= m; i++) xy += x[i] * y[m - i], xz += x[i] * z[m - i];
    x[m + 1] = 10 * (y[m] - x[m]) / (m + 1);
    y[m + 1] = (28 * x[m] - y[m] - xz) / (m + 1);
    z[m + 1] = (xy - 8 * z[m] / 3) / (m + 1);
  }
  v[0] = v[1] = v[2] = 0;
  for (int m = ORDER; m >= 0; m--)
    v[0] = v[0] * h + x[m], v[1] = v[1] * h + y[m], v[2] = v[2] * h + z[m];
}

static void lorenz_meets_a_taylor_series(void)
{
  fixture s;
  if (fixture_open(&s, "lorenz")) return;
  double v[] = {s.p.y0[0], s.p.y0[1], s.p.y0[2]};
  for (int i = 0; i < 1000; i++) taylor(v, 0.01);
  for (int i = 0; i < 3; i++) /* rounding grows by e^9 */
    CLOSE(s.p.reference->value[i], v[i], 1e-10);
  fixture_close(&s);
}

static void the_pendulum_reference_is_the_closed_solution(void)
{
  fixture s;
  if (fixture_open(&s, "pendulum")) return;
  CHECK(s.p.exact(s.p.reference->t, s.y, NULL, s.p.user) == 0);
  for (int i = 0; i < 2; i++) CLOSE(s.p.reference->value[i], NV_Ith_S(s.y, i), 3e-14);
  fixture_close(&s);
}

static void pendulum_start_is_consistent_in_every_form(void)
{
  static const char *const specs[] = {"pendulum3", "pendulum3:index=1", "pendulum3:index=2",
                                      "pendulum3:index=ggl"};
  static const int dimension[] = {5, 5, 5, 6}, index[] = {3, 1, 2, 2}, last[] = {3, 0, 2, 2};
  for (int k = 0; k < 4; k++) {
    fixture s;
    if (fixture_open(&s, specs[k])) return;
    CU_ASSERT_EQUAL(s.p.n, dimension[k]);
    CU_ASSERT_EQUAL(s.p.dae_index, index[k]);
    CU_ASSERT_EQUAL(s.p.index ? s.p.index[s.p.n - 1] : 0, last[k]);
    for (sunindextype i = 0; i < s.p.n; i++)
      NV_Ith_S(s.y, i) = s.p.y0[i], NV_Ith_S(s.yp, i) = s.p.yp0[i];
    CHECK(fixture_residual(&s, 0) == 0);
    CLOSE_FLOOR(N_VMaxNorm(s.r), 0, 4e-15, 1);
    fixture_close(&s);
  }
}

/* E and A of IDA's matrix J(c) = dF/dy + c dF/dy': affine in c, singular dF/dy'. */
static void ida_matrix_is_affine_in_c(void)
{
  fixture s;
  if (fixture_open(&s, "pendulum3")) return;
  shake(&s.p, s.y, 0.13);
  SUNMatrix J[3];
  const double c[] = {0, 1.7, -4.3};
  for (int k = 0; k < 3; k++) {
    J[k] = fixture_matrix(&s, 0);
    CHECK(s.p.idajac(0, c[k], s.y, s.yp, s.r, J[k], s.p.user, s.r, s.r, s.r) == 0);
  }
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) {
      const double lead = (SM_ELEMENT_D(J[1], i, j) - SM_ELEMENT_D(J[0], i, j)) / c[1];
      CLOSE_FLOOR(lead, i == j && i < 4, 1e-15, 1);
      CLOSE_FLOOR(SM_ELEMENT_D(J[2], i, j), SM_ELEMENT_D(J[0], i, j) + c[2] * lead, 1e-14, 1);
    }
  for (int k = 0; k < 3; k++) SUNMatDestroy(J[k]);
  fixture_close(&s);
}

static void heat_is_its_jacobian_times_u_in_every_storage(void)
{
  static const char *const specs[] = {"heat:n=13", "heat:n=13,storage=dense",
                                      "heat:n=13,storage=sparse"};
  for (int k = 0; k < 3; k++) {
    fixture s;
    if (fixture_open(&s, specs[k])) return;
    shake(&s.p, s.y, 0.7);
    SUNMatrix J = fixture_matrix(&s, s.p.nnz);
    CHECK(s.p.jac(0, s.y, s.r, J, s.p.user, s.r, s.r, s.r) == 0);
    CHECK(s.p.f(0, s.y, s.r, s.p.user) == 0);
    for (sunindextype i = 0; i < 13; i++) {
      double sum = 0;
      for (sunindextype j = 0; j < 13; j++) sum += fixture_element(J, i, j) * NV_Ith_S(s.y, j);
      CLOSE_FLOOR(sum, NV_Ith_S(s.r, i), 1e-12, 1);
    }
    SUNMatDestroy(J);
    fixture_close(&s);
  }
}

/* u = 1, v = 3.4 is the equilibrium of the reaction; on it only the source is left. */
static void brusselator_rests_but_for_its_source(void)
{
  fixture s;
  if (fixture_open(&s, "bruss2d:n=10")) return;
  CU_ASSERT_EQUAL(s.p.n, 200);
  CLOSE(s.p.breaks[0], 1.1, 0);
  for (int i = 0; i < 200; i++) NV_Ith_S(s.y, i) = i < 100 ? 1 : 3.4;
  CHECK(s.p.f(1.0999, s.y, s.r, s.p.user) == 0);
  CLOSE_FLOOR(N_VMaxNorm(s.r), 0, 1e-14, 1);
  CHECK(s.p.f(1.1, s.y, s.r, s.p.user) == 0);
  for (int j = 0; j < 10; j++)
    for (int i = 0; i < 10; i++) { /* centre (3, 6), its four neighbours on the rim */
      const int lit = abs(i - 3) + abs(j - 6) <= 1;
      CLOSE_FLOOR(NV_Ith_S(s.r, 10 * j + i), 5 * lit, 1e-14, 1);
      CLOSE_FLOOR(NV_Ith_S(s.r, 100 + 10 * j + i), 0, 1e-14, 1);
    }
  fixture_close(&s);
}

/* cos 2 pi (2x - y) on the periodic grid: an eigenvector of the five-point sum. */
static void brusselator_diffuses_waves(void)
{
  const double two_pi = 6.283185307179586;
  fixture s;
  if (fixture_open(&s, "bruss2d:n=9")) return;
  for (int c = 0; c < 81; c++) { /* v = 0: the reaction of u is 1 - 4.4 u, of v 3.4 u */
    NV_Ith_S(s.y, c) = cos(two_pi * (2 * (c % 9) - c / 9) / 9);
    NV_Ith_S(s.y, 81 + c) = 0;
  }
  CHECK(s.p.f(0.5, s.y, s.r, s.p.user) == 0);
  const double s1 = sin(two_pi / 18), s2 = sin(two_pi / 9);
  const double eigenvalue = -0.1 * 81 * 4 * (s1 * s1 + s2 * s2);
  for (int c = 0; c < 81; c++) {
    const double u = NV_Ith_S(s.y, c);
    CLOSE_FLOOR(NV_Ith_S(s.r, c), 1 + (eigenvalue - 4.4) * u, 1e-13, 1);
    CLOSE_FLOOR(NV_Ith_S(s.r, 81 + c), 3.4 * u, 1e-14, 1);
  }
  /* u(x, 3/9) = 22 y (1-y)^1.5, v(4/9, y) = 27 x (1-x)^1.5 */
  CLOSE(s.p.y0[3 * 9 + 7], 22.0 / 3 * pow(2.0 / 3, 1.5), 1e-15);
  CLOSE(s.p.y0[81 + 6 * 9 + 4], 12 * pow(5.0 / 9, 1.5), 1e-15);
  fixture_close(&s);
}

/* One step of the classical Runge-Kutta method, its times cut off at `until`. */
static void classical(fixture *s, double t, double h, double until)
{
  static const double node[] = {0, 0.5, 0.5, 1}, weight[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  N_VScale(1, s->y, s->yp);
  for (int k = 0; k < 4; k++) {
    N_VLinearSum(1, s->y, node[k] * h, s->r, s->w);
    CHECK(s->p.f(fmin(t + node[k] * h, until), s->w, s->r, s->p.user) == 0);
    N_VLinearSum(1, s->yp, weight[k] * h, s->r, s->yp);
  }
  N_VScale(1, s->yp, s->y);
}

static void brusselator_reference_meets_an_explicit_method(void)
{
  fixture s;
  double scd, mescd;
  if (fixture_open(&s, "bruss2d:n=16")) return;
  for (int i = 0; i < 512; i++) NV_Ith_S(s.y, i) = s.p.y0[i];
  for (int k = 0; k < 550; k++) classical(&s, k * 0.002, 0.002, 1.0999999);
  for (int k = 0; k < 5200; k++) classical(&s, fmax(1.1, 1.1 + k * 0.002), 0.002, 11.5);
  CHECK(steif_problem_digits(s.ctx, &s.p, 11.5, s.y, 1, &scd, &mescd) == STEIF_OK);
  if (scd < 8) printf("\n  %.2f digits", scd);
  CHECK(scd > 8);
  fixture_close(&s);
}

static void references_are_known_for_three_grids(void)
{
  static const char *const specs[] = {"bruss2d:n=16", "bruss2d:n=32", "bruss2d:n=64"};
  double far = INFINITY;
  steif_problem p[3];
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) {
    CHECK(steif_problem_find(ctx, specs[i], &p[i]) == STEIF_OK);
    CHECK(p[i].reference && p[i].reference->count == 16);
    /* v at x = 3/16, y = 1/16 */
    const int N = 16 << i, apart = 1 << i;
    CU_ASSERT_EQUAL(p[i].reference->component[9], N * N + apart * N + 3 * apart);
  }
  for (int i = 0; i < 2; i++) { /* second differences: finer grids differ less */
    double most = 0;
    for (int k = 0; k < 16; k++)
      most = fmax(most, fabs(p[i + 1].reference->value[k] - p[i].reference->value[k]));
    CHECK(most < far);
    far = 0.6 * most;
  }
  for (int i = 0; i < 3; i++) steif_problem_clear(ctx, &p[i]);
  CHECK(steif_problem_find(ctx, "bruss2d:n=17", &p[0]) == STEIF_OK && !p[0].reference);
  steif_problem_clear(ctx, &p[0]);
  steif_context_free(&ctx);
}

static void the_declared_pattern_is_that_of_the_jacobian(void)
{
  fixture s;
  if (fixture_open(&s, "bruss2d:n=5")) return;
  SUNMatrix J = fixture_matrix(&s, s.p.nnz);
  shake(&s.p, s.y, 0.4);
  CHECK(s.p.jac(0, s.y, s.r, J, s.p.user, s.r, s.r, s.r) == 0);
  CU_ASSERT_EQUAL(s.p.nnz, 300);
  for (int j = 0; j <= 50; j++) {
    CU_ASSERT_EQUAL(s.p.pattern->column[j], 6 * j);
    CU_ASSERT_EQUAL(SM_INDEXPTRS_S(J)[j], 6 * j);
  }
  for (int k = 0; k < 300; k++) CU_ASSERT_EQUAL(SM_INDEXVALS_S(J)[k], s.p.pattern->row[k]);
  SUNMatDestroy(J);
  J = fixture_matrix(&s, 299);
  CHECK(s.p.jac(0, s.y, s.r, J, s.p.user, s.r, s.r, s.r) < 0);
  SUNMatDestroy(J);
  fixture_close(&s);
}

CU_TestInfo tests_of_small[] = {
  {"Jacobians agree with differences", jacobians_agree_with_differences},
  {"Lorenz' reference meets a Taylor series", lorenz_meets_a_taylor_series},
  {"the pendulum's reference is its closed solution",
   the_pendulum_reference_is_the_closed_solution},
  {"the pendulum's start is consistent in every form",
   pendulum_start_is_consistent_in_every_form},
  {"IDA's matrix is affine in c", ida_matrix_is_affine_in_c},
  {"heat is its Jacobian times u in every storage",
   heat_is_its_jacobian_times_u_in_every_storage},
  {"the Brusselator rests but for its source", brusselator_rests_but_for_its_source},
  {"the Brusselator diffuses waves", brusselator_diffuses_waves},
  {"the Brusselator's reference meets an explicit method",
   brusselator_reference_meets_an_explicit_method},
  {"the Brusselator's references are known for three grids",
   references_are_known_for_three_grids},
  {"the declared pattern is that of the Jacobian",
   the_declared_pattern_is_that_of_the_jacobian},
  CU_TEST_INFO_NULL};
