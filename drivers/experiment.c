/* experiment.c: known experiments, each number beside its reference.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <math.h>

static int shelf(struct call *call)
{
  const char *name, *about;
  steif_report *r = steif_report_new(call->ctx);
  for (size_t i = 0; (name = steif_experiment_name(i, &about)); i++) {
    steif_report_row(r, "experiments");
    steif_report_text(r, "experiments.name", name);
    steif_report_text(r, "experiments.about", about);
  }
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

/* Are there printed figures beside the values? */
static bool beside(const steif_findings *f)
{
  for (size_t i = 0; i < f->count; i++)
    if (!isnan(f->finding[i].printed)) return true;
  return false;
}

static void fill(steif_report *r, const steif_findings *f)
{
  steif_report_text(r, "experiment", f->name);
  steif_report_text(r, "about", f->about);
  const bool printed = beside(f);
  for (size_t i = 0; i < f->count; i++) {
    const steif_finding *x = f->finding + i;
    steif_report_row(r, "rows");
    steif_report_text(r, "rows.of", x->of);
    report_maybe(r, "rows.", "h", !isnan(x->h), x->h);
    steif_report_text(r, "rows.quantity", x->quantity);
    if (printed) {
      report_maybe(r, "rows.", "printed", !isnan(x->printed), x->printed);
      report_maybe(r, "rows.", "imitated", !isnan(x->imitated), x->imitated);
    }
    steif_report_real(r, "rows.value", x->value);
    report_maybe(r, "rows.", "reference", x->agrees >= 0, x->reference);
    report_maybe(r, "rows.", "error", x->agrees >= 0, x->error);
    report_maybe(r, "rows.", "order", !isnan(x->order), x->order);
  }
  steif_report_whole(r, "disagree", (long)f->disagree);
}

static int doubt(struct call *call, const steif_findings *f)
{
  for (size_t i = 0; i < f->count; i++) {
    const steif_finding *x = f->finding + i;
    if (x->agrees != 0) continue;
    say(call, "%s, h = %g: %s is %.10g, the reference is %.10g", x->of, x->h, x->quantity,
        x->value, x->reference);
  }
  return f->disagree ? EXIT_UNCERTIFIED : EXIT_OK;
}

static int tell(struct call *call, const steif_findings *f)
{
  if (call->plot && !f->plot.count)
    return refuse(call, "%s has no picture; leave --plot out", f->name);
  steif_report *r = steif_report_new(call->ctx);
  if (r) fill(r, f);
  int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  if (!code) code = save_plot(call, &f->plot, call->plot);
  return code ? code : doubt(call, f);
}

static int run(struct call *call)
{
  steif_findings f;
  if (!call->words)
    return call->plot ? refuse(call, "name an experiment to draw") : shelf(call);
  progress(call, "%s", call->word[0]);
  if (steif_experiment_run(call->ctx, call->word[0], &f)) return fail(call);
  const int code = tell(call, &f);
  steif_findings_clear(call->ctx, &f);
  return code;
}

static const struct option options[] = {{NULL, FLAG, NULL, NULL}};

const struct verb verb_experiment = {
  "experiment",
  "Run a known experiment: every number beside its reference",
  "[NAME]",
  0,
  1,
  options,
  NULL,
  run};
