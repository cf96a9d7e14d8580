/* test_checkpoints.c: what a gradient comes to does not depend on what is kept.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include "base/failing.h"
#include "folder.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int last(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, NV_LENGTH_S(y) - 1);
  return 0;
}

static void find(steif_context *ctx, const struct subject *s, const char *method,
                 sunrealtype t1, steif_gradient *g)
{
  const steif_functional J = {.count = 1, .integrand = last, .end = last};
  gradient_of(ctx, s, method, 1e-6, t1, &J, g);
}

static bool same(const steif_gradient *a, const steif_gradient *b)
{
  const size_t size = sizeof *a->dp;
  return a->n == b->n && a->parameters == b->parameters && a->value[0] == b->value[0] &&
         !memcmp(a->dp, b->dp, (size_t)a->parameters * size) &&
         !memcmp(a->dy0, b->dy0, (size_t)a->n * size);
}

static void bit_for_bit(void)
{
  static const char *const methods[] = {"radau:s=3", "gauss:s=3",     "bdf",
                                        "bdf:p=2",   "dirk:esdirk43", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  for (int m = 0; m < 6; m++)
    for (int storage = 0; storage < 4; storage++) {
      if (storage < 3)
        subject_brusselator(&s, storage == 2   ? STEIF_SPARSE
                                : storage == 1 ? STEIF_BAND
                                               : STEIF_DENSE);
      else
        subject_robertson(&s);
      steif_gradient all = {0}, few = {.checkpoints = 3}, more = {.checkpoints = 7};
      find(ctx, &s, methods[m], 1, &all), find(ctx, &s, methods[m], 1, &few);
      find(ctx, &s, methods[m], 1, &more);
      CHECK(same(&all, &few) && same(&all, &more));
      CHECK(all.cost.recomputed_steps == 0);
      CHECK(few.cost.recomputed_steps > few.cost.steps || few.cost.steps <= 9);
      CHECK(more.cost.recomputed_steps <= few.cost.recomputed_steps);
      steif_gradient_free(ctx, &all), steif_gradient_free(ctx, &few);
      steif_gradient_free(ctx, &more);
    }
  steif_context_free(&ctx);
}

/* r N - C(c + r, r - 1) advances with c images, and the steps whose stages are looked at; with c^2 >= N a segment of
 * stages is kept beside them, and images of the way forward serve: none is advanced over. */
static void as_few_as_possible(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_functional J = {.count = 1, .end = last};
  struct subject s;
  subject_lotka(&s);
  steif_options o = steif_defaults();
  o.h = 0.01, o.t1 = 10;
  static const struct {
    int c;
    long advances;
  } of[] = {{10, 3636}, {20, 2747}, {30, 2472}, {45, 0}};
  for (int i = 0; i < 4; i++) {
    steif_gradient g = {.checkpoints = of[i].c};
    CHECK(steif_gradient_find(ctx, &s.problem, "radau:s=2", &o, &J, &g) == STEIF_OK);
    CHECK(g.cost.steps == 1000);
    CHECK(g.cost.recomputed_steps == of[i].advances + 1000);
    if (g.cost.recomputed_steps != of[i].advances + 1000)
      printf("\n  c = %d: %ld", of[i].c, g.cost.recomputed_steps);
    steif_gradient_free(ctx, &g);
  }
  steif_context_free(&ctx);
}

static void within_the_limit(void)
{
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_brusselator(&s, STEIF_SPARSE);
  steif_gradient all = {0}, limited = {0};
  find(ctx, &s, "radau:s=3", 10, &all);
  limited.memory = all.cost.bytes / 2;
  const steif_functional J = {.count = 1, .integrand = last, .end = last};
  steif_options o = steif_defaults();
  o.rtol = 1e-6, o.t1 = 10;
  const int code = steif_gradient_find(ctx, &s.problem, "radau:s=3", &o, &J, &limited);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  CHECK(same(&all, &limited) && limited.cost.recomputed_steps > 0);
  CHECK(limited.cost.bytes <= limited.memory);
  steif_gradient_free(ctx, &limited);
  limited = (steif_gradient){.memory = 2000};
  CHECK(steif_gradient_find(ctx, &s.problem, "radau:s=3", &o, &J, &limited) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "too small") != NULL && limited.dp == NULL);
  steif_gradient_free(ctx, &all);
  steif_context_free(&ctx);
}

static void in_files(void)
{
  char folder[400];
  CU_ASSERT_FATAL(folder_make(folder, sizeof folder) != NULL);
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_robertson(&s);
  steif_gradient all = {0}, few = {.checkpoints = 4, .folder = folder};
  find(ctx, &s, "radau:s=3", 40, &all), find(ctx, &s, "radau:s=3", 40, &few);
  CHECK(same(&all, &few) && few.cost.recomputed_steps > 0);
  CHECK(rmdir(folder) == 0); /* nothing is left behind */
  steif_gradient_free(ctx, &all), steif_gradient_free(ctx, &few);
  steif_context_free(&ctx);
}

/* Steps made again from images leave nothing. */
static void images_are_released(void)
{
  static const size_t memory[] = {60000, 100000};
  struct subject s;
  subject_robertson(&s);
  const steif_functional last = {
    .count = 1, .integrand = weighted_sum, .end = weighted_sum, .slopes = weighted_slopes};
  for (int i = 0; i < 2; i++) {
    failing counted = {0};
    steif_setup setup = failing_setup(&counted);
    steif_context *ctx = steif_context_new(&setup);
    const long before = counted.alive;
    steif_gradient a = {.memory = memory[i], .checkpoints = 3 + i};
    steif_options o = steif_defaults();
    o.rtol = 1e-9, o.t1 = 40;
    CHECK(steif_gradient_find(ctx, &s.problem, "radau:s=3", &o, &last, &a) == STEIF_OK);
    steif_gradient_free(ctx, &a);
    CHECK(counted.alive == before);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_checkpoints[] = {
  {"three images, or all stages: bit for bit", bit_for_bit},
  {"recomputations are as few as can be", as_few_as_possible},
  {"memory stays within the limit", within_the_limit},
  {"images in files", in_files},
  {"images are released", images_are_released},
  CU_TEST_INFO_NULL};
