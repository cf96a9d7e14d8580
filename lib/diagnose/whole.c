/* whole.c: consistent start values from the whole derivative array F_0 = ... = F_K = 0, K
 * the index, where the structure cannot order the equations. Components of number 1 move
 * least; with them fixed those of number 2, and so on.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "diagnose.h"
#include <math.h>
#include <string.h>

static const sunrealtype proximal = 1e-3, violated = 1e-6, fulfilled = 1e-10;

typedef struct whole {
  stf_task *task;
  size_t n, rows, columns;
  int K, pass; /* pass: the number that is moved least now */
  const int *number;
  sunrealtype *z, *climb, *nodes, *E, *B, *D;
  size_t *place; /* of the unknowns of a pass in z */
  stf_curve curve;
  stf_fit fit;
  stf_ladder ladder;
} whole;

static void put(whole *w, const sunrealtype *z)
{
  for (size_t k = 0; k < w->columns; k++) w->z[w->place[k]] = z[k];
}

static int residual(void *data, const sunrealtype *z, sunrealtype *r)
{
  whole *w = data;
  put(w, z);
  STEIF_TRY(stf_ladder_climb(&w->ladder, &w->curve, w->climb));
  memcpy(r, w->climb, w->rows * sizeof *r);
  return STEIF_OK;
}

static int jacobian(void *data, const sunrealtype *z, sunrealtype *J)
{
  whole *w = data;
  sunrealtype delta;
  put(w, z);
  STEIF_TRY(stf_ladder_choose(&w->ladder, &w->curve, w->task->scale, NULL));
  STEIF_TRY(
    stf_curve_matrices(w->task->lens, &w->curve, &w->fit, w->nodes, w->E, w->B, &delta));
  stf_array_fill(w->n, w->K, w->curve.tau, w->E, w->B, w->D);
  for (size_t k = 0; k < w->columns; k++)
    memcpy(J + k * w->rows, w->D + w->place[k] * w->rows, w->rows * sizeof *J);
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

static void prepare(void *data, stf_move *m)
{
  const whole *w = data;
  const stf_lens *s = w->task->lens;
  for (size_t k = 0; k < w->columns; k++) {
    const size_t at = w->place[k], j = at % w->n;
    const bool pulled =
      at < w->n && w->number[j] == w->pass && stf_start_attribute(w->task, j) == STEIF_GUESS;
    m->z[k] = w->z[at];
    m->target[k] = pulled ? s->y0[j] : NAN;
    m->weight[k] = stf_start_weight(w->task, j) * (pulled ? 1 : proximal);
    m->unit[k] = s->floor[j];
  }
}

static int judge(whole *w, const stf_move *m)
{
  stf_lens *s = w->task->lens;
  char room[STEIF_SPEC_WORD];
  sunrealtype most = 0;
  size_t worst = 0;
  for (size_t k = 0; k < w->n; k++) {
    const sunrealtype part = fabs(m->r[k]) / w->task->scale[k];
    if (!(part <= most)) most = part, worst = k;
  }
  w->task->start->residual = fmax(w->task->start->residual, most);
  STEIF_CHECK(most <= (m->converged ? violated : fulfilled), s->ctx, STEIF_NO_CONVERGENCE,
              "no consistent point found within %d iterations of the array of %d derivatives; "
              "residual %.3g in %s%s: give better values",
              m->iterations, w->K, fabs(m->r[worst]), stf_diagnose_equation(s, worst, room),
              m->rank < m->rows ? " (fixed values contradict each other, or equations repeat)"
                                : "");
  return STEIF_OK;
}

static int accept(void *data, stf_move *m)
{
  whole *w = data;
  put(w, m->z);
  return judge(w, m);
}

static int one_pass(whole *w)
{
  select(w);
  stf_move m = {.rows = w->rows,
                .columns = w->columns,
                .residual = residual,
                .jacobian = jacobian,
                .prepare = prepare,
                .accept = accept,
                .data = w,
                .most = w->task->most};
  const int code = stf_move_run(w->task->lens, &m);
  w->task->start->iterations += m.iterations;
  return code;
}

static int claim(stf_pool *pool, whole *w)
{
  const size_t n = w->n, orders = (size_t)w->K + 2, square = n * n;
  stf_fit_open(&w->fit, w->K + 4, w->K + 1);
  w->z = stf_claim(pool, 2 * orders * n, sizeof *w->z);
  w->nodes = stf_claim(pool, 2 * (size_t)w->fit.m * square, sizeof *w->nodes);
  w->E = stf_claim(pool, 2 * orders * square, sizeof *w->E);
  w->D = stf_claim(pool, w->rows * orders * n, sizeof *w->D);
  w->place = stf_claim(pool, orders * n, sizeof *w->place);
  if (!w->z || !w->nodes || !w->E || !w->D || !w->place) return STEIF_NO_MEMORY;
  w->climb = w->z + orders * n, w->B = w->E + orders * square;
  return stf_ladder_open(pool, w->task->lens, w->K, &w->ladder);
}

static int all(whole *w, stf_pool *pool, sunrealtype tau)
{
  stf_lens *s = w->task->lens;
  int last = 0;
  STEIF_TRY(claim(pool, w));
  stf_view_rates(s, w->task->view, &w->ladder.slowest, &w->ladder.fastest);
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

int stf_start_array(stf_task *task, const stf_array *a, const int *number)
{
  stf_lens *s = task->lens;
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
