/* constrained_columns.c: S on the algebraic equations differentiated, A S = F_p in the rows where E has no entries, to
 * rounding. Differences leave 1e-11 of S, which the first steps of index 3 divide by h^2; the movement of least norm is far
 * below the tolerance.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

typedef struct work {
  steif_solver *s;
  int n, rows, columns;
  int *row;           /* the algebraic equations */
  sunrealtype *J, *r; /* rows x n; n x columns: residuals, then movements */
  sunrealtype *sigma, *lapack;
  int size;
} work;

/* Rows of E without entries, where E applied to a vector of no particular direction is 0. */
static int find_rows(work *w, N_Vector x, N_Vector Ex)
{
  const stf_carry *T = w->s->step.carry;
  for (int j = 0; j < w->n; j++) stf_array(x)[j] = sqrt(2 + (sunrealtype)j);
  STEIF_TRY(stf_matrices_at_product(&T->at, 0, 'E', x, Ex));
  for (int i = 0; i < w->n; i++)
    if (stf_array(Ex)[i] == 0) w->row[w->rows++] = i;
  return STEIF_OK;
}

static int claim(work *w, stf_pool *pool)
{
  const size_t n = (size_t)w->n, m = (size_t)w->rows;
  w->size = 5 * w->n + w->columns;
  w->J = stf_pool_array(pool, m * n, sizeof *w->J);
  w->r = stf_pool_array(pool, n * (size_t)w->columns, sizeof *w->r);
  w->sigma = stf_pool_array(pool, n, sizeof *w->sigma);
  w->lapack = stf_pool_array(pool, (size_t)w->size, sizeof *w->lapack);
  return w->J && w->r && w->sigma && w->lapack ? STEIF_OK : STEIF_NO_MEMORY;
}

static int fill(work *w, N_Vector *S, N_Vector x, N_Vector Ax)
{
  stf_carry *T = w->s->step.carry;
  for (int j = 0; j < w->n; j++) {
    N_VConst(0, x);
    stf_array(x)[j] = 1;
    STEIF_TRY(stf_matrices_at_product(&T->at, 0, 'A', x, Ax));
    for (int i = 0; i < w->rows; i++) w->J[j * w->rows + i] = stf_array(Ax)[w->row[i]];
  }
  for (int k = 0; k < w->columns; k++) {
    STEIF_TRY(stf_carry_residual(T, 0, k, S[k], NULL, Ax));
    for (int i = 0; i < w->rows; i++) w->r[k * w->n + i] = stf_array(Ax)[w->row[i]];
  }
  return STEIF_OK;
}

static void move(work *w, N_Vector *S)
{
  const double small = 1e-10;
  int rank, info;
  dgelss_(&w->rows, &w->n, &w->columns, w->J, &w->rows, w->r, &w->n, w->sigma, &small, &rank,
          w->lapack, &w->size, &info);
  for (int k = 0; info == 0 && k < w->columns; k++)
    for (int j = 0; j < w->n; j++) stf_array(S[k])[j] -= w->r[k * w->n + j];
}

int stf_columns_constrain(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, N_Vector *S)
{
  stf_saltation *v = s->saltation;
  work w = {.s = s, .n = (int)s->problem->n, .columns = stf_columns(s)};
  if (w.columns == 0 || s->problem->n > STEIF_DIAGNOSE_LARGEST) return STEIF_OK;
  stf_pool *pool = stf_pool_new(s->ctx);
  int code = STEIF_NO_MEMORY;
  if (pool && (w.row = stf_pool_array(pool, (size_t)w.n, sizeof *w.row)))
    code = stf_carry_point(s->step.carry, 0, t, y, yp);
  if (!code) code = find_rows(&w, v->r[0], v->r[1]);
  if (!code && w.rows > 0) {
    code = claim(&w, pool);
    if (!code) code = fill(&w, S, v->r[0], v->r[1]);
    if (!code) move(&w, S);
  }
  stf_pool_free(&pool);
  return code > 0 ? steif_status(s->ctx) : code;
}
