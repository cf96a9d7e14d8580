/* sensitivity_cost.c: derivatives by parameters against the plain run, and against CVODES and IDAS at equal digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "benchmarks.h"
#include "sundials_build.h"
#include "timing.h"
#include <math.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <steif/gradient.h>
#include <steif/sensitivity.h>
#include <string.h>

enum { METHODS = 5, JOBS = 6, REPEATS = 3, PARAMETERS = 10 };

static const struct {
  const char *problem;
  sunrealtype t1;
} plan[] = {{"rober", 4e3}, {"chemakzo", 180}, {"bruss2d:n=16", 1}};
enum { PLANS = sizeof plan / sizeof *plan };
static const char *const methods[METHODS] = {"radau:s=3", "radau:s=5", "bdf", "cvodes", "idas"};
static const sunrealtype digits_wanted = 5;

/* What is timed: forward with so many columns, 0 the plain run; or a gradient, stored or with checkpoints. */
static const struct {
  const char *name;
  int columns;
  bool gradient, checkpoints;
} jobs[JOBS] = {{"plain", 0, false, false},   {"forward", 1, false, false},
                {"forward", 3, false, false}, {"forward", PARAMETERS, false, false},
                {"gradient", 0, true, false}, {"gradient, checkpoints", 0, true, true}};

typedef struct outcome {
  bool done;
  int columns;
  sunrealtype cpu_s, rtol, digits;
  long steps, factors, solves, f;
} outcome;

typedef struct subject {
  struct call *call;
  steif_problem problem;
  steif_options options;
  int all, active[PARAMETERS];
  sunrealtype *reference, *found; /* S by columns of n */
  outcome result[METHODS][JOBS];
} subject;

/* ---- one run ---------------------------------------------------------------------------------- */

static int collect(subject *w, steif_solver *s, int columns, sunrealtype *S)
{
  const sunindextype n = w->problem.n;
  N_Vector d = N_VNew_Serial(n, steif_sundials(w->call->ctx));
  int code = d ? STEIF_OK : STEIF_NO_MEMORY;
  for (int k = 0; !code && k < columns; k++) {
    code = steif_sensitivity(s, w->options.t1, k, d);
    memcpy(S + k * n, N_VGetArrayPointer(d), (size_t)n * sizeof *S);
  }
  if (d) N_VDestroy(d);
  return code;
}

static int run_once(subject *w, const char *method, int columns, sunrealtype *S, outcome *o)
{
  steif_options options = w->options;
  options.rtol = o->rtol, options.sensitivities = columns > 0;
  options.active = w->active, options.active_count = columns;
  const sunrealtype from = stf_now();
  steif_solver *s = steif_solver_new(w->call->ctx, &w->problem, method, &options);
  int code = s ? steif_solve_to(s, options.t1) : steif_status(w->call->ctx);
  o->cpu_s = stf_now() - from;
  if (!code) {
    const steif_stats *n = steif_statistics(s);
    o->steps = n->steps, o->factors = n->nlu, o->solves = n->nsolve, o->f = n->nfe;
  }
  if (!code && S) code = collect(w, s, columns, S);
  steif_solver_free(&s);
  return code;
}

/* Sum of the unknowns at the end. */
static int sum(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  *g = 0;
  for (sunindextype i = 0; i < N_VGetLength(y); i++) *g += N_VGetArrayPointer(y)[i];
  return 0;
}

static int slopes_of_sum(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy,
                         sunrealtype *dp, void *user)
{
  (void)t, (void)y, (void)i, (void)at_end, (void)dp, (void)user;
  N_VConst(1, dy);
  return 0;
}

static int gradient_once(subject *w, const char *method, bool checkpoints, long steps,
                         outcome *o)
{
  const steif_functional J = {.count = 1, .end = sum, .slopes = slopes_of_sum};
  steif_gradient g = {0};
  steif_options options = w->options;
  options.rtol = o->rtol;
  if (checkpoints) g.checkpoints = (int)fmax(3, ceil(sqrt((sunrealtype)steps)));
  const sunrealtype from = stf_now();
  const int code = steif_gradient_find(w->call->ctx, &w->problem, method, &options, &J, &g);
  o->cpu_s = stf_now() - from;
  if (code) return code;
  o->steps = g.cost.steps + g.cost.recomputed_steps, o->factors = g.cost.factors,
  o->solves = g.cost.solves + g.cost.transposed_solves, o->f = -1;
  steif_gradient_free(w->call->ctx, &g);
  return STEIF_OK;
}

/* ---- digits ------------------------------------------------------------------------------------ */

/* Of the worst column, by largest components. */
static sunrealtype digits_of(const subject *w)
{
  const sunindextype n = w->problem.n;
  sunrealtype least = INFINITY;
  for (int k = 0; k < w->all; k++) {
    sunrealtype off = 0, size = 0;
    for (sunindextype i = k * n; i < (k + 1) * n; i++) {
      off = fmax(off, fabs(w->found[i] - w->reference[i]));
      size = fmax(size, fabs(w->reference[i]));
    }
    least = fmin(least, -log10(off / size));
  }
  return least;
}

/* The loosest tolerance of a row of them that keeps the digits of all columns. */
static bool find_tolerance(subject *w, const char *method, outcome *o)
{
  for (int half = 6; half <= 22; half++) {
    o->rtol = pow(10, -0.5 * half);
    if (run_once(w, method, w->all, w->found, o)) {
      steif_forget(w->call->ctx);
      continue;
    }
    o->digits = digits_of(w);
    if (o->digits >= digits_wanted) return true;
  }
  return false;
}

/* ---- rows ------------------------------------------------------------------------------------- */

/* Least time of several runs. */
static void measure(subject *w, int m, int j, const outcome *at)
{
  outcome *o = &w->result[m][j], best = *at;
  best.columns = jobs[j].columns < w->all ? jobs[j].columns : w->all;
  best.cpu_s = INFINITY;
  for (int repeat = 0; repeat < REPEATS; repeat++) {
    outcome one = best;
    const int code = jobs[j].gradient ? gradient_once(w, methods[m], jobs[j].checkpoints,
                                                      w->result[m][0].steps, &one)
                                      : run_once(w, methods[m], best.columns, NULL, &one);
    if (code) {
      steif_forget(w->call->ctx);
      return;
    }
    if (repeat) one.cpu_s = fmin(one.cpu_s, best.cpu_s);
    best = one;
  }
  *o = best, o->done = true;
}

/* Seconds of the faster of CVODES and IDAS at the same job; NaN: neither does it. */
static sunrealtype sundials_seconds(const subject *w, int j)
{
  sunrealtype least = INFINITY;
  for (int m = METHODS - 2; m < METHODS; m++)
    if (w->result[m][j].done) least = fmin(least, w->result[m][j].cpu_s);
  return isfinite(least) ? least : NAN;
}

static void tell(const subject *w, steif_report *r, int m, int j)
{
  const outcome *o = &w->result[m][j];
  if (!o->done) return;
  const sunrealtype other = sundials_seconds(w, j);
  steif_report_row(r, "rows");
  steif_report_text(r, "rows.problem", w->problem.name);
  steif_report_text(r, "rows.method", methods[m]);
  steif_report_text(r, "rows.job", jobs[j].name);
  steif_report_whole(r, "rows.columns", jobs[j].gradient ? w->all : o->columns);
  steif_report_real(r, "rows.rtol", o->rtol);
  steif_report_real(r, "rows.digits", o->digits);
  steif_report_whole(r, "rows.steps", o->steps);
  steif_report_whole(r, "rows.factors", o->factors);
  steif_report_whole(r, "rows.solves", o->solves);
  report_maybe(r, "rows.", "f", o->f >= 0, (sunrealtype)o->f);
  steif_report_real(r, "rows.cpu_s", o->cpu_s);
  steif_report_real(r, "rows.to_plain", o->cpu_s / w->result[m][0].cpu_s);
  report_maybe(r, "rows.", "to_sundials", other == other, o->cpu_s / other);
}

static int prepare(subject *w)
{
  const steif_parameters *p = w->problem.parameters;
  outcome reference = {.rtol = 1e-11};
  w->all = p->count < PARAMETERS ? p->count : PARAMETERS;
  for (int k = 0; k < w->all; k++) w->active[k] = k;
  const size_t size = (size_t)w->all * (size_t)w->problem.n;
  w->reference = calloc(size, sizeof *w->reference), w->found = calloc(size, sizeof *w->found);
  STEIF_CHECK(w->reference && w->found, w->call->ctx, STEIF_NO_MEMORY,
              "no memory for %d columns of problem '%s'", w->all, w->problem.name);
  return run_once(w, "radau:s=7", w->all, w->reference, &reference);
}

static int compare(struct call *call, size_t i, steif_report *r)
{
  subject w = {.call = call, .options = steif_defaults()};
  STEIF_TRY(steif_problem_find(call->ctx, plan[i].problem, &w.problem));
  w.options.t1 = plan[i].t1;
  const int code = prepare(&w);
  for (int m = 0; !code && m < METHODS && !interrupted(); m++) {
    outcome at = {0};
    progress(call, "%s by %s", plan[i].problem, methods[m]);
    for (int j = 0; j < JOBS && (j || find_tolerance(&w, methods[m], &at)); j++)
      if (!(jobs[j].columns > w.all && jobs[j - 1].columns == w.all)) measure(&w, m, j, &at);
  }
  for (int m = 0; !code && m < METHODS; m++)
    for (int j = 0; j < JOBS; j++) tell(&w, r, m, j);
  if (!code) rows_come(call, r);
  free(w.reference), free(w.found);
  steif_problem_clear(call->ctx, &w.problem);
  return code;
}

int bench_sensitivity(struct call *call)
{
  char build[160];
  steif_report *r = steif_report_new(call->ctx);
  steif_report_text(r, "benchmark", "sensitivity");
  sundials_describe(call->ctx, build, sizeof build);
  steif_report_text(r, "sundials", build);
  for (size_t i = 0; r && i < PLANS; i++)
    if (interrupted() || compare(call, i, r)) break;
  return bench_present(call, &r);
}
