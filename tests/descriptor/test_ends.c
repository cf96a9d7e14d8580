/* test_ends.c: runs of sparse systems of index 3 meet their tolerance where they end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "systems.h"

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

CU_TestInfo tests_of_ends[] = {
  {"multipliers are right at the end", multipliers_are_right_at_the_end}, CU_TEST_INFO_NULL};
