/* Jacobians by differences against analytic ones, the number of evaluations they take, and the
 * probe for entries missing from a pattern.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "fixture.h"
#include <steif/solver.h>

/* f_i = a u_{i-1} - b u_i^2 + c u_{i+1} + d u_i sin t: tridiagonal. */
enum { N = 23 };
static const double a = 1.37, b = 0.61, c = -2.13, d = 0.29;
static int calls;
static double start[N];

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double *far = user;
  const double *u = NV_DATA_S(y);
  calls++;
  for (int i = 0; i < N; i++) {
    NV_Ith_S(out, i) = -b * u[i] * u[i] + d * u[i] * sin(t);
    if (i > 0) NV_Ith_S(out, i) += a * u[i - 1];
    if (i < N - 1) NV_Ith_S(out, i) += c * u[i + 1];
  }
  if (far) NV_Ith_S(out, 17) += *far * u[4]; /* an entry that no tridiagonal pattern has */
  return 0;
}

/* E y' - f, E = diag(1 + u_i / 10). */
static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const int code = f(t, y, r, user);
  for (int i = 0; i < N; i++)
    NV_Ith_S(r, i) = (1 + NV_Ith_S(y, i) / 10) * NV_Ith_S(yp, i) - NV_Ith_S(r, i);
  return code;
}

static double exact(int i, int j, double t)
{
  if (i == j) return -2 * b * start[i] + d * sin(t);
  return j == i - 1 ? a : j == i + 1 ? c : 0;
}

static sunindextype column[N + 1], row[3 * N];
static const steif_pattern pattern = {column, row};

static steif_problem chain(void)
{
  sunindextype k = 0;
  for (int j = 0; j < N; j++) {
    start[j] = 0.31 + sin(1.7 * j);
    column[j] = k;
    for (int i = j - 1; i <= j + 1; i++)
      if (i >= 0 && i < N) row[k++] = i;
  }
  column[N] = k;
  return (steif_problem){.name = "chain",
                         .n = N,
                         .t0 = 0.4,
                         .t1 = 1,
                         .y0 = start,
                         .f = f,
                         .lower = 1,
                         .upper = 1,
                         .pattern = &pattern};
}

static void differences_meet_the_jacobian(void)
{
  static const enum steif_storage kinds[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE};
  static const int evaluations[] = {N + 1, 4,
                                    4}; /* a tridiagonal pattern falls into 3 groups */
  const steif_problem p = chain();
  for (int k = 0; k < 3; k++) {
    fixture s;
    CU_ASSERT_FATAL(!fixture_open(&s, &p, kinds[k]));
    calls = 0;
    CHECK(!stf_differ(&s.system, 'A', 0.4, s.y, s.yp, s.system.A));
    CHECK(calls == evaluations[k]);
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++)
        CLOSE_FLOOR(fixture_element(s.system.A, i, j), exact(i, j, 0.4), 3e-7, 1);
    fixture_close(&s);
  }
}

static void differences_of_an_implicit_form(void)
{
  static const enum steif_storage kinds[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE};
  steif_problem p = chain();
  double slope[N];
  for (int i = 0; i < N; i++) slope[i] = cos(0.9 * i);
  p.f = NULL, p.F = F, p.yp0 = slope, p.nnz = 2; /* the room of .nnz is less than the pattern */
  for (int k = 0; k < 3; k++) {
    fixture s;
    CU_ASSERT_FATAL(!fixture_open(&s, &p, kinds[k]));
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) {
        const double E = i == j ? 1 + start[i] / 10 : 0,
                     A = exact(i, j, 0.4) - (i == j ? slope[i] / 10 : 0);
        CLOSE_FLOOR(fixture_element(s.system.E, i, j), E, 3e-7, 1);
        CLOSE_FLOOR(fixture_element(s.system.A, i, j), A, 3e-7, 1);
      }
    fixture_close(&s);
  }
}

/* A u + g(t), far from 0: differences from 0 are as exact as the columns. */
static int affine(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  const double *u = NV_DATA_S(y);
  for (int i = 0; i < N; i++) {
    NV_Ith_S(out, i) = 0.3 * sin(t) - b * u[i];
    if (i > 0) NV_Ith_S(out, i) += a * u[i - 1];
    if (i < N - 1) NV_Ith_S(out, i) += c * u[i + 1];
  }
  return 0;
}

static int affine_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const int code = affine(t, y, r, user);
  for (int i = 0; i < N; i++) NV_Ith_S(r, i) = 1.7 * NV_Ith_S(yp, i) - NV_Ith_S(r, i);
  return code;
}

static void differences_of_linear_systems_are_exact(void)
{
  static const enum steif_storage kinds[] = {STEIF_DENSE, STEIF_BAND, STEIF_SPARSE};
  for (int k = 0; k < 6; k++) {
    steif_problem p = chain();
    fixture s;
    p.f = k < 3 ? affine : NULL, p.F = k < 3 ? NULL : affine_residual;
    p.linear = 1;
    for (int i = 0; i < N; i++) start[i] *= 1e4;
    CU_ASSERT_FATAL(!fixture_open(&s, &p, kinds[k % 3]));
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) {
        const double A = i == j ? -b : i == j + 1 ? a : j == i + 1 ? c : 0;
        CLOSE_FLOOR(fixture_element(s.system.A, i, j), A, 4e-16, 1);
        if (k >= 3) CLOSE_FLOOR(fixture_element(s.system.E, i, j), i == j ? 1.7 : 0, 4e-16, 1);
      }
    fixture_close(&s);
  }
}

/* An arrow (first row and column, diagonal) needs n groups, its diagonal without them one. */
static sunindextype arrow_column[N + 1], arrow_row[3 * N];

static void groups_are_as_few_as_the_pattern_allows(void)
{
  steif_problem p = chain();
  const steif_pattern diagonal = {arrow_column, arrow_row};
  p.pattern = &diagonal;
  for (int j = 0; j <= N; j++) arrow_column[j] = j;
  for (int j = 0; j < N; j++) arrow_row[j] = j;
  fixture s; /* the probe finds what the diagonal leaves out: three groups serve the chain */
  CHECK(fixture_open(&s, &p, STEIF_SPARSE) == STEIF_OK);
  calls = 0;
  CHECK(!stf_differ(&s.system, 'A', 0.4, s.y, s.yp, s.system.A));
  CHECK(calls == 4);
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      CLOSE_FLOOR(fixture_element(s.system.A, i, j), exact(i, j, 0.4), 3e-7, 1);
  fixture_close(&s);
  sunindextype k = 0;
  for (int j = 0; j < N; j++) {
    arrow_column[j] = k;
    if (j) arrow_row[k++] = 0;
    arrow_row[k++] = j;
    for (int i = 1; j == 0 && i < N; i++) arrow_row[k++] = i;
  }
  arrow_column[N] = k;
  CHECK(fixture_open(&s, &p, STEIF_SPARSE) == STEIF_OK);
  calls = 0;
  CHECK(!stf_differ(&s.system, 'A', 0.4, s.y, s.yp, s.system.A));
  CHECK(calls == N + 1);
  fixture_close(&s);
}

/* A large band: the width exceeds n. */
static void bands_may_be_full(void)
{
  steif_problem p = chain();
  p.lower = p.upper = N - 1;
  fixture s;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_BAND));
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      CLOSE_FLOOR(fixture_element(s.system.A, i, j), exact(i, j, 0.4), 3e-7, 1);
  fixture_close(&s);
}

/* One entry far from the others: it joins the pattern of f, or those of F, and a band cannot have it. */
static void the_probe_adds_what_is_missing(void)
{
  double far = 0.37;
  fixture s;
  steif_problem p = chain();
  p.user = &far;
  fixture_refused(&p, STEIF_BAND, STEIF_BAD_INPUT,
                  "band of problem 'chain' misses the derivative of e18 with respect to y5");
  fixture_refused(&p, STEIF_BAND, STEIF_BAD_INPUT, "found about 0.37 there; widen it");
  for (int implicit = 0; implicit < 2; implicit++) {
    if (implicit) p.f = NULL, p.F = F;
    CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_SPARSE));
    CHECK(SM_INDEXPTRS_S(s.system.A)[N] == column[N] + 1);
    CLOSE(fixture_element(s.system.A, 17, 4), 0.37, 1e-6);
    CHECK(p.pattern == &pattern && column[N] == pattern.column[N]); /* the user's stays */
    fixture_close(&s);
  }
  far = 0;
  CHECK(!fixture_open(&s, &p, STEIF_SPARSE));
  CHECK(SM_INDEXPTRS_S(s.system.A)[N] == column[N]);
  fixture_close(&s);
}

static void memory_may_end_while_the_pattern_grows(void)
{
  double far = 0.37;
  steif_problem p = chain();
  p.user = &far, p.f = NULL, p.F = F, p.storage = STEIF_SPARSE;
  for (long k = 1, more = 1; more; k++) {
    failing x = {.refuse_at = k};
    const steif_setup setup = failing_setup(&x);
    steif_context *short_of = steif_context_new(&setup);
    steif_solver *s = short_of ? steif_solver_new(short_of, &p, "radau:s=3", NULL) : NULL;
    more = x.served >= k;
    CHECK((s != NULL) == !more);
    if (short_of && !s) CHECK(steif_status(short_of) == STEIF_NO_MEMORY);
    steif_solver_free(&s);
    steif_context_free(&short_of);
    CHECK(x.alive == 0);
  }
}

static int analytic(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector x,
                    N_Vector z, N_Vector w)
{
  (void)y, (void)fy, (void)user, (void)x, (void)z, (void)w;
  for (int j = 0; j <= N; j++) SM_INDEXPTRS_S(J)[j] = column[j];
  for (int j = 0; j < N; j++)
    for (sunindextype k = column[j]; k < column[j + 1]; k++)
      SM_INDEXVALS_S(J)[k] = row[k], SM_DATA_S(J)[k] = exact((int)row[k], j, t);
  return 0;
}

static void patterns_are_checked(void)
{
  steif_problem p = chain();
  steif_pattern none = {NULL, row};
  p.pattern = &none;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "no Jacobian callback: give its .pattern");
  p.pattern = NULL, p.nnz = 3 * N;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "no Jacobian callback: give its .pattern");
  p.pattern = &pattern, row[6] = N;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "row indices of column 3 must ascend");
  p.jac = analytic; /* a pattern that nothing needs is looked at too: its size is used */
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "row indices of column 3 must ascend");
  p = chain(), p.nnz = 3 * N, row[6] = row[5];
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "row indices of column 3 must ascend");
  p = chain(), column[5] = 2;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "they fall at column 5");
  p = chain(), column[0] = 1;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "must rise from 0");
  p = chain(), p.jac = analytic;
  fixture s;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_SPARSE)); /* room as the pattern says */
  CLOSE(fixture_element(s.system.A, 9, 8), a, 1e-16);
  fixture_close(&s);
}

/* Components of size 1e-9 and 0 among those of size 1e5: increments follow atol / rtol = 1. */
static int uneven(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), w = NV_Ith_S(y, 2);
  NV_Ith_S(out, 0) = 3 * v - 1e-5 * u, NV_Ith_S(out, 1) = v * w, NV_Ith_S(out, 2) = w * w - v;
  return 0;
}

static void increments_follow_the_scale(void)
{
  static const double y0[] = {1.7e5, 3e-9, 0},
                      J[3][3] = {{-1e-5, 3, 0}, {0, 0, 3e-9}, {0, -1, 0}};
  const steif_problem p = {.name = "uneven", .n = 3, .t1 = 1, .y0 = y0, .f = uneven};
  fixture s;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      CLOSE_FLOOR(fixture_element(s.system.A, i, j), J[i][j], 2e-7, 1);
  fixture_close(&s);
}

CU_TestInfo tests_of_differ[] = {
  {"differences of linear systems are exact", differences_of_linear_systems_are_exact},
  {"differences meet the Jacobian in few evaluations", differences_meet_the_jacobian},
  {"differences of an implicit form", differences_of_an_implicit_form},
  {"groups are as few as the pattern allows", groups_are_as_few_as_the_pattern_allows},
  {"bands may be full", bands_may_be_full},
  {"the probe adds what is missing", the_probe_adds_what_is_missing},
  {"memory may end while the pattern grows", memory_may_end_while_the_pattern_grows},
  {"patterns are checked", patterns_are_checked},
  {"increments follow the scale", increments_follow_the_scale},
  CU_TEST_INFO_NULL};
