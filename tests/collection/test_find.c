/* test_find.c: specs become problems, wrong specs become sentences, nothing leaks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "fixture.h"
#include <stdbool.h>
#include <stdlib.h>

static void shelf_lists_names(void)
{
  static const char *const ours[] = {
    "stiffpair", "forced", "harmonic", "pendulum", "pendulum3", "kepler",   "lorenz",
    "jordan",    "ut5",    "heat",     "bruss2d",  "prothero",  "dahlquist"};
  for (size_t k = 0; k < sizeof ours / sizeof *ours; k++) {
    int seen = 0;
    for (size_t i = 0; steif_problem_name(i); i++)
      seen += !strcmp(steif_problem_name(i), ours[k]);
    CU_ASSERT_EQUAL(seen, 1);
  }
  CU_ASSERT_PTR_NULL(steif_problem_name(4711));
}

static void every_name_is_found_with_a_valid_form(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; steif_problem_name(i); i++) {
    steif_problem p;
    CHECK(steif_problem_find(ctx, steif_problem_name(i), &p) == STEIF_OK);
    CHECK(p.name && !strcmp(p.name, steif_problem_name(i)));
    CHECK(p.n > 0 && p.t1 > p.t0 && p.y0 && p.about && strlen(p.about) > 30);
    CHECK(!!p.f + !!p.F + !!p.g == 1);
    CHECK(p.jac || p.idajac || p.A);
    if (p.reference) CHECK(p.reference->t > p.t0 && p.reference->value && p.reference->source);
    for (sunindextype k = 0; p.index && k < p.n; k++) CHECK(p.index[k] >= 1 && p.index[k] <= 3);
    steif_problem_clear(ctx, &p);
    CHECK(!p.name && !p.n && !p.user);
  }
  steif_context_free(&ctx);
}

static void the_name_is_the_whole_spec_and_outlives_it(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p, q;
  char spec[] = "heat:n=37,storage=sparse";
  CHECK(steif_problem_find(ctx, spec, &p) == STEIF_OK);
  CHECK(steif_problem_find(ctx, "heat:n=23", &q) == STEIF_OK);
  memset(spec, 'x', sizeof spec - 1);
  CU_ASSERT_STRING_EQUAL(p.name, "heat:n=37,storage=sparse");
  CU_ASSERT_EQUAL(p.n, 37);
  CU_ASSERT_EQUAL(p.storage, STEIF_SPARSE);
  CU_ASSERT_EQUAL(p.nnz, 109); /* 3 n - 2 */
  CU_ASSERT_EQUAL(q.n, 23);
  CU_ASSERT_EQUAL(q.storage, STEIF_BAND);
  steif_problem_clear(ctx, &p);
  steif_problem_clear(ctx, &p);
  steif_problem_clear(ctx, &q);
  steif_problem_clear(ctx, NULL);
  steif_context_free(&ctx);
}

static void rejected(const char *spec, int code, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  memset(&p, 0x5a, sizeof p);
  const int got = steif_problem_find(ctx, spec, &p);
  if (got != code || !strstr(steif_message(ctx), words))
    printf("\n  %s: code %d, \"%s\"", spec ? spec : "NULL", got, steif_message(ctx));
  CU_ASSERT_EQUAL(got, code);
  CU_ASSERT_PTR_NOT_NULL(strstr(steif_message(ctx), words));
  CHECK(!p.name && !p.n && !p.user && !p.build);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void wrong_specs_are_rejected_with_a_sentence(void)
{
  rejected("hate:n=400", STEIF_UNKNOWN_NAME, "'heat'");
  rejected("stifpair", STEIF_UNKNOWN_NAME, "'stiffpair'");
  rejected("harmonic:w=2", STEIF_UNKNOWN_NAME, "'harmonic' has no parameter 'w'");
  rejected("heat:m=7", STEIF_UNKNOWN_NAME, "it takes n, storage");
  rejected("heat:n=0", STEIF_BAD_INPUT, "from 1 to");
  rejected("heat:storage=tape", STEIF_UNKNOWN_NAME, "dense, band or sparse");
  rejected("jordan:k=13", STEIF_BAD_INPUT, "from 1 to 12");
  rejected("jordan:case=N-con", STEIF_UNKNOWN_NAME, "N-cons");
  rejected("forced:c=0", STEIF_BAD_INPUT, "resonance");
  rejected("forced:k=0.01", STEIF_BAD_INPUT, "c^2/4");
  rejected("pendulum3:index=4", STEIF_BAD_INPUT, "1, 2, 3 or ggl");
  rejected("ut5:case=odd", STEIF_UNKNOWN_NAME, "inc or cons");
  rejected("kepler:e=1", STEIF_BAD_INPUT, "0.99");
  rejected("prothero:lambda=nan", STEIF_BAD_INPUT, "lambda=nan");
  rejected("", STEIF_BAD_INPUT, "cannot read");
  rejected(NULL, STEIF_BAD_INPUT, "NULL");
}

static void no_place_for_the_problem_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CU_ASSERT_EQUAL(steif_problem_find(ctx, "heat", NULL), STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* Find `spec`, rejected its block number budget + 1; true when it asks for less. */
static bool starved(const char *spec, int budget)
{
  failing memory = {0};
  const steif_setup setup = failing_setup(&memory);
  steif_context *ctx = steif_context_new(&setup);
  const long before = memory.alive;
  steif_problem p;
  memory.refuse_at = memory.served + budget + 1;
  const int code = steif_problem_find(ctx, spec, &p);
  CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
  if (code) CHECK(!p.name && !p.user && memory.alive == before);
  if (code) CHECK(steif_status(ctx) == STEIF_NO_MEMORY);
  steif_problem_clear(ctx, &p);
  CHECK(memory.alive == before);
  steif_context_free(&ctx);
  CU_ASSERT_EQUAL(memory.alive, 0);
  return code == STEIF_OK;
}

static void short_memory_is_reported_and_nothing_leaks(void)
{
  static const char *const more[] = {"bruss2d:n=7", "jordan:k=5,case=sin-inc", "heat:n=19",
                                     "pendulum3:index=ggl"};
  for (size_t i = 0; i < sizeof more / sizeof *more; i++) {
    int budget = 0;
    while (budget < 50 && !starved(more[i], budget)) budget++;
    CHECK(budget >= 2 && budget < 50); /* the name and the data */
  }
  for (size_t i = 0; steif_problem_name(i); i++) {
    int budget = 0;
    while (budget < 50 && !starved(steif_problem_name(i), budget)) budget++;
    CHECK(budget < 50);
  }
}

CU_TestInfo tests_of_find[] = {
  {"the shelf lists each name once", shelf_lists_names},
  {"every name is found with one form and a Jacobian", every_name_is_found_with_a_valid_form},
  {"the name is the whole spec and outlives it", the_name_is_the_whole_spec_and_outlives_it},
  {"wrong specs are rejected with a sentence", wrong_specs_are_rejected_with_a_sentence},
  {"no place for the problem is rejected", no_place_for_the_problem_is_rejected},
  {"short memory is reported and nothing leaks", short_memory_is_reported_and_nothing_leaks},
  CU_TEST_INFO_NULL};
