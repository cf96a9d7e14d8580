/* model_problem.c: a model as a steif_problem: its callbacks and its members.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { DENSE_UP_TO = 64 };

static stf_feed feed_at(const stf_model *m, sunrealtype t, N_Vector y, N_Vector yp)
{
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = y ? N_VGetArrayPointer(y) : NULL;
  feed.yp = yp ? N_VGetArrayPointer(yp) : NULL;
  return feed;
}

static int run(sunrealtype t, N_Vector y, N_Vector yp, N_Vector out, const stf_model *m)
{
  const stf_feed feed = feed_at(m, t, y, yp);
  double *to = N_VGetArrayPointer(out);
  memset(to, 0, (size_t)m->n * sizeof *to);
  stf_quantity_run(m, &m->f, &feed, to);
  for (int32_t i = 0; i < m->n; i++)
    if (!isfinite(to[i])) return 1;
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  return run(t, y, NULL, ydot, user);
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  return run(t, y, yp, r, user);
}

static int fill(const stf_model *m, const stf_matrix *M, const stf_feed *feed, SUNMatrix to)
{
  if (SUNMatGetID(to) == SUNMATRIX_SPARSE) {
    if (SUNSparseMatrix_NNZ(to) < M->entries) return -1;
    double *data = SUNSparseMatrix_Data(to);
    memcpy(SUNSparseMatrix_IndexPointers(to), M->column,
           ((size_t)m->n + 1) * sizeof *M->column);
    memcpy(SUNSparseMatrix_IndexValues(to), M->row, (size_t)M->entries * sizeof *M->row);
    memset(data, 0, (size_t)M->entries * sizeof *data);
    stf_quantity_run(m, &M->quantity, feed, data);
    return 0;
  }
  memset(M->scratch, 0, (size_t)M->entries * sizeof *M->scratch);
  stf_quantity_run(m, &M->quantity, feed, M->scratch);
  for (int32_t j = 0; j < m->n; j++)
    for (sunindextype k = M->column[j]; k < M->column[j + 1]; k++)
      SM_ELEMENT_D(to, M->row[k], j) = M->scratch[k];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const stf_model *m = user;
  const stf_feed feed = feed_at(m, t, y, NULL);
  (void)fy, (void)a, (void)b, (void)c;
  return fill(m, &m->A, &feed, J);
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  const stf_model *m = user;
  const stf_feed feed = feed_at(m, t, y, yp);
  return fill(m, &m->A, &feed, A);
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const stf_model *m = user;
  const stf_feed feed = feed_at(m, t, y, yp);
  return fill(m, &m->E, &feed, E);
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  if (!derivative) return run(t, NULL, NULL, out, user);
  return 1;
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

/* ---- members --------------------------------------------------------------------------------- */

static int interval(stf_model *m, steif_problem *p)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_TIME) continue;
    STEIF_TRY(stf_number_of(m, &s->value, &p->t0));
    STEIF_TRY(stf_number_of(m, &s->other, &p->t1));
    if (p->t1 > p->t0) return STEIF_OK;
    stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                 "the interval from %.12g to %.12g; the end lies after the start", p->t0,
                 p->t1);
    return stf_complaints(&m->syntax.sources);
  }
  stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
               "no time interval; add 'time 0 to 10'");
  return stf_complaints(&m->syntax.sources);
}

static const char *title(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_TITLE) continue;
    const stf_text *text = STF_AT(m->syntax.sources.texts, stf_text, 0);
    char *copy = stf_pool_array(m->pool, (size_t)s->strlength + 1, 1);
    return copy ? memcpy(copy, text->text + s->string, s->strlength) : NULL;
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

int stf_model_fill(stf_model *m, steif_problem *p)
{
  const double full = (double)m->n * m->n;
  p->about = title(m);
  if (!p->about) return STEIF_NO_MEMORY;
  p->n = m->n;
  p->y0 = m->y0;
  p->yp0 = m->yp0;
  p->user = m;
  m->problem_names = (steif_names){.unknown = m->unknown, .equation = m->equation};
  p->names = &m->problem_names;
  p->storage =
    m->n <= DENSE_UP_TO || (double)m->A.entries > 0.3 * full ? STEIF_DENSE : STEIF_SPARSE;
  p->nnz = m->A.entries;
  p->nnz_E = m->E.entries;
  p->linear = m->linear;
  p->autonomous = m->autonomous;
  callbacks(m, p);
  STEIF_TRY(sizes(m, p));
  return interval(m, p);
}
