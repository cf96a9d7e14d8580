/* test_semilinear.c: the declared linear parts, and fronts that any method must meet.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* Where y = 0 the Jacobian is L and the slope of N: `rest` times the identity. */
static void linear_parts(void)
{
  static const struct {
    const char *spec;
    double rest;
  } cases[] = {{"parabolic:n=7", 0},
               {"parabolic:n=7,storage=sparse", 0},
               {"parabolic:n=1,storage=dense", 0},
               {"allencahn:n=9", 1},
               {"allencahn:n=9,storage=sparse", 1},
               {"bruss2d:n=3", 0}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    fixture s;
    if (fixture_open(&s, cases[k].spec)) continue;
    SUNMatrix L = fixture_matrix(&s, s.p.nnz), J = fixture_matrix(&s, s.p.nnz);
    double largest = 0;
    N_VConst(0, s.y);
    CHECK(s.p.L(0.31, s.y, s.yp, L, s.p.user) == 0);
    CHECK(s.p.jac(0.31, s.y, s.r, J, s.p.user, s.r, s.r, s.r) == 0);
    for (sunindextype i = 0; i < s.p.n; i++)
      for (sunindextype j = 0; j < s.p.n; j++) {
        const double l = fixture_element(L, i, j);
        CLOSE_FLOOR(fixture_element(J, i, j) - l, i == j ? cases[k].rest : 0, 1e-15, 1);
        largest = fmax(largest, fabs(l));
      }
    CHECK(largest > 0.1);
    /* It is a constant: other arguments change nothing. */
    N_VConst(0.83, s.y);
    CHECK(s.p.L(1.7, s.y, s.yp, J, s.p.user) == 0);
    for (sunindextype i = 0; i < s.p.n; i++)
      for (sunindextype j = 0; j < s.p.n; j++)
        CHECK(fixture_element(J, i, j) == fixture_element(L, i, j));
    SUNMatDestroy(L), SUNMatDestroy(J);
    fixture_close(&s);
  }
}

/* Odd in x, so is the solution; N_i = u_i - u_i^3 but for the ends. */
static void fronts_are_odd(void)
{
  fixture s;
  if (fixture_open(&s, "allencahn:n=39")) return;
  for (int i = 0; i < 39; i++) {
    NV_Ith_S(s.y, i) = s.p.y0[i];
    CLOSE_FLOOR(s.p.y0[i], -s.p.y0[38 - i], 1e-15, 1);
  }
  CHECK(s.p.f(0, s.y, s.r, s.p.user) == 0);
  for (int i = 0; i < 39; i++) CLOSE_FLOOR(NV_Ith_S(s.r, i), -NV_Ith_S(s.r, 38 - i), 1e-13, 1);
  const double u = s.p.y0[12];
  CLOSE(NV_Ith_S(s.r, 12), 4 * (s.p.y0[11] - 2 * u + s.p.y0[13]) + u - u * u * u, 1e-12);
  fixture_close(&s);
}

CU_TestInfo tests_of_semilinear[] = {
  {"linear parts are what the Jacobian is at 0", linear_parts},
  {"the front of Allen and Cahn is odd", fronts_are_odd},
  CU_TEST_INFO_NULL};
