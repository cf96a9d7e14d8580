/* test_misuse.c: bad arguments, failing callbacks, failing memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "models/models.h"
#include "suite.h"
#include "toy.h"
#include <steif/impulse.h>
#include <string.h>

static toy run;

/* All that the room does for one problem; the first failure that is not of the problem. */
static int life(steif_context *ctx, const steif_problem *p)
{
  steif_diagnosis d;
  steif_start s;
  steif_cause cause;
  int code = steif_diagnose(ctx, p, NULL, &d);
  if (code) return code;
  steif_diagnosis_clear(&d);
  code = steif_consistent(ctx, p, NULL, NULL, &s);
  if (code) return code;
  steif_start_clear(&s);
  code = steif_check_jacobian(ctx, p, NULL, &cause);
  if (code) return code;
  return toy_explain(ctx, p, &run, (steif_point){0}, &cause);
}

static void the_allocator_may_fail_anywhere(void)
{
  static const char *const names[] = {"fold", "hess2", "floating"};
  for (int i = 0; i < 3; i++) {
    const steif_problem p = model_problem(model_find(names[i]), 1);
    steif_context *ctx = steif_context_new(NULL);
    run = (toy){.rtol = 1e-4, .atol = 1e-4, .t1 = 1e-2, .most = 3};
    CHECK(!toy_run(ctx, &p, NULL, NULL, &run));
    steif_context_free(&ctx);
    for (long k = 1;; k++) {
      failing f = {.refuse_at = k};
      const steif_setup setup = failing_setup(&f);
      ctx = steif_context_new(&setup);
      const int code = ctx ? life(ctx, &p) : STEIF_NO_MEMORY;
      steif_context_free(&ctx);
      CHECK(f.alive == 0);
      if (f.served < k) {
        if (code) printf("\n  %s: %d after %ld", names[i], code, k);
        CHECK(code == STEIF_OK && k > 100);
        break;
      }
      if (code != STEIF_NO_MEMORY) printf("\n  %s, request %ld: %d", names[i], k, code);
      CU_ASSERT(code == STEIF_NO_MEMORY);
    }
  }
}

static void bad_arguments_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = model_problem(model_find("hess2"), 1);
  steif_diagnosis d;
  steif_start s;
  steif_cause cause;
  const double bad[] = {1, NAN, 1}, good[] = {1, 1, 1}, zero[] = {1, 0, 1};
  CHECK(steif_diagnose(ctx, &p, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_diagnose(ctx, &p, &(steif_point){.y = bad}, &d) == STEIF_NOT_FINITE);
  CHECK(strstr(steif_message(ctx), "y[1]") != NULL);
  CHECK(steif_diagnose(ctx, &p, &(steif_point){.y = good, .size = zero}, &d) ==
        STEIF_BAD_INPUT);
  CHECK(steif_consistent(ctx, &p, NULL, &(steif_request){.weight = zero}, &s) ==
        STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "weight[1]") != NULL);
  CHECK(steif_consistent(ctx, &p, NULL, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_explain(ctx, &p, NULL, NULL, &cause) == STEIF_BAD_INPUT);
  CHECK(steif_explain(ctx, &p, NULL, &(steif_history){.count = 0}, &cause) == STEIF_BAD_INPUT);
  steif_diagnosis_clear(NULL), steif_start_clear(NULL);
  d = (steif_diagnosis){0}, steif_diagnosis_clear(&d);
  steif_context_free(&ctx);
}

static int calls, refuse_after;

static int refusing(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const steif_problem p = model_problem(user, 0);
  return ++calls > refuse_after ? -7 : p.F(t, y, yp, r, user);
}

/* A callback that stops everything ends the work with its sentence, wherever it does so. */
static void callbacks_that_stop_are_obeyed(void)
{
  const model *m = model_find("hess2");
  for (refuse_after = 1; refuse_after < 2000; refuse_after += 97) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p = model_problem(m, 0);
    steif_diagnosis d;
    p.F = refusing, calls = 0;
    CHECK(steif_diagnose(ctx, &p, NULL, &d) == STEIF_CALLBACK);
    CHECK(strstr(steif_message(ctx), "-7") != NULL);
    steif_context_free(&ctx);
  }
}

/* A problem without a name is one like others. */
static void no_name_is_needed(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = model_problem(model_find("hess2"), 1);
  steif_pattern *pattern;
  steif_linear linear;
  p.name = NULL;
  steif_diagnosis d;
  steif_start s;
  steif_cause cause;
  CHECK(steif_diagnose(ctx, &p, NULL, &d) == STEIF_OK && d.index == 2);
  CHECK(steif_consistent(ctx, &p, NULL, NULL, &s) == STEIF_OK);
  CHECK(steif_check_jacobian(ctx, &p, NULL, &cause) == STEIF_OK);
  steif_diagnosis_clear(&d), steif_start_clear(&s);
  CHECK(steif_pattern_find(ctx, &p, &pattern) == STEIF_OK);
  steif_pattern_free(ctx, &pattern);
  CHECK(steif_linear_of(ctx, &p, &linear) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "'unnamed'") != NULL && !p.name);
  steif_context_free(&ctx);
}

/* Names of the user appear in the sentences. */
static void names_are_used(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const model *m = model_find("cstr");
  const steif_problem p = model_problem(m, 1);
  const steif_point q = model_inquiry(m);
  steif_diagnosis d;
  CHECK(!steif_diagnose(ctx, &p, &q, &d));
  CHECK(strstr(d.message, "Tc (3)") != NULL && strstr(d.message, "spec (2)") != NULL);
  CHECK(strcmp(steif_message(ctx), "ok") == 0);
  steif_diagnosis_clear(&d);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_misuse[] = {
  {"the allocator may fail anywhere", the_allocator_may_fail_anywhere},
  {"bad arguments are refused", bad_arguments_are_refused},
  {"callbacks that stop are obeyed", callbacks_that_stop_are_obeyed},
  {"no name is needed", no_name_is_needed},
  {"names are used", names_are_used},
  CU_TEST_INFO_NULL};
