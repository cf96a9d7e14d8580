/* impulse_beside.c: what an integrator of SUNDIALS makes of the same x(0-), in every setting it allows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include "settings.h"

enum { BREAKS = 256 };

/* Those of f, at which the baseline starts anew. */
static void declare_breaks(const struct descriptor *l, steif_problem *p, double *breaks)
{
  const size_t count =
    l->function ? steif_function_breaks(l->function, p->t0, p->t1, BREAKS, breaks) : 0;
  p->breaks = breaks;
  p->break_count = count <= BREAKS ? (int)count : 0;
}

void report_beside(const struct call *call, const struct descriptor *l, const char *method,
                   steif_report *r)
{
  static settings s;
  static double breaks[BREAKS];
  known_solution known;
  steif_problem p = l->problem;
  steif_options o = steif_defaults();
  const bool published = descriptor_as_published(call, l);
  o.t1 = real_or(call, "--t1", published ? p.t1 : l->t0 + 1);
  o.rtol = real_or(call, "--rtol", o.rtol);
  o.atol = real_of(call, "--atol");
  outcome got = {.t = l->t0};
  if (!published && steif_linear_problem(call->ctx, &l->system, l->x0, l->t0, o.t1, &p)) {
    got.code = steif_status(call->ctx);
    snprintf(got.message, sizeof got.message, "%s", steif_message(call->ctx));
  } else {
    if (!published) declare_breaks(l, &p, breaks);
    known_open(call, &p, &o, &known);
    settings_run(call, &p, method, &o, &known, &s);
    known_close(call, &known);
    got = s.run[0].out;
  }
  steif_report_text(r, "vs.method", method);
  report_status(r, "vs.", &got);
  steif_report_real(r, "vs.t", got.t);
  steif_report_whole(r, "vs.steps", got.stats.steps);
  if (s.count) {
    report_best(r, "vs", &s);
    steif_report_text(r, "vs.verdict", s.run[0].verdict);
  }
  steif_report_text(r, "vs.impulses", NULL); /* it has none in any setting */
  report_settings(r, "settings", NULL, &s);
  steif_forget(call->ctx);
}
