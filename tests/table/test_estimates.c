/* test_estimates.c: what the estimates of general linear methods do not see.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include "suite.h"

/* Of y = 1 a step leaves X = W (1, 0, .., 0) and F = 0: derivatives and errors are 0, to rounding of the
 * weights. What is more would be a part of y itself, that no step is short enough for. */
static void constants_have_no_derivative(void)
{
  static const char *const tables[] = {
    "ab:p=2",   "ab:p=4",   "am:p=2",   "am:p=4",      "am:p=6",      "bdf:p=2",
    "bdf:p=4",  "bdf:p=6",  "dimsim1",  "dimsim1:p=3", "dimsim1:p=4", "dimsim2",
    "irks:p=1", "irks:p=2", "irks:p=3", "irks:p=4",    "nord22",      "nordsieck:of=bdf,p=2"};
  steif_context *ctx = steif_context_new(NULL);
  int seen = 0;
  for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
    steif_table *t = steif_table_new(ctx, tables[i]);
    CU_ASSERT_FATAL(t != NULL);
    const steif_glm *g = t->general;
    for (int beyond = 0; beyond < 2; beyond++) {
      sunrealtype target[STEIF_PAST + 2] = {0}, d[STF_LEAST], sum = 0, size = 0;
      bool found;
      target[g->order + beyond] = beyond ? g->error : 1;
      CHECK(!stf_glm_combination(ctx, g, target, beyond, d, &found));
      for (int l = 0; found && l < g->k; l++) {
        const sunrealtype now = d[l], before = d[g->k + g->r + l];
        sum += (now + before) * g->W[l * (g->order + 1)];
        size = fmax(size, fmax(fabs(now), fabs(before)));
      }
      seen += found;
      if (!(fabs(sum) <= 100 * SUN_UNIT_ROUNDOFF * size))
        printf("\n  %s: %.3g of weights of size %.3g", tables[i], sum, size);
      CHECK(fabs(sum) <= 100 * SUN_UNIT_ROUNDOFF * size);
    }
    steif_table_free(ctx, &t);
  }
  CHECK(seen > 18);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_estimates[] = {
  {"constants have no derivative and no error", constants_have_no_derivative},
  CU_TEST_INFO_NULL};
