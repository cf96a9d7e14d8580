/* workprec_report.c: the benchmark of work against precision as a report and a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "workprec_report.h"
#include "sundials_build.h"
#include <math.h>
#include <string.h>

static const double wanted[DIGITS] = {4, 6, 8, 10};

void work_header(const workprec *w, const struct call *call, steif_report *r)
{
  const double sundials = sundials_ratio(call->ctx);
  steif_report_text(r, "benchmark", "workprec");
  steif_report_text(r, "sundials",
                    isnan(sundials) ? "optimisation not measured"
                    : sundials > SUNDIALS_SLOW
                      ? "compiled without optimisation; tests/peers.sh builds one at -O2"
                      : "compiled with optimisation");
  steif_report_real(r, "sundials_vectors", sundials);
  steif_report_list(r, "rtols", w->rtols, w->rtol);
}

/* A number or, for NaN, nothing. */
static void cell(steif_report *r, const char *prefix, const char *key, double value)
{
  report_maybe(r, prefix, key, value == value, value);
}

static void pick(steif_report *r, const char *who, const char *prefix,
                 const steif_bench_pick *p)
{
  steif_report_text(r, who, *p->method ? p->method : NULL);
  cell(r, prefix, "rtol", p->rtol);
  cell(r, prefix, "atol", p->atol);
  cell(r, prefix, "cpu_s", p->cpu_s);
}

static void add_match(steif_report *r, const steif_bench_match *m)
{
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.problem", m->problem);
  steif_report_whole(r, "rows.n", (long)m->n);
  steif_report_whole(r, "rows.digits", (long)m->digits);
  pick(r, "rows.method", "rows.", &m->ours);
  cell(r, "rows.", "auto_rtol", m->automatic.rtol);
  cell(r, "rows.", "auto_cpu_s", m->automatic.cpu_s);
  pick(r, "rows.best_baseline", "rows.baseline_", &m->baseline);
  cell(r, "rows.", "ratio", m->ratio);
  cell(r, "rows.", "auto_ratio", m->auto_ratio);
}

static const char *status(const steif_bench_solve *s)
{
  return s->late ? "time is up" : steif_code_name(s->code);
}

/* Failures of one kind and method are one row; runs of a method stand side by side. */
static void add_failures(const workprec *w, steif_report *r)
{
  for (size_t i = 0, end; i < w->runs; i = end) {
    const steif_bench_solve *s = &w->run[i];
    char rtols[192];
    size_t used = 0;
    for (end = i; end < w->runs && !strcmp(w->run[end].method, s->method) &&
                  !strcmp(status(&w->run[end]), status(s));
         end++)
      if (used < sizeof rtols)
        used += (size_t)snprintf(rtols + used, sizeof rtols - used, end > i ? " %.0e" : "%.0e",
                                 w->run[end].rtol);
    if (s->code == STEIF_OK) continue;
    steif_report_row(r, "failures");
    steif_report_text(r, "failures.problem", s->problem);
    steif_report_text(r, "failures.method", s->method);
    steif_report_text(r, "failures.status", status(s));
    steif_report_text(r, "failures.rtols", rtols);
    steif_report_text(r, "failures.message", s->message);
  }
}

static void add_run(steif_report *r, const char *sheet, const char *prefix,
                    const steif_bench_solve *s)
{
  char name[64];
  steif_report_row(r, sheet);
  snprintf(name, sizeof name, "%sproblem", prefix);
  steif_report_text(r, name, s->problem);
  snprintf(name, sizeof name, "%smethod", prefix);
  steif_report_text(r, name, s->method);
  cell(r, prefix, "rtol", s->rtol);
  cell(r, prefix, "atol", s->atol);
  cell(r, prefix, "mescd", s->mescd);
  cell(r, prefix, "cpu_s", s->cpu_s);
}

void work_problem(workprec *w, const struct call *call, steif_report *r)
{
  for (int k = 0; k < DIGITS && w->runs; k++) {
    w->match[w->matches] = steif_bench_compare(w->run, w->runs, wanted[k]);
    add_match(r, &w->match[w->matches++]);
  }
  add_failures(w, r);
  for (size_t i = 0; i < w->runs; i++) {
    const steif_bench_solve *s = &w->run[i];
    const bool poor = s->code == STEIF_OK && !(s->mescd >= s->due);
    if (poor && !s->baseline) add_run(r, "short", "short.", s);
    if (poor && s->baseline) w->short_baselines++;
    if (given(call, "--runs")) add_run(r, "runs", "runs.", s);
  }
}

static void add_mean(steif_report *r, const char *name, const steif_bench_mean *m)
{
  steif_report_row(r, "classes");
  steif_report_text(r, "classes.class", name);
  steif_report_whole(r, "classes.ratios", m->count);
  cell(r, "classes.", "geomean", m->ratio);
  steif_report_whole(r, "classes.auto_ratios", m->auto_count);
  cell(r, "classes.", "auto_geomean", m->auto_ratio);
  steif_report_whole(r, "classes.peer_ratios", m->peer_count);
  cell(r, "classes.", "peer_geomean", m->peer_ratio);
  steif_report_whole(r, "classes.only_steif", m->alone);
  steif_report_whole(r, "classes.only_baselines", m->beaten);
}

static void add_peers(const workprec *w, steif_report *r)
{
  const double speed = steif_bench_speed(w->match, w->matches);
  for (size_t i = 0; i < w->matches; i++) {
    const steif_bench_match *m = &w->match[i];
    if (!m->peer || speed != speed) continue;
    steif_report_row(r, "peers");
    steif_report_text(r, "peers.problem", m->problem);
    steif_report_whole(r, "peers.digits", (long)m->digits);
    steif_report_text(r, "peers.peer", m->peer);
    cell(r, "peers.", "peer_cpu_s", speed * m->peer_s);
    cell(r, "peers.", "ratio", m->ours.cpu_s / (speed * m->peer_s));
    cell(r, "peers.", "auto_ratio", m->automatic.cpu_s / (speed * m->peer_s));
  }
  cell(r, "", "peer_speed", speed);
}

void work_summary(const workprec *w, steif_report *r)
{
  static const struct {
    const char *name;
    sunindextype least, most;
  } classes[] = {{"n <= 20", 0, 20},
                 {"n <= 1000", 20, 1000},
                 {"larger", 1000, 2000000000},
                 {"all", 0, 2000000000}};
  steif_bench_mean m;
  add_peers(w, r);
  for (size_t i = 0; i < sizeof classes / sizeof *classes; i++) {
    m = (steif_bench_mean){.least_n = classes[i].least, .most_n = classes[i].most};
    steif_bench_average(w->match, w->matches, &m);
    add_mean(r, classes[i].name, &m);
  }
  steif_report_whole(r, "short_baselines", w->short_baselines);
  cell(r, "", "geomean", m.ratio);
}

/* --- pictures --- */

static int draw_runs(const workprec *w, const struct call *call)
{
  static work_curves curves;
  for (size_t i = 0; i < w->runs; i++) {
    const steif_bench_solve *s = &w->run[i];
    const outcome o = {
      .known = s->mescd == s->mescd, .mescd = s->mescd, .stats.cpu_s = s->cpu_s};
    if (!i || strcmp(s->method, s[-1].method)) work_open(&curves, s->method);
    work_add(&curves, &o);
  }
  return work_plot(call, &curves, w->problems.item[0], call->plot);
}

int work_picture(const workprec *w, const struct call *call)
{
  static steif_curve curve[PLAN_MOST];
  static double x[PLAN_MOST * DIGITS], y[PLAN_MOST * DIGITS];
  if (w->problems.count == 1) return draw_runs(w, call);
  for (size_t i = 0; i < w->matches; i++) {
    x[i] = w->match[i].digits;
    y[i] = w->match[i].ratio;
    if (i % DIGITS == 0)
      curve[i / DIGITS] = (steif_curve){w->match[i].problem, DIGITS, x + i, y + i, 1};
  }
  const steif_plot plot = {.title = "Best of steif over best of CVODE, IDA, ARKODE",
                           .x_label = "digits (mescd)",
                           .y_label = "ratio of processor times",
                           .log_y = 1,
                           .count = w->matches / DIGITS,
                           .curve = curve};
  return save_plot(call, &plot, call->plot);
}
