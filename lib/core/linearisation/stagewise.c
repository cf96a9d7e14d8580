/* stagewise.c: consistent start values by stages. In stage k = -max d, ..., 0, 1 the equations
 * F_i^(c_i + k) determine y_j^(d_j + k) (orders >= 0), with the matching part of the system
 * Jacobian; what is left open moves least. J. D. Pryce, Numer. Algorithms 19 (1998) 195-211.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stagewise.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

static sunrealtype factorial(int k) { return k > 1 ? k * factorial(k - 1) : 1; }

static void put(stf_stage *w, const sunrealtype *z)
{
  for (size_t k = 0; k < w->columns; k++) {
    const int order = stf_stage_order(w, w->unknown[k]);
    w->u[(size_t)order * w->n + w->unknown[k]] = z[k] / factorial(order);
  }
}

static int residual(void *data, const sunrealtype *z, sunrealtype *r)
{
  stf_stage *w = data;
  put(w, z);
  STEIF_TRY(stf_total_derivatives_evaluate(&w->derivatives, &w->curve, w->values));
  for (size_t k = 0; k < w->rows; k++) {
    const int order = w->order[w->equation[k]];
    r[k] = factorial(order) * w->values[(size_t)order * w->n + w->equation[k]];
  }
  return STEIF_OK;
}

/* Sizes of the terms of the equations at the current point. */
static void rescale(stf_stage *w)
{
  const sunrealtype *floor = w->task->point->floor;
  sunrealtype *scale = w->task->scale;
  memset(scale, 0, w->n * sizeof *scale);
  for (size_t j = 0; j < w->n; j++)
    for (sunindextype k = w->view.column[j]; k < w->view.column[j + 1]; k++)
      scale[w->view.row[k]] += fabs(w->view.e[k] * w->u[w->n + j]) +
                               fabs(w->view.b[k]) * fmax(fabs(w->u[j]), floor[j]);
  for (size_t i = 0; i < w->n; i++)
    if (!(scale[i] > 0)) scale[i] = 1;
}

bool stf_stage_entry(const stf_stage *w, size_t j, sunindextype k, sunrealtype *value)
{
  const stf_view *v = &w->view;
  const int order = w->offsets->d[j] - w->offsets->c[v->row[k]];
  *value = order == 1 ? v->e[k] : v->b[k];
  return w->order[v->row[k]] >= 0 && (order == 0 || order == 1);
}

static void fill_dense(const stf_stage *w, sunrealtype *J)
{
  sunrealtype value;
  memset(J, 0, w->rows * w->columns * sizeof *J);
  for (size_t l = 0; l < w->columns; l++) {
    const size_t j = w->unknown[l];
    for (sunindextype k = w->view.column[j]; k < w->view.column[j + 1]; k++)
      if (stf_stage_entry(w, j, k, &value)) J[l * w->rows + w->row[w->view.row[k]]] = value;
  }
}

static void fill_sparse(const stf_stage *w, SUNMatrix J)
{
  sunindextype used = 0;
  sunrealtype value;
  for (size_t l = 0; l < w->columns; l++) {
    const size_t j = w->unknown[l];
    SM_INDEXPTRS_S(J)[l] = used;
    for (sunindextype k = w->view.column[j]; k < w->view.column[j + 1]; k++) {
      if (!stf_stage_entry(w, j, k, &value) || value == 0) continue;
      SM_INDEXVALS_S(J)[used] = (sunindextype)w->row[w->view.row[k]];
      SM_DATA_S(J)[used++] = value;
    }
  }
  SM_INDEXPTRS_S(J)[w->columns] = used;
}

static int place_of(const stf_stage *w)
{
  const int place = w->deepest + w->stage;
  return place >= 0 && place < STF_NODE_STAGES && w->derivatives.order < STF_NODE_ORDERS ? place
                                                                                         : -1;
}

static void remember(const stf_stage *w)
{
  stf_start_nodes *nodes = w->task->nodes;
  const int place = nodes ? place_of(w) : -1;
  if (nodes && w->derivatives.narrow) nodes->narrow = true;
  if (place < 0 || !stf_total_derivatives_fit(&w->derivatives, &w->curve)) return;
  nodes->known[place] = true;
  for (int p = 1; p <= w->derivatives.order; p++)
    nodes->delta[place][p] = w->derivatives.window[p].delta;
}

static bool remembered(stf_stage *w)
{
  const stf_start_nodes *nodes = w->task->nodes;
  const int place = place_of(w);
  if (place < 0 || !nodes->known[place]) return false;
  for (int p = 1; p <= w->derivatives.order; p++)
    w->derivatives.window[p] = (stf_window){.delta = nodes->delta[place][p]};
  return stf_total_derivatives_fit(&w->derivatives, &w->curve);
}

/* Are the nodes of earlier points good enough for this one? */
static void look_at_nodes(stf_start_nodes *nodes, const stf_point *s, sunrealtype slow,
                          sunrealtype fast)
{
  enum { USES = 16 };
  const sunrealtype apart = 1.5;
  const bool near = slow <= apart * nodes->slowest && nodes->slowest <= apart * slow &&
                    fast <= apart * nodes->fastest && nodes->fastest <= apart * fast;
  if (nodes->uses == 0 || nodes->uses >= USES || !near || nodes->from != s->from)
    *nodes = (stf_start_nodes){.slowest = slow, .fastest = fast, .from = s->from, .to = s->to};
  nodes->narrow = false;
  nodes->uses++;
}

/* Nodes serve the curves near to that they were chosen for: large systems spare the search for others, and so do
 * points beside which some are remembered. The first curve of a stage has slopes that are guesses, or 0: nodes are
 * looked for along the next ones, too. */
static bool searches(stf_stage *w, bool sparse)
{
  enum { SEARCHES = 3 };
  if (w->chosen == 0) w->recalled = w->task->nodes && remembered(w);
  if (w->recalled) return false;
  return (!sparse && !w->task->nodes) || w->chosen < SEARCHES;
}

static int jacobian(void *data, stf_nearest_point *m)
{
  stf_stage *w = data;
  stf_point *point = w->task->point;
  put(w, m->z);
  STEIF_TRY(stf_view_take(point, w->curve.t, w->u, w->u + w->n, &w->view));
  rescale(w);
  if (searches(w, m->sparse)) {
    STEIF_TRY(
      stf_total_derivatives_choose(&w->derivatives, &w->curve, w->task->scale, w->order));
    remember(w);
  }
  w->chosen++;
  if (!m->sparse)
    fill_dense(w, m->J);
  else if (m->entries >= (size_t)w->view.column[w->n])
    fill_sparse(w, m->sparse);
  else
    return STEIF_RETRY;
  return STEIF_OK;
}

static void select(stf_stage *w)
{
  const stf_offsets *s = w->offsets;
  w->rows = w->columns = 0;
  for (size_t i = 0; i < w->n; i++) {
    w->order[i] = s->c[i] + w->stage >= 0 ? s->c[i] + w->stage : -1;
    w->row[i] = w->rows;
    if (w->order[i] >= 0) w->equation[w->rows++] = i;
  }
  for (size_t j = 0; j < w->n; j++) {
    const int order = stf_stage_order(w, j);
    const bool fixed = order == 0 && stf_start_attribute(w->task, j) == STEIF_FIXED;
    if (order >= 0 && !fixed) w->unknown[w->columns++] = j;
  }
}

static void prepare(void *data, stf_nearest_point *m)
{
  stf_stage *w = data;
  const stf_start_task *task = w->task;
  const sunrealtype rate = sqrt(w->derivatives.slowest * w->derivatives.fastest);
  for (size_t k = 0; k < w->columns; k++) {
    const size_t j = w->unknown[k];
    const int order = stf_stage_order(w, j);
    const bool guessed = order == 0 && stf_start_attribute(task, j) == STEIF_GUESS;
    m->z[k] = factorial(order) * w->u[(size_t)order * w->n + j];
    m->target[k] = guessed ? w->guess[j] : NAN;
    m->weight[k] = stf_start_weight(task, j) * (guessed ? 1 : STF_PROXIMAL * pow(rate, -order));
    m->unit[k] = task->point->floor[j] * pow(rate, order);
  }
}

/* -- one stage --------------------------------------------------------------------------- */

/* What moved by rounding only did not move. */
static void snap(stf_nearest_point *m)
{
  for (size_t k = 0; k < m->columns; k++)
    if (fabs(m->z[k] - m->target[k]) <= 64 * STF_EPS * fabs(m->target[k]))
      m->z[k] = m->target[k];
}

static int accept(void *data, stf_nearest_point *m)
{
  stf_stage *w = data;
  snap(m);
  put(w, m->z);
  return stf_stage_judge(w, m);
}

static int run(stf_stage *w)
{
  select(w);
  w->chosen = 0;
  if (w->rows == 0) return STEIF_OK;
  const bool sparse = w->n > STEIF_DIAGNOSE_LARGEST;
  const size_t entries = (size_t)w->task->view->column[w->n];
  stf_nearest_point m = {.solver = sparse ? &stf_nearest_sparse : &stf_nearest_dense,
                         .entries = 2 * entries,
                         .rows = w->rows,
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

static int claim(stf_pool *pool, stf_stage *w)
{
  const size_t n = w->n, orders = (size_t)w->deepest + 1;
  w->u = stf_pool_array(pool, 2 * orders * n, sizeof *w->u);
  w->guess = stf_pool_array(pool, n, sizeof *w->guess);
  w->equation = stf_pool_array(pool, 3 * n, sizeof *w->equation);
  w->order = stf_pool_array(pool, n, sizeof *w->order);
  if (!w->u || !w->guess || !w->equation || !w->order) return STEIF_NO_MEMORY;
  w->values = w->u + orders * n;
  w->unknown = w->equation + n;
  w->row = w->equation + 2 * n;
  w->curve = (stf_curve){.t = w->task->point->t, .tau = 1, .count = w->deepest + 1, .z = w->u};
  return STEIF_OK;
}

static int all(stf_stage *w, stf_pool *pool, int c, int d)
{
  stf_point *point = w->task->point;
  sunrealtype slow, fast;
  stf_view_rates(point, w->task->view, &slow, &fast);
  if (w->task->nodes) look_at_nodes(w->task->nodes, point, slow, fast);
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
  stf_stage w = {.task = task, .offsets = s, .n = point->n};
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
  stf_view_free(point, &w.view);
  stf_pool_free(&pool);
  return code;
}
