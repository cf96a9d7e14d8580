/* impulse_beside.c: what an integrator of SUNDIALS makes of the same x(0-).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"

enum { STEPS_MOST = 100000 };

void report_beside(const struct call *call, const struct descriptor *l, const char *method,
                   steif_report *r)
{
  steif_problem p = l->problem;
  steif_options o = steif_defaults();
  const bool published = descriptor_as_published(call, l);
  o.t1 = real_or(call, "--t1", published ? p.t1 : l->t0 + 1);
  o.rtol = real_or(call, "--rtol", o.rtol);
  o.max_steps = STEPS_MOST;
  outcome got = {.t = l->t0};
  progress(call, "%s from the same x(0-)", method);
  if (!published && steif_linear_problem(call->ctx, &l->system, l->x0, l->t0, o.t1, &p)) {
    got.code = steif_status(call->ctx);
    snprintf(got.message, sizeof got.message, "%s", steif_message(call->ctx));
  } else {
    got = integrate(call->ctx, &p, method, &o, NULL);
  }
  steif_report_text(r, "vs.method", method);
  report_status(r, "vs.", &got);
  steif_report_real(r, "vs.t", got.t);
  steif_report_whole(r, "vs.steps", got.stats.steps);
  steif_forget(call->ctx);
}
