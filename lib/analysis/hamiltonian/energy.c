/* energy.c: the drift of invariants over a run: its bounds, its mean, does it grow or oscillate.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "hamiltonian_thresholds.h"
#include "integrator.h"
#include <math.h>
#include <steif/energy.h>

/* Sums over one part of the run. */
typedef struct part {
  sunrealtype count, time;
} part;

typedef struct record {
  steif_context *ctx;
  const steif_problem *problem;
  const steif_options *options;
  steif_energy *energy;
  size_t room; /* rows that fit */
  sunrealtype t1;
  part part[STF_DRIFT_PARTS];
  sunrealtype *value;      /* invariants now ... */
  sunrealtype *sum;        /* ... and sums of drifts by part and invariant */
  sunrealtype y[2], t[2];  /* first component at the last two points */
  sunrealtype first, last; /* maxima of it */
  long points, maxima;
} record;

static int invariants(record *w, sunrealtype t, N_Vector y)
{
  const int returned = w->problem->invariant(t, y, w->value, w->problem->user);
  STEIF_CHECK(returned == 0, w->ctx, STEIF_CALLBACK,
              "invariant of problem '%s' returned %d at t = %.12g", w->problem->name, returned,
              t);
  return STEIF_OK;
}

/* The vertex of the parabola through three points whose middle one is the highest. */
static void look_for_maximum(record *w, sunrealtype t, sunrealtype y)
{
  if (w->points > 1 && w->y[1] > w->y[0] && w->y[1] >= y) {
    const sunrealtype a = w->t[1] - w->t[0], b = t - w->t[1];
    const sunrealtype left = (w->y[1] - w->y[0]) / a, right = (y - w->y[1]) / b;
    const sunrealtype vertex = w->t[0] + a / 2 + (a + b) / 2 * left / (left - right);
    if (w->maxima++ == 0) w->first = vertex;
    w->last = vertex;
  }
  w->y[0] = w->y[1];
  w->t[0] = w->t[1];
  w->y[1] = y;
  w->t[1] = t;
}

/* Rows are taken evenly: row r where the share of the time gone reaches r / (room - 1). */
static void keep_row(record *w, sunrealtype t)
{
  steif_energy *e = w->energy;
  const sunrealtype span = w->t1 - w->problem->t0, gone = (t - w->problem->t0) / span;
  const int count = w->problem->invariants;
  if (e->rows == w->room ||
      gone * (sunrealtype)(w->room - 1) < (sunrealtype)e->rows - STF_ROW_ROUNDING)
    return;
  sunrealtype *row = e->row + e->rows * (size_t)(1 + count);
  row[0] = t;
  for (int i = 0; i < count; i++) row[1 + i] = w->value[i] - e->drift[i].start;
  e->rows++;
}

static int point(record *w, sunrealtype t, N_Vector y)
{
  const sunrealtype t0 = w->problem->t0, *first = N_VGetArrayPointer(y);
  const int count = w->problem->invariants;
  int k = (int)(STF_DRIFT_PARTS * (t - t0) / (w->t1 - t0));
  k = k < 0 ? 0 : k >= STF_DRIFT_PARTS ? STF_DRIFT_PARTS - 1 : k;
  STEIF_TRY(invariants(w, t, y));
  w->part[k].count += 1;
  w->part[k].time += t - t0;
  for (int i = 0; i < count; i++) {
    steif_drift *d = &w->energy->drift[i];
    if (w->points == 0) d->start = w->value[i];
    const sunrealtype drift = w->value[i] - d->start;
    d->max = fmax(d->max, drift);
    d->min = fmin(d->min, drift);
    d->final = drift;
    w->sum[k * count + i] += drift;
  }
  if (first) look_for_maximum(w, t, first[0]);
  keep_row(w, t);
  w->points++;
  return STEIF_OK;
}

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  record *w = user;
  if (point(w, t, y)) return -1;
  return w->options->observe ? w->options->observe(s, t, y, w->options->observer) : 0;
}

/* Do the means go one way? A random walk, as rounding makes it, turns back too often, though a line
 * through it may look steep. */
static bool one_way(int n, const sunrealtype *y, sunrealtype share)
{
  sunrealtype path = 0;
  for (int k = 1; k < n; k++) path += fabs(y[k] - y[k - 1]);
  return n > 2 && path > 0 && fabs(y[n - 1] - y[0]) >= share * path;
}

/* The line through the means of the parts that have points, all of one weight. */
static void line(const record *w, int i, steif_drift *d)
{
  const int count = w->problem->invariants;
  sunrealtype x[STF_DRIFT_PARTS], y[STF_DRIFT_PARTS], mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
  int n = 0;
  for (int k = 0; k < STF_DRIFT_PARTS; k++) {
    if (!(w->part[k].count > 0)) continue;
    x[n] = w->part[k].time / w->part[k].count;
    y[n] = w->sum[k * count + i] / w->part[k].count;
    mx += x[n];
    my += y[n++];
  }
  mx /= n;
  my /= n;
  for (int k = 0; k < n; k++) {
    xx += (x[k] - mx) * (x[k] - mx);
    xy += (x[k] - mx) * (y[k] - my);
  }
  d->slope = n > 1 ? xy / xx : NAN;
  for (int k = 0; k < n; k++) {
    const sunrealtype off = y[k] - my - d->slope * (x[k] - mx);
    yy += off * off;
  }
  d->slope_error = n > 2 ? sqrt(yy / (n - 2) / xx) : NAN;
  const bool steep = fabs(d->slope) > STF_DRIFT_ERRORS * d->slope_error;
  const bool away = fabs(y[n - 1]) > STF_DRIFT_RUNS_AWAY * fabs(y[n / 2]);
  /* What is lost for good comes to rest, and a line fits badly. */
  const bool gone = n == STF_DRIFT_PARTS && one_way(n, y, STF_DRIFT_STRAIGHT) &&
                    2 * fabs(y[n - 1]) > fmax(d->max, -d->min);
  d->drifts = gone || ((steep || away) && one_way(n, y, STF_DRIFT_ONE_WAY));
}

static void finish(record *w)
{
  steif_energy *e = w->energy;
  const int count = w->problem->invariants;
  e->steps = w->points - 1;
  if (!(e->period > 0))
    e->period = w->maxima > 1 ? (w->last - w->first) / (sunrealtype)(w->maxima - 1) : NAN;
  for (int i = 0; i < count; i++) {
    steif_drift *d = &e->drift[i];
    for (int k = 0; k < STF_DRIFT_PARTS; k++) d->mean += w->sum[k * count + i];
    d->mean /= (sunrealtype)w->points;
    line(w, i, d);
    d->per_period = d->slope * e->period;
  }
}

static int run(record *w, const char *method)
{
  steif_options o = *w->options;
  o.t1 = w->t1;
  o.observe = observe;
  o.observer = w;
  steif_solver *s = steif_solver_new(w->ctx, w->problem, method, &o);
  if (!s) return steif_status(w->ctx);
  int code = point(w, w->problem->t0, steif_solution(s));
  if (code == STEIF_OK) code = steif_solve_to(s, o.t1);
  if (code == STEIF_STOPPED) w->energy->end = steif_time(s);
  steif_solver_free(&s);
  if (code == STEIF_OK || (code == STEIF_STOPPED && w->points > 1)) finish(w);
  return code;
}

/* Constant steps end where the last whole one does: a shorter one would not be symplectic. */
static int whole_steps(record *w)
{
  const steif_options *o = w->options;
  stf_constant c;
  w->energy->h = !o->mesh && o->h > 0 ? o->h : 0;
  if (w->energy->h > 0) {
    STEIF_TRY(stf_constant_steps(w->ctx, o->h, w->problem->t0, w->t1, &c));
    w->t1 = c.end;
  }
  w->energy->end = w->t1;
  return STEIF_OK;
}

int steif_energy_measure(steif_context *ctx, const steif_problem *problem, const char *method,
                         const steif_options *options, steif_energy *energy)
{
  STF_NAMED(problem);
  STEIF_CHECK(problem && method && energy && energy->drift, ctx, STEIF_BAD_INPUT,
              "a problem, a method and room for the drifts are needed");
  const steif_options usual = steif_defaults();
  const int count = problem->invariants;
  STEIF_CHECK(
    count > 0 && problem->invariant, ctx, STEIF_UNSUPPORTED,
    "problem '%s' declares no invariant whose drift could be measured: set .invariants "
    "and .invariant",
    problem->name);
  STEIF_CHECK(energy->period >= 0 && isfinite(energy->period), ctx, STEIF_BAD_INPUT,
              "the period %g must be finite and not negative", energy->period);
  record w = {.ctx = ctx, .problem = problem, .energy = energy};
  w.options = options ? options : &usual;
  const sunrealtype mesh_end =
    w.options->mesh && w.options->mesh_size ? w.options->mesh[w.options->mesh_size - 1] : 0;
  w.t1 = mesh_end != 0 ? mesh_end : w.options->t1 != 0 ? w.options->t1 : problem->t1;
  STEIF_TRY(whole_steps(&w));
  w.room = energy->row ? energy->rows : 0;
  energy->rows = 0;
  for (int i = 0; i < count; i++) energy->drift[i] = (steif_drift){0};
  w.value = stf_allocate(ctx, (size_t)count * (1 + STF_DRIFT_PARTS), sizeof *w.value);
  if (!w.value) return STEIF_NO_MEMORY;
  w.sum = w.value + count;
  const int code = run(&w, method);
  stf_release(ctx, w.value);
  return code;
}
