/* test_shelf.c: looking tables up, parameters, ownership, known coefficients.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include "table.h"
#include <stdlib.h>
#include <string.h>

static steif_table *make(steif_context *ctx, const char *spec)
{
  steif_table *t = steif_table_new(ctx, spec);
  if (!t) printf("\n  %s: %s", spec, steif_message(ctx));
  CU_ASSERT_FATAL(t != NULL);
  return t;
}

static void names_equal_files(void)
{
  CHECK(stf_table_count >= 14);
  for (size_t i = 0; i < stf_table_count; i++) {
    const steif_table *t = steif_table_at(i);
    CHECK(!strcmp(t->name, stf_table_shelf[i].name));
    CHECK(t->about && strlen(t->about) > 12);
    if (t->kind == STEIF_GLM)
      CHECK(!t->A && !t->b && !t->fill != !t->general);
    else
      CHECK(t->build ? !t->A && !t->b : t->A && t->b && t->s > 0 && t->order > 0);
    CHECK(!t->bhat == !t->order_hat);
  }
  CHECK(steif_table_at(stf_table_count) == NULL);
}

static void defaults_of_families(void)
{
  const struct {
    const char *spec;
    int s, order, stage_order;
  } all[] = {{"gauss", 2, 4, 2},       {"radau", 3, 5, 3},         {"radau1a", 2, 3, 1},
             {"lobatto3c", 3, 4, 2},   {"gauss:s=7", 7, 14, 7},    {"radau:s=9", 9, 17, 9},
             {"radau1a:s=5", 5, 9, 4}, {"lobatto3c:s=6", 6, 10, 5}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    steif_table *t = make(ctx, all[i].spec);
    CHECK(t->s == all[i].s && t->order == all[i].order && t->stage_order == all[i].stage_order);
    steif_table_free(ctx, &t);
    CHECK(t == NULL);
  }
  steif_context_free(&ctx);
}

static void tables_are_complete(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < stf_table_count; i++) {
    const steif_table *item = steif_table_at(i);
    if (item->kind == STEIF_GLM) continue;
    steif_table *t = make(ctx, item->name), *u = make(ctx, item->name);
    CHECK(t->A && t->b && t->c);
    if (!item->build) CHECK(t->A != item->A && t->b != item->b && t->A != u->A);
    CHECK(!t->bhat == !item->bhat && (!t->bhat || t->bhat != item->bhat));
    for (int k = 0; k < t->s * t->s; k++) CHECK(t->A[k] == u->A[k]);
    steif_table_free(ctx, &t), steif_table_free(ctx, &u);
  }
  steif_context_free(&ctx);
}

/* Given nodes are row sums to rounding; those of tables that give none are (Alexander's third:
 * gamma, (1 + gamma)/2, 1). */
static void nodes_are_row_sums(void)
{
  const double g = 0.43586652150845899942, alexander[] = {g, (1 + g) / 2, 1};
  steif_context *ctx = steif_context_new(NULL);
  steif_table *t = make(ctx, "alexander3");
  for (int i = 0; i < 3; i++) CLOSE(t->c[i], alexander[i], 2e-16);
  steif_table_free(ctx, &t);
  int given = 0;
  for (size_t k = 0; k < stf_table_count; k++) {
    const steif_table *item = steif_table_at(k);
    if (!item->c) continue;
    t = make(ctx, item->name);
    for (int i = 0; i < t->s; i++) {
      double sum = 0;
      for (int j = 0; j < t->s; j++) sum += t->A[i * t->s + j];
      CLOSE_FLOOR(t->c[i], sum, 1e-14, 1);
    }
    steif_table_free(ctx, &t);
    given++;
  }
  CHECK(given >= 2);
  steif_context_free(&ctx);
}

static void expect(steif_context *ctx, const char *spec, int s, const double *A,
                   const double *b, const double *c)
{
  steif_table *t = make(ctx, spec);
  CHECK(t->s == s);
  for (int i = 0; i < s * s; i++) CLOSE_FLOOR(t->A[i], A[i], 2e-16, 1);
  for (int i = 0; i < s; i++) {
    CLOSE_FLOOR(t->b[i], b[i], 2e-16, 1);
    CLOSE_FLOOR(t->c[i], c[i], 2e-16, 1);
  }
  steif_table_free(ctx, &t);
}

/* Hairer, Wanner: Solving ODEs II, tables IV.5.1 to 5.6 and 5.13. */
static void known_coefficients(void)
{
  const double r3 = sqrt(3.0), r6 = sqrt(6.0);
  const double gauss2[] = {0.25, 0.25 - r3 / 6, 0.25 + r3 / 6, 0.25};
  const double radau2[] = {5 / 12.0, -1 / 12.0, 0.75, 0.25};
  const double radau3[] = {
    (88 - 7 * r6) / 360,     (296 - 169 * r6) / 1800, (-2 + 3 * r6) / 225,
    (296 + 169 * r6) / 1800, (88 + 7 * r6) / 360,     (-2 - 3 * r6) / 225,
    (16 - r6) / 36,          (16 + r6) / 36,          1 / 9.0};
  const double c3[] = {(4 - r6) / 10, (4 + r6) / 10, 1};
  const double left2[] = {0.25, -0.25, 0.25, 5 / 12.0};
  const double lobatto2[] = {0.5, -0.5, 0.5, 0.5};
  const double lobatto3[] = {1 / 6.0,   -1 / 3.0, 1 / 6.0, 1 / 6.0, 5 / 12.0,
                             -1 / 12.0, 1 / 6.0,  2 / 3.0, 1 / 6.0};
  steif_context *ctx = steif_context_new(NULL);
  expect(ctx, "gauss:s=2", 2, gauss2, (double[]){0.5, 0.5},
         (double[]){0.5 - r3 / 6, 0.5 + r3 / 6});
  expect(ctx, "radau:s=2", 2, radau2, radau2 + 2, (double[]){1 / 3.0, 1});
  expect(ctx, "radau:s=3", 3, radau3, radau3 + 6, c3);
  expect(ctx, "radau1a:s=2", 2, left2, (double[]){0.25, 0.75}, (double[]){0, 2 / 3.0});
  expect(ctx, "lobatto3c:s=2", 2, lobatto2, (double[]){0.5, 0.5}, (double[]){0, 1});
  expect(ctx, "lobatto3c:s=3", 3, lobatto3, lobatto3 + 6, (double[]){0, 0.5, 1});
  steif_context_free(&ctx);
}

static void one_stage(void)
{
  const double one[] = {1}, half[] = {0.5}, none[] = {0};
  steif_context *ctx = steif_context_new(NULL);
  expect(ctx, "radau:s=1", 1, one, one, one);
  expect(ctx, "gauss:s=1", 1, half, one, half);
  expect(ctx, "radau1a:s=1", 1, one, one, none);
  steif_context_free(&ctx);
}

/* A + A_low carries the digits that rounding to double drops: 1/12 is not a double. */
static void low_parts(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_table *t = make(ctx, "radau:s=2");
  const long double a = (long double)t->A[1] + (long double)t->A_low[1];
  CHECK(t->A_low[1] != 0);
  CHECK(fabsl(a + 1 / 12.0L) < 1e-19L);
  steif_table_free(ctx, &t);
  t = make(ctx, "hw43");
  CHECK(t->A_low == NULL);
  steif_table_free(ctx, &t);
  steif_context_free(&ctx);
}

static void refused(steif_context *ctx, const char *spec, int code, const char *words)
{
  steif_forget(ctx);
  CHECK(steif_table_new(ctx, spec) == NULL);
  CHECK(steif_status(ctx) == code);
  if (!strstr(steif_message(ctx), words)) printf("\n  %s: %s", spec, steif_message(ctx));
  CHECK(strstr(steif_message(ctx), words));
}

static void wrong_specs_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  refused(ctx, "radao:s=3", STEIF_UNKNOWN_NAME, "'radao'; did you mean 'radau'?");
  refused(ctx, "alexandre3", STEIF_UNKNOWN_NAME, "did you mean 'alexander3'?");
  refused(ctx, "crank-nicolson", STEIF_UNKNOWN_NAME, "did you mean 'cranknicolson'?");
  refused(ctx, "alexander2:s=2", STEIF_UNKNOWN_NAME,
          "'alexander2' has no parameter 's'; it takes none");
  refused(ctx, "gauss:q=3", STEIF_UNKNOWN_NAME, "'gauss' has no parameter 'q'; it takes s");
  refused(ctx, "radau:s=33", STEIF_BAD_INPUT,
          "s=33 of 'radau' must be a whole number from 1 to 32");
  refused(ctx, "lobatto3c:s=1", STEIF_BAD_INPUT, "from 2 to 32");
  refused(ctx, "gauss:s=2.5", STEIF_BAD_INPUT, "whole number");
  refused(ctx, "radau:", STEIF_BAD_INPUT, "cannot read 'radau:'");
  refused(ctx, NULL, STEIF_BAD_INPUT, "NULL");
  CHECK(steif_table_new(NULL, "radau") == NULL);
  steif_table *none = NULL;
  steif_table_free(ctx, &none);
  steif_table_free(ctx, NULL);
  steif_context_free(&ctx);
}

/* The k-th allocation fails for every k until all succeed. */
static void short_memory_is_reported(void)
{
  int successes = 0;
  for (int k = 0; k < 40 && !successes; k++) {
    failing memory = {0};
    const steif_setup setup = failing_setup(&memory);
    steif_context *ctx = steif_context_new(&setup);
    CU_ASSERT_FATAL(ctx != NULL);
    const long own = memory.alive;
    memory.refuse_at = memory.served + k + 1;
    steif_table *t = steif_table_new(ctx, "radau:s=13");
    stf_pool *pool = t ? stf_pool_new(ctx) : NULL;
    stf_transform transform;
    const int code = pool ? stf_transform_build(pool, ctx, t, &transform) : STEIF_NO_MEMORY;
    CHECK(code == STEIF_OK ||
          (code == STEIF_NO_MEMORY && steif_status(ctx) == STEIF_NO_MEMORY));
    successes += code == STEIF_OK;
    CHECK((code == STEIF_OK) == (k >= 7)); /* table, pool, work, B, T, Tinv, coupling */
    stf_pool_free(&pool);
    steif_table_free(ctx, &t);
    CHECK(memory.alive == own);
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
  }
  CHECK(successes == 1);
}

CU_TestInfo tests_of_shelf[] = {
  {"every table is named as its file and says where it is from", names_equal_files},
  {"families have their default and their given stages", defaults_of_families},
  {"tables made from a spec are complete and alike", tables_are_complete},
  {"nodes are row sums, given or not", nodes_are_row_sums},
  {"coefficients agree with the handbook's closed forms", known_coefficients},
  {"one stage gives backward Euler and the midpoint rule", one_stage},
  {"low parts carry the digits that double drops", low_parts},
  {"unknown names and parameters get a code and the nearest", wrong_specs_are_refused},
  {"a failing allocation is reported and nothing leaks", short_memory_is_reported},
  CU_TEST_INFO_NULL};
