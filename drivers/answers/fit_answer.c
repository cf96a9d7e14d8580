/* fit_answer.c: parameters found as rows, and what there is to know of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fitted.h"
#include <string.h>

static void rows(steif_report *r, const struct fitted *a)
{
  char room[STEIF_SPEC_WORD];
  const steif_fit *f = &a->fit;
  for (int i = 0; i < f->count; i++) {
    steif_report_row(r, "rows");
    steif_report_text(r, "rows.parameter", fitted_name(a, i, room));
    steif_report_real(r, "rows.start", a->start[i]);
    steif_report_real(r, "rows.p", f->p[i]);
    steif_report_real(r, "rows.sd", f->sd[i]);
    steif_report_real(r, "rows.low", f->low[i]);
    steif_report_real(r, "rows.high", f->high[i]);
    steif_report_text(r, "rows.bound", f->bound[i] < 0 ? "low" : f->bound[i] > 0 ? "high" : "");
  }
}

static void matrices(steif_report *r, const struct call *call, const steif_fit *f)
{
  const size_t P = (size_t)f->count;
  steif_report_list(r, "singular", P, f->singular);
  steif_report_matrix(r, "correlation", P, P, f->correlation);
  if (!call->json && !call->npz && !call->h5 && !call->mtx) return;
  steif_report_matrix(r, "covariance", P, P, f->covariance);
  steif_report_matrix(r, "covariance_theta", P, P, f->covariance_theta);
  steif_report_matrix(r, "direction", P, P, f->direction);
}

/* How low and high came about. */
static void intervals(steif_report *r, const steif_fit *f)
{
  char text[120];
  if (f->known)
    snprintf(text, sizeof text, "95 %%, normal: sd of the data as given");
  else if (f->dof > 0)
    snprintf(text, sizeof text, "95 %%, Student's t %.4g: sd of the data estimated",
             f->quantile);
  else
    snprintf(text, sizeof text, "none: no degree of freedom tells the sd of the data");
  steif_report_text(r, "intervals", text);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct fitted *a = result;
  const steif_fit *f = &a->fit;
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", a->method);
  if (strcmp(a->method, f->used)) steif_report_text(r, "used", f->used);
  steif_report_text(r, "data", fitted_data(call, a));
  steif_report_whole(r, "measurements", (long)f->residuals);
  steif_report_text(r, "theta", f->log ? "log p" : "p / scale");
  rows(r, a);
  if (call->json) steif_report_list(r, "p", (size_t)f->count, f->p);
  steif_report_real(r, "chi2", f->chi2);
  steif_report_whole(r, "dof", f->dof);
  if (f->dof > 0) steif_report_real(r, "ratio", f->chi2 / (double)f->dof);
  if (f->known && f->dof > 0) steif_report_real(r, "probability", f->probability);
  intervals(r, f);
  matrices(r, call, f);
  steif_report_whole(r, "undetermined", f->undetermined);
  if (f->starts > 1) steif_report_list(r, "starts", (size_t)f->starts, f->chi2_of);
  if (a->status) steif_report_text(r, "status", steif_code_name(a->status));
  char message[sizeof f->message];
  snprintf(message, sizeof message, "%s", f->message);
  speak(message, sizeof message);
  steif_report_text(r, "message", message);
  steif_report_whole(r, "cost.iterations", f->iterations);
  steif_report_whole(r, "cost.runs", f->runs);
  steif_report_whole(r, "cost.failed", f->failed);
}

int fitted_present(const struct call *call, const struct fitted *a)
{
  return present_result(call, fill, a);
}

int fitted_find(struct call *call, struct fitted *a)
{
  const steif_fit_options o = {.run = &a->run,
                               .count = a->count,
                               .parameter = a->parameter,
                               .start = a->start,
                               .low = a->low,
                               .high = a->high,
                               .scale = given(call, "--log") || a->log ? STEIF_FIT_LOG
                                        : given(call, "--linear")      ? STEIF_FIT_LINEAR
                                                                       : STEIF_FIT_AUTO,
                               .starts = (int)whole_of(call, "--starts"),
                               .evaluations = (int)whole_of(call, "--evaluations")};
  int code = check_outputs(call);
  if (code) return code;
  progress(call, "%s by %s", a->problem->name, a->method);
  const int found = steif_fit_find(call->ctx, a->problem, a->method, &a->data, &o, &a->fit);
  if (!a->fit.p) return fail(call);
  if (found) say(call, "%s", steif_message(call->ctx));
  if (found) code = exit_of(found);
  a->status = found;
  const int shown = fitted_present(call, a);
  const int drawn = fitted_plot(call, a);
  return code ? code : shown ? shown : drawn;
}
