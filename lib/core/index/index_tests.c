/* index_tests.c: the three tests of the index at several points: the one given, a consistent one where
 * the structure offers it, and two moved by about a percent of each component, the last in time too.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "consistent_start.h"
#include "evidence.h"
#include "index_thresholds.h"
#include <math.h>
#include <string.h>

enum { RETRIES = 12 };

static int open_point(stf_evidence *e, int k)
{
  const size_t n = e->point->n;
  e->at[k].y = stf_pool_array(e->point->pool, 3 * n, sizeof *e->at[k].y);
  if (!e->at[k].y) return STEIF_NO_MEMORY;
  e->at[k].yp = e->at[k].y + n;
  e->at[k].ypp = e->at[k].y + 2 * n;
  e->at[k].t = e->point->t;
  return stf_derivative_array_open(e->point, &e->at[k].array);
}

/* Move y, y' and y'' by `part` of their sizes; zeros move by a tenth of that, of their
 * floor. */
static void move(const stf_point *s, sunrealtype part, sunrealtype rate, unsigned *seed,
                 sunrealtype *y, sunrealtype *yp, sunrealtype *ypp)
{
  for (size_t j = 0; j < s->n; j++) {
    const sunrealtype size = s->y0[j] != 0 ? fabs(s->y0[j]) : 0.1 * s->floor[j];
    const sunrealtype u = stf_point_random(seed);
    y[j] = s->y0[j] + part * size * u;
    yp[j] = s->yp0[j] + part * (fabs(s->yp0[j]) + rate * size) * stf_point_random(seed);
    ypp[j] = part * rate * rate * size * stf_point_random(seed);
  }
}

/* A point beside the given one where everything can be evaluated. */
static int beside(stf_evidence *e, int k, sunrealtype rate)
{
  stf_point *s = e->point;
  sunrealtype part = STF_POINTS_APART;
  const sunrealtype length = s->problem.t1 > s->t ? s->problem.t1 - s->t : 0;
  int code = STEIF_RETRY;
  for (int tries = 0; tries < RETRIES && code > 0; tries++, part /= 4) {
    unsigned seed = 77003u + 5u * (unsigned)k;
    move(s, part, rate, &seed, e->at[k].y, e->at[k].yp, e->at[k].ypp);
    if (k == STF_POINTS - 2)
      e->at[k].t = fmin(s->t + 0.1 * part * fmin(length, 1 / rate), s->to);
    code = stf_view_take(s, e->at[k].t, e->at[k].y, e->at[k].yp, &e->view);
    if (!code) code = stf_point_residual(s, e->at[k].t, e->at[k].y, e->at[k].yp, s->scratch);
  }
  return code;
}

int stf_evidence_points(stf_evidence *e)
{
  stf_point *s = e->point;
  sunrealtype slow, fast;
  STEIF_TRY(open_point(e, 0));
  memcpy(e->at[0].y, s->y0, s->n * sizeof *s->y0);
  memcpy(e->at[0].yp, s->yp0, s->n * sizeof *s->yp0);
  int code = stf_view_take(s, s->t, s->y0, s->yp0, &e->view);
  STEIF_CHECK(
    code <= 0, s->ctx, STEIF_CALLBACK,
    "'%s' cannot be evaluated at t = %g, the point to diagnose: give a point inside the "
    "domain of its functions",
    s->problem.name, s->t);
  STEIF_TRY(code);
  stf_view_rates(s, &e->view, &slow, &fast);
  e->points = 1;
  if (s->system.linear) return STEIF_OK; /* all points are alike */
  for (int k = 2; k < STF_POINTS; k++) {
    STEIF_TRY(open_point(e, e->points));
    code = beside(e, e->points, sqrt(slow * fast));
    if (code < 0) return code;
    e->points += !code;
  }
  return STEIF_OK;
}

/* The point after a start by stages joins the others, if that is found. */
static int add_consistent(stf_evidence *e)
{
  stf_point *s = e->point;
  const steif_request request = {0};
  steif_start start = {0};
  STEIF_TRY(stf_start_allocate(s->ctx, s->n, &start));
  stf_start_task task = {
    .point = s, .request = &request, .start = &start, .view = &e->view, .most = 30};
  task.scale = stf_allocate(s->ctx, s->n, sizeof *task.scale);
  int code = task.scale ? stf_start_scale(&task) : STEIF_NO_MEMORY;
  if (!code) code = stf_start_stages(&task, &e->offsets);
  if (!code) code = open_point(e, e->points);
  if (!code) {
    memcpy(e->at[e->points].y, start.y, s->n * sizeof *start.y);
    memcpy(e->at[e->points].yp, start.yp, s->n * sizeof *start.yp);
    code = stf_view_take(s, s->t, start.y, start.yp, &e->view);
    e->points += !code;
  }
  stf_release(s->ctx, task.scale);
  steif_start_clear(&start);
  return code == STEIF_NO_MEMORY ? code : STEIF_OK;
}

static int measure_jacobian(stf_evidence *e, int k)
{
  const stf_offsets *S = &e->offsets;
  STEIF_TRY(stf_view_take(e->point, e->at[k].t, e->at[k].y, e->at[k].yp, &e->view));
  if (!S->matched) return STEIF_OK;
  const int code = stf_factor_jacobian(e->factor, &e->view, S->c, S->d);
  if (code) return code == STEIF_SINGULAR ? STEIF_OK : code;
  return stf_factor_rcond(e->factor, &e->at[k].rcond);
}

int stf_evidence_regular(stf_evidence *e)
{
  STEIF_TRY(stf_factor_open(e->point, &e->view, &e->factor));
  for (int k = 0; k < e->points; k++) STEIF_TRY(measure_jacobian(e, k));
  return STEIF_OK;
}

static int measure(stf_evidence *e, int k)
{
  stf_point *s = e->point;
  const stf_offsets *S = &e->offsets;
  STEIF_TRY(measure_jacobian(e, k));
  if (s->n > STEIF_DIAGNOSE_LARGEST && k > 0) return STEIF_OK;
  const bool good = S->matched && e->at[k].rcond >= stf_evidence_regular_rcond(s);
  return stf_resolvent_growth_find(s, &e->view, e->factor, good ? S->component_index : NULL,
                                   &e->at[k].growth);
}

int stf_evidence_growth(stf_evidence *e)
{
  STEIF_TRY(stf_factor_open(e->point, &e->view, &e->factor));
  for (int k = 0; k < e->points; k++) {
    const int code = measure(e, k);
    if (code < 0) return code;
  }
  return STEIF_OK;
}

int stf_evidence_structure(stf_evidence *e)
{
  STEIF_TRY(stf_evidence_points(e));
  STEIF_TRY(stf_evidence_offsets(e));
  return stf_evidence_regular(e);
}

int stf_evidence_certified_at(stf_evidence *e, const steif_start *start, bool *certified)
{
  stf_point *s = e->point;
  const int k = e->points;
  const sunindextype entries = e->view.column[s->n];
  *certified = true;
  if (s->n > STEIF_DIAGNOSE_LARGEST || s->system.linear) return STEIF_OK;
  STEIF_TRY(open_point(e, k));
  e->at[k].y = start->y, e->at[k].yp = start->yp;
  const int code = stf_view_take(s, s->t, start->y, start->yp, &e->view);
  if (code || e->view.column[s->n] != entries) return code == STEIF_NO_MEMORY ? code : STEIF_OK;
  STEIF_TRY(measure_jacobian(e, k));
  *certified = e->at[k].rcond >= stf_evidence_regular_rcond(s);
  return STEIF_OK;
}

sunrealtype stf_evidence_regular_rcond(const stf_point *s)
{
  return s->analytic ? STF_REGULAR_EXACT : STF_REGULAR_RCOND;
}

sunrealtype stf_evidence_rcond(const stf_evidence *e)
{
  sunrealtype rcond = e->points ? INFINITY : 0;
  for (int k = 0; k < e->points; k++) rcond = fmin(rcond, e->at[k].rcond);
  return rcond;
}

bool stf_evidence_certified(const stf_evidence *e)
{
  return e->offsets.matched &&
         (!e->points || stf_evidence_rcond(e) >= stf_evidence_regular_rcond(e->point));
}

/* Of constant matrices all points are alike; where the structure is not certified there are no stages.
 * A point that brings new entries would need another structure. */
int stf_evidence_consistent(stf_evidence *e)
{
  const stf_point *s = e->point;
  const int before = e->points;
  const sunindextype entries = e->view.column[s->n];
  const bool small = s->n <= STEIF_DIAGNOSE_LARGEST;
  if (!small || s->system.linear || !stf_evidence_certified(e)) return STEIF_OK;
  STEIF_TRY(add_consistent(e));
  if (e->points > before && e->view.column[s->n] == entries) return measure(e, before);
  e->points = before;
  return STEIF_OK;
}

bool stf_evidence_agrees(const stf_evidence *e)
{
  if (!stf_evidence_certified(e)) return false;
  for (int k = 0; k < e->points; k++)
    if (!e->at[k].growth.found || e->at[k].growth.index != e->offsets.index) return false;
  return true;
}

int stf_evidence_offsets(stf_evidence *e)
{
  const stf_point *s = e->point;
  const stf_view *v = &e->view;
  return stf_offsets_find(s->ctx, s->pool, s->n, v->column, v->row, v->has, &e->offsets);
}

int stf_evidence_arrays(stf_evidence *e)
{
  stf_point *s = e->point;
  if (s->n > STF_ARRAY_LARGEST) return STEIF_OK;
  if (s->n > STF_ALWAYS_ARRAY && stf_evidence_agrees(e)) return STEIF_OK;
  for (int k = 0; k < e->points; k++) {
    STEIF_TRY(stf_view_take(s, e->at[k].t, e->at[k].y, e->at[k].yp, &e->view));
    STEIF_TRY(stf_derivative_array_scan(s, &e->view, e->at[k].t, e->at[k].y, e->at[k].yp,
                                        e->at[k].ypp, &e->at[k].array));
    e->arrays++;
  }
  return STEIF_OK;
}

void stf_evidence_free(stf_evidence *e)
{
  stf_view_free(e->point, &e->view);
  stf_factor_free(&e->factor);
}
