/* test_subject.c: the distributional solution of any pencil, paired with g = (1-t)_+^8 and sampled,
 * and runs measured against it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include "base/failing.h"
#include "suite.h"
#include <string.h>

enum { MOST = 8 };

/* By closed formulas under its name, and by the pencil alone. */
typedef struct twins {
  steif_context *ctx;
  steif_problem problem;
  steif_linear linear;
  stf_subject named, plain;
} twins;

static void open_twins(twins *w, const char *spec)
{
  w->ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(w->ctx, spec, &w->problem));
  CU_ASSERT_FATAL(!steif_linear_of(w->ctx, &w->problem, &w->linear));
  CU_ASSERT_FATAL(!stf_subject_open(w->ctx, spec, NULL, NULL, &w->named));
  CU_ASSERT_FATAL(!stf_subject_open(w->ctx, NULL, &w->linear, w->problem.y0, &w->plain));
}

static void close_twins(twins *w)
{
  stf_subject_close(&w->named), stf_subject_close(&w->plain);
  SUNMatDestroy(w->linear.E), SUNMatDestroy(w->linear.F);
  steif_problem_clear(w->ctx, &w->problem);
  steif_context_free(&w->ctx);
}

/* Jordan blocks have no slow part; the circuit has one of 1e-4 seconds, the masses swing. */
static const struct {
  const char *spec;
  double tolerance;
} known[] = {{"ut5", 1e-11},
             {"switchrlc", 1e-10},
             {"impact:gap=0.3", 1e-11},
             {"jordan:k=1,case=N-inc", 1e-12},
             {"jordan:k=2,case=H-inc", 1e-12},
             {"jordan:k=3,case=N-inc", 1e-12},
             {"jordan:k=4,case=N-cons", 1e-12},
             {"jordan:k=5,case=N-inc", 1e-12}};
enum { KNOWN = sizeof known / sizeof *known };

static void pencils_pair_as_closed_formulas(void)
{
  for (int i = 0; i < KNOWN; i++) {
    twins w;
    double closed[MOST], found[MOST], accuracy, size = 0;
    char how[160];
    open_twins(&w, known[i].spec);
    CHECK(!stf_subject_pair(&w.named, closed, &accuracy, how, sizeof how));
    for (int m = 0; m < w.named.n; m++) size = fmax(size, fabs(closed[m]));
    CHECK(accuracy <
          1e-11 * size); /* their own error bar; the last digits are those of eigenvectors */
    CHECK(!stf_subject_pair(&w.plain, found, &accuracy, how, sizeof how));
    CHECK(strstr(how, "radau:s=5") && accuracy < 1e-8);
    for (int m = 0; m < w.named.n; m++)
      CLOSE_FLOOR(found[m], closed[m], known[i].tolerance, size);
    close_twins(&w);
  }
}

/* Staircase, contour and Drazin formulas with 40 digits agree. */
static void five_by_five(void)
{
  static const double paired[] = {39.5766969234249, 40.5487357059799, -39.4580672725173,
                                  4.87926131714857, 1.5612155130093e-4};
  twins w;
  double value[MOST], accuracy;
  char how[160];
  open_twins(&w, "ut5");
  CHECK(!stf_subject_pair(&w.named, value, &accuracy, how, sizeof how));
  for (int m = 0; m < 5; m++) CLOSE_FLOOR(value[m], paired[m], 2e-14, 40);
  CHECK(!stf_subject_pair(&w.plain, value, &accuracy, how, sizeof how));
  for (int m = 0; m < 5; m++) CLOSE_FLOOR(value[m], paired[m], 1e-12, 40);
  close_twins(&w);
}

/* The circuit takes 40 000 steps: their rounding errors of eps each add up to 1e-11 of what they are
 * multiplied by. */
static void pencils_follow_closed_solutions(void)
{
  static const double t[] = {0, 1e-4, 0.013, 0.25, 0.7, 1};
  enum { TIMES = sizeof t / sizeof *t };
  for (int i = 0; i < KNOWN; i++) {
    twins w;
    double closed[TIMES * MOST], found[TIMES * MOST], size = 0;
    open_twins(&w, known[i].spec);
    CHECK(!stf_subject_smooth(&w.named, TIMES, t, closed));
    CHECK(!stf_subject_smooth(&w.plain, TIMES, t, found));
    const int n = w.named.n;
    for (int k = 0; k < TIMES * n; k++) size = fmax(size, fabs(closed[k]));
    for (int k = 0; k < TIMES * n; k++) CLOSE_FLOOR(found[k], closed[k], 1e-10, size);
    close_twins(&w);
  }
}

/* Where nothing is closed, convolution quadrature of order p arrives with order p. */
static void quadrature_agrees(void)
{
  static const char *const spec[] = {"springs:n=20,c=2", "blocks:nf=4,sizes=3.2.1",
                                     "stokes:m=4", "hidden:n=10,c=1,lambda=40"};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4; i++) {
    steif_weak_row row[3];
    steif_weak_result result;
    const steif_weak_query query = {.method = "bdf:p=3",
                                    .problem = spec[i],
                                    .convention = STEIF_C,
                                    .start = "cq",
                                    .h = 1.0 / 256,
                                    .rows = 3,
                                    .component = STEIF_ALL};
    CHECK(!steif_weak_measure(ctx, &query, row, &result));
    CHECK(result.converges == 1 && result.accuracy < 1e-9 * result.exact);
    const int good = fabs(row[2].order - 3) < 0.2;
    CHECK(good);
    if (!good) printf("\n  %s: %s; %s", spec[i], result.verdict, steif_message(ctx));
  }
  steif_context_free(&ctx);
}

/* 2-norms over the components and the components by themselves; the errors of the table: 40 to 60
 * digits by recurrences that share nothing with the library. */
static void all_components_at_once(void)
{
  static const double error[4] = {0.618956, 0.0893707, 0.0119903, 1.55222e-3};
  steif_context *ctx = steif_context_new(NULL);
  double value[4 * 5], exact[5];
  steif_weak_row row[4], one[4];
  steif_weak_result result, single;
  steif_weak_query query = {.method = "bdf:p=3",
                            .problem = "ut5",
                            .convention = STEIF_C,
                            .start = "cq",
                            .h = 1.0 / 16,
                            .rows = 4,
                            .component = STEIF_ALL,
                            .values = value,
                            .exacts = exact};
  CHECK(!steif_weak_measure(ctx, &query, row, &result) && result.index == 3);
  for (int i = 0; i < 4; i++) CLOSE(row[i].error, error[i], 1e-5);
  query.component = 3;
  CHECK(!steif_weak_measure(ctx, &query, one, &single));
  CLOSE(single.exact, exact[3], 0);
  for (int i = 0; i < 4; i++) CLOSE(one[i].value, value[5 * i + 3], 0);
  query.component = 5;
  CHECK(steif_weak_measure(ctx, &query, one, &single) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* On Jordan blocks the layer of the pencil is that of the block. */
static void layers_are_as_long(void)
{
  static const char *const method[] = {"be", "bdf:p=2", "radau:s=3"};
  enum { STEPS = 24 };
  for (int k = 2; k <= 4; k++)
    for (int i = 0; i < 3; i++) {
      twins w;
      char spec[32];
      static double t[2][STEPS + 1], x[2][4 * STEPS + 4], exact[2][4 * STEPS + 4],
        error[2][STEPS + 1];
      steif_layer_result block, plain;
      snprintf(spec, sizeof spec, "jordan:k=%d,case=N-inc", k);
      open_twins(&w, spec);
      CHECK(!steif_layer_measure(w.ctx, method[i], spec, "constant", 0.01, STEPS, t[0], x[0],
                                 exact[0], error[0], &block) ||
            i == 2);
      if (i == 2)
        CHECK(!steif_layer_measure(w.ctx, method[i], spec, NULL, 0.01, STEPS, t[0], x[0],
                                   exact[0], error[0], &block));
      CHECK(!steif_layer_linear(w.ctx, method[i], &w.linear, w.problem.y0,
                                i == 2 ? NULL : "constant", 0.01, STEPS, t[1], x[1], exact[1],
                                error[1], &plain));
      CHECK(block.layer_steps == plain.layer_steps && plain.index == k);
      for (int j = 0; j <= STEPS; j++) CLOSE_FLOOR(error[1][j], error[0][j], 1e-6, 1e-6);
      close_twins(&w);
    }
}

static int clipped(sunrealtype t, int q, N_Vector g, void *user)
{
  (void)t, (void)user;
  N_VConst(0.5, g);
  return q > 0;
}

static void bad_requests_are_refused(void)
{
  twins w;
  double x[MOST] = {0};
  stf_subject s;
  open_twins(&w, "ut5");
  CHECK(stf_subject_open(w.ctx, NULL, &w.linear, NULL, &s) == STEIF_BAD_INPUT);
  CHECK(stf_subject_open(w.ctx, "rober", NULL, NULL, &s) == STEIF_UNSUPPORTED);
  CHECK(stf_subject_open(w.ctx, NULL, NULL, NULL, &s) == STEIF_BAD_INPUT);
  w.linear.f = clipped;
  CHECK(stf_subject_open(w.ctx, NULL, &w.linear, x, &s) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(w.ctx), "derivative 1"));
  close_twins(&w);
}

static void every_allocation_may_fail(void)
{
  int code = STEIF_NO_MEMORY;
  long refused = 0;
  for (long at = 1; code && at < 3000; at++) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    steif_weak_row row[1];
    steif_weak_result result;
    const steif_weak_query query = {.method = "be",
                                    .problem = at % 2 ? "impact" : "blocks:nf=2,sizes=2",
                                    .convention = STEIF_R,
                                    .h = 0.5,
                                    .rows = 1,
                                    .component = STEIF_ALL};
    f.refuse_at = f.served + at;
    code = steif_weak_measure(ctx, &query, row, &result);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    refused += code != 0;
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
  CHECK(!code && refused > 50);
}

CU_TestInfo tests_of_subject[] = {
  {"a pencil pairs as its closed formulas do", pencils_pair_as_closed_formulas},
  {"UT5 pairs to fifteen digits", five_by_five},
  {"a pencil follows its closed solution", pencils_follow_closed_solutions},
  {"CQ-BDF-3 tends to the pairing with order 3", quadrature_agrees},
  {"all components at once are each by itself", all_components_at_once},
  {"layers of a pencil and of its block are as long", layers_are_as_long},
  {"bad requests are refused", bad_requests_are_refused},
  {"every allocation may fail", every_allocation_may_fail},
  CU_TEST_INFO_NULL};
