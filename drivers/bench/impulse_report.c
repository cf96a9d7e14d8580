/* impulse_report.c: the analysis of large descriptor systems, one process for each.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "impulse_cost.h"
#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void add(steif_report *r, const steif_bench_impulse *row)
{
  static const struct member costs[] = {MEMBER(steif_bench_impulse, problem, A_WORD),
                                        MEMBER(steif_bench_impulse, n, A_INDEX),
                                        MEMBER(steif_bench_impulse, factors, A_LONG),
                                        MEMBER(steif_bench_impulse, refactors, A_LONG),
                                        MEMBER(steif_bench_impulse, solves, A_LONG),
                                        MEMBER(steif_bench_impulse, cpu_s, A_REAL),
                                        MEMBER(steif_bench_impulse, floor_s, A_REAL),
                                        MEMBER(steif_bench_impulse, ratio, A_REAL),
                                        MEMBER(steif_bench_impulse, threads, A_WHOLE),
                                        MEMBER(steif_bench_impulse, wall_s, A_REAL),
                                        MEMBER(steif_bench_impulse, wall_ratio, A_REAL),
                                        MEMBERS_END};
  static const struct member results[] = {
    MEMBER(steif_bench_impulse, peak_mb, A_REAL),
    MEMBER(steif_bench_impulse, bytes_per_unknown, A_REAL),
    MEMBER(steif_bench_impulse, estimate, A_REAL),
    MEMBER(steif_bench_impulse, certified, A_TRUTH), MEMBERS_END};
  const double us = 1e6 / (double)row->n; /* microseconds for each unknown */
  steif_report_row(r, "rows");
  report_members(r, "rows.", costs, row);
  steif_report_real(r, "rows.us_per_unknown", us * row->cpu_s);
  steif_report_real(r, "rows.floor_us_per_unknown", us * row->floor_s);
  steif_report_real(r, "rows.analyse_us_per_unknown", us * row->analyse_s);
  report_members(r, "rows.", results, row);
}

/* The row, out of a process of its own: peak memory does not fall again. */
static int apart(struct call *call, const char *problem, steif_bench_impulse *row)
{
  int end[2], status = 0;
  if (pipe(end)) {
    say(call, "no pipe to measure %s in a process of its own [STEIF_IO]", problem);
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
  if (child > 0 && interrupted()) kill(child, SIGKILL);
  if (child > 0) waitpid(child, &status, 0);
  if (interrupted()) return EXIT_FAILED;
  if (got && WIFEXITED(status)) return WEXITSTATUS(status);
  say(call,
      "%s could not be measured: its process did not end by itself; is memory short? "
      "[STEIF_NO_MEMORY]",
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

/* Problem i of --problems, or of the usual plan; NULL past the end. */
static const char *problem_at(const struct call *call, size_t i)
{
  const char *only = word_of(call, "--problems");
  if (!only) return steif_bench_system(i);
  return i == 0 ? only : NULL;
}

int bench_impulse(struct call *call)
{
  enum { ROWS = 32 };
  static steif_bench_impulse row[ROWS];
  const char *problem;
  size_t rows = 0;
  steif_report *r = steif_report_new(call->ctx);
  int code = r ? EXIT_OK : fail(call);
  for (size_t i = 0; !code && i < ROWS && (problem = problem_at(call, i)); i++) {
    progress(call, "%s", problem);
    code = apart(call, problem, &row[i]);
    if (code) break;
    add(r, &row[i]);
    rows_come(call, r);
    rows++;
  }
  if (!code || interrupted()) {
    grow(r, row, rows);
    code = present(call, r);
  }
  steif_report_free(&r);
  return bench_end(call, code);
}
