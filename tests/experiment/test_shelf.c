/* test_shelf.c: every experiment of the shelf finds its references, and has its picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "findings.h"
#include "suite.h"
#include <stdlib.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

static size_t finds_its_references(steif_context *ctx, const char *name)
{
  steif_findings f;
  size_t known = 0;
  const int code = steif_experiment_run(ctx, name, &f);
  if (code) printf("\n  %s: %s", name, steif_message(ctx));
  CHECK(code == STEIF_OK && f.disagree == 0 && f.count > 0);
  for (size_t i = 0; i < f.count; i++) {
    const steif_finding *x = f.finding + i;
    known += x->agrees >= 0;
    if (x->agrees == 0)
      printf("\n  %s, %s, h = %g: %s %.12e, expected %.12e", name, x->of, x->h, x->quantity,
             x->value, x->reference);
  }
  for (size_t k = 0; k < f.plot.count; k++) CHECK(f.plot.curve[k].count > 0);
  CHECK(f.plot.count == 0 || (f.plot.title && f.plot.x_label && f.plot.y_label));
  steif_findings_clear(ctx, &f);
  return known;
}

static void all_find_their_references(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const char *name, *about;
  size_t i = 0, known = 0;
  for (; (name = steif_experiment_name(i, &about)); i++) {
    CHECK(strlen(about) > 10);
    const size_t more = finds_its_references(ctx, name);
    CHECK(more > 0);
    known += more;
  }
  CHECK(i >= 10 && known > 300);
  steif_context_free(&ctx);
}

static void orders_come_from_halved_steps(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_findings f;
  CU_ASSERT_FATAL(steif_experiment_run(ctx, "symplectic", &f) == STEIF_OK);
  CHECK(isnan(f.finding[0].order) && f.plot.log_x && f.plot.count == 10);
  CLOSE(f.finding[1].order, 1.010333, 1e-6);
  CLOSE(f.finding[4].order, 1.001148, 1e-6);
  CHECK(isnan(f.finding[5].order)); /* the next method begins */
  CHECK(f.finding[0].error < 1e-10 && f.finding[0].agrees == 1);
  steif_findings_clear(ctx, &f);
  CHECK(f.finding == NULL);
  steif_context_free(&ctx);
}

static void unknown_names_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_findings f;
  CHECK(steif_experiment_run(ctx, "drfit", &f) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "'drift'") != NULL);
  CHECK(steif_experiment_run(ctx, NULL, &f) == STEIF_BAD_INPUT);
  CHECK(steif_experiment_run(ctx, "drift", NULL) == STEIF_BAD_INPUT);
  CHECK(steif_experiment_name(1000, NULL) == NULL);
  steif_findings_clear(ctx, NULL);
  steif_context_free(&ctx);
}

static void *stingy(size_t bytes, void *left)
{
  return (*(int *)left)-- > 0 ? malloc(bytes) : NULL;
}
static void give_back(void *block, void *left) { (void)left, free(block); }

static void memory_may_end_anywhere(void)
{
  int tries = 0, done = 0;
  for (; !done && tries < 1000; tries++) {
    int left = 1000;
    steif_context *ctx = steif_context_new(
      &(steif_setup){.allocate = stingy, .release = give_back, .user = &left});
    steif_findings f;
    left = tries;
    const int code = steif_experiment_run(ctx, "exptrapezoidal", &f);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    done = code == STEIF_OK;
    steif_findings_clear(ctx, &f);
    left = 1000;
    steif_context_free(&ctx);
  }
  CHECK(done && tries > 30);
}

CU_TestInfo tests_of_shelf[] = {
  {"all experiments find their references", all_find_their_references},
  {"orders come from halved steps", orders_come_from_halved_steps},
  {"unknown names are rejected", unknown_names_are_rejected},
  {"memory may end anywhere", memory_may_end_anywhere},
  CU_TEST_INFO_NULL};
