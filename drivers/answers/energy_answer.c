/* energy_answer.c: what a method keeps of the invariants of a problem, as a report and a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include "members.h"
#include <stdlib.h>

static const struct member drift_members[] = {MEMBER(steif_drift, start, A_REAL),
                                              MEMBER(steif_drift, max, A_REAL),
                                              MEMBER(steif_drift, min, A_REAL),
                                              MEMBER(steif_drift, final, A_REAL),
                                              MEMBER(steif_drift, mean, A_REAL),
                                              MEMBER(steif_drift, per_period, A_REAL),
                                              MEMBER(steif_drift, slope, A_REAL),
                                              MEMBER(steif_drift, slope_error, A_REAL),
                                              MEMBERS_END};

static void map_of_step(const struct call *call, steif_report *r, const steif_problem *p)
{
  enum { MAP_LARGEST = 64 }; /* unknowns up to which the map of one step is looked at */
  static const struct member members[] = {
    MEMBER(steif_step_map, determinant, A_REAL),
    {"symplectic_defect", A_REAL, offsetof(steif_step_map, symplectic)},
    {"reversal_defect", A_REAL, offsetof(steif_step_map, reversal)},
    MEMBER(steif_step_map, radius, A_REAL),
    MEMBERS_END};
  const double h = real_of(call, "--h");
  steif_step_map map;
  if (p->positions == 0 || !(h > 0) || p->n > MAP_LARGEST) return;
  if (steif_step_map_find(call->ctx, p, call->word[1], h, NULL, NULL, &map) == STEIF_OK) {
    report_members(r, "step.", members, &map);
    if (p->linear && map.border)
      steif_report_text(
        r, "step.border",
        "two eigenvalues of the map of one step meet at -1: h is at the border of stability, "
        "where the energy of other starts grows");
  }
  steif_forget(call->ctx);
}

static void rows(struct energy_answer *a)
{
  const steif_energy *e = &a->energy;
  steif_report *r = a->report;
  if (!a->told) {
    steif_report_text(r, "problem", a->call->word[0]);
    steif_report_text(r, "method", a->call->word[1]);
  }
  for (; a->told < e->rows; a->told++) {
    const double *row = e->row + a->told * a->columns;
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.t", row[0]);
    steif_report_real(r, "rows.drift", row[a->which]);
  }
  rows_come(a->call, r);
}

int energy_follow(steif_solver *s, double t, N_Vector y, void *answer)
{
  struct energy_answer *a = answer;
  (void)s, (void)t, (void)y;
  if (a->told < a->energy.rows) rows(a);
  return 0;
}

static void finish(const struct call *call, struct energy_answer *a)
{
  const steif_energy *e = &a->energy;
  steif_report *r = a->report;
  rows(a);
  steif_report_whole(r, "steps", e->steps);
  if (e->h > 0)
    report_steps(r, &(struct steps_made){.t0 = a->problem->t0,
                                         .h = e->h,
                                         .end = e->end,
                                         .last_h = e->h,
                                         .asked = a->t1,
                                         .steps = e->steps});
  report_members(r, "", drift_members, &e->drift[a->which - 1]);
  steif_report_real(r, "period", e->period);
  steif_report_truth(r, "drifts", e->drift[a->which - 1].drifts);
  map_of_step(call, r, a->problem);
  for (size_t i = 0; a->columns > 2 && i + 1 < a->columns; i++) {
    steif_report_row(r, "invariants");
    report_members(r, "invariants.", drift_members, &e->drift[i]);
  }
}

static int draw(const struct call *call, const struct energy_answer *a)
{
  const steif_energy *e = &a->energy;
  char title[160];
  double *t = malloc((2 * e->rows + 1) * sizeof *t), *drift = t ? t + e->rows : NULL;
  if (!t) return no_memory(call, "the picture", "leave --plot out");
  for (size_t i = 0; i < e->rows; i++) {
    t[i] = e->row[i * a->columns];
    drift[i] = e->row[i * a->columns + a->which];
  }
  snprintf(title, sizeof title, "Drift of the invariant: %s, %s", call->word[0], call->word[1]);
  const steif_curve curve = {call->word[1], e->rows, t, drift, 0};
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "I(t) - I(0)", .count = 1, .curve = &curve};
  const int code = save_plot(call, &plot, call->plot);
  free(t);
  return code;
}

static int energy_present(struct call *call, struct energy_answer *a)
{
  finish(call, a);
  const int code = present(call, a->report);
  return code || !call->plot ? code : draw(call, a);
}

/* A run that a signal has stopped shows what it has seen. */
int energy_shown(struct call *call, struct energy_answer *a, int code)
{
  char why[240];
  if (code != STEIF_OK && !(code == STEIF_STOPPED && a->energy.steps > 0)) return fail(call);
  if (code == STEIF_OK) return energy_present(call, a);
  snprintf(why, sizeof why, "%s", steif_message(call->ctx));
  a->t1 = a->energy.end;
  const int output = energy_present(call, a);
  say(call, "%s", why);
  return output ? output : exit_of(code);
}
