/* test_ends.c: runs of sparse systems of index 3 meet their tolerance where they end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <steif/runs.h>
#include "impulse/systems.h"

typedef struct ending {
  double before, *x; /* time of the last step but one; the last value */
  double t;
} ending;

static int on_step(sunrealtype t, N_Vector x, void *user)
{
  ending *e = user;
  e->before = e->t, e->t = t;
  memcpy(e->x, N_VGetArrayPointer(x), (size_t)N_VGetLength(x) * sizeof *e->x);
  return 0;
}

static double apart(size_t from, size_t to, const double *a, const double *b)
{
  double most = 0;
  for (size_t i = from; i < to; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* 200 masses under 20 constraints: positions of index 1, velocities of 2, multipliers of 3. Methods
 * that leave errors of h^2 and tol / h^2 in the multipliers agree on them at the end. */
static void multipliers_are_right_at_the_end(void)
{
  enum { MASSES = 200, N = 420 };
  static const char *const methods[] = {"radau:s=5", "radau:s=3", "bdf"};
  static double x[3][N], start[N];
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_linear l;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "springs:n=200,c=20", &p) && p.n == N);
  CU_ASSERT_FATAL(!steif_linear_of(ctx, &p, &l));
  memcpy(start, p.y0, sizeof start);
  steif_options o = steif_defaults();
  o.t1 = 0.5, o.rtol = 1e-9, o.atol = 1e-9;
  for (int m = 0; m < 3; m++) {
    ending e = {.x = x[m]};
    const steif_linear_output out = {.step = on_step, .user = &e};
    CHECK(steif_linear_run(ctx, &l, start, 0, methods[m], &o, NULL, 0, NULL, &out) == STEIF_OK);
    CHECK(e.t == 0.5 && e.before < 0.5 && e.before > 0);
    const double slow = apart(0, MASSES, x[m], x[0]), all = apart(0, N, x[m], x[0]);
    if (m) CHECK(slow < 2e-8 && all < 1e-7);
  }
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* f = (0, 0, g, 0), g = t^4 before t = 1/2 and 3 - t^3 from there on, in N x' + x = f with N of order 3
 * beside x_4' + 2 x_4 = 0. */
static int broken(sunrealtype t, int q, N_Vector f, void *user)
{
  static const double fourth[] = {1, 4, 12, 24}, third[] = {-1, -3, -6, -6};
  (void)user;
  N_VConst(0, f);
  if (q > 3) return 1;
  N_VGetArrayPointer(f)[2] =
    t < 0.5 ? fourth[q] * pow(t, 4 - q) : (q ? 0 : 3) + third[q] * pow(t, 3 - q);
  return 0;
}

/* x = (g'', -g', g, e^{-2 t}), left limits at the break. */
static void exact_solutions_through_a_break(void)
{
  static const double t[] = {0.2, 0.5, 0.6, 1.25}, breaks[] = {0.5}, x0[4] = {9, 8, 7, 1};
  static const double wanted[4][3] = {{12 * 0.04, -4 * 0.008, 0.0016},
                                      {12 * 0.25, -4 * 0.125, 0.0625},
                                      {-6 * 0.6, 3 * 0.36, 3 - 0.216},
                                      {-6 * 1.25, 3 * 1.5625, 3 - 1.953125}};
  double x[16], made[16] = {0};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = SUNDenseMatrix(4, 4, steif_sundials(ctx)), F = SUNMatClone(E);
  SUNMatZero(E), SUNMatZero(F);
  for (int i = 0; i < 4; i++) SM_ELEMENT_D(F, i, i) = i < 3 ? 1 : 2;
  SM_ELEMENT_D(E, 0, 1) = SM_ELEMENT_D(E, 1, 2) = SM_ELEMENT_D(E, 3, 3) = 1;
  const steif_linear l = {E, F, broken, NULL};
  steif_linear_truth truth;
  CHECK(steif_linear_exact(ctx, &l, x0, 0, NULL, 1, breaks, 4, t, made, x, &truth) == STEIF_OK);
  for (int k = 0; k < 4; k++) {
    for (int i = 0; i < 3; i++) CLOSE_FLOOR(x[4 * k + i], wanted[k][i], 1e-11, 1);
    CLOSE(x[4 * k + 3], exp(-2 * t[k]), 1e-11);
  }
  CHECK(truth.accuracy < 1e-11);
  CLOSE(truth.most, 1, 1e-12);
  CLOSE(truth.end, 1, 1e-12); /* of zeros */
  CHECK(steif_linear_exact(ctx, &l, x0, 0.2, NULL, 1, breaks, 4, t, NULL, x, &truth) ==
        STEIF_BAD_INPUT);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_ends[] = {
  {"multipliers are right at the end", multipliers_are_right_at_the_end},
  {"exact solutions through a break", exact_solutions_through_a_break},
  CU_TEST_INFO_NULL};
