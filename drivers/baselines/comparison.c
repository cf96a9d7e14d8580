/* comparison.c: runs of one method at all tolerances or step sizes of a call.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "comparison.h"
#include "settings.h"
#include <math.h>

/* Step sizes for methods without an error estimate and when nothing else is given; else tolerances. */
static size_t asked(struct call *call, const char *method, double *value, bool *steps)
{
  steif_method_info m;
  const char *const hs = given(call, "--hs") ? "--hs" : "--h";
  const bool adaptive = steif_method_find(call->ctx, method, &m) == STEIF_OK && m.adaptive;
  *steps = given(call, hs) && (!adaptive || !given(call, "--rtols"));
  return reals_of(call, *steps ? hs : "--rtols", value);
}

static outcome best(struct call *call, comparison *c, const char *method,
                    const steif_options *o, settings *s)
{
  known_solution known;
  known_open(call, &c->problem, o, &known);
  settings_run(call, &c->problem, method, o, &known, s);
  known_close(call, &known);
  return s->run[0].out;
}

/* Processor seconds of short runs: the least of five, the first of which finds cold caches. */
static void repeat(struct call *call, comparison *c, const char *spec, const steif_options *o,
                   outcome *out)
{
  const double enough = 0.02;
  for (int k = 1; k < 5 && out->code == STEIF_OK && out->stats.cpu_s < enough; k++) {
    steif_solver *s = NULL;
    const outcome again = integrate_from(call->ctx, &c->problem, spec, o, &s, NULL, NULL);
    steif_solver_free(&s);
    if (again.code || again.stats.steps != out->stats.steps) return;
    out->stats.cpu_s = fmin(out->stats.cpu_s, again.stats.cpu_s);
  }
}

void compare_method(struct call *call, comparison *c, const char *method)
{
  static settings s;
  double value[REALS_MOST];
  bool steps;
  const size_t count = asked(call, method, value, &steps);
  const char *const what = steps ? "h" : "rtol";
  const bool many = !steps && settings_many(method, &c->problem);
  work_open(&c->work, many ? "ida (best)" : method);
  for (size_t i = 0; i < count && !interrupted(); i++) {
    steif_options o = options_of(call);
    o.h = steps ? value[i] : 0;
    o.initial = STEIF_AS_GIVEN;
    if (!steps) o.rtol = value[i];
    progress(call, "%s, %s %.3g", method, what, value[i]);
    outcome out = many ? best(call, c, method, &o, &s)
                       : integrate(call->ctx, &c->problem, method, &o, NULL);
    if (out.why[0]) say(call, "%s, %s %.3g: %s", method, what, value[i], out.why);
    const char *const spec = many ? s.run[0].spec : method;
    repeat(call, c, spec, &o, &out);
    own_digits(call, c, &o, &out);
    report_run(c->report, method, &c->problem, &o, &out);
    steif_report_text(c->report, "rows.settings", spec);
    if (many) report_settings(c->report, "settings", NULL, &s);
    rows_come(call, c->report);
    work_add(&c->work, &out);
    c->good += out.code == STEIF_OK || out.code == STEIF_EVENT;
  }
}
