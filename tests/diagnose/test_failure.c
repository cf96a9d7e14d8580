/* test_failure.c: failed runs of the solver, and what is said of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <string.h>

/* y1' = y1^2, y2' = -y2: y1 = 1/(1 - t). */
static int burst(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  NV_Ith_S(r, 1) = -NV_Ith_S(y, 1);
  return 0;
}
static const sunrealtype ones[] = {1, 1};
static const steif_problem blow_up = {.name = "burst", .n = 2, .t1 = 2, .y0 = ones, .f = burst};

/* y2 has to be the square root of 0.5 - t. */
static int root(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 1);
  NV_Ith_S(r, 1) = NV_Ith_S(y, 1) * NV_Ith_S(y, 1) - (0.5 - t);
  return 0;
}
static int first_only(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}
static const sunrealtype at_root[] = {1, 0.70710678118654752};
static const steif_problem turns = {
  .name = "turns", .n = 2, .t1 = 1, .y0 = at_root, .f = root, .E = first_only, .dae_index = 1};

static void find(const steif_problem *p, const char *method, double rtol, steif_failure *f)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = rtol;
  memset(f, 0, sizeof *f);
  const int code = steif_failure_find(ctx, p, method, &o, f);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(!code && f->code < 0);
  steif_context_free(&ctx);
}

static void a_blow_up_is_told_with_its_time(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=5", "rodas4", "auto"};
  for (int m = 0; m < 4; m++) {
    steif_failure f;
    find(&blow_up, methods[m], 1e-5, &f);
    CHECK(f.cause.kind == STEIF_CAUSE_BLOW_UP);
    CLOSE(f.cause.t, 1, 5e-3);
    CHECK(f.t < 1.01 && f.h > 0 && f.order > 0 && f.steps > 5);
    CHECK(f.count == 2 && f.worst[0].component == 0);
    CHECK(strstr(f.message, "worst y1") && strstr(f.message, "blows up"));
  }
}

static void an_impasse_is_told_with_its_time(void)
{
  steif_failure f;
  find(&turns, "radau:s=3", 1e-5, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_IMPASSE);
  CLOSE(f.cause.t, 0.5, 5e-3);
}

static void an_inconsistent_start_is_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_failure f;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "switchrlc", &p));
  find(&p, "radau:s=3", 1e-8, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_START && f.steps == 0);
  CHECK(strstr(f.message, "equation switch") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Impulses of ut5, regular and of index 3, drive y to 1e16 in many short steps: what fails is still the
 * start. */
static void impulses_of_the_start_are_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_failure f;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "ut5", &p));
  find(&p, "radau:s=5", 1e-6, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_START && f.steps > 1);
  CHECK(strstr(f.message, "method descriptor") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void good_runs_have_no_failure(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_failure f;
  steif_options o = steif_defaults();
  o.t1 = 0.5;
  CHECK(steif_failure_find(ctx, &blow_up, "radau:s=3", &o, &f) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "does not fail") != NULL);
  CHECK(steif_failure_find(ctx, &blow_up, "rado", &o, &f) == STEIF_UNKNOWN_NAME);
  CHECK(steif_failure_find(ctx, NULL, "auto", &o, &f) == STEIF_BAD_INPUT);
  CHECK(steif_failure_find(ctx, &blow_up, "auto", &o, NULL) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void memory_may_fail_at_any_request(void)
{
  long refused = 0;
  for (long k = 1;; k += 7) {
    failing x = {.refuse_at = k};
    const steif_setup setup = failing_setup(&x);
    steif_context *ctx = steif_context_new(&setup);
    steif_failure f;
    const int code =
      ctx ? steif_failure_find(ctx, &blow_up, "radau:s=3", NULL, &f) : STEIF_NO_MEMORY;
    steif_context_free(&ctx);
    CHECK(x.alive == 0);
    if (x.served < k) {
      CHECK(!code);
      break;
    }
    CHECK(code == STEIF_NO_MEMORY);
    refused++;
  }
  CHECK(refused > 10);
}

CU_TestInfo tests_of_failure[] = {
  {"a blow-up is told with its time", a_blow_up_is_told_with_its_time},
  {"an impasse is told with its time", an_impasse_is_told_with_its_time},
  {"an inconsistent start is told", an_inconsistent_start_is_told},
  {"impulses of the start are told", impulses_of_the_start_are_told},
  {"good runs have no failure", good_runs_have_no_failure},
  {"memory may fail at any request", memory_may_fail_at_any_request},
  CU_TEST_INFO_NULL};
