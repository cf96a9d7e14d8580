/* model_problem.c: a model as a steif_problem: its callbacks and its members.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "products.h"
#include "reactions.h"
#include "series.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { DENSE_UP_TO = 64, DERIVATIVES = 64 };

static stf_feed feed_at(const stf_model *m, sunrealtype t, N_Vector y, N_Vector yp)
{
  return (stf_feed){.t = t,
                    .y = stf_array(y),
                    .yp = yp ? stf_array(yp) : NULL,
                    .p = m->feed.p,
                    .memory = m->feed.memory,
                    .lookups = m->feed.lookups};
}

/* A frozen branch is evaluated a little beyond its border, where it may have no
 * value: then relations are taken as they are at this point. The step ends at
 * the event, so that this does no harm. */
void stf_take_literally(const stf_model *m, stf_feed *feed)
{
  memcpy(m->memory_literal, m->memory, (size_t)m->memories * sizeof *m->memory);
  stf_literal_switches(m, feed->t, feed->y, m->memory_literal);
  feed->memory = m->memory_literal;
}

static bool retried(const stf_model *m, stf_feed *feed, double *to)
{
  if (!m->switches || !feed->y) return false;
  stf_take_literally(m, feed);
  stf_quantity_run(m, &m->f, feed, to);
  return stf_all_finite(to, (size_t)m->n);
}

/* The operation that has no value, as a failure that a smaller step may cure. */
static int blame(stf_model *m, const stf_feed *feed, const double *f)
{
  stf_blame found;
  int32_t i = 0;
  int line, column;
  while (i < m->n && isfinite(f[i])) i++;
  if (i == m->n || !stf_find_blame(m, feed, i, &found)) return 1;
  const stf_text *text = stf_place(&m->syntax.sources, found.at, &line, &column);
  return STEIF_RECOVER(m->ctx, STEIF_NOT_FINITE, "%s:%d:%d: %s, in the equation of row %s",
                       text->name, line, column, found.what, m->unknown[i]);
}

/* f is not finite: where branches are frozen, as they are at this point; else why. */
static __attribute__((noinline)) int amiss(stf_model *m, stf_feed *feed, double *to)
{
  return retried(m, feed, to) ? 0 : blame(m, feed, to);
}

static int run(stf_model *m, stf_feed *feed, N_Vector out)
{
  double *to = stf_array(out);
  stf_quantity_run(m, &m->f, feed, to);
  return stf_all_finite(to, (size_t)m->n) ? 0 : amiss(m, feed, to);
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  stf_feed feed = feed_at(user, t, y, NULL);
  return run(user, &feed, ydot);
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  stf_feed feed = feed_at(user, t, y, yp);
  return run(user, &feed, r);
}

/* The entries; where a frozen branch has none, those of the branch at this point. */
static void entries(const stf_model *m, const stf_matrix *M, stf_feed *feed, double *to)
{
  stf_quantity_run(m, &M->quantity, feed, to);
  if (!m->switches || !feed->y || stf_all_finite(to, (size_t)M->entries)) return;
  stf_take_literally(m, feed);
  stf_quantity_run(m, &M->quantity, feed, to);
}

static int fill(const stf_model *m, const stf_matrix *M, stf_feed *feed, SUNMatrix to)
{
  if (SUNMatGetID(to) == SUNMATRIX_SPARSE) {
    if (SUNSparseMatrix_NNZ(to) < M->entries) return -1;
    memcpy(SUNSparseMatrix_IndexPointers(to), M->column,
           ((size_t)m->n + 1) * sizeof *M->column);
    memcpy(SUNSparseMatrix_IndexValues(to), M->row, (size_t)M->entries * sizeof *M->row);
    entries(m, M, feed, SUNSparseMatrix_Data(to));
    return 0;
  }
  entries(m, M, feed, M->scratch);
  sunindextype k = 0;
  for (int32_t j = 0; j < m->n; j++) {
    double *column = SM_COLUMN_D(to, j);
    for (; k < M->column[j + 1]; k++) column[M->row[k]] = M->scratch[k];
  }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const stf_model *m = user;
  stf_feed feed = feed_at(m, t, y, NULL);
  (void)fy, (void)a, (void)b, (void)c;
  return fill(m, &m->A, &feed, J);
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  const stf_model *m = user;
  stf_feed feed = feed_at(m, t, y, yp);
  return fill(m, &m->A, &feed, A);
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const stf_model *m = user;
  stf_feed feed = feed_at(m, t, y, yp);
  return fill(m, &m->E, &feed, E);
}

/* One equation of g in all passes; NaN where the derivative is not known. */
static int differentiate(stf_model *m, const stf_block *block, const stf_equation *e,
                         const stf_feed *feed, int order, double *to, bool *known)
{
  const int64_t count = stf_passes(&block->box);
  int32_t counter[STF_LOOPS];
  for (int64_t k = 0; k < count; k++) {
    const int32_t row = e->slot ? e->slot[k] : stf_at_pass(&block->box, k, e->row, e->stride);
    for (int d = 0; d < STF_LOOPS; d++) {
      static const int32_t unit[STF_LOOPS][STF_LOOPS] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      counter[d] = stf_at_pass(&block->box, k, 0, unit[d]);
    }
    double coefficient[DERIVATIVES + 1], factorial = 1;
    const int code = stf_taylor(&block->graph, e->forcing, feed, NULL, counter, order,
                                &m->sweep, coefficient, NULL);
    if (code < 0) return code;
    for (int j = 2; j <= order; j++) factorial *= j;
    to[row] = code ? NAN : factorial * coefficient[order];
    *known = *known || !code;
  }
  return STEIF_OK;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  stf_model *m = user;
  stf_feed feed = {
    .t = t, .p = m->feed.p, .memory = m->feed.memory, .lookups = m->feed.lookups};
  if (!derivative) return run(m, &feed, out);
  if (derivative > DERIVATIVES) return 1;
  bool known = false;
  for (size_t i = 0; i < m->blocks.count; i++) {
    const stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    for (size_t k = 0; k < block->equations.count; k++) {
      const stf_equation *e = STF_AT(block->equations, stf_equation, k);
      const int code = differentiate(m, block, e, &feed, derivative, stf_array(out), &known);
      if (code < 0) return code;
    }
  }
  return known ? 0 : 1;
}

/* The smallest size that is declared serves all unknowns. */
static int sizes(stf_model *m, steif_problem *p)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    double scale = 0;
    if (s->kind != STF_SAY_STATE || s->other.to == s->other.from) continue;
    STEIF_TRY(stf_number_of(m, &s->other, &scale));
    if (!(scale > 0 && isfinite(scale))) {
      stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                   "the scale of a state is a positive number, here %g", scale);
      return stf_complaints(&m->syntax.sources);
    }
    if (!(p->rtol_scale > 0) || scale < p->rtol_scale) p->rtol_scale = scale;
  }
  return STEIF_OK;
}

/* ---- members
 * ---------------------------------------------------------------------------------
 */

static const char *title(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_TITLE) continue;
    char *copy = stf_pool_array(m->pool, (size_t)s->strlength + 1, 1);
    return copy ? memcpy(copy, stf_source_at(&m->syntax.sources, s->string), s->strlength)
                : NULL;
  }
  return "a model";
}

static void callbacks(const stf_model *m, steif_problem *p)
{
  p->E = m->form == STEIF_ODE ? NULL : fill_E;
  if (m->form == STEIF_IMPLICIT) p->F = F;
  if (m->form == STEIF_DESCRIPTOR) p->g = g;
  if (m->form == STEIF_IMPLICIT || m->form == STEIF_DESCRIPTOR) p->A = fill_A;
  if (m->form == STEIF_ODE || m->form == STEIF_MASS) {
    p->f = f;
    p->jac = jac;
  }
}

static void events(stf_model *m, steif_problem *p)
{
  p->events = m->switches + m->timers;
  if (!p->events) return;
  p->event = stf_event_callback;
  p->event_list = m->event_list;
  p->handle_event = stf_reactions_handle;
  if (m->form != STEIF_ODE) p->event_slope = stf_reactions_slope;
  p->event_spacing = isfinite(m->piece) ? m->piece : 0;
  p->begin = stf_reactions_begin;
  p->save = stf_reactions_save;
  p->restore = stf_reactions_restore;
}

/* A start at which an equation has no value is no start. */
static int check_start(stf_model *m)
{
  stf_blame found;
  stf_feed feed = m->feed;
  feed.t = m->t0;
  feed.y = m->y0;
  feed.yp = m->yp0;
  if (m->form == STEIF_IMPLICIT && !feed.yp) return STEIF_OK;
  double *f = stf_allocate(m->ctx, (size_t)m->n, sizeof *f);
  if (!f) return STEIF_NO_MEMORY;
  stf_quantity_run(m, &m->f, &feed, f);
  int32_t i = 0;
  while (i < m->n && isfinite(f[i])) i++;
  stf_release(m->ctx, f);
  if (i == m->n || !stf_find_blame(m, &feed, i, &found)) return STEIF_OK;
  char *mark = strstr(found.what, " (t = ");
  if (mark) *mark = 0;
  stf_complain(&m->syntax.sources, found.at, STEIF_NOT_FINITE,
               "%s at the start%s%s; change the start or rewrite", found.what, mark ? " (" : "",
               mark ? mark + 2 : "");
  return stf_complaints(&m->syntax.sources);
}

int stf_model_fill(stf_model *m, steif_problem *p)
{
  const double full = (double)m->n * m->n;
  p->about = title(m);
  if (!p->about) return STEIF_NO_MEMORY;
  p->n = m->n;
  p->y0 = m->y0;
  p->yp0 = m->yp0;
  p->user = m;
  STEIF_TRY(stf_name_equations(m));
  m->problem_names = (steif_names){.unknown = m->unknown, .equation = m->equation};
  p->names = &m->problem_names;
  p->storage =
    m->n <= DENSE_UP_TO || (double)m->A.entries > 0.3 * full ? STEIF_DENSE : STEIF_SPARSE;
  p->nnz = m->A.entries;
  p->nnz_E = m->E.entries;
  p->linear = m->linear;
  p->autonomous = m->autonomous;
  callbacks(m, p);
  p->t0 = m->t0;
  p->t1 = isfinite(m->t1) ? m->t1 : m->t0;
  events(m, p);
  STEIF_TRY(sizes(m, p));
  STEIF_TRY(stf_finish(m, p));
  STEIF_TRY(stf_products_open(m));
  stf_operators(m, p);
  STEIF_TRY(stf_parameter_members(m, p));
  STEIF_TRY(stf_reactions_begin(m->t0, m));
  STEIF_TRY(stf_consistent_start(m, p));
  STEIF_TRY(stf_reactions_begin(m->t0, m));
  return check_start(m);
}
