/* kernel_report.c: steps against their kernels, row by row.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "kernels.h"
#include "sundials_build.h"

static void add(steif_report *r, const steif_bench_row *row)
{
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.kind", row->kind);
  steif_report_text(r, "rows.problem", row->problem);
  steif_report_whole(r, "rows.n", (long)row->n);
  steif_report_text(r, "rows.method", row->method);
  report_maybe(r, "rows.", "h", row->h > 0, row->h);
  report_maybe(r, "rows.", "rtol", row->rtol > 0, row->rtol);
  report_maybe(r, "rows.", "atol", row->rtol > 0, row->atol);
  steif_report_real(r, "rows.step_us", 1e6 * row->step_s);
  steif_report_real(r, "rows.floor_us", 1e6 * row->floor_s);
  steif_report_real(r, "rows.ratio", row->ratio);
  steif_report_real(r, "rows.limit", row->limit);
}

int bench_end(struct call *call, int code)
{
  if (!interrupted()) return code;
  say(call, "interrupted: what is left of the benchmark is not made [STEIF_STOPPED]");
  return interruption_exit();
}

int bench_present(struct call *call, steif_report **r)
{
  progress(call, NULL);
  if (interrupted()) steif_forget(call->ctx);
  const int code = *r && !steif_status(call->ctx) ? present(call, *r) : fail(call);
  steif_report_free(r);
  return bench_end(call, code);
}

static int against_kernels(struct call *call, const char *name,
                           int (*measure)(steif_context *ctx, size_t i, steif_bench_row *row))
{
  steif_report *r = steif_report_new(call->ctx);
  steif_bench_row row;
  char build[160];
  const double sums = sundials_describe(call->ctx, build, sizeof build);
  steif_report_text(r, "benchmark", name);
  steif_report_text(r, "sundials", build);
  steif_report_real(r, "sundials_vectors", sums);
  for (size_t i = 0; r && !interrupted() && !measure(call->ctx, i, &row); i++) {
    add(r, &row);
    rows_come(call, r);
    progress(call, "%s %s %s", row.kind, row.problem, row.method);
  }
  return bench_present(call, &r);
}

int bench_step(struct call *call) { return against_kernels(call, "step", steif_bench_step); }

int bench_cost_accounting(struct call *call)
{
  return against_kernels(call, "books", steif_bench_cost_accounting);
}

int bench_model(struct call *call) { return against_kernels(call, "model", steif_bench_model); }

int bench_lyapunov(struct call *call)
{
  return against_kernels(call, "lyapunov", steif_bench_lyapunov);
}
