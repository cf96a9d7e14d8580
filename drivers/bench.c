/* bench.c: costs as ratios in one run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
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

static int run(struct call *call)
{
  const char *name = call->words ? call->word[0] : "step";
  if (strcmp(name, "step")) return refuse(call, "no benchmark '%s'; there is 'step'", name);
  steif_report *r = steif_report_new(call->ctx);
  steif_bench_row row;
  steif_report_text(r, "benchmark", name);
  for (size_t i = 0; !steif_bench_step(call->ctx, i, &row); i++) {
    progress(call, "%s %s %s", row.kind, row.problem, row.method);
    add(r, &row);
  }
  progress(call, NULL);
  const int shown = steif_status(call->ctx) ? fail(call) : present(call, r);
  steif_report_free(&r);
  return shown;
}

static const struct option options[] = {{NULL, FLAG, NULL, NULL}};

const struct verb verb_bench = {"bench",
                                "Measure a step against the kernels it needs, as ratios",
                                "[step]",
                                0,
                                1,
                                options,
                                NULL,
                                run};
