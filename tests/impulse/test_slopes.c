/* test_slopes.c: derivatives of x(0+) and of impulses: closed forms, sums over the Laurent coefficients in
 * rational numbers (figures by fractions), differences of the jump itself, and directions without a derivative.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_case.h"

/* Certified, there, and these numbers: n of x(0+), then those of the impulses. To `loss` of the largest, or
 * of `least`. */
static void expect(bench *b, const double *wanted, double loss, double least)
{
  const steif_impulse_slope *s = &b->slope;
  double most = least;
  CHECK(find(b) == STEIF_OK);
  CHECK(s->exists == 1 && s->certified && strstr(s->message, "the derivative exists"));
  const int rows = 1 + s->count;
  for (int i = 0; i < rows * s->n; i++) most = fmax(most, fabs(wanted[i]));
  for (int i = 0; i < s->n; i++) CLOSE_FLOOR(s->x_plus[i], wanted[i], loss, most);
  for (int i = 0; i < s->count * s->n; i++) CLOSE_FLOOR(s->c[i], wanted[s->n + i], loss, most);
  clear(b);
}

/* ---- closed forms ------------------------------------------------------------------------------ */

/* x(0-) = (5, 1, 0, 0, 0): v = (C1 5 + C2)/(C1 + C2), i = (C2 i_L + C1 v/R2)/(C1 + C2),
 * c_0 = C1 C2 4/(C1 + C2); unknowns v1, v2, i_L, e, i. */
static void closed_switch(void)
{
  bench b;
  set_up(&b, "switchrlc");
  SM_ELEMENT_D(b.dE, 0, 0) = 1;
  expect(&b, (double[]){480000, 480000, 0, 0, 2520, 0, 0, 0, 0, 1.44}, 1e-12, 0);
  SM_ELEMENT_D(b.dE, 1, 1) = 1;
  expect(&b, (double[]){-320000, -320000, 0, 0, -1680, 0, 0, 0, 0, 0.64}, 1e-12, 0);
  SM_ELEMENT_D(b.dE, 2, 2) = 1;
  expect(&b, (double[10]){0}, 1e-12, 5 / 1e-3);
  SM_ELEMENT_D(b.dF, 3, 2) = 1;
  expect(&b, (double[10]){0}, 1e-12, 5 / 10.0);
  SM_ELEMENT_D(b.dF, 1, 1) = -1 / (200. * 200); /* by R2 */
  expect(&b, (double[]){0, 0, 0, 0, -2.6e-5, 0, 0, 0, 0, 0}, 1e-12, 0);
  tear_down(&b);
}

static int one_in_3(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)t, (void)user;
  N_VConst(0, g);
  if (derivative == 0) N_VGetArrayPointer(g)[3] = 1;
  return 0;
}

static void of_start_and_forcing(void)
{
  static const sunrealtype gap[] = {0, 1, 0, 0, 0};
  bench b;
  set_up(&b, "switchrlc");
  b.along.f = one_in_3; /* by the voltage of the battery */
  CHECK(find(&b) == STEIF_OK && b.slope.exists == 1 && b.slope.certified);
  for (int i = 0; i < 5; i++) CLOSE_FLOOR(b.slope.x_plus[i], i == 3, 1e-13, 1);
  tear_down(&b);
  set_up(&b, "impact");
  b.along.x0 = gap; /* c_1 = m1 m2/(m1 + m2) gap and so on, lib/data/collection */
  CHECK(find(&b) == STEIF_OK && b.slope.exists == 1 && b.slope.certified);
  CLOSE(b.slope.x_plus[0], 0.7 / 2.2, 1e-13);
  CLOSE(b.slope.x_plus[2], -0.0867768595041322, 1e-12);
  CLOSE(b.slope.c[4], 0.0607438016528926, 1e-12);
  CLOSE(b.slope.c[5 + 4], 1.5 * 0.7 / 2.2, 1e-13);
  tear_down(&b);
}

static int weight(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)t;
  N_VConst(0, g);
  if (derivative == 0) N_VGetArrayPointer(g)[*(const int *)user] = 9.81;
  return 0;
}

/* v(0+) = m1 3/(m1 + m2), c_0(lambda) = -3 m1 m2/(m1 + m2) where the gap is 0; the weight m G, too. */
static void masses(void)
{
  static const double by[] = {0.433884297520661, -0.929752066115702}, /* of v(0+) */
    c0[] = {-0.303719008264463, -1.39462809917355};
  bench b;
  set_up(&b, "impact");
  for (int i = 0; i < 2; i++) {
    int row = 2 + i;
    SM_ELEMENT_D(b.dE, row, row) = 1;
    b.along.f = weight, b.along.user = &row;
    CHECK(find(&b) == STEIF_OK && b.slope.exists == 1 && b.slope.certified);
    CLOSE(b.slope.x_plus[2], by[i], 1e-12);
    CLOSE(b.slope.x_plus[3], by[i], 1e-12);
    CLOSE(b.slope.c[4], c0[i], 1e-12);
    clear(&b);
  }
  tear_down(&b);
}

/* q N x' + x = f, f_m = cos(t + m), x(0-) = (1, 2, 3), at q = 1. */
static void a_jordan_block(void)
{
  bench b;
  set_up(&b, "jordan:k=3,case=N-inc");
  SUNMatCopy(b.system.E, b.dE);
  expect(&b,
         (double[]){2.889282420026573, 0.1411200080598672, 0, 2.1339068204274, 3.9899924966004,
                    0, -7.9799849932009, 0, 0},
         1e-12, 0);
  tear_down(&b);
}

/* ---- a system of five ---------------------------------------------------------------------------- */

static void product(SUNMatrix A, SUNMatrix B, SUNMatrix out)
{
  SUNMatZero(out);
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++)
      for (int k = 0; k < 5; k++)
        SM_ELEMENT_D(out, i, j) += SM_ELEMENT_D(A, i, k) * SM_ELEMENT_D(B, k, j);
}

/* V, so that E = U diag(I, N) V: z1 = x1 + x3, z2 = x2 + x3 + x5, w1 = x3 + x4, w2 = x4, w3 = x5. */
static const double V[5][5] = {
  {1, 0, 1, 0, 0}, {0, 1, 1, 0, 1}, {0, 0, 1, 1, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}};
static const double back[5][5] = {
  {1, 0, -1, 1, 0}, {0, 1, -1, 1, -1}, {0, 0, 1, -1, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}};

/* Figures by fractions, from sums over Phi_-5 .. Phi_2. */
static void whole_numbers(void)
{
  static const int X_entries[][3] = {{0, 1, 1}, {1, 3, 2}, {2, 0, 1}, {3, 4, -1}, {4, 2, 1}};
  bench b;
  set_up(&b, "ut5");
  SUNMatrix X = SUNDenseMatrix(5, 5, steif_sundials(b.ctx));
  for (int i = 0; i < 5; i++) /* E_p = U diag(0, N) V: N becomes beta N */
    for (int j = 0; j < 5; j++)
      for (int k = 2; k < 5; k++)
        for (int l = 0; l < 5; l++)
          SM_ELEMENT_D(b.dE, i, j) += SM_ELEMENT_D(b.system.E, i, l) * back[l][k] * V[k][j];
  expect(&b, (double[]){-20, -20, 20, 1, 0, 2, 2, -2, 5, 0, 10, 10, -10, 0, 0}, 1e-11, 0);
  SUNMatZero(X);
  for (int i = 0; i < 5; i++)
    SM_ELEMENT_D(X, X_entries[i][0], X_entries[i][1]) = X_entries[i][2];
  product(X, b.system.E, b.dE), product(X, b.system.F, b.dF);
  expect(&b, (double[]){20, 20, -20, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-11, 0);
  product(b.system.E, X, b.dE), product(b.system.F, X, b.dF);
  expect(&b, (double[]){5, 12, 8, 0, -12, 7, -2, -9, 3, 1, -2, 3, -8, 0, 5}, 1e-11, 0);
  SUNMatDestroy(X);
  tear_down(&b);
}

/* Of all entries of E and F these seven alone leave det(s E + F) at degree 2. */
static void entries_that_keep_the_structure(void)
{
  static const int keeps[][3] = {{0, 0, 4}, {1, 0, 3}, {1, 0, 4}, {1, 1, 4},
                                 {1, 2, 4}, {1, 3, 4}, {1, 4, 4}};
  bench b;
  set_up(&b, "ut5");
  for (int which = 0; which < 2; which++)
    for (int i = 0; i < 5; i++)
      for (int j = 0; j < 5; j++) {
        int wanted = 0;
        for (int k = 0; k < 7; k++)
          wanted |= keeps[k][0] == which && keeps[k][1] == i && keeps[k][2] == j;
        SM_ELEMENT_D((which ? b.dF : b.dE), i, j) = 1;
        CHECK(find(&b) == STEIF_OK && b.slope.certified && b.slope.exists == wanted);
        CHECK(wanted ||
              (isnan(b.slope.x_plus[0]) && strstr(b.slope.message, "singular perturbation")));
        clear(&b);
      }
  tear_down(&b);
}

/* ---- no derivative ---------------------------------------------------------------------------------- */

/* A resistor or an inductor in series with the closed switch: x(0+) as it tends to 0 is another one. */
static void in_series_with_the_switch(void)
{
  bench b;
  set_up(&b, "switchrlc");
  for (int k = 0; k < 2; k++) {
    SM_ELEMENT_D((k ? b.dE : b.dF), 4, 4) = -1;
    CHECK(find(&b) == STEIF_OK && b.slope.certified && b.slope.exists == 0);
    clear(&b);
  }
  tear_down(&b);
}

typedef struct curve {
  steif_context *ctx;
  int which; /* 2: a curve that keeps index and count; 3: told straight */
} curve;

/* E = e12 + p (e11 - e22), F = I; 2: with - p^2 e21. */
static int a_curve(sunrealtype p, SUNMatrix *E, SUNMatrix *F, void *user)
{
  const curve *of = user;
  SUNMatrix M = *E = SUNDenseMatrix(2, 2, steif_sundials(of->ctx)),
            N = *F = SUNDenseMatrix(2, 2, steif_sundials(of->ctx));
  SUNMatZero(M), SUNMatZero(N);
  SM_ELEMENT_D(M, 0, 1) = SM_ELEMENT_D(N, 0, 0) = SM_ELEMENT_D(N, 1, 1) = 1;
  SM_ELEMENT_D(M, 0, 0) = p, SM_ELEMENT_D(M, 1, 1) = -p;
  SM_ELEMENT_D(M, 1, 0) = of->which == 2 ? -p * p : 0;
  return STEIF_OK;
}

/* N = e12, F = I, E_p = diag(1, -1): det(s (E + p E_p) + F) = 1 - p^2 s^2. First order sees nothing; along the
 * curve the pencil is another one, and without the curve it is not known. */
static void second_order(void)
{
  static const sunrealtype x0[] = {1, 2};
  curve of = {.ctx = steif_context_new(NULL)};
  SUNMatrix E, F, dE = SUNDenseMatrix(2, 2, steif_sundials(of.ctx));
  CHECK(a_curve(0, &E, &F, &of) == STEIF_OK);
  const steif_linear l = {E, F, NULL, NULL};
  SUNMatZero(dE);
  SM_ELEMENT_D(dE, 0, 0) = 1, SM_ELEMENT_D(dE, 1, 1) = -1;
  for (; of.which < 4; of.which++) {
    static const int exists[] = {-1, 0, 1, 0};
    const steif_impulse_direction d = {
      .E = dE, .straight = of.which == 3, .nearby = of.which % 3 ? a_curve : NULL, .user = &of};
    steif_impulse_slope s;
    CHECK(steif_impulse_slope_find(of.ctx, &l, x0, 0, NULL, NULL, &d, &s) == STEIF_OK);
    CHECK(s.certified && s.exists == exists[of.which]);
    CHECK(of.which % 2 == 0 || (isnan(s.x_plus[0]) && strstr(s.message, "2 nearby")));
    /* With E = e12 + p (e11 - e22) - p^2 e21, E^2 = 0: x(0+) = 0, c_0 = E x(0-), dc_0 = (1, -2). */
    if (of.which % 2 == 0) {
      CLOSE(s.c[0], 1, 1e-13);
      CLOSE(s.c[1], -2, 1e-13);
      CLOSE_FLOOR(s.x_plus[0], 0, 1e-13, 1);
    }
    steif_impulse_slope_clear(of.ctx, &s);
  }
  SUNMatDestroy(E), SUNMatDestroy(F), SUNMatDestroy(dE);
  steif_context_free(&of.ctx);
}

/* x(0+) = x(0-) at and beside p. E = (e, d; 1, c): det(s E + F) has degree 2 but where d = e c, at e = 1/64, c = 1
 * for one, which lies 2^-6 of the largest entry away; F = 0 makes the pencil there a singular one. */
static void beside_a_singular_value(void)
{
  static const double known[][4] = {/* e, the entry below, c, that of F */
                                    {1. / 64, 1, 1, 1},
                                    {0.25, 16, 2048, 0}};
  static const sunrealtype x0[] = {1, 1};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M[3];
  for (int k = 0; k < 3; k++) M[k] = SUNDenseMatrix(2, 2, steif_sundials(ctx));
  for (int k = 0; k < 2; k++) {
    const steif_linear l = {M[0], M[1], NULL, NULL};
    const steif_impulse_direction d = {.E = M[2], .straight = 1};
    steif_impulse_slope s;
    for (int i = 0; i < 3; i++) SUNMatZero(M[i]);
    SM_ELEMENT_D(M[0], 0, 0) = known[k][0], SM_ELEMENT_D(M[0], 1, 0) = known[k][1];
    SM_ELEMENT_D(M[0], 1, 1) = known[k][2];
    SM_ELEMENT_D(M[1], 0, 0) = SM_ELEMENT_D(M[1], 1, 1) = known[k][3];
    SM_ELEMENT_D(M[2], 0, 1) = 1;
    CHECK(steif_impulse_slope_find(ctx, &l, x0, 0, NULL, NULL, &d, &s) == STEIF_OK);
    CHECK(s.exists == 1 && s.certified && s.finite == 2 && s.finite_near == 2);
    for (int i = 0; i < 2; i++) CLOSE_FLOOR(s.x_plus[i], 0, 1e-12, 1 / s.unit);
    steif_impulse_slope_clear(ctx, &s);
  }
  for (int k = 0; k < 3; k++) SUNMatDestroy(M[k]);
  steif_context_free(&ctx);
}

/* ---- sparse ------------------------------------------------------------------------------------------ */

/* By the inductance l_7 that hangs on a current source, in 1 of 3,404 equations: x(0+) and c_0 are linear in it. */
static void by_differences(void)
{
  enum { NODES = 1002, COLUMN = 3 * NODES - 1 + 2 * 7 + 1 };
  bench b;
  set_up(&b, "ladder:n=1002,storage=sparse");
  SUNMatrix E = b.system.E;
  const sunindextype at = SM_INDEXPTRS_S(E)[COLUMN];
  CHECK(SM_INDEXPTRS_S(E)[COLUMN + 1] == at + 1);
  SUNMatrix dE = SUNSparseMatrix(b.n, b.n, 1, CSC_MAT, steif_sundials(b.ctx));
  SM_INDEXVALS_S(dE)[0] = SM_INDEXVALS_S(E)[at], SM_DATA_S(dE)[0] = 1;
  for (sunindextype k = 0; k <= b.n; k++) SM_INDEXPTRS_S(dE)[k] = k > COLUMN;
  const steif_impulse_direction d = {.E = dE};
  const steif_impulse_slope *s = &b.slope;
  CHECK(!steif_impulse_slope_find(b.ctx, &b.system, b.problem.y0, 0, NULL, NULL, &d, &b.slope));
  CHECK(s->exists == 1 && s->certified && s->count == 1);
  const double p = SM_DATA_S(E)[at], step = p / 4;
  steif_impulse side[2];
  for (int k = 0; k < 2; k++) {
    SM_DATA_S(E)[at] = p + (k ? step : -step);
    CHECK(!steif_impulse_find(b.ctx, E, b.system.F, b.problem.y0, 0, b.system.f, b.system.user,
                              NULL, NULL, side + k));
  }
  double most = 0, off = 0, impulse = 0;
  for (sunindextype i = 0; i < b.n; i++) {
    most = fmax(most, fabs(s->x_plus[i]));
    impulse = fmax(impulse, fabs(s->c[i]));
    off = fmax(off, fabs((side[1].x_plus[i] - side[0].x_plus[i]) / (2 * step) - s->x_plus[i]));
    off = fmax(off, fabs((side[1].c[i] - side[0].c[i]) / (2 * step) - s->c[i]));
  }
  CHECK(most > 0 && impulse > 0 && off <= 1e-9 * fmax(most, impulse));
  for (int k = 0; k < 2; k++) steif_impulse_clear(b.ctx, side + k);
  SM_DATA_S(E)[at] = p;
  SUNMatDestroy(dE);
  tear_down(&b);
}

CU_TestInfo tests_of_slopes[] = {
  {"a circuit by its elements", closed_switch},
  {"by x(0-) and f", of_start_and_forcing},
  {"an impact by its masses", masses},
  {"a Jordan block", a_jordan_block},
  {"five unknowns in whole numbers", whole_numbers},
  {"entries that keep the structure", entries_that_keep_the_structure},
  {"no derivative in series with a switch", in_series_with_the_switch},
  {"structure lost in second order", second_order},
  {"beside a singular value", beside_a_singular_value},
  {"differences of the jump, sparse", by_differences},
  CU_TEST_INFO_NULL};
