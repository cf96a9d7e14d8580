/* bench.c: costs as ratios in one run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bench.h"
#include <string.h>

static void add(steif_report *r, const steif_bench_row *row)
{
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.kind", row->kind);
  steif_report_text(r, "rows.problem", row->problem);
  steif_report_whole(r, "rows.n", (long)row->n);
  steif_report_text(r, "rows.method", row->method);
  steif_report_real(r, "rows.step_us", 1e6 * row->step_s);
  steif_report_real(r, "rows.floor_us", 1e6 * row->floor_s);
  steif_report_real(r, "rows.ratio", row->ratio);
  steif_report_real(r, "rows.limit", row->limit);
}

static int against_kernels(struct call *call, const char *name,
                           int (*measure)(steif_context *ctx, size_t i, steif_bench_row *row))
{
  steif_report *r = steif_report_new(call->ctx);
  steif_bench_row row;
  steif_report_text(r, "benchmark", name);
  for (size_t i = 0; !measure(call->ctx, i, &row); i++) {
    progress(call, "%s %s %s", row.kind, row.problem, row.method);
    add(r, &row);
  }
  progress(call, NULL);
  const int shown = steif_status(call->ctx) ? fail(call) : present(call, r);
  steif_report_free(&r);
  return shown;
}

int bench_step(struct call *call) { return against_kernels(call, "step", steif_bench_step); }

static int bench_books(struct call *call)
{
  return against_kernels(call, "books", steif_bench_books);
}

static int bench_lyapunov(struct call *call)
{
  return against_kernels(call, "lyapunov", steif_bench_lyapunov);
}

static const struct {
  const char *name;
  int (*run)(struct call *call);
} benchmarks[] = {{"step", bench_step},
                  {"books", bench_books},
                  {"workprec", bench_workprec},
                  {"impulse", bench_impulse},
                  {"phi", bench_phi},
                  {"lyapunov", bench_lyapunov},
                  {"lorenz", bench_lorenz}};
enum { BENCHMARKS = sizeof benchmarks / sizeof *benchmarks };

static const char *name_at(const void *list, size_t i)
{
  (void)list;
  return i < BENCHMARKS ? benchmarks[i].name : NULL;
}

static int run(struct call *call)
{
  const char *name = call->words ? call->word[0] : "step";
  for (size_t i = 0; i < BENCHMARKS; i++)
    if (!strcmp(name, benchmarks[i].name)) return benchmarks[i].run(call);
  return refuse(call, "no benchmark '%s'; the nearest is '%s'", name,
                nearest(name, name_at, NULL));
}

static const struct option options[] = {
  {"--problems", WORD, "a,b,c", "workprec: instead of the usual ones; impulse: one"},
  {"--methods", WORD, "a,b,c", "workprec: instead of the usual ones; baselines among them"},
  {"--rtols", REALS, "a,b,c", "workprec: relative tolerances (default 1e-1, 1e-2 ... 1e-11)"},
  {"--longest", POSITIVE, "S", "a solve ends after S processor seconds (default 2; phi: 10)"},
  {"--runs", FLAG, NULL, "workprec: every run as well, not the best ones alone"},
  {NULL, FLAG, NULL, NULL}};

const struct verb verb_bench = {
  "bench",
  "Measure steps against their kernels, solves against CVODE, IDA, ARKODE",
  "[step|books|workprec|impulse|phi|lyapunov|lorenz]",
  0,
  1,
  options,
  NULL,
  run};
