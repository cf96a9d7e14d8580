/* comparison.c: runs of one method at all tolerances or step sizes of a call.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "comparison.h"
#include "settings.h"

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
  known_close(&known);
  return s->run[s->best].out;
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
    if (!steps) o.rtol = value[i];
    progress(call, "%s, %s %.3g", method, what, value[i]);
    const outcome out = many ? best(call, c, method, &o, &s)
                             : integrate(call->ctx, &c->problem, method, &o, NULL);
    if (out.why[0]) say(call, "%s, %s %.3g: %s", method, what, value[i], out.why);
    report_run(c->report, method, &c->problem, &o, &out);
    steif_report_text(c->report, "rows.settings", many ? s.run[s.best].spec : method);
    if (many) report_settings(c->report, "settings", NULL, &s);
    work_add(&c->work, &out);
    c->good += out.code == STEIF_OK || out.code == STEIF_EVENT;
  }
}
