/* success_report.c: the campaign as a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "success.h"
#include <math.h>
#include <stdlib.h>

static int by_size(const void *a, const void *b)
{
  const sunrealtype x = *(const sunrealtype *)a, y = *(const sunrealtype *)b;
  return (x > y) - (x < y);
}

/* Of runs that say ok and are known to be looked at. */
static bool counts(const success_run *run) { return run->code == STEIF_OK && !run->told; }

static sunrealtype at_end(const success_run *run) { return run->error; }
static sunrealtype on_the_way(const success_run *run) { return run->whole; }

/* Of what is known. */
static sunrealtype median(const success_runs *all, sunrealtype (*of)(const success_run *))
{
  static sunrealtype error[SUCCESS_RUNS];
  size_t count = 0;
  for (size_t i = 0; i < all->count; i++)
    if (counts(&all->run[i]) && !isnan(of(&all->run[i]))) error[count++] = of(&all->run[i]);
  qsort(error, count, sizeof *error, by_size);
  return count ? error[count / 2] : NAN;
}

static void one_run(steif_report *r, const char *method, const success_run *run)
{
  steif_report_row(r, "runs");
  steif_report_text(r, "runs.method", method);
  steif_report_text(r, "runs.problem", run->problem);
  steif_report_real(r, "runs.rtol", run->rtol);
  steif_report_text(r, "runs.status", run->late ? "time is up" : steif_code_name(run->code));
  steif_report_whole(r, "runs.steps", run->steps);
  steif_report_real(r, "runs.error", run->error);
  steif_report_real(r, "runs.whole", run->whole);
  steif_report_real(r, "runs.levels", run->levels);
  steif_report_real(r, "runs.promised", run->promised);
  steif_report_real(r, "runs.cpu_s", run->cpu_s);
}

void success_report(success_runs *all, bool every, steif_report *r)
{
  long ok = 0, beyond10 = 0, beyond100 = 0, told = 0, late = 0, steps = 0;
  sunrealtype cpu_s = 0;
  for (size_t i = 0; i < all->count; i++) {
    const success_run *run = &all->run[i];
    const bool good = counts(run), off = good && !(run->error <= 10);
    ok += good;
    beyond10 += off;
    beyond100 += good && !(run->error <= 100);
    told += run->told;
    late += run->late;
    cpu_s += run->cpu_s;
    if (good) steps += run->steps;
    if (off || every) one_run(r, all->method, run);
  }
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.method", all->method);
  steif_report_whole(r, "rows.runs", (long)all->count);
  steif_report_whole(r, "rows.ok", ok);
  steif_report_whole(r, "rows.beyond_10", beyond10);
  steif_report_whole(r, "rows.beyond_100", beyond100);
  steif_report_whole(r, "rows.told", told);
  steif_report_whole(r, "rows.failed", (long)all->count - ok - told - late);
  steif_report_whole(r, "rows.late", late);
  steif_report_real(r, "rows.median", median(all, at_end));
  steif_report_real(r, "rows.median_whole", median(all, on_the_way));
  steif_report_whole(r, "rows.steps", steps);
  steif_report_real(r, "rows.cpu_s", cpu_s);
}
