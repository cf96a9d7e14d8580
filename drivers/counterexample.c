/* counterexample.c: an equation that decays while a method grows on it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <math.h>
#include <stdlib.h>

enum { MOST = 100000 };

/* |x| after every step: of the method, and exact. */
typedef struct race {
  size_t count;
  double *t, *x, *exact;
} race;

static int lap(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  race *r = user;
  (void)s;
  r->t[r->count] = t;
  r->x[r->count++] = fabs(N_VGetArrayPointer(y)[0]);
  return 0;
}

static int follow(struct call *call, const steif_problem *p, double h, race *r)
{
  steif_options o = steif_defaults();
  o.h = h, o.t1 = p->t1, o.start = "exact", o.observe = lap, o.observer = r;
  steif_solver *s = steif_solver_new(call->ctx, p, call->word[0], &o);
  int code = s ? steif_solve_to(s, p->t1) : steif_status(call->ctx);
  for (size_t i = 0; i < r->count && code == STEIF_OK; i++) {
    if (p->exact(r->t[i], steif_solution(s), NULL, p->user)) code = STEIF_CALLBACK;
    r->exact[i] = N_VGetArrayPointer(steif_solution(s))[0];
  }
  steif_solver_free(&s);
  return code == STEIF_OK ? EXIT_OK : fail(call);
}

static int tell(struct call *call, double h, double rate, const steif_counterexample *e,
                const race *r)
{
  steif_report *report = steif_report_new(call->ctx);
  if (!report) return fail(call);
  char formula[STEIF_STAGES * 40 + 80];
  int at = snprintf(formula, sizeof formula, "%.10g - %.10g", rate, e->E);
  for (int i = 0; i < e->nodes; i++)
    at += snprintf(formula + at, sizeof formula - (size_t)at, " sin^2(pi (t/h - %.10g))",
                   e->node[i]);
  steif_report_text(report, "method", call->word[0]);
  steif_report_text(report, "lambda", formula);
  steif_report_real(report, "h", h);
  steif_report_list(report, "nodes", (size_t)e->nodes, e->node);
  steif_report_real(report, "mean", -rate);
  steif_report_real(report, "exponent", e->exponent);
  steif_report_real(report, "constant", e->constant);
  steif_report_real(report, "cosine", e->cosine);
  const size_t stride = r->count > 10 ? r->count / 10 : 1;
  for (size_t i = stride - 1; i < r->count; i += stride) {
    steif_report_row(report, "rows");
    steif_report_real(report, "rows.t", r->t[i]);
    steif_report_real(report, "rows.method", r->x[i]);
    steif_report_real(report, "rows.exact", r->exact[i]);
  }
  const int code = present(call, report);
  steif_report_free(&report);
  return code;
}

static int draw(const struct call *call, const race *r)
{
  char title[160];
  snprintf(title, sizeof title, "x' = lambda(t) x, a counterexample to %s", call->word[0]);
  const steif_curve curve[] = {{call->word[0], r->count, r->t, r->x, 0},
                               {"exact", r->count, r->t, r->exact, 0}};
  const steif_plot plot = {title, "t", "|x|", 0, 1, 0, 2, curve};
  return save_plot(call, &plot, call->plot);
}

static int run(struct call *call)
{
  const double h = real_of(call, "--h", 0.1), rate = real_of(call, "--rate", 1);
  const long steps = whole_of(call, "--steps", 200);
  steif_problem p;
  steif_counterexample e;
  if (steps > MOST) return refuse(call, "--steps must be at most %d", MOST);
  if (steif_counterexample_new(call->ctx, call->word[0], h, rate, &p, &e) != STEIF_OK)
    return fail(call);
  p.t1 = h * (double)steps;
  race r = {.t = calloc(3 * (size_t)(steps + 2), sizeof *r.t)};
  r.x = r.t + steps + 2, r.exact = r.x + steps + 2;
  int code = EXIT_FAILED;
  if (!r.t)
    say(call, "no memory for %ld steps; take fewer", steps);
  else if ((code = follow(call, &p, h, &r)) == EXIT_OK &&
           (code = tell(call, h, rate, &e, &r)) == EXIT_OK)
    code = draw(call, &r);
  free(r.t);
  steif_counterexample_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--h", POSITIVE, "H", "the step (default 0.1)"},
  {"--rate", POSITIVE, "K",
   "at which the equation decays and the stages see growth (default 1)"},
  {"--steps", COUNT, "N", "that are followed (default 200)"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_counterexample = {
  "counterexample",
  "Find an equation that decays while a method grows on it",
  "METHOD [--h H --rate K --steps N]",
  1,
  1,
  options,
  NULL,
  run};
