/* system_image.c: what a system remembers of a run: E and A as they were filled, where, and their factors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "problem.h"
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void keep_sparse(stf_image *m, SUNMatrix M)
{
  sunindextype *column = SM_INDEXPTRS_S(M);
  const size_t columns = (size_t)SM_COLUMNS_S(M);
  size_t entries = (size_t)column[columns];
  stf_keep_count(m, &entries, (size_t)SM_NNZ_S(M));
  stf_keep(m, column, (columns + 1) * sizeof *column);
  stf_keep(m, SM_INDEXVALS_S(M), entries * sizeof(sunindextype));
  stf_keep(m, SM_DATA_S(M), entries * sizeof(sunrealtype));
}

static void keep_matrix(stf_image *m, SUNMatrix M)
{
  if (!M || m->code) return;
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE:
    stf_keep(m, SM_DATA_D(M), (size_t)SM_LDATA_D(M) * sizeof(sunrealtype));
    break;
  case SUNMATRIX_BAND:
    stf_keep(m, SM_DATA_B(M), (size_t)SM_LDATA_B(M) * sizeof(sunrealtype));
    break;
  default: keep_sparse(m, M);
  }
}

void stf_matrices_keep(stf_system *s, stf_image *m)
{
  keep_matrix(m, s->E);
  keep_matrix(m, s->A);
}

/* Operators are applied at the point of the last linearisation. */
static void keep_point(stf_system *s, stf_image *m)
{
  if (!s->at.y) return;
  STF_KEEP(m, s->at.t);
  stf_keep_vector(m, s->at.y);
  stf_keep_vector(m, s->at.yp);
  stf_keep_vector(m, s->at.f);
  STF_KEEP(m, s->at.size);
  if (!s->made.y) return;
  STF_KEEP(m, s->made.t);
  stf_keep_vector(m, s->made.y);
  stf_keep_vector(m, s->made.yp);
  stf_keep_vector(m, s->made.f);
}

void stf_system_keep(stf_system *s, stf_image *m)
{
  stf_matrices_keep(s, m);
  keep_point(s, m);
  if (s->near && !m->code) stf_pencil_keep(s->near, m);
  if (s->pencil && !m->code) stf_pencil_keep(s->pencil, m);
  STF_KEEP(m, s->filled);
  STF_KEEP(m, s->weight);
  STF_KEEP(m, s->nfe);
  STF_KEEP(m, s->nje);
  STF_KEEP(m, s->sums);
}
