/* lyapunov_answer.c: Lyapunov exponents, their checks and measures of one solution, as a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include "members.h"
#include <math.h>

static void checks(steif_report *r, const struct lyapunov_answer *a)
{
  static const struct member members[] = {
    {"law", A_TEXT, offsetof(steif_lyapunov_check, name)},
    {"exponent", A_WHOLE, offsetof(steif_lyapunov_check, which)},
    MEMBER(steif_lyapunov_check, value, A_REAL),
    MEMBER(steif_lyapunov_check, expected, A_REAL),
    MEMBER(steif_lyapunov_check, tolerance, A_REAL),
    MEMBER(steif_lyapunov_check, holds, A_TRUTH),
    MEMBERS_END};
  for (int i = 0; i < a->checks; i++) {
    steif_report_row(r, "checks");
    report_members(r, "checks.", members, &a->check[i]);
  }
}

static void separations(steif_report *r, const struct lyapunov_answer *a)
{
  static const struct member members[] = {
    MEMBER(steif_separation, window, A_NUMBER),   MEMBER(steif_separation, low, A_NUMBER),
    MEMBER(steif_separation, high, A_NUMBER),     MEMBER(steif_separation, spread, A_NUMBER),
    MEMBER(steif_separation, separated, A_TRUTH), MEMBERS_END};
  for (size_t i = 0; i + 1 < a->count; i++) {
    steif_report_row(r, "separation");
    steif_report_whole(r, "separation.exponent", (long)i + 1);
    report_members(r, "separation.", members, &a->separation[i]);
  }
}

/* Every measure of one solution of a linear problem. */
static void diagnostics(steif_report *r, const steif_growth_facts *g)
{
  const struct {
    const char *name;
    double value;
  } row[] = {{"mu", g->mu},
             {"mu_last", g->mu_last},
             {"mu_window", g->mu_window},
             {"mu_running", g->mu_running},
             {"mu_partial", g->mu_partial},
             {"lte_mean", g->lte_mean},
             {"lte_max", g->lte_max},
             {"residual_mean", g->residual_mean},
             {"residual_max", g->residual_max},
             {"local_mean", g->local_mean},
             {"local_max", g->local_max},
             {"tau_max", g->tau_max},
             {"tau_all", g->tau_all},
             {"norm_max", g->norm_max},
             {"norm_end", g->norm_end}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_report_row(r, "diagnostics");
    steif_report_text(r, "diagnostics.quantity", row[i].name);
    report_maybe(r, "diagnostics.", "found", isfinite(row[i].value), row[i].value);
  }
}

/* The equation, the numbers and what that says of the step. */
static void fill_decay(steif_report *r, const struct lyapunov_answer *a)
{
  static const struct member rates[] = {
    MEMBER(steif_decay, lambda, A_REAL),
    MEMBER(steif_decay, lambda_error, A_REAL),
    {"numbers", A_REAL, offsetof(steif_decay, mu)},
    {"numbers_error", A_REAL, offsetof(steif_decay, mu_error)},
    MEMBER(steif_decay, rise, A_REAL),
    MEMBER(steif_decay, rise_numbers, A_REAL),
    MEMBERS_END};
  const steif_decay *d = &a->decay;
  steif_report_text(r, "verdict", d->sentence);
  if (!a->judged) return;
  steif_report_whole(r, "decision", d->verdict);
  report_members(r, "", rates, d);
  if (d->period > 0) {
    steif_report_real(r, "period", d->period);
    steif_report_truth(r, "period_found", d->found);
  }
  if (d->h_good > 0) {
    steif_report_real(r, "h_star", d->h_good);
    report_maybe(r, "", "h_too_long", d->h_bad < 1e300, d->h_bad);
  }
  if (d->most > 0) {
    steif_report_whole(r, "steps_least", d->least);
    steif_report_whole(r, "steps_most", d->most);
    steif_report_truth(r, "tail", d->tail);
  }
}

/* The mean of trace J: of the equation, and at the stages of the steps. */
static void fill_trace(steif_report *r, const struct lyapunov_answer *a)
{
  const bool known = a->checks > 0 && a->check[0].law == STEIF_SUM_LAW;
  report_maybe(r, "", "trace", known, known ? a->check[0].expected : 0);
  report_maybe(r, "", "trace_sampled", isfinite(a->facts.trace), a->facts.trace);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const struct member members[] = {
    MEMBER(steif_lyapunov_facts, sum, A_REAL), MEMBER(steif_lyapunov_facts, linear, A_TRUTH),
    MEMBER(steif_lyapunov_facts, steps, A_LONG), MEMBERS_END};
  const struct lyapunov_answer *a = result;
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  fill_decay(r, a);
  steif_report_list(r, "exponents", a->count, a->exponent);
  steif_report_list(r, "errors", a->count, a->error);
  steif_report_matrix(r, "intervals", a->count, 2, a->interval);
  report_maybe(r, "", "dimension", a->facts.dimension >= 0, a->facts.dimension);
  const double mu = a->measured ? a->growth.mu : a->facts.mu;
  report_maybe(r, "", "mu", isfinite(mu), mu);
  report_maybe(r, "", "lte_mean", a->measured, a->growth.lte_mean);
  report_maybe(r, "", "lte_max", a->measured, a->growth.lte_max);
  report_maybe(r, "", "tau_max", a->measured, a->growth.tau_max);
  report_members(r, "", members, &a->facts);
  fill_trace(r, a);
  report_steps(
    r,
    &(struct steps_made){
      .t0 = a->t0, .h = a->facts.h, .end = a->facts.end, .last_h = a->facts.h, .asked = a->t1});
  checks(r, a);
  separations(r, a);
  if (a->measured) diagnostics(r, &a->growth);
}

static void fill_rows(steif_report *r, const struct call *call, const void *result)
{
  const struct lyapunov_answer *a = result;
  (void)call;
  for (size_t i = 0; i < a->count; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.exponent", a->exponent[i]);
    steif_report_real(r, "rows.error", a->error[i]);
    steif_report_real(r, "rows.low", a->interval[2 * i]);
    steif_report_real(r, "rows.high", a->interval[2 * i + 1]);
  }
}

int lyapunov_present(const struct call *call, const struct lyapunov_answer *a)
{
  const int code = show_result(call, fill, a);
  const int saved = code ? code : save_rows(call, fill_rows, a);
  if (saved || a->decided) return saved;
  say(call, "%s", a->decay.sentence);
  return EXIT_UNCERTIFIED;
}
