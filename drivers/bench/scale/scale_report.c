/* scale_report.c: what runs over ranks would cost.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "scale.h"
#include "timing.h"
#include <string.h>

/* Names of the loosest tolerance that gives about 5 digits, where the user names none. */
static const struct {
  const char *method;
  double rtol;
} usual[] = {{"bdf", 1e-4}, {"radau:s=3", 1e-3}, {"cvode", 1e-6}};
enum { USUAL = sizeof usual / sizeof *usual };

static void add_run(steif_report *r, const scale_run *run)
{
  steif_report_row(r, "runs");
  steif_report_text(r, "runs.method", run->method);
  steif_report_real(r, "runs.rtol", run->rtol);
  steif_report_real(r, "runs.error", run->error);
  steif_report_whole(r, "runs.steps", run->steps);
  steif_report_whole(r, "runs.iterations", run->iterations);
  steif_report_whole(r, "runs.cycles", run->network.cycles);
  steif_report_whole(r, "runs.setups", run->network.setups);
  steif_report_whole(r, "runs.sums", run->network.sums);
  steif_report_whole(r, "runs.exchanges", run->network.exchange[0]);
  steif_report_real(r, "runs.work_us", 1e6 * run->cpu_s / (double)run->n);
}

static void add_price(steif_report *r, const scale_run *run, const scale_machine *m,
                      double ranks)
{
  const scale_price p = scale_price_of(run, m, ranks);
  steif_report_row(r, "prices");
  steif_report_text(r, "prices.method", run->method);
  steif_report_whole(r, "prices.ranks", (long)ranks);
  steif_report_real(r, "prices.work_s", p.work);
  steif_report_real(r, "prices.sums_s", p.sums);
  steif_report_real(r, "prices.fine_s", p.fine);
  steif_report_real(r, "prices.coarse_s", p.coarse);
  steif_report_real(r, "prices.efficiency", p.efficiency);
}

/* The same run with a delay at every sum and exchange: what the counts predict, and the clock. */
static int check(struct call *call, steif_report *r, int side, const scale_run *run)
{
  const double delay = real_of(call, "--delay"), lasts = scale_sleep_lasts(delay);
  scale_run slow = *run;
  progress(call, "%s, delayed", run->method);
  STEIF_TRY(scale_measure(call->ctx, side, delay, &slow));
  double waits = (double)run->network.sums;
  for (int l = 0; l < run->levels; l++) waits += (double)run->network.exchange[l];
  steif_report_row(r, "check");
  steif_report_text(r, "check.method", run->method);
  steif_report_real(r, "check.delay_us", 1e6 * lasts);
  steif_report_whole(r, "check.counted", (long)waits);
  const double predicted = run->clock_s + waits * lasts;
  steif_report_real(r, "check.predicted_s", predicted);
  steif_report_real(r, "check.clock_s", slow.clock_s);
  steif_report_real(r, "check.ratio", slow.clock_s / predicted);
  return STEIF_OK;
}

static int one(struct call *call, steif_report *r, const char *method, double rtol)
{
  const scale_machine machine = {.latency = real_of(call, "--latency"),
                                 .bandwidth = real_of(call, "--bandwidth"),
                                 .rows = real_of(call, "--rows")};
  const int side = (1 << whole_of(call, "--grid")) - 1;
  const double most = (double)whole_of(call, "--ranks");
  scale_run run = {.rtol = rtol};
  snprintf(run.method, sizeof run.method, "%s", method);
  progress(call, "%s, %d^3 points", method, side);
  STEIF_TRY(scale_measure(call->ctx, side, 0, &run));
  add_run(r, &run);
  for (double ranks = 1; ranks < most; ranks *= 8) add_price(r, &run, &machine, ranks);
  add_price(r, &run, &machine, most);
  rows_come(call, r);
  return real_of(call, "--delay") > 0 ? check(call, r, side, &run) : STEIF_OK;
}

static int all(struct call *call, steif_report *r)
{
  const char *list = word_of(call, "--methods");
  double rtol[REALS_MOST];
  const bool told = given(call, "--rtols");
  if (told) reals_of(call, "--rtols", rtol);
  for (int i = 0; !list && i < USUAL && !interrupted(); i++)
    STEIF_TRY(one(call, r, usual[i].method, told ? rtol[0] : usual[i].rtol));
  while (list && *list && !interrupted()) {
    char name[STEIF_SPEC_WORD];
    const size_t size = strcspn(list, ",");
    snprintf(name, sizeof name, "%.*s", (int)size, list);
    STEIF_TRY(one(call, r, name, told ? rtol[0] : 1e-4));
    list += size + (list[size] == ',');
  }
  return STEIF_OK;
}

int bench_scale(struct call *call)
{
  if (whole_of(call, "--grid") > 8) {
    say(call, "--grid is at most 8, which is 255^3 points");
    return EXIT_USAGE;
  }
  steif_report *r = steif_report_new(call->ctx);
  const int side = (1 << whole_of(call, "--grid")) - 1;
  steif_report_text(r, "benchmark", "scale");
  steif_report_whole(r, "unknowns", (long)side * side * side);
  steif_report_real(r, "rows", real_of(call, "--rows"));
  steif_report_real(r, "latency_s", real_of(call, "--latency"));
  steif_report_real(r, "bandwidth", real_of(call, "--bandwidth"));
  if (r) all(call, r);
  return bench_present(call, &r);
}
