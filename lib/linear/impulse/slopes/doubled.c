/* doubled.c: matrices, start and forcing of a system beside its derivative.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "doubled.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static bool sparse(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_SPARSE; }

sunindextype stf_matrix_order(SUNMatrix M)
{
  return sparse(M) ? SUNSparseMatrix_Columns(M) : SUNDenseMatrix_Columns(M);
}

bool stf_entries_next(stf_entries *at, sunindextype *i, sunindextype *j, sunrealtype *value)
{
  const sunindextype n = at->M ? stf_matrix_order(at->M) : 0, end = at->end ? at->end : n;
  for (; at->j < end && n; at->j++, at->k = 0) {
    const sunindextype from = sparse(at->M) ? SM_INDEXPTRS_S(at->M)[at->j] : 0;
    const sunindextype count = sparse(at->M) ? SM_INDEXPTRS_S(at->M)[at->j + 1] - from : n;
    if (at->k >= count) continue;
    *j = at->j;
    *i = sparse(at->M) ? SM_INDEXVALS_S(at->M)[from + at->k] : at->k;
    *value = sparse(at->M) ? SM_DATA_S(at->M)[from + at->k] : SM_ELEMENT_D(at->M, at->k, at->j);
    at->k++;
    return true;
  }
  return false;
}

static sunindextype entries(SUNMatrix M)
{
  if (!M) return 0;
  return sparse(M) ? SM_INDEXPTRS_S(M)[stf_matrix_order(M)] : SUNDenseMatrix_LData(M);
}

static int no_memory(steif_context *ctx, sunindextype n)
{
  return STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for matrices of order %lld", (long long)n);
}

/* ---- by columns ------------------------------------------------------------------------------- */

/* Column j of M, times a factor, after what `to` has, from row `below` on. */
static void append(SUNMatrix to, SUNMatrix M, sunindextype j, sunindextype below,
                   sunrealtype factor, sunindextype *count)
{
  stf_entries at = {M, j, 0, j + 1};
  sunindextype i, column;
  sunrealtype value;
  while (stf_entries_next(&at, &i, &column, &value)) {
    if (value == 0) continue;
    SM_INDEXVALS_S(to)[*count] = i + below;
    SM_DATA_S(to)[(*count)++] = factor * value;
  }
}

static SUNMatrix sparse_pair(const stf_doubled *d, SUNMatrix M, SUNMatrix slope)
{
  const sunindextype n = d->n, room = 2 * entries(M) + entries(slope) + 1;
  SUNMatrix to = SUNSparseMatrix(2 * n, 2 * n, room, CSC_MAT, steif_sundials(d->ctx));
  sunindextype count = 0;
  for (sunindextype j = 0; to && j < n; j++) {
    append(to, M, j, 0, 1, &count);
    if (slope) append(to, slope, j, n, d->unit, &count);
    SM_INDEXPTRS_S(to)[j + 1] = count;
  }
  for (sunindextype j = 0; to && j < n; j++) {
    append(to, M, j, n, 1, &count);
    SM_INDEXPTRS_S(to)[n + j + 1] = count;
  }
  return to;
}

static SUNMatrix dense_pair(const stf_doubled *d, SUNMatrix M, SUNMatrix slope)
{
  const sunindextype n = d->n;
  SUNMatrix to = SUNDenseMatrix(2 * n, 2 * n, steif_sundials(d->ctx));
  sunindextype i, j;
  sunrealtype value;
  if (!to) return NULL;
  SUNMatZero(to);
  for (stf_entries at = {M, 0, 0, 0}; stf_entries_next(&at, &i, &j, &value);)
    SM_ELEMENT_D(to, i, j) += value, SM_ELEMENT_D(to, n + i, n + j) += value;
  for (stf_entries at = {slope, 0, 0, 0}; stf_entries_next(&at, &i, &j, &value);)
    SM_ELEMENT_D(to, n + i, j) += d->unit * value;
  return to;
}

static SUNMatrix pair(const stf_doubled *d, SUNMatrix M, SUNMatrix slope)
{
  return sparse(M) ? sparse_pair(d, M, slope) : dense_pair(d, M, slope);
}

/* ---- the system ------------------------------------------------------------------------------- */

int stf_doubled_open(stf_doubled *d, const sunrealtype *x0, sunrealtype unit)
{
  const steif_impulse_direction *p = d->direction;
  const size_t n = (size_t)d->n;
  d->unit = unit;
  d->E = pair(d, d->system->E, p->E), d->F = pair(d, d->system->F, p->F);
  d->x0 = stf_allocate(d->ctx, 2 * n, sizeof *d->x0);
  d->part = N_VNew_Serial(d->n, steif_sundials(d->ctx));
  if (!d->x0) return STEIF_NO_MEMORY;
  if (!d->E || !d->F || !d->part) return no_memory(d->ctx, 2 * d->n);
  for (size_t i = 0; i < n; i++) {
    d->x0[i] = x0[i];
    d->x0[n + i] = p->x0 ? unit * p->x0[i] : 0;
  }
  return STEIF_OK;
}

void stf_doubled_close(stf_doubled *d)
{
  if (d->E) SUNMatDestroy(d->E);
  if (d->F) SUNMatDestroy(d->F);
  if (d->part) N_VDestroy(d->part);
  stf_release(d->ctx, d->x0);
  d->E = d->F = NULL, d->part = NULL, d->x0 = NULL;
}

int stf_doubled_force(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const stf_doubled *d = user;
  const size_t n = (size_t)d->n;
  const struct {
    steif_forcing f;
    void *user;
    sunrealtype factor;
  } half[] = {{d->system->f, d->system->user, 1},
              {d->direction->f, d->direction->user, d->unit}};
  for (size_t k = 0; k < 2; k++) {
    sunrealtype *to = N_VGetArrayPointer(g) + k * n;
    N_VConst(0, d->part);
    const int code = half[k].f ? half[k].f(t, derivative, d->part, half[k].user) : 0;
    if (code) return code;
    const sunrealtype *from = N_VGetArrayPointer(d->part);
    for (size_t i = 0; i < n; i++) to[i] = half[k].factor * from[i];
  }
  return 0;
}

/* ---- nearby ----------------------------------------------------------------------------------- */

static SUNMatrix sparse_sum(steif_context *ctx, SUNMatrix from, SUNMatrix slope, sunrealtype by)
{
  const sunindextype n = stf_matrix_order(from);
  SUNMatrix to =
    SUNSparseMatrix(n, n, entries(from) + entries(slope) + 1, CSC_MAT, steif_sundials(ctx));
  sunindextype count = 0;
  for (sunindextype j = 0; to && j < n; j++) {
    const sunindextype first = count;
    append(to, from, j, 0, 1, &count);
    const sunindextype own = count;
    stf_entries at = {slope, j, 0, j + 1};
    sunindextype i, column;
    sunrealtype value;
    while (stf_entries_next(&at, &i, &column, &value)) {
      sunindextype k = first;
      while (k < own && SM_INDEXVALS_S(to)[k] != i) k++;
      if (k == own) SM_INDEXVALS_S(to)[k = count++] = i, SM_DATA_S(to)[k] = 0;
      SM_DATA_S(to)[k] += by * value;
    }
    SM_INDEXPTRS_S(to)[j + 1] = count;
  }
  return to;
}

SUNMatrix stf_moved_matrix(steif_context *ctx, SUNMatrix from, SUNMatrix slope, sunrealtype by)
{
  const sunindextype n = stf_matrix_order(from);
  SUNMatrix to;
  sunindextype i, j;
  sunrealtype value;
  if (sparse(from)) {
    to = sparse_sum(ctx, from, slope, by);
  } else if ((to = SUNDenseMatrix(n, n, steif_sundials(ctx)))) {
    SUNMatCopy(from, to);
    for (stf_entries at = {slope, 0, 0, 0}; stf_entries_next(&at, &i, &j, &value);)
      SM_ELEMENT_D(to, i, j) += by * value;
  }
  if (!to) no_memory(ctx, n);
  return to;
}
