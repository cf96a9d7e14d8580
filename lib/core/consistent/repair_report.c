/* repair_report.c: the sentence on what a repair has done to a start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"
#include <math.h>
#include <string.h>

/* In tolerances. */
static sunrealtype movement(const stf_repair *r, const sunrealtype *y, size_t j)
{
  return fabs(y[j] - r->point.y0[j]) / r->weight[j];
}

/* Those of `count` moved components without, or with, a derivative that moved most. */
static void list_moved(stf_repair *r, const sunrealtype *y, bool algebraic, int count)
{
  enum { SHOWN = 4 };
  char room[STEIF_SPEC_WORD], *text = r->report.message;
  sunrealtype below = INFINITY;
  for (int shown = 0; shown < SHOWN && shown < count; shown++) {
    size_t at = 0;
    sunrealtype most = -1;
    for (size_t j = 0; j < r->point.n; j++) {
      const sunrealtype part = movement(r, y, j);
      if (r->algebraic[j] == algebraic && part < below && part > most) most = part, at = j;
    }
    below = most;
    stf_point_say(text, "%s%s by %.3g",
                  shown     ? ", "
                  : text[0] ? ", and without a derivative "
                            : "start: moved ",
                  stf_point_unknown(&r->point, at, room), y[at] - r->point.y0[at]);
  }
  if (count > SHOWN) stf_point_say(text, " and %d more", count - SHOWN);
}

/* Count what moved, and name it: jumps of velocities and charges before the forces that follow from them. */
void stf_report_moved(stf_repair *r, const sunrealtype *y)
{
  int count[2] = {0, 0};
  for (size_t j = 0; j < r->point.n; j++) {
    const sunrealtype part = movement(r, y, j);
    count[r->algebraic[j]] += part > 1;
    r->report.largest = fmax(r->report.largest, part);
  }
  r->report.moved = count[0] + count[1];
  for (int k = 0; k < 2; k++) list_moved(r, y, k, count[k]);
}

/* F_i = 0 where equation i has derivatives, or where tolerances of its unknowns, allowed_i in all, make as
 * much of it. */
static void keep_violations(const stf_repair *r, sunrealtype *F, sunrealtype *allowed)
{
  const stf_view *v = &r->view;
  for (size_t j = 0; j < v->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      if (v->has[k] & 1) F[v->row[k]] = 0;
      allowed[v->row[k]] += fabs(v->b[k]) * r->weight[j];
    }
  for (size_t i = 0; i < v->n; i++)
    if (fabs(F[i]) <= 0.1 * allowed[i]) F[i] = 0;
}

/* The equations without derivatives that the given start violates most. */
int stf_report_violated(stf_repair *r)
{
  enum { SHOWN = 3 };
  stf_point *s = &r->point;
  char room[STEIF_SPEC_WORD];
  sunrealtype *F = stf_allocate(r->ctx, 2 * s->n, sizeof *F), below = INFINITY;
  if (!F) return STEIF_NO_MEMORY;
  int code = stf_point_residual(s, s->t, s->y0, s->yp0, F);
  if (!code) keep_violations(r, F, F + s->n);
  for (int shown = 0; shown < SHOWN && !code; shown++) {
    size_t at = 0;
    sunrealtype most = 0;
    for (size_t i = 0; i < s->n; i++)
      if (fabs(F[i]) < below && fabs(F[i]) > most) most = fabs(F[i]), at = i;
    if (!(most > 0)) break;
    below = most;
    stf_point_say(r->report.message, "%s%s (off by %.2g)", shown ? ", " : " to fulfil ",
                  stf_point_equation(s, at, room), most);
  }
  stf_release(r->ctx, F);
  return code < 0 ? code : STEIF_OK;
}

/* Hidden constraints: those whose derivatives the stages have enforced. */
void stf_report_enforced(stf_repair *r, const int *enforced)
{
  enum { SHOWN = 3 };
  char room[STEIF_SPEC_WORD];
  int shown = 0, most = 0;
  for (size_t i = 0; i < r->point.n; i++) most = enforced[i] > most ? enforced[i] : most;
  for (size_t i = 0; i < r->point.n && most > 0; i++) {
    if (enforced[i] < most) continue;
    if (shown++ < SHOWN)
      stf_point_say(r->report.message, "%s%s",
                    shown > 1 ? ", " : "; kept with their derivatives: ",
                    stf_point_equation(&r->point, i, room));
  }
  if (shown > SHOWN) stf_point_say(r->report.message, " and %d more", shown - SHOWN);
}

/* Energy and other invariants that the movement has changed. */
int stf_report_invariants(stf_repair *r, const sunrealtype *y)
{
  const steif_problem *p = r->given;
  if (p->invariants <= 0 || !p->invariant) return STEIF_OK;
  const size_t count = (size_t)p->invariants;
  sunrealtype *a = stf_allocate(r->ctx, 2 * count, sizeof *a);
  if (!a) return STEIF_NO_MEMORY;
  memcpy(stf_array(r->point.y), r->point.y0, r->point.n * sizeof *y);
  int code = p->invariant(r->point.t, r->point.y, a, p->user);
  memcpy(stf_array(r->point.y), y, r->point.n * sizeof *y);
  if (!code) code = p->invariant(r->point.t, r->point.y, a + count, p->user);
  for (size_t k = 0; k < count && !code; k++)
    if (fabs(a[count + k] - a[k]) > r->rtol * (fabs(a[k]) + 1))
      stf_point_say(r->report.message, "; invariant %zu changes by %.3g", k + 1,
                    a[count + k] - a[k]);
  stf_release(r->ctx, a);
  return STEIF_OK;
}

/* E (y - y_0) by the velocities, or charges, that jump: what impulses of the constraints have put into these equations. */
int stf_report_impulses(stf_repair *r, const steif_diagnosis *d, const sunrealtype *y)
{
  enum { SHOWN = 3 };
  const stf_view *v = &r->view;
  char room[STEIF_SPEC_WORD];
  const size_t n = r->point.n;
  sunrealtype *jump = stf_allocate(r->ctx, 2 * n, sizeof *jump), *allowed = jump + n;
  int shown = 0;
  if (!jump) return STEIF_NO_MEMORY;
  for (size_t j = 0; j < n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      if (d->index >= 3 && d->number[j] < 2) continue;
      jump[v->row[k]] += v->e[k] * (y[j] - r->point.y0[j]);
      allowed[v->row[k]] += fabs(v->e[k]) * r->weight[j];
    }
  for (size_t i = 0; i < n && shown < SHOWN; i++)
    if (fabs(jump[i]) > allowed[i])
      stf_point_say(r->report.message, "%s%.4g in %s", shown++ ? ", " : "; impulse ", jump[i],
                    stf_point_equation(&r->point, i, room));
  stf_release(r->ctx, jump);
  return STEIF_OK;
}
