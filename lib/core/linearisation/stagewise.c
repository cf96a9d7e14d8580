/* stagewise.c: consistent start values by stages. In stage k = -max d, ..., 0, 1 the equations
 * F_i^(c_i + k) determine y_j^(d_j + k) (orders >= 0), with the matching part of the system
 * Jacobian; what is left open moves least. J. D. Pryce, Numer. Algorithms 19 (1998) 195-211.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "consistent_start.h"
#include "nearest.h"
#include "total_derivatives.h"
#include <math.h>
#include <string.h>

typedef struct stage_work {
  stf_start_task *task;
  const stf_offsets *offsets;
  size_t n;
  int deepest; /* orders kept */
  int stage;
  sunrealtype *u; /* y^(k)/k!, (deepest + 1) x n */
  sunrealtype *guess, *values, *E, *B;
  size_t rows, columns;
  size_t *equation, *unknown;
  int *order; /* n: of equation i in this stage, -1 */
  stf_total_derivatives derivatives;
  stf_curve curve;
} stage_work;

static sunrealtype factorial(int k) { return k > 1 ? k * factorial(k - 1) : 1; }

static int unknown_order(const stage_work *w, size_t j) { return w->offsets->d[j] + w->stage; }

static void put(stage_work *w, const sunrealtype *z)
{
  for (size_t k = 0; k < w->columns; k++) {
    const int order = unknown_order(w, w->unknown[k]);
    w->u[(size_t)order * w->n + w->unknown[k]] = z[k] / factorial(order);
  }
}

static int residual(void *data, const sunrealtype *z, sunrealtype *r)
{
  stage_work *w = data;
  put(w, z);
  STEIF_TRY(stf_total_derivatives_evaluate(&w->derivatives, &w->curve, w->values));
  for (size_t k = 0; k < w->rows; k++) {
    const int order = w->order[w->equation[k]];
    r[k] = factorial(order) * w->values[(size_t)order * w->n + w->equation[k]];
  }
  return STEIF_OK;
}

/* Sizes of the terms of the equations at the current point. */
static void rescale(stage_work *w)
{
  const sunrealtype *floor = w->task->point->floor;
  sunrealtype *scale = w->task->scale;
  memset(scale, 0, w->n * sizeof *scale);
  for (size_t k = 0; k < w->n * w->n; k++) {
    const size_t i = k % w->n, j = k / w->n;
    scale[i] += fabs(w->E[k] * w->u[w->n + j]) + fabs(w->B[k]) * fmax(fabs(w->u[j]), floor[j]);
  }
  for (size_t i = 0; i < w->n; i++)
    if (!(scale[i] > 0)) scale[i] = 1;
}

static int jacobian(void *data, const sunrealtype *z, sunrealtype *J)
{
  stage_work *w = data;
  const stf_offsets *s = w->offsets;
  put(w, z);
  STEIF_TRY(stf_point_matrices(w->task->point, w->curve.t, w->u, w->u + w->n, w->E, w->B));
  rescale(w);
  STEIF_TRY(stf_total_derivatives_choose(&w->derivatives, &w->curve, w->task->scale, w->order));
  for (size_t l = 0; l < w->columns; l++)
    for (size_t k = 0; k < w->rows; k++) {
      const size_t i = w->equation[k], j = w->unknown[l];
      const int order = s->d[j] - s->c[i];
      J[l * w->rows + k] = order == 1   ? w->E[j * w->n + i]
                           : order == 0 ? w->B[j * w->n + i]
                                        : 0;
    }
  return STEIF_OK;
}

static void select(stage_work *w)
{
  const stf_offsets *s = w->offsets;
  w->rows = w->columns = 0;
  for (size_t i = 0; i < w->n; i++) {
    w->order[i] = s->c[i] + w->stage >= 0 ? s->c[i] + w->stage : -1;
    if (w->order[i] >= 0) w->equation[w->rows++] = i;
  }
  for (size_t j = 0; j < w->n; j++) {
    const int order = unknown_order(w, j);
    const bool fixed = order == 0 && stf_start_attribute(w->task, j) == STEIF_FIXED;
    if (order >= 0 && !fixed) w->unknown[w->columns++] = j;
  }
}

static void prepare(void *data, stf_nearest_point *m)
{
  stage_work *w = data;
  const stf_start_task *task = w->task;
  const sunrealtype rate = sqrt(w->derivatives.slowest * w->derivatives.fastest);
  for (size_t k = 0; k < w->columns; k++) {
    const size_t j = w->unknown[k];
    const int order = unknown_order(w, j);
    const bool guessed = order == 0 && stf_start_attribute(task, j) == STEIF_GUESS;
    m->z[k] = factorial(order) * w->u[(size_t)order * w->n + j];
    m->target[k] = guessed ? w->guess[j] : NAN;
    m->weight[k] = stf_start_weight(task, j) * (guessed ? 1 : STF_PROXIMAL * pow(rate, -order));
    m->unit[k] = task->point->floor[j] * pow(rate, order);
  }
}

/* -- what went wrong --------------------------------------------------------------------- */

static bool occurs(const stage_work *w, size_t i, size_t j)
{
  return w->E[j * w->n + i] != 0 || w->B[j * w->n + i] != 0;
}

/* Equations that the fixed values contradict: those with a part in a combination of rows
 * that no unknown of the stage can change and that is not zero. */
static int conflict(stage_work *w, const stf_nearest_point *m, sunrealtype size)
{
  stf_point *point = w->task->point;
  char text[STEIF_SENTENCE] = "", room[STEIF_SPEC_WORD];
  size_t fixed = 0, last = 0;
  stf_point_say(text, "fixed values contradict each other: equations {");
  int *in = w->order; /* done with */
  for (size_t i = 0; i < w->n; i++) in[i] = 0;
  for (size_t k = m->rank; k < m->rows; k++) {
    sunrealtype along = 0;
    for (size_t i = 0; i < m->rows; i++) along += m->U[k * m->rows + i] * m->left[i] * m->r[i];
    for (size_t i = 0; i < m->rows && fabs(along) > 1e-9; i++)
      if (fabs(m->U[k * m->rows + i]) > 1e-6) in[w->equation[i]] = 1;
  }
  stf_point_list(point, text, true, in, 1, false);
  stf_point_say(text, "} contain only fixed unknowns {");
  for (size_t j = 0; j < w->n; j++) {
    if (unknown_order(w, j) != 0 || stf_start_attribute(w->task, j) != STEIF_FIXED) continue;
    bool there = false;
    for (size_t i = 0; i < w->n; i++) there = there || (in[i] && occurs(w, i, j));
    if (!there) continue;
    stf_point_say(text, "%s%s", fixed++ ? ", " : "", stf_point_unknown(point, j, room));
    last = j;
  }
  stf_point_say(text, "}; residual %.4g.", size);
  if (fixed == 1)
    stf_point_say(text, " The equations determine %s: it can never be prescribed.",
                  stf_point_unknown(point, last, room));
  else
    stf_point_say(text, " Leave at least one of them free.");
  return STEIF_FAIL(point->ctx, STEIF_BAD_INPUT, "%s", text);
}

static int stalled(stage_work *w, const stf_nearest_point *m, size_t worst, sunrealtype size)
{
  stf_point *point = w->task->point;
  char text[STEIF_SENTENCE] = "", e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  for (size_t k = 0; k < w->columns && k < 3; k++)
    stf_point_say(text, "%s%s", k ? ", " : "",
                  stf_point_unknown(point, w->unknown[w->columns - 1 - k], y));
  return STEIF_FAIL(
    point->ctx, STEIF_NO_CONVERGENCE,
    "no consistent point found within %d iterations; residual %.3g in %s; stage "
    "%d stalled; last unknowns %s: give better values for them",
    m->iterations, size, stf_point_equation(point, w->equation[worst], e), w->stage, text);
}

static int singular(stage_work *w, const stf_nearest_point *m, size_t worst)
{
  stf_point *point = w->task->point;
  char text[STEIF_SENTENCE] = "", y[STEIF_SPEC_WORD], e[STEIF_SPEC_WORD];
  const size_t least = m->rows < m->columns ? m->rows : m->columns;
  int shown = 0;
  for (size_t k = 0; k < m->columns && shown < 5; k++) {
    sunrealtype part = 0;
    for (size_t q = m->rank; q < least; q++) part = fmax(part, fabs(m->VT[k * m->columns + q]));
    if (part > 0.3)
      stf_point_say(text, "%s%s", shown++ ? ", " : "",
                    stf_point_unknown(point, w->unknown[k], y));
  }
  return STEIF_FAIL(
    point->ctx, STEIF_SINGULAR,
    "%s %s more than one consistent value near the guess, or none (Jacobian of "
    "stage %d nearly singular, rcond %.1e; equation %s is off by %.3g): give %s, or "
    "move the guess",
    shown ? text : "the start", shown > 1 ? "have" : "has", w->stage, m->rcond,
    stf_point_equation(point, w->equation[worst], e), fabs(m->r[worst]),
    shown ? text : "more values");
}

/* -- one stage --------------------------------------------------------------------------- */

/* Largest residual against the terms of its equation; *worst names the row. */
static sunrealtype leftover(const stage_work *w, const stf_nearest_point *m, size_t *worst)
{
  sunrealtype most = 0;
  *worst = 0;
  for (size_t k = 0; k < m->rows; k++) {
    sunrealtype size = w->task->scale[w->equation[k]];
    for (size_t l = 0; l < m->columns; l++)
      size = fmax(size, fabs(m->J[l * m->rows + k]) * fmax(fabs(m->z[l]), m->unit[l]));
    const sunrealtype part = fabs(m->r[k]) / (size > 0 ? size : 1);
    if (!(part <= most)) most = part, *worst = k;
  }
  return most;
}

static int judge(stage_work *w, stf_nearest_point *m)
{
  size_t fixed = 0, worst;
  for (size_t j = 0; j < w->n; j++)
    fixed += unknown_order(w, j) == 0 && stf_start_attribute(w->task, j) == STEIF_FIXED;
  const sunrealtype part = leftover(w, m, &worst);
  w->task->start->residual = fmax(w->task->start->residual, part);
  if (part > STF_VIOLATED && m->rank < m->rows && fixed)
    return conflict(w, m, fabs(m->r[worst]));
  if (m->rank < m->rows && !fixed) return singular(w, m, worst);
  if (part > (m->converged ? STF_VIOLATED : STF_FULFILLED))
    return stalled(w, m, worst, fabs(m->r[worst]));
  return STEIF_OK;
}

/* What moved by rounding only did not move. */
static void snap(stf_nearest_point *m)
{
  for (size_t k = 0; k < m->columns; k++)
    if (fabs(m->z[k] - m->target[k]) <= 64 * STF_EPS * fabs(m->target[k]))
      m->z[k] = m->target[k];
}

static int accept(void *data, stf_nearest_point *m)
{
  stage_work *w = data;
  snap(m);
  put(w, m->z);
  return judge(w, m);
}

static int run(stage_work *w)
{
  select(w);
  if (w->rows == 0) return STEIF_OK;
  stf_nearest_point m = {.rows = w->rows,
                         .columns = w->columns,
                         .residual = residual,
                         .jacobian = jacobian,
                         .prepare = prepare,
                         .accept = accept,
                         .data = w,
                         .most = w->task->most};
  const int code = stf_nearest_point_find(w->task->point, &m);
  w->task->start->iterations += m.iterations;
  return code;
}

static int claim(stf_pool *pool, stage_work *w)
{
  const size_t n = w->n, orders = (size_t)w->deepest + 1;
  w->u = stf_pool_array(pool, 2 * orders * n, sizeof *w->u);
  w->guess = stf_pool_array(pool, n, sizeof *w->guess);
  w->E = stf_pool_array(pool, 2 * n * n, sizeof *w->E);
  w->equation = stf_pool_array(pool, 2 * n, sizeof *w->equation);
  w->order = stf_pool_array(pool, n, sizeof *w->order);
  if (!w->u || !w->guess || !w->E || !w->equation || !w->order) return STEIF_NO_MEMORY;
  w->values = w->u + orders * n, w->B = w->E + n * n, w->unknown = w->equation + n;
  w->curve = (stf_curve){.t = w->task->point->t, .tau = 1, .count = w->deepest + 1, .z = w->u};
  return STEIF_OK;
}

static int all(stage_work *w, stf_pool *pool, int c, int d)
{
  stf_point *point = w->task->point;
  sunrealtype slow, fast;
  stf_view_rates(point, w->task->view, &slow, &fast);
  STEIF_TRY(claim(pool, w));
  memcpy(w->u, point->y0, w->n * sizeof *w->u);
  memcpy(w->u + w->n, point->yp0, w->n * sizeof *w->u);
  memcpy(w->guess, point->y0, w->n * sizeof *w->guess);
  bool algebraic = false;
  for (size_t j = 0; j < w->n; j++) algebraic = algebraic || w->offsets->d[j] == 0;
  for (w->stage = -d; w->stage <= (algebraic ? 1 : 0); w->stage++) {
    const int order = c + w->stage;
    STEIF_TRY(stf_total_derivatives_open(pool, point, order > 0 ? order : 0, &w->derivatives));
    w->derivatives.slowest = slow, w->derivatives.fastest = fast;
    STEIF_TRY(run(w));
    w->task->start->stages++;
  }
  return STEIF_OK;
}

int stf_start_stages(stf_start_task *task, const stf_offsets *s)
{
  stf_point *point = task->point;
  stage_work w = {.task = task, .offsets = s, .n = point->n};
  int c = 0, d = 0;
  for (size_t i = 0; i < w.n; i++) c = s->c[i] > c ? s->c[i] : c, d = s->d[i] > d ? s->d[i] : d;
  STEIF_CHECK(c < STF_DEEPEST, point->ctx, STEIF_UNSUPPORTED,
              "'%s' has an equation that must be differentiated %d times: a start is computed "
              "for at most %d",
              point->problem.name, c, STF_DEEPEST - 1);
  w.deepest = d + 1 > c + 2 ? d + 1 : c + 2;
  stf_pool *pool = stf_pool_new(point->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  task->start->stages = 0;
  const int code = all(&w, pool, c, d);
  if (!code) {
    memcpy(task->start->y, w.u, w.n * sizeof *w.u);
    memcpy(task->start->yp, w.u + w.n, w.n * sizeof *w.u);
    memcpy(task->start->enforced, s->c, w.n * sizeof *s->c);
  }
  stf_pool_free(&pool);
  return code;
}
