/* test_scale.c: the model of runs over ranks: its limits, and counts that it stands on.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scale.h"
#include "suite.h"

static const char *const methods[] = {"bdf", "radau:s=3", "cvode"};

/* A cycle exchanges faces four times on every inner grid, and once on the last; on the finest three times, beside
 * those of f and of products. Sums are those that the library counts. */
static void counts(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    scale_run run = {.rtol = 1e-4};
    snprintf(run.method, sizeof run.method, "%s", methods[m]);
    CHECK(scale_measure(ctx, 15, 0, &run) == STEIF_OK);
    const long cycles = run.network.cycles;
    CHECK(run.levels == 4 && run.n == 15 * 15 * 15 && cycles > run.iterations);
    for (int l = 1; l < run.levels - 1; l++) CHECK(run.network.exchange[l] == 4 * cycles);
    CHECK(run.network.exchange[run.levels - 1] == cycles);
    CHECK(run.network.exchange[0] >= 3 * cycles + run.iterations + run.steps);
    CHECK(run.network.sums >= run.iterations + run.steps);
    CHECK(m == 2 ? run.reductions == 0 : run.reductions == run.network.sums);
    CHECK(run.error < 1e-3 && run.error > 0);
  }
  steif_context_free(&ctx);
}

/* The cycles are a good preconditioner: as many iterations on a grid of eight times the points. */
static void grids(void)
{
  steif_context *ctx = steif_context_new(NULL);
  long a_step[2];
  for (int k = 0; k < 2; k++) {
    scale_run run = {.rtol = 1e-4, .method = "radau:s=3"};
    CHECK(scale_measure(ctx, k ? 15 : 7, 0, &run) == STEIF_OK);
    a_step[k] = 100 * run.network.cycles / run.steps;
  }
  CHECK(a_step[1] < 2 * a_step[0] && a_step[1] <= 2500);
  steif_context_free(&ctx);
}

static void limits(void)
{
  const scale_run run = {
    .n = 1000,
    .levels = 4,
    .steps = 10,
    .cpu_s = 0.01,
    .network = {.sums = 90, .exchange = {500, 400, 400, 100}, .cycles = 100}};
  const scale_machine free_of_cost = {.latency = 0, .bandwidth = INFINITY, .rows = 24000};
  const scale_machine slow = {.latency = 2e-6, .bandwidth = 1e10, .rows = 24000};
  const scale_machine slower = {.latency = 4e-6, .bandwidth = 1e10, .rows = 24000};
  CLOSE(scale_price_of(&run, &slow, 1).work, 0.24, 1e-14);
  CHECK(scale_price_of(&run, &slow, 1).efficiency == 1);
  CHECK(scale_price_of(&run, &free_of_cost, 4096).efficiency == 1);
  double last = 1;
  for (double ranks = 8; ranks < 1e5; ranks *= 8) {
    const scale_price p = scale_price_of(&run, &slow, ranks),
                      q = scale_price_of(&run, &slower, ranks);
    CLOSE(p.sums, 100 * ceil(log2(ranks)) * 2e-6, 1e-14);
    CLOSE(p.fine, 500 * 6 * (2e-6 + 8 * pow(24000, 2. / 3) / 1e10), 1e-14);
    CHECK(p.efficiency < last && q.efficiency < p.efficiency);
    last = p.efficiency;
  }
}

/* Delays at every sum and exchange are slept: the run lasts no less, and comes to the same numbers. */
static void delays(void)
{
  steif_context *ctx = steif_context_new(NULL);
  scale_run quick = {.rtol = 1e-3, .method = "bdf"}, slow = quick;
  CHECK(scale_measure(ctx, 7, 0, &quick) == STEIF_OK);
  CHECK(scale_measure(ctx, 7, 1e-5, &slow) == STEIF_OK);
  double waits = (double)slow.network.sums;
  for (int l = 0; l < slow.levels; l++) waits += (double)slow.network.exchange[l];
  CHECK(slow.clock_s >= waits * 1e-5);
  CHECK(slow.network.sums == quick.network.sums && slow.error == quick.error);
  steif_context_free(&ctx);
}

static void bad_input(void)
{
  steif_context *ctx = steif_context_new(NULL);
  scale_run run = {.rtol = 1e-3, .method = "nothing"};
  CHECK(scale_measure(ctx, 7, 0, &run) == STEIF_UNKNOWN_NAME);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_scale[] = {{"exchanges and sums of a run", counts},
                                {"cycles serve every grid", grids},
                                {"limits of the model", limits},
                                {"delays are slept", delays},
                                {"bad input", bad_input},
                                CU_TEST_INFO_NULL};
