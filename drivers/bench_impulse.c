/* bench_impulse.c: the analysis of large descriptor systems, one process for each.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bench.h"
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void add(steif_report *r, const steif_bench_impulse *row)
{
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.problem", row->problem);
  steif_report_whole(r, "rows.n", (long)row->n);
  steif_report_whole(r, "rows.factors", row->factors);
  steif_report_whole(r, "rows.refactors", row->refactors);
  steif_report_whole(r, "rows.solves", row->solves);
  steif_report_real(r, "rows.cpu_s", row->cpu_s);
  steif_report_real(r, "rows.floor_s", row->floor_s);
  steif_report_real(r, "rows.ratio", row->ratio);
  steif_report_whole(r, "rows.threads", row->threads);
  steif_report_real(r, "rows.wall_s", row->wall_s);
  steif_report_real(r, "rows.wall_ratio", row->wall_ratio);
  steif_report_real(r, "rows.us_per_unknown", 1e6 * row->cpu_s / (double)row->n);
  steif_report_real(r, "rows.floor_us_per_unknown", 1e6 * row->floor_s / (double)row->n);
  steif_report_real(r, "rows.analyse_us_per_unknown", 1e6 * row->analyse_s / (double)row->n);
  steif_report_real(r, "rows.peak_mb", row->peak_mb);
  steif_report_real(r, "rows.bytes_per_unknown", row->bytes_per_unknown);
  steif_report_real(r, "rows.estimate", row->estimate);
  steif_report_truth(r, "rows.certified", row->certified);
}

/* The row, out of a process of its own: peak memory does not fall again. */
static int apart(struct call *call, const char *problem, steif_bench_impulse *row)
{
  int end[2], status = 0;
  if (pipe(end)) {
    say(call, "no pipe to measure %s in a process of its own", problem);
    return EXIT_FAILED;
  }
  const pid_t child = fork();
  if (child == 0) {
    const int code = steif_bench_circles(call->ctx, problem, row) ? fail(call) : EXIT_OK;
    const bool sent = write(end[1], row, sizeof *row) == (ssize_t)sizeof *row;
    _exit(code ? code : sent ? EXIT_OK : EXIT_FAILED);
  }
  close(end[1]);
  const bool got = child > 0 && read(end[0], row, sizeof *row) == (ssize_t)sizeof *row;
  close(end[0]);
  if (child > 0) waitpid(child, &status, 0);
  if (got && WIFEXITED(status)) return WEXITSTATUS(status);
  say(call, "%s could not be measured: its process did not end by itself; is memory short?",
      problem);
  return EXIT_FAILED;
}

/* One line for each family, where its first row stands. */
static void grow(steif_report *r, const steif_bench_impulse *row, size_t count)
{
  for (size_t i = 0; i < count; i++) {
    const steif_bench_growth g = steif_bench_exponents(row, count, i);
    bool first = true;
    for (size_t k = 0; k < i; k++)
      first = first && strcmp(steif_bench_exponents(row, count, k).family, g.family);
    if (!first || g.rows < 2) continue;
    steif_report_row(r, "growth");
    steif_report_text(r, "growth.family", g.family);
    steif_report_whole(r, "growth.sizes", g.rows);
    steif_report_real(r, "growth.cpu_exponent", g.cpu);
    steif_report_real(r, "growth.floor_exponent", g.floor);
  }
}

int bench_impulse(struct call *call)
{
  enum { ROWS = 32 };
  static steif_bench_impulse row[ROWS];
  size_t rows = 0;
  steif_report *r = steif_report_new(call->ctx);
  const char *only = word_of(call, "--problems", NULL), *problem;
  int code = r ? EXIT_OK : fail(call);
  for (size_t i = 0; !code && i < ROWS &&
                     (problem = only && !i ? only
                                : only     ? NULL
                                           : steif_bench_system(i));
       i++) {
    progress(call, "%s", problem);
    code = apart(call, problem, &row[i]);
    if (!code) add(r, &row[i]), rows++;
  }
  if (!code) grow(r, row, rows);
  if (!code) code = present(call, r);
  steif_report_free(&r);
  return code;
}
