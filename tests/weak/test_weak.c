/* test_weak.c: verdicts and refusals of the weak measurement.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"
#include <stdlib.h>

static void expect(const char *method, int k, const char *name, enum steif_convention c,
                   const char *start, int converges, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[4];
  steif_weak_result result;
  CHECK(weak_rows(ctx, method, k, name, c, start, 1.0 / 32, 4, row, &result) == STEIF_OK);
  CHECK(result.converges == converges);
  const bool same = !strncmp(result.verdict, words, strlen(words));
  if (!same) printf("\n  %s, k=%d: '%s', expected '%s'", method, k, result.verdict, words);
  CHECK(same);
  steif_context_free(&ctx);
}

static void verdicts_say_what_happens(void)
{
  expect("be", 3, "N-inc", STEIF_R, NULL, 1, "converges weakly, order 0.98");
  expect("bdf:p=2", 2, "H-inc", STEIF_R, "ramp", 0,
         "does not converge weakly: error tends to -1");
  expect("bdf:p=2", 3, "H-inc", STEIF_R, "ramp", 0,
         "does not converge weakly: error grows like h^-1.0");
  expect("bdf:p=2", 3, "H-inc", STEIF_R, "constant", 1, "converges weakly, order 1.98");
  expect("bdf:p=3", 3, "N-inc", STEIF_C, "cq", 1, "converges weakly, order 2.97");
  expect("bdf:p=3,start=cq", 3, "N-inc", STEIF_C, NULL, 1, "converges weakly, order 2.97");
  expect("lobatto3c:s=2", 2, "H-inc", STEIF_STAGE, NULL, 1,
         "exact to rounding at every h measured");
  expect("radau:s=2", 2, "H-inc", STEIF_STAGE, NULL, 1, "converges weakly, order 1.9");
  expect("radau:s=2", 2, "H-inc", STEIF_R, NULL, 0,
         "does not converge weakly: error tends to -6");
  expect("radau:s=2", 3, "H-inc", STEIF_R, NULL, 0,
         "does not converge weakly: error grows like h^-1.0");
}

static void first_order_constant_is_for_euler_alone(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[2];
  steif_weak_result result;
  weak_rows(ctx, "bdf:p=1", 2, "H-inc", STEIF_R, "constant", 0.25, 2, row, &result);
  CLOSE(result.first, -8.0, 1e-12);
  CHECK(isnan(row[0].order) && isfinite(row[1].order));
  weak_rows(ctx, "bdf:p=2", 2, "H-inc", STEIF_R, "constant", 0.25, 2, row, &result);
  CHECK(isnan(result.first));
  weak_rows(ctx, "bdf:p=1", 2, "H-inc", STEIF_C, "cq", 0.25, 2, row, &result);
  CHECK(isnan(result.first));
  weak_rows(ctx, "be", 2, "H-inc", STEIF_R, NULL, 0.25, 1, row, &result);
  CHECK(result.converges == -1 && !strncmp(result.verdict, "undecided", 9));
  steif_context_free(&ctx);
}

static void refuse(const steif_weak_query *query, int code, const char *word)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_row row[4];
  steif_weak_result result;
  CHECK(steif_weak_measure(ctx, query, row, &result) == code);
  const bool told = strstr(steif_message(ctx), word) != NULL;
  if (!told) printf("\n  '%s' does not mention '%s'", steif_message(ctx), word);
  CHECK(told);
  steif_context_free(&ctx);
}

static void questions_without_sense_are_refused(void)
{
  const steif_weak_query good = {.method = "be",
                                 .problem = "jordan:k=3,case=H-inc",
                                 .convention = STEIF_R,
                                 .h = 0.125,
                                 .rows = 2};
  steif_weak_query q = good;
  q.h = 2, refuse(&q, STEIF_BAD_INPUT, "(0, 1]");
  q = good, q.h = NAN, refuse(&q, STEIF_BAD_INPUT, "(0, 1]");
  q = good, q.rows = 0, refuse(&q, STEIF_BAD_INPUT, "rows");
  q = good, q.rows = 60, refuse(&q, STEIF_BAD_INPUT, "fewer rows");
  q = good, q.component = 3, refuse(&q, STEIF_BAD_INPUT, "component 4");
  q = good, q.method = NULL, refuse(&q, STEIF_BAD_INPUT, "method");
  q = good, q.method = "bdf:p=9", refuse(&q, STEIF_BAD_INPUT, "p=9");
  q = good, q.method = "badau", refuse(&q, STEIF_UNKNOWN_NAME, "radau");
  q = good, q.problem = "rober", refuse(&q, STEIF_UNSUPPORTED, "rober");
  q = good, q.problem = NULL, refuse(&q, STEIF_BAD_INPUT, "problem");
  q = good, q.problem = "jordan:k=3,case=H-ink", refuse(&q, STEIF_UNKNOWN_NAME, "H-inc");
  q = good, q.problem = "jordan:k=77", refuse(&q, STEIF_BAD_INPUT, "k=77");
  q = good, q.method = "bdf:p=2", q.convention = STEIF_STAGE,
  refuse(&q, STEIF_UNSUPPORTED, "no stages");
  q = good, q.method = "bdf:p=2", q.start = "jump", refuse(&q, STEIF_UNKNOWN_NAME, "jump");
}

/* Every allocation fails in turn: the code says so, nothing leaks (AddressSanitizer watches). */
static void *starving(size_t bytes, void *user)
{
  long *left = user;
  return (*left)-- > 0 ? malloc(bytes) : NULL;
}

static void feeding(void *block, void *user)
{
  (void)user;
  free(block);
}

static void memory_may_run_short_anywhere(void)
{
  const steif_weak_query query = {.method = "bdf:p=2",
                                  .problem = "jordan:k=3,case=N-inc",
                                  .convention = STEIF_R,
                                  .h = 0.25,
                                  .rows = 2};
  int code = STEIF_NO_MEMORY, hungry = 0;
  for (long meals = 1; code != STEIF_OK && meals < 1000; meals++) {
    long left = meals;
    steif_weak_row row[2];
    steif_weak_result result;
    const steif_setup setup = {.allocate = starving, .release = feeding, .user = &left};
    steif_context *ctx = steif_context_new(&setup);
    if (!ctx) continue;
    code = steif_weak_measure(ctx, &query, row, &result);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    hungry += code == STEIF_NO_MEMORY;
    steif_context_free(&ctx);
  }
  CHECK(code == STEIF_OK && hungry > 10);
}

CU_TestInfo tests_of_weak[] = {
  {"verdicts say what happens", verdicts_say_what_happens},
  {"the first-order constant belongs to backward Euler",
   first_order_constant_is_for_euler_alone},
  {"questions without sense are refused with a sentence", questions_without_sense_are_refused},
  {"memory may run short anywhere", memory_may_run_short_anywhere},
  CU_TEST_INFO_NULL};
