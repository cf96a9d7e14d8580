/* energy.c: what a method keeps of the invariants of a problem over a run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <stdlib.h>

enum { MAP_LARGEST = 64 }; /* unknowns up to which the map of one step is looked at */

static void drift(steif_report *r, const char *prefix, const steif_drift *d)
{
  const struct {
    const char *key;
    double value;
  } part[] = {{"start", d->start}, {"max", d->max},
              {"min", d->min},     {"final", d->final},
              {"mean", d->mean},   {"per_period", d->per_period},
              {"slope", d->slope}, {"slope_error", d->slope_error}};
  for (size_t i = 0; i < sizeof part / sizeof *part; i++)
    report_maybe(r, prefix, part[i].key, true, part[i].value);
}

static void map_of_step(struct call *call, steif_report *r, const steif_problem *p)
{
  const double h = real_of(call, "--h", 0);
  steif_step_map map;
  if (p->positions == 0 || !(h > 0) || p->n > MAP_LARGEST) return;
  if (steif_step_map_find(call->ctx, p, call->word[1], h, NULL, NULL, &map) == STEIF_OK) {
    steif_report_real(r, "step.determinant", map.determinant);
    steif_report_real(r, "step.symplectic_defect", map.symplectic);
    steif_report_real(r, "step.reversal_defect", map.reversal);
  }
  steif_forget(call->ctx);
}

static int tell(struct call *call, const steif_problem *p, const steif_energy *e, size_t which)
{
  const size_t columns = 1 + (size_t)p->invariants;
  steif_report *r = steif_report_new(call->ctx);
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_whole(r, "steps", e->steps);
  for (size_t i = 0; i < e->rows; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.t", e->row[i * columns]);
    steif_report_real(r, "rows.drift", e->row[i * columns + which]);
  }
  drift(r, "", &e->drift[which - 1]);
  steif_report_real(r, "period", e->period);
  steif_report_truth(r, "drifts", e->drift[which - 1].drifts);
  map_of_step(call, r, p);
  for (size_t i = 0; p->invariants > 1 && i + 1 < columns; i++) {
    steif_report_row(r, "invariants");
    drift(r, "invariants.", &e->drift[i]);
  }
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

static int draw(const struct call *call, const steif_energy *e, size_t columns, size_t which,
                double *xy)
{
  char title[160];
  for (size_t i = 0; i < e->rows; i++)
    xy[i] = e->row[i * columns], xy[e->rows + i] = e->row[i * columns + which];
  snprintf(title, sizeof title, "Drift of the invariant: %s, %s", call->word[0], call->word[1]);
  const steif_curve curve = {call->word[1], e->rows, xy, xy + e->rows, 0};
  const steif_plot plot = {title, "t", "I(t) - I(0)", 0, 0, 0, 1, &curve};
  return save_plot(call, &plot, call->plot);
}

static int watch(struct call *call, const steif_problem *p, size_t which)
{
  const size_t rows = (size_t)whole_of(call, "--rows", 100),
               columns = 1 + (size_t)p->invariants;
  const steif_options o = options_of(call);
  steif_energy e = {.period = real_of(call, "--period", 0), .rows = rows};
  e.drift = calloc(columns, sizeof *e.drift);
  e.row = calloc(rows * (columns + 2), sizeof *e.row);
  int code = EXIT_FAILED;
  if (!e.drift || !e.row)
    say(call, "no memory for %zu rows; ask for fewer with --rows", rows);
  else if (steif_energy_watch(call->ctx, p, call->word[1], &o, &e) != STEIF_OK)
    code = fail(call);
  else if ((code = tell(call, p, &e, which)) == EXIT_OK)
    code = draw(call, &e, columns, which, e.row + rows * columns);
  free(e.row), free(e.drift);
  return code;
}

static int run(struct call *call)
{
  const long which = whole_of(call, "--invariant", 1);
  steif_problem p;
  if (whole_of(call, "--rows", 100) > 1000000)
    return refuse(call, "--rows must be at most 1000000");
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  int code = EXIT_USAGE;
  if (p.invariants > 0 && which > p.invariants)
    refuse(call, "--invariant is %ld and '%s' has %d", which, call->word[0], p.invariants);
  else
    code = watch(call, &p, (size_t)which);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--h", POSITIVE, "H", "equal steps"},
  {"--rtol", POSITIVE, "R", "relative tolerance of chosen steps"},
  {"--atol", POSITIVE, "A", "absolute tolerance"},
  {"--period", POSITIVE, "P", "of the motion (default: between maxima of the first component)"},
  {"--invariant", COUNT, "I", "which one, from 1 (default 1)"},
  {"--rows", COUNT, "N", "rows of the table and points of the picture (default 100)"},
  RUN_OPTIONS,
  {NULL, FLAG, NULL, NULL},
};

static const char *const clash[][2] = {{"--h", "--rtol"}, {"--h", "--atol"}, {NULL, NULL}};

const struct verb verb_energy = {"energy",
                                 "Watch the drift of invariants: line or band, per period",
                                 "PROBLEM METHOD --h H --t1 T [--period P] [--invariant I]",
                                 2,
                                 2,
                                 options,
                                 clash,
                                 run};
