/* kinetic_jump.c: the jump of velocities, or of charges, that impulses of the constraints make. In a step of backward
 * Euler of length h with frozen E and B = F_y,
 *   E (w - y(t-))/h + F(t + h, y(t-), 0) + B (w - y(t-)) = 0,  constraints as they are at w,
 * E (w - y(t-)) is h times what multipliers push, which are of size 1/h: as h -> 0, M (v+ - v-) = -G^T Lambda, and
 * (v+ - v-)^T M (v+ - v-) is least; 2 w(h) - w(2 h) is free of the motion h y'. E and B are those at y(t-), then those at
 * y(t+): they differ where the directions of impulses depend on what jumps, and then no jump is the right one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "repair.h"
#include <math.h>
#include <string.h>

enum { ROUNDS = 6, TURNS = 60 };
static const sunrealtype part = 1e-7, apart = 10;

typedef struct jump {
  stf_repair *r;
  size_t n;
  const sunrealtype *base;
  sunrealtype *F0, *F, *zero, *w, *once, *twice;
  bool *constraint; /* rows without derivatives */
} jump;

/* E (w - base)/h + F0 + B (w - base) of rows with derivatives, F(w) of the others. */
static int residual(jump *q, sunrealtype h)
{
  const stf_view *v = &q->r->view;
  stf_point *s = &q->r->point;
  STEIF_TRY(stf_point_residual(s, s->t + h, q->w, q->zero, q->F));
  for (size_t i = 0; i < q->n; i++)
    if (!q->constraint[i]) q->F[i] = q->F0[i];
  for (size_t j = 0; j < q->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      if (!q->constraint[v->row[k]])
        q->F[v->row[k]] += (v->e[k] / h + v->b[k]) * (q->w[j] - q->base[j]);
  return STEIF_OK;
}

/* The end of a step of length h into `out`. */
static int step(jump *q, sunrealtype h, sunrealtype *out)
{
  stf_point *s = &q->r->point;
  stf_view_factor c;
  N_Vector x = s->r;
  int code = stf_view_factor_open(q->r, 1 / h, NULL, 1, &c);
  if (!code) code = stf_point_residual(s, s->t + h, q->base, q->zero, q->F0);
  memcpy(q->w, q->base, q->n * sizeof *q->w);
  for (int k = 0; k < ROUNDS && !code; k++) {
    code = residual(q, h);
    if (code) break;
    memcpy(stf_array(x), q->F, q->n * sizeof *q->F);
    code = steif_pencil_solve(c.pencil, 0, 1, &x, NULL);
    for (size_t j = 0; j < q->n && !code; j++) q->w[j] -= stf_array(x)[j];
  }
  stf_view_factor_close(&c);
  memcpy(out, q->w, q->n * sizeof *out);
  for (size_t j = 0; j < q->n && !code; j++)
    if (!isfinite(out[j])) code = STEIF_RETRY;
  return code;
}

/* y(t+) with the matrices of the view: in differential components; the others stay. */
static int through(jump *q, sunrealtype h, sunrealtype *y)
{
  STEIF_TRY(step(q, h, q->once));
  STEIF_TRY(step(q, 2 * h, q->twice));
  for (size_t j = 0; j < q->n; j++)
    y[j] = q->r->algebraic[j] ? q->base[j] : 2 * q->once[j] - q->twice[j];
  return STEIF_OK;
}

/* In tolerances; *at: where. */
static sunrealtype distance(const jump *q, const sunrealtype *a, const sunrealtype *b,
                            size_t *at)
{
  sunrealtype most = 0;
  *at = 0;
  for (size_t j = 0; j < q->n; j++) {
    const sunrealtype d = fabs(a[j] - b[j]) / q->r->weight[j];
    if (!q->r->algebraic[j] && !(d <= most)) most = d, *at = j;
  }
  return most;
}

static int at_state(jump *q, const sunrealtype *y, sunrealtype h, sunrealtype *out)
{
  stf_repair *r = q->r;
  STEIF_TRY(stf_view_take(&r->point, r->point.t, y, r->yp, &r->view));
  return through(q, h, out);
}

/* Matrices at y(t+) itself, by iteration. */
static int right(jump *q, const sunrealtype *left, sunrealtype h, sunrealtype *y,
                 sunrealtype *next)
{
  size_t at;
  memcpy(y, left, q->n * sizeof *y);
  for (int k = 0; k < TURNS; k++) {
    STEIF_TRY(at_state(q, y, h, next));
    const sunrealtype moved = distance(q, next, y, &at);
    memcpy(y, next, q->n * sizeof *y);
    if (moved <= 1e-3) return STEIF_OK;
  }
  return STEIF_RETRY;
}

static int compare(const jump *q, const sunrealtype *left, const sunrealtype *y)
{
  size_t at;
  char room[STEIF_SPEC_WORD];
  STEIF_CHECK(
    !(distance(q, left, y, &at) > apart), q->r->ctx, STEIF_BAD_INPUT,
    "the start of '%s' jumps, and how is not unique: %s becomes %.10g where impulses act "
    "as before the jump, %.10g as after it; give a start on the constraints",
    q->r->given->name, stf_point_unknown(&q->r->point, at, room), left[at], y[at]);
  return STEIF_OK;
}

static void mark_constraints(const stf_view *v, bool *constraint)
{
  for (size_t i = 0; i < v->n; i++) constraint[i] = true;
  for (size_t j = 0; j < v->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      if (v->has[k] & 1) constraint[v->row[k]] = false;
}

static int find(jump *q, sunrealtype *work, sunrealtype *y)
{
  stf_repair *r = q->r;
  sunrealtype slow, fast, *left = work, *next = work + q->n;
  const sunrealtype span = r->given->t1 - r->given->t0;
  stf_view_rates(&r->point, &r->view, &slow, &fast);
  const sunrealtype h = fmin(part * span, part / sqrt(slow * fast));
  if (!(h > 0)) return STEIF_RETRY;
  STEIF_TRY(at_state(q, q->base, h, left));
  STEIF_TRY(right(q, left, h, y, next));
  return compare(q, left, y);
}

static int jump_of(stf_repair *r, const sunrealtype *base, sunrealtype *y)
{
  const size_t n = r->point.n;
  stf_pool *pool = stf_pool_new(r->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  sunrealtype *work = stf_pool_array(pool, 8 * n, sizeof *work);
  jump q = {.r = r, .n = n, .base = base, .constraint = stf_pool_array(pool, n, sizeof(bool))};
  int code = work && q.constraint ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code) {
    q.F0 = work + 2 * n, q.F = work + 3 * n, q.zero = work + 4 * n;
    q.w = work + 5 * n, q.once = work + 6 * n, q.twice = work + 7 * n;
    code = stf_view_take(&r->point, r->point.t, base, r->yp, &r->view);
  }
  if (!code) {
    mark_constraints(&r->view, q.constraint);
    code = find(&q, work, y);
  }
  stf_pool_free(&pool);
  const bool passes = code == STEIF_OK || code == STEIF_BAD_INPUT || code == STEIF_NO_MEMORY;
  if (!passes) steif_forget(r->ctx);
  return passes ? code : STEIF_RETRY;
}

/* What is the same but for rounding, and positions, stay as they are in *start. */
static bool differs(const stf_repair *r, const steif_diagnosis *d, const steif_start *start,
                    sunrealtype *y)
{
  static const sunrealtype same = 1e-3;
  bool some = false;
  for (size_t j = 0; j < r->point.n; j++) {
    const bool position = d->index >= 3 && d->number[j] == 1;
    if (r->algebraic[j] || position || fabs(y[j] - start->y[j]) <= same * r->weight[j])
      y[j] = start->y[j];
    else
      some = true;
  }
  return some;
}

/* The stages move velocities least in sum m_jj dv_j^2; where M is not diagonal the jump is another one. Positions
 * stay where the stages put them, and the stages end what linear constraints leave open. */
int stf_keep_momenta(stf_repair *r, stf_evidence *e, const steif_diagnosis *d,
                     const steif_request *request, steif_start *start)
{
  stf_point *s = &r->point;
  const size_t n = s->n, bytes = n * sizeof *s->y0;
  for (size_t j = 0; j < n; j++)
    if (r->attribute && r->attribute[j] == STEIF_FIXED) return STEIF_OK;
  steif_start better = {0};
  sunrealtype *base = stf_pool_array(s->pool, 3 * n, sizeof *base);
  if (!base) return STEIF_NO_MEMORY;
  sunrealtype *y = base + n, *given = base + 2 * n;
  memcpy(given, s->y0, bytes);
  for (size_t j = 0; j < n; j++)
    base[j] = r->algebraic[j] || (d->index >= 3 && d->number[j] == 1) ? start->y[j] : given[j];
  memcpy(r->y, start->y, bytes);
  memcpy(r->yp, start->yp, bytes);
  int code = jump_of(r, base, y);
  if (code) return code > 0 ? STEIF_OK : code;
  if (!differs(r, d, start, y)) return STEIF_OK;
  memcpy(s->y0, y, bytes);
  code = stf_start_from(e, d, request, &better);
  memcpy(s->y0, given, bytes);
  if (code) {
    steif_forget(r->ctx);
    return code == STEIF_NO_MEMORY ? code : STEIF_OK;
  }
  memcpy(start->y, better.y, bytes);
  memcpy(start->yp, better.yp, bytes);
  steif_start_clear(&better);
  return STEIF_OK;
}
