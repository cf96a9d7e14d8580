/* E and F of different storage: runs and starts are those of two dense matrices, bit for bit.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/systems.h"
#include <steif/runs.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { N = 5 };

typedef struct told {
  int jumps, steps;
  double after[N], impulse[2 * N], x[N];
} told;

static int on_jump(sunrealtype t, const sunrealtype *before, const steif_impulse *i, void *user)
{
  told *s = user;
  (void)t, (void)before;
  CU_ASSERT_FATAL(i->n == N && i->count == 2 && i->certified);
  s->jumps++;
  memcpy(s->after, i->x_plus, sizeof s->after);
  memcpy(s->impulse, i->c, sizeof s->impulse);
  return 0;
}

static int on_step(sunrealtype t, N_Vector x, void *user)
{
  told *s = user;
  (void)t;
  s->steps++;
  memcpy(s->x, N_VGetArrayPointer(x), sizeof s->x);
  return 0;
}

/* From x(0-), which jumps with impulses, to t = 1; which: 1 E sparse, 2 F sparse. */
static told run(const char *method, int which)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_linear l;
  told s = {0};
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "ut5", &p) && !steif_linear_of(ctx, &p, &l));
  SUNMatrix full[] = {l.E, l.F};
  if (which & 1) l.E = SUNSparseFromDenseMatrix(full[0], 0, CSC_MAT);
  if (which & 2) l.F = SUNSparseFromDenseMatrix(full[1], 0, CSC_MAT);
  steif_options o = steif_defaults();
  o.t1 = 1, o.rtol = 1e-8;
  const steif_linear_output out = {on_jump, on_step, &s};
  const int code = steif_linear_run(ctx, &l, p.y0, 0, method, &o, NULL, 0, NULL, &out);
  CHECK(!code);
  if (code) printf("\n  %s, %d: %s", method, which, steif_message(ctx));
  for (int k = 0; k < 2; k++) SUNMatDestroy(full[k]);
  if (which & 1) SUNMatDestroy(l.E);
  if (which & 2) SUNMatDestroy(l.F);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return s;
}

static void one_of_two_may_be_sparse(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "dirk:hw43"};
  for (int m = 0; m < 3; m++) {
    const told dense = run(methods[m], 0);
    CHECK(dense.jumps == 1 && dense.steps > 5);
    for (int which = 1; which < 3; which++) {
      const told mixed = run(methods[m], which);
      CHECK(mixed.jumps == dense.jumps && mixed.steps == dense.steps);
      CHECK(!memcmp(mixed.after, dense.after, sizeof dense.after));
      CHECK(!memcmp(mixed.impulse, dense.impulse, sizeof dense.impulse));
      CHECK(!memcmp(mixed.x, dense.x, sizeof dense.x));
    }
  }
}

static void sizes_that_differ_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  const double x[] = {1, 2, 3};
  steif_problem p;
  steif_linear l = {.E = SUNSparseMatrix(3, 3, 3, CSC_MAT, sun),
                    .F = SUNDenseMatrix(2, 2, sun)};
  CHECK(steif_linear_problem(ctx, &l, x, 0, 1, &p) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(ctx), "E has 3 rows, F has 2"));
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_storage[] = {
  {"one of E and F may be sparse", one_of_two_may_be_sparse},
  {"sizes that differ are refused", sizes_that_differ_are_refused},
  CU_TEST_INFO_NULL,
};
