/* experiment.c: known experiments, each number beside its reference.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "findings.h"
#include "members.h"
#include "program.h"

static void fill_list(steif_report *r, const struct call *call, const void *result)
{
  const char *name, *about;
  (void)call, (void)result;
  for (size_t i = 0; (name = steif_experiment_name(i, &about)); i++) {
    steif_report_row(r, "experiments");
    steif_report_text(r, "experiments.name", name);
    steif_report_text(r, "experiments.about", about);
  }
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const struct member what[] = {MEMBER(steif_finding, of, A_TEXT),
                                       MEMBER(steif_finding, h, A_NUMBER),
                                       MEMBER(steif_finding, quantity, A_TEXT), MEMBERS_END};
  static const struct member printed[] = {MEMBER(steif_finding, printed, A_NUMBER),
                                          MEMBER(steif_finding, imitated, A_NUMBER),
                                          MEMBERS_END};
  const steif_findings *f = result;
  (void)call;
  steif_report_text(r, "experiment", f->name);
  steif_report_text(r, "about", f->about);
  for (size_t i = 0; i < f->count; i++) {
    const steif_finding *x = f->finding + i;
    steif_report_row(r, "rows");
    report_members(r, "rows.", what, x);
    if (f->printed) report_members(r, "rows.", printed, x);
    steif_report_real(r, "rows.value", x->value);
    report_maybe(r, "rows.", "reference", x->agrees >= 0, x->reference);
    report_maybe(r, "rows.", "error", x->agrees >= 0, x->error);
    report_maybe(r, "rows.", "order", x->order == x->order, x->order);
  }
  steif_report_whole(r, "disagree", (long)f->disagree);
}

static int present_findings(struct call *call, const steif_findings *f)
{
  if (call->plot && !f->plot.count)
    return bad_usage(call, "%s has no picture; leave --plot out", f->name);
  int code = present_result(call, fill, f);
  if (!code) code = save_plot(call, &f->plot, call->plot);
  for (size_t i = 0; !code && i < f->count; i++) {
    const steif_finding *x = f->finding + i;
    if (x->agrees == 0)
      say(call, "%s, h = %g: %s is %.10g, the reference is %.10g [STEIF_NOT_CERTIFIED]", x->of,
          x->h, x->quantity, x->value, x->reference);
  }
  return code ? code : f->disagree ? EXIT_UNCERTIFIED : EXIT_OK;
}

static int run(struct call *call)
{
  steif_findings f;
  if (!call->words && call->plot) return bad_usage(call, "name an experiment to draw");
  if (!call->words) return present_result(call, fill_list, NULL);
  progress(call, "%s", call->word[0]);
  if (steif_experiment_run(call->ctx, call->word[0], &f)) return fail(call);
  const int code = present_findings(call, &f);
  steif_findings_clear(call->ctx, &f);
  return code;
}

const struct verb verb_experiment = {
  .name = "experiment",
  .about = "Run a known experiment: every number beside its reference",
  .usage = "[NAME]",
  .most = 1,
  .picture = true,
  .run = run,
};
