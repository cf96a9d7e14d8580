/* whole_array.c: consistent start values from the whole derivative array F_0 = ... = F_K = 0, K
 * the index, where the structure cannot order the equations. Components of number 1 move
 * least; with them fixed those of number 2, and so on.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "nearest.h"
#include "total_derivatives.h"
#include <math.h>
#include <string.h>

typedef struct whole {
  stf_start_task *task;
  size_t n, rows, columns;
  int K, pass; /* pass: the number that is moved least now */
  const int *number;
  sunrealtype *z, *values, *nodes, *E, *B, *D;
  size_t *place; /* of the unknowns of a pass in z */
  stf_curve curve;
  stf_chebyshev rule;
  stf_total_derivatives derivatives;
} whole;

static void put(whole *w, const sunrealtype *z)
{
  for (size_t k = 0; k < w->columns; k++) w->z[w->place[k]] = z[k];
}

static int residual(void *data, const sunrealtype *z, sunrealtype *r)
{
  whole *w = data;
  put(w, z);
  STEIF_TRY(stf_total_derivatives_evaluate(&w->derivatives, &w->curve, w->values));
  memcpy(r, w->values, w->rows * sizeof *r);
  return STEIF_OK;
}

static int jacobian(void *data, stf_nearest_point *m)
{
  whole *w = data;
  sunrealtype delta;
  put(w, m->z);
  STEIF_TRY(stf_total_derivatives_choose(&w->derivatives, &w->curve, w->task->scale, NULL));
  STEIF_TRY(
    stf_curve_matrices(w->task->point, &w->curve, &w->rule, w->nodes, w->E, w->B, &delta));
  stf_derivative_array_fill(w->n, w->K, w->curve.tau, w->E, w->B, w->D);
  for (size_t k = 0; k < w->columns; k++)
    memcpy(m->J + k * w->rows, w->D + w->place[k] * w->rows, w->rows * sizeof *m->J);
  return STEIF_OK;
}

/* Fixed ones and those of earlier passes stay. */
static bool stays(const whole *w, size_t j)
{
  const enum steif_attribute a = stf_start_attribute(w->task, j);
  return a == STEIF_FIXED || (a == STEIF_GUESS && w->number[j] < w->pass);
}

static void select(whole *w)
{
  w->columns = 0;
  for (size_t k = 0; k < (size_t)(w->K + 2) * w->n; k++)
    if (k >= w->n || !stays(w, k)) w->place[w->columns++] = k;
}

static void prepare(void *data, stf_nearest_point *m)
{
  const whole *w = data;
  const stf_point *s = w->task->point;
  for (size_t k = 0; k < w->columns; k++) {
    const size_t at = w->place[k], j = at % w->n;
    const bool pulled =
      at < w->n && w->number[j] == w->pass && stf_start_attribute(w->task, j) == STEIF_GUESS;
    m->z[k] = w->z[at];
    m->target[k] = pulled ? s->y0[j] : NAN;
    m->weight[k] = stf_start_weight(w->task, j) * (pulled ? 1 : STF_PROXIMAL);
    m->unit[k] = s->floor[j];
  }
}

static int judge(whole *w, const stf_nearest_point *m)
{
  stf_point *s = w->task->point;
  char room[STEIF_SPEC_WORD];
  sunrealtype most = 0;
  size_t worst = 0;
  for (size_t k = 0; k < w->n; k++) {
    const sunrealtype part = fabs(m->r[k]) / w->task->scale[k];
    if (!(part <= most)) most = part, worst = k;
  }
  w->task->start->residual = fmax(w->task->start->residual, most);
  STEIF_CHECK(
    most <= (m->converged ? STF_VIOLATED : STF_FULFILLED), s->ctx, STEIF_NO_CONVERGENCE,
    "no consistent point found within %d iterations of the array of %d derivatives; "
    "residual %.3g in %s%s: give better values",
    m->iterations, w->K, fabs(m->r[worst]), stf_point_equation(s, worst, room),
    m->rank < m->rows ? " (fixed values contradict each other, or equations repeat)" : "");
  return STEIF_OK;
}

static int accept(void *data, stf_nearest_point *m)
{
  whole *w = data;
  put(w, m->z);
  return judge(w, m);
}

static int one_pass(whole *w)
{
  select(w);
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

static int claim(stf_pool *pool, whole *w)
{
  const size_t n = w->n, orders = (size_t)w->K + 2, square = n * n;
  stf_chebyshev_open(&w->rule, w->K + 4, w->K + 1);
  w->z = stf_pool_array(pool, 2 * orders * n, sizeof *w->z);
  w->nodes = stf_pool_array(pool, 2 * (size_t)w->rule.m * square, sizeof *w->nodes);
  w->E = stf_pool_array(pool, 2 * orders * square, sizeof *w->E);
  w->D = stf_pool_array(pool, w->rows * orders * n, sizeof *w->D);
  w->place = stf_pool_array(pool, orders * n, sizeof *w->place);
  if (!w->z || !w->nodes || !w->E || !w->D || !w->place) return STEIF_NO_MEMORY;
  w->values = w->z + orders * n, w->B = w->E + orders * square;
  return stf_total_derivatives_open(pool, w->task->point, w->K, &w->derivatives);
}

static int all(whole *w, stf_pool *pool, sunrealtype tau)
{
  stf_point *s = w->task->point;
  int last = 0;
  STEIF_TRY(claim(pool, w));
  stf_view_rates(s, w->task->view, &w->derivatives.slowest, &w->derivatives.fastest);
  w->curve = (stf_curve){.t = s->t, .tau = tau, .count = w->K + 2, .z = w->z};
  for (size_t j = 0; j < w->n; j++) {
    w->z[j] = s->y0[j], w->z[w->n + j] = tau * s->yp0[j];
    last = w->number[j] > last ? w->number[j] : last;
  }
  for (w->pass = 1; w->pass <= last; w->pass++) {
    bool there = false;
    for (size_t j = 0; j < w->n; j++) there = there || w->number[j] == w->pass;
    if (there) STEIF_TRY(one_pass(w));
  }
  return STEIF_OK;
}

int stf_start_array(stf_start_task *task, const stf_derivative_array *a, const int *number)
{
  stf_point *s = task->point;
  whole w = {.task = task, .n = s->n, .K = a->index, .number = number};
  w.rows = (size_t)(w.K + 1) * w.n;
  stf_pool *pool = stf_pool_new(s->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = all(&w, pool, a->tau);
  for (size_t j = 0; j < w.n && !code; j++) {
    task->start->y[j] = w.z[j];
    task->start->yp[j] = w.z[w.n + j] / a->tau;
    task->start->enforced[j] = a->derivatives[j];
  }
  task->start->stages = 1;
  stf_pool_free(&pool);
  return code;
}
