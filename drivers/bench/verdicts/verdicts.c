/* verdicts.c: what verdicts of weak convergence are worth, on random systems whose solution is known.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "verdict_case.h"
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SEEDS = 10000, QUICK = 300 };

/* Words of verdicts that leave a question open. */
static const char *const reasons[] = {"differ; ask for",
                                      "on the way to another",
                                      "fall slowly",
                                      "do not resolve",
                                      "three rows decide",
                                      "rounding from",
                                      "does not see impulses",
                                      "by themselves",
                                      "every part",
                                      "undecided"};
enum { REASONS = sizeof reasons / sizeof *reasons };

typedef struct campaign {
  method_orders known;
  verdict_case one;
  long count[VERDICT_OUTCOMES], of_method[64][VERDICT_OUTCOMES], open[REASONS];
} campaign;

static void give_reason(campaign *p)
{
  int i = 0;
  while (i + 1 < REASONS && !strstr(p->one.result.verdict, reasons[i])) i++;
  p->open[i]++;
}

static void note(steif_report *r, const verdict_case *c, bool runs, const char *message)
{
  const asked_method *a = asked_method_at(c->method);
  if (c->outcome == VERDICT_RIGHT || (c->outcome == VERDICT_OPEN && !runs)) return;
  steif_report_row(r, "others");
  steif_report_text(r, "others.outcome", verdict_outcome_name(c->outcome));
  steif_report_whole(r, "others.seed", c->seed);
  steif_report_text(r, "others.method", a->method);
  steif_report_text(r, "others.start", a->start ? a->start : "-");
  steif_report_whole(r, "others.n", c->system.n);
  steif_report_whole(r, "others.index", c->system.index);
  steif_report_text(r, "others.g", c->g ? c->g : "power:n=8");
  steif_report_real(r, "others.h", c->h);
  steif_report_real(r, "others.truth", c->truth);
  steif_report_real(r, "others.error_over_level", c->off);
  steif_report_text(r, "others.verdict",
                    c->outcome == VERDICT_FAILED ? message : c->result.verdict);
}

static int run(struct call *call, campaign *p, long seeds, steif_report *r)
{
  const long first = whole_or(call, "--first", 1);
  const bool runs = given(call, "--runs");
  for (long k = 0; k < seeds && !interrupted(); k++) {
    const long seed = first + k;
    if (k % 50 == 0) progress(call, "%ld of %ld", k, seeds);
    if (verdict_case_run(call->ctx, seed, &p->known, &p->one)) return fail(call);
    p->count[p->one.outcome]++;
    p->of_method[p->one.method][p->one.outcome]++;
    if (p->one.outcome == VERDICT_OPEN) give_reason(p);
    note(r, &p->one, runs, steif_message(call->ctx));
  }
  return EXIT_OK;
}

static void tell(steif_report *r, const campaign *p, double cpu_s)
{
  for (int i = 0; asked_method_at(i); i++) {
    const asked_method *a = asked_method_at(i);
    steif_report_row(r, "rows");
    steif_report_text(r, "rows.method", a->method);
    steif_report_text(r, "rows.start", a->start ? a->start : "-");
    for (int k = 0; k < VERDICT_OUTCOMES; k++) {
      char name[48];
      snprintf(name, sizeof name, "rows.%s", verdict_outcome_name((enum verdict_outcome)k));
      steif_report_whole(r, name, p->of_method[i][k]);
    }
  }
  for (int i = 0; i < REASONS; i++) {
    steif_report_row(r, "reasons");
    steif_report_text(r, "reasons.undecided", reasons[i]);
    steif_report_whole(r, "reasons.count", p->open[i]);
  }
  for (int k = 0; k < VERDICT_OUTCOMES; k++)
    steif_report_whole(r, verdict_outcome_name((enum verdict_outcome)k), p->count[k]);
  steif_report_real(r, "cpu_s", cpu_s);
}

int bench_verdicts(struct call *call)
{
  const long seeds = whole_or(call, "--seeds", given(call, "--quick") ? QUICK : SEEDS);
  const clock_t from = clock();
  campaign *p = calloc(1, sizeof *p);
  steif_report *r = steif_report_new(call->ctx);
  int code = p && r ? EXIT_OK : no_memory(call, "the campaign", "give the process more");
  if (!code) code = run(call, p, seeds, r);
  if (!code) tell(r, p, (double)(clock() - from) / CLOCKS_PER_SEC);
  if (!code) code = bench_present(call, &r);
  const bool wrong = !code && (p->count[VERDICT_FALSE] || p->count[VERDICT_ORDER] ||
                               p->count[VERDICT_ERROR_BAR]);
  if (p) verdict_case_free(&p->one);
  free(p);
  steif_report_free(&r);
  return code ? code : wrong ? EXIT_FAILED : EXIT_OK;
}
