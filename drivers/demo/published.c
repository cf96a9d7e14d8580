/* published.c: published problems by every family, beside CVODE, IDA and ARKODE.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "curves.h"
#include "demo.h"
#include "settings.h"
#include "sundials_build.h"
#include <string.h>

/* h: constant step size for the method without an error estimate; 0: none does for the whole run. */
static const struct {
  const char *problem;
  bool dae;
  double h;
} problems[] = {
  {"vdpol", false, 0},    {"rober", false, 0},      {"hires", false, 0.05},
  {"orego", false, 1e-3}, {"chemakzo", true, 0.05}, {"transamp", true, 1e-5},
};
static const char *const methods[] = {"be",        "bdf:p=2",   "dirk:alexander2",
                                      "dirk:hw43", "gauss:s=3", "radau:s=3",
                                      "cvode",     "ida",       "arkode"};
enum {
  PROBLEMS = sizeof problems / sizeof *problems,
  METHODS = sizeof methods / sizeof *methods
};

static void row(demo *d, const char *problem, const char *method, const steif_options *o,
                const char *spec, const outcome *out)
{
  char name[64], setting[96];
  const bool more = *spec;
  snprintf(name, sizeof name, "%s, %s%s", problem, method, more ? " (best)" : "");
  snprintf(setting, sizeof setting, "%s %.0e%s%s", o->h > 0 ? "h" : "rtol",
           o->h > 0 ? o->h : o->rtol, more ? ", " : "", more ? spec : "");
  steif_report_row(d->report, "published");
  steif_report_text(d->report, "published.run", name);
  steif_report_text(d->report, "published.setting", setting);
  report_digits(d->report, "published.", out);
  report_status(d->report, "published.", out);
  report_stats(d->report, "published.", out);
}

static void best(demo *d, size_t i, const steif_problem *p, const char *method,
                 const steif_options *o)
{
  static settings s;
  known_solution known;
  known_open(d->call, p, o, &known);
  settings_run(d->call, p, method, o, &known, &s);
  known_close(d->call, &known);
  row(d, problems[i].problem, method, o, s.run[0].spec, &s.run[0].out);
}

static void one_method(demo *d, size_t i, const steif_problem *p, const char *method)
{
  steif_method_info m;
  steif_options o = steif_defaults();
  if (steif_method_find(d->call->ctx, method, &m) != STEIF_OK) return;
  if (problems[i].dae && (!strcmp(method, "cvode") || !strcmp(method, "arkode"))) return;
  if (!m.adaptive && !(problems[i].h > 0)) return;
  if (!m.adaptive) o.h = problems[i].h;
  progress(d->call, "%s by %s", problems[i].problem, method);
  if (settings_many(method, p)) {
    best(d, i, p, method, &o);
    return;
  }
  const outcome out = integrate(d->call->ctx, p, method, &o, NULL);
  row(d, problems[i].problem, method, &o, "", &out);
}

static int sweep(demo *d, const steif_problem *p)
{
  static const double rtol[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  static work_curves work;
  sundials_caption(d->call->ctx, work.note, work.measured);
  for (size_t k = 1; k < METHODS; k++) {
    steif_options o = steif_defaults();
    work_open(&work, methods[k]);
    for (size_t i = 0; i < sizeof rtol / sizeof *rtol; i++) {
      progress(d->call, "%s by %s, rtol %.0e", problems[0].problem, methods[k], rtol[i]);
      o.rtol = rtol[i];
      const outcome out = integrate(d->call->ctx, p, methods[k], &o, NULL);
      work_add(&work, &out);
    }
  }
  return work_plot(d->call, &work, problems[0].problem, demo_picture(d, "published.svg"));
}

int demo_published(demo *d)
{
  int code = EXIT_OK;
  for (size_t i = 0; i < PROBLEMS && code == EXIT_OK; i++) {
    steif_problem p;
    if (steif_problem_find(d->call->ctx, problems[i].problem, &p)) return fail(d->call);
    for (size_t k = 0; k < METHODS; k++) one_method(d, i, &p, methods[k]);
    if (i == 0) code = sweep(d, &p);
    steif_problem_clear(d->call->ctx, &p);
  }
  return code;
}
