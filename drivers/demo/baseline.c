/* baseline.c: IDA in its best setting on DAEs of index 1 to 4, consistent and inconsistent start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demo.h"
#include "members.h"
#include "layer.h"
#include "settings.h"

/* The first six are followed by backward Euler, too, with h = 1/64. */
static const char *const problems[] = {"jordan:k=2,case=N-cons",
                                       "jordan:k=3,case=N-cons",
                                       "jordan:k=4,case=N-cons",
                                       "jordan:k=2,case=N-inc",
                                       "jordan:k=3,case=N-inc",
                                       "jordan:k=4,case=N-inc",
                                       "pendulum3:index=3",
                                       "bus:n=60",
                                       "switchrlc",
                                       "ladder:n=20"};
enum { PROBLEMS = sizeof problems / sizeof *problems, BLOCKS = 6 };

/* The error of backward Euler at t = 1. */
static int backward_euler(demo *d, size_t i, double *error)
{
  struct layer l = {.k = i % 3 + 2, .steps = 64, .h = 1.0 / 64};
  snprintf(l.problem, sizeof l.problem, "%s", problems[i]);
  const int code = layer_measure(d->call->ctx, &l, "be", NULL) ? fail(d->call) : EXIT_OK;
  if (!code) *error = l.error[l.steps];
  layer_free(&l);
  return code;
}

static int one(demo *d, size_t i)
{
  static settings s;
  known_solution known;
  steif_problem p;
  steif_options o = steif_defaults();
  double euler = 0;
  int code = i < BLOCKS ? backward_euler(d, i, &euler) : EXIT_OK;
  if (code) return code;
  if (steif_problem_find(d->call->ctx, problems[i], &p)) return fail(d->call);
  known_open(d->call, &p, &o, &known);
  settings_run(d->call, &p, "ida", &o, &known, &s);
  known_close(d->call, &known);
  const setting_run *best = &s.run[0];
  steif_report_row(d->report, "ida");
  steif_report_text(d->report, "ida.problem", problems[i]);
  report_best(d->report, "ida", &s);
  steif_report_text(d->report, "ida.verdict", best->verdict);
  steif_report_whole(d->report, "ida.steps", best->out.stats.steps);
  steif_report_real(d->report, "ida.asked", 6);
  report_maybe(d->report, "ida.", "error", !best->out.code, best->end);
  report_maybe(d->report, "ida.", "error_of_be_at_end", i < BLOCKS, euler);
  report_status(d->report, "ida.", &best->out);
  steif_problem_clear(d->call->ctx, &p);
  return EXIT_OK;
}

int demo_baseline(demo *d)
{
  int code = EXIT_OK;
  for (size_t i = 0; i < PROBLEMS && !code && !interrupted(); i++) code = one(d, i);
  return code;
}
