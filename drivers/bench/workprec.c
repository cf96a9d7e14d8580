/* workprec.c: whole solves, timed, with the digits they reach.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "timing.h"
#include "workprec.h"
#include <math.h>
#include <steif/collection.h>
#include <stdio.h>
#include <string.h>

static const char *const problems[] = {"vdpol",   "rober",        "orego",       "hires",
                                       "pollu",   "e5",           "plei",        "ringmod",
                                       "beam",    "medakzo",      "chemakzo",    "transamp",
                                       "caraxis", "bruss2d:n=16", "bruss2d:n=32"};

static const char *const methods[] = {
  "auto",           "radau:s=3",     "radau:s=5", "radau:s=7",      "bdf",
  "rodas4",         "rodas4p2",      "rodas5p",   "gauss:s=3",      "gauss:s=5",
  "dopri87",        "cvode",         "ida",       "ida:suppress=1", "ida:suppress=1,id=index",
  "arkode:order=4", "arkode:order=5"};

const char *steif_bench_problem(size_t i)
{
  return i < sizeof problems / sizeof *problems ? problems[i] : NULL;
}

const char *steif_bench_method(size_t i)
{
  return i < sizeof methods / sizeof *methods ? methods[i] : NULL;
}

typedef struct deadline {
  sunrealtype end;
  int ticks;
  bool late;
} deadline;

/* Looking at the clock costs as much as a small step does: every 64 steps are enough. */
static int end_when_late(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)t, (void)y;
  deadline *d = user;
  if (++d->ticks % 64 == 0) d->late = stf_now() > d->end;
  return d->late;
}

typedef struct task {
  steif_context *ctx;
  const steif_problem *problem;
  steif_options options;
  deadline clock;
  sunrealtype longest;
} task;

static void judge(task *w, steif_solver *s, steif_bench_solve *out)
{
  const sunrealtype scale = w->problem->rtol_scale > 0 ? w->problem->rtol_scale : 1;
  sunrealtype scd;
  out->late = w->clock.late || out->code == STEIF_TIME_LIMIT;
  out->mescd = NAN;
  snprintf(out->message, sizeof out->message, "%s",
           out->code == STEIF_OK ? "ok" : steif_message(w->ctx));
  if (out->code == STEIF_OK)
    out->code = steif_problem_digits(w->ctx, w->problem, w->problem->t1, steif_solution(s),
                                     scale, &scd, &out->mescd);
}

/* Seconds of one solve; the first one is judged as well. */
static sunrealtype once(task *w, steif_bench_solve *out, bool first)
{
  sunrealtype from = stf_now();
  w->clock = (deadline){.end = from + w->longest};
  steif_solver *s = steif_solver_new(w->ctx, w->problem, out->method, &w->options);
  const int code = s ? steif_solve_to(s, w->problem->t1) : steif_status(w->ctx);
  sunrealtype took = stf_now() - from;
  if (first) {
    out->code = code;
    judge(w, s, out);
  }
  from = stf_now();
  steif_solver_free(&s);
  steif_forget(w->ctx);
  return took + (stf_now() - from);
}

/* 5 solves and 20 ms, unless they add up to more than `much`. */
static void repeat(task *w, steif_bench_solve *out)
{
  const sunrealtype enough = 20e-3, much = 0.05;
  sunrealtype sum = out->cpu_s = once(w, out, true);
  for (int k = 1; out->code == STEIF_OK && (k < 5 || sum < enough) && sum < much; k++) {
    const sunrealtype took = once(w, out, false);
    if (took < out->cpu_s) out->cpu_s = took;
    sum += took;
  }
}

/* ARKODE needs a nonsingular E; Gauss methods do not keep constraints; IDA's error test can leave out what
 * only a DAE has. */
static bool takes(steif_context *ctx, const steif_problem *p, const steif_method_info *m)
{
  const int form = steif_problem_form(ctx, p);
  const bool ode = !strncmp(m->name, "arkode", 6) || !strncmp(m->name, "gauss", 5);
  const bool dae = !strncmp(m->name, "ida:suppress=1", 14);
  return m->adaptive && (m->forms & (unsigned)form) && !(ode && p->dae_index > 0) &&
         !(dae && p->dae_index == 0);
}

int steif_bench_measure(steif_context *ctx, const char *problem, const char *method,
                        sunrealtype rtol, sunrealtype longest, steif_bench_solve *solve)
{
  steif_problem p;
  steif_method_info m;
  memset(solve, 0, sizeof *solve);
  STEIF_TRY(steif_method_find(ctx, method, &m));
  STEIF_TRY(steif_problem_find(ctx, problem, &p));
  task w = {.ctx = ctx, .problem = &p, .options = steif_defaults(), .longest = longest};
  w.options.rtol = rtol;
  w.options.max_steps = 1000000000;
  snprintf(solve->problem, sizeof solve->problem, "%s", problem);
  snprintf(solve->method, sizeof solve->method, "%s", method);
  solve->rtol = rtol;
  solve->atol = rtol * (p.rtol_scale > 0 ? p.rtol_scale : 1);
  solve->due = -log10(rtol) - 1;
  solve->n = p.n;
  solve->mescd = NAN;
  solve->baseline = !strcmp(m.family, "baseline");
  if (solve->baseline) /* an observer would look at every step: limits cost nothing */
    w.options.max_seconds = longest;
  else
    w.options.observe = end_when_late, w.options.observer = &w.clock;
  const bool fits = takes(ctx, &p, &m);
  if (fits) repeat(&w, solve);
  steif_problem_clear(ctx, &p);
  return fits ? STEIF_OK : STEIF_UNSUPPORTED;
}
