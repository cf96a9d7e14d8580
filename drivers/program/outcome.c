/* outcome.c: what came of an integration, as fields and rows of a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integration.h"
#include "members.h"

double tolerance_ratio(const steif_problem *problem, const steif_options *options)
{
  const double scale = problem->rtol_scale > 0 ? problem->rtol_scale : 1;
  return options->atol > 0 && options->rtol > 0 ? options->atol / options->rtol : scale;
}

void report_digits(steif_report *r, const char *prefix, const outcome *o)
{
  report_maybe(r, prefix, "scd", o->known, o->scd);
  report_maybe(r, prefix, "mescd", o->known, o->mescd);
}

void report_status(steif_report *r, const char *prefix, const outcome *o)
{
  char name[96];
  snprintf(name, sizeof name, "%sstatus", prefix);
  steif_report_text(r, name, steif_code_name(o->code));
  snprintf(name, sizeof name, "%smessage", prefix);
  steif_report_text(r, name, o->message);
}

void report_stats(steif_report *r, const char *prefix, const outcome *o)
{
  static const struct member counts[] = {MEMBER(steif_stats, steps, A_LONG),
                                         MEMBER(steif_stats, rejected, A_LONG),
                                         MEMBER(steif_stats, nfe, A_LONG),
                                         MEMBER(steif_stats, nje, A_LONG),
                                         MEMBER(steif_stats, nlu, A_LONG),
                                         MEMBER(steif_stats, nsolve, A_LONG),
                                         MEMBERS_END};
  static const struct member krylov[] = {MEMBER(steif_stats, nli, A_LONG), MEMBERS_END},
                             seconds[] = {MEMBER(steif_stats, cpu_s, A_REAL), MEMBERS_END};
  report_members(r, prefix, counts, &o->stats);
  if (o->stats.nli > 0) report_members(r, prefix, krylov, &o->stats);
  report_members(r, prefix, seconds, &o->stats);
}

void report_run(steif_report *r, const char *method, const steif_problem *problem,
                const steif_options *options, const outcome *o)
{
  const bool steps = options->h > 0;
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.method", method);
  report_maybe(r, "rows.", "rtol", !steps, options->rtol);
  report_maybe(r, "rows.", "atol", !steps, options->rtol * tolerance_ratio(problem, options));
  report_maybe(r, "rows.", "h", steps, options->h);
  report_digits(r, "rows.", o);
  report_status(r, "rows.", o);
  report_stats(r, "rows.", o);
}
