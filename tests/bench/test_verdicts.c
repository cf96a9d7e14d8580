/* test_verdicts.c: verdicts of weak convergence on random systems are right or open, and errors are within
 * their levels: against runs in many digits on the canonical systems that the random ones are made of.
 * `steif bench verdicts` is the whole campaign.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "verdict_case.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sunmatrix/sunmatrix_dense.h>

/* The canonical system in other coordinates is the random one: E x = S E_z T x and x = back z, exactly. */
static void systems_are_what_they_are_made_of(void)
{
  steif_context *ctx = steif_context_new(NULL);
  planted_system *s = calloc(1, sizeof *s);
  for (long seed = 1; seed <= 60; seed++) {
    CHECK(!planted_system_new(ctx, seed, s));
    const int n = s->n;
    for (int i = 0; i < n; i++) {
      sunrealtype z = 0, left = 0, right = 0, product = 0;
      for (int j = 0; j < n; j++) {
        z += s->T[i][j] * s->x0[j];
        product += s->T[i][j] * s->back[j][i];
        left += SM_ELEMENT_D(s->linear.F, i, j) * s->x0[j];
        for (int k = 0; k < n; k++)
          right += s->S[i][j] * SM_ELEMENT_D(s->plain.F, j, k) * s->z0[k];
      }
      CHECK(z == s->z0[i] && product == 1);
      CHECK(fabs(left - right) <= 1e-12 * (1 + fabs(left)));
    }
  }
  planted_system_free(s);
  free(s);
  steif_context_free(&ctx);
}

/* Five rows show an order that smaller steps do not have: the smooth part, far below the impulses, has a
 * lower one; an error changes its sign. */
static void orders_of_small_parts_are_told(void)
{
  static const long seed[] = {1068, 2016, 2449};
  steif_context *ctx = steif_context_new(NULL);
  method_orders *known = calloc(1, sizeof *known);
  verdict_case *c = calloc(1, sizeof *c);
  for (int i = 0; i < 3; i++) {
    CHECK(!verdict_case_run(ctx, seed[i], known, c));
    CHECK(c->outcome == VERDICT_RIGHT || c->outcome == VERDICT_OPEN);
    CHECK(!(fabs(c->result.order - c->truth) > 0.3));
  }
  verdict_case_free(c);
  free(c);
  free(known);
  steif_context_free(&ctx);
}

static void no_verdict_is_wrong(void)
{
  enum { FIRST = 20001, COUNT = 60 };
  steif_context *ctx = steif_context_new(NULL);
  method_orders *known = calloc(1, sizeof *known);
  verdict_case *c = calloc(1, sizeof *c);
  int count[VERDICT_OUTCOMES] = {0};
  for (long seed = FIRST; seed < FIRST + COUNT; seed++) {
    CHECK(!verdict_case_run(ctx, seed, known, c));
    count[c->outcome]++;
    if (c->outcome != VERDICT_RIGHT && c->outcome != VERDICT_OPEN)
      printf("\n  seed %ld: %s: %s", seed, verdict_outcome_name(c->outcome), c->result.verdict);
  }
  CHECK(count[VERDICT_FALSE] == 0 && count[VERDICT_ORDER] == 0);
  CHECK(count[VERDICT_ERROR_BAR] == 0 && count[VERDICT_FAILED] == 0);
  CHECK(4 * count[VERDICT_RIGHT] > 3 * COUNT);
  verdict_case_free(c);
  free(c);
  free(known);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_verdicts[] = {
  {"random systems are what they are made of", systems_are_what_they_are_made_of},
  {"orders of small parts are told", orders_of_small_parts_are_told},
  {"no verdict on a random system is wrong", no_verdict_is_wrong},
  CU_TEST_INFO_NULL};
