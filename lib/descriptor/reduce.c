/* reduce.c: a system of index 1 with the slow part of another. With Pi_s the slow projector the pencil
 * (E Pi_s, F) is diag(I, 0), diag(J, I) in the coordinates where (E, F) is diag(I, N), diag(J, I):
 * runs on it keep the slow part to rounding, where runs on (E, F) of index k lose a factor
 * h^(-2 (k-1)).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense.h"
#include "subject.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static SUNMatrix dense_copy(const stf_subject *s, SUNMatrix M)
{
  SUNMatrix D = SUNDenseMatrix(s->n, s->n, steif_sundials(s->ctx));
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  if (!D) {
    STEIF_FAIL(s->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %d", s->n);
    return NULL;
  }
  SUNMatZero(D);
  if (dense) memcpy(SM_DATA_D(D), SM_DATA_D(M), (size_t)SM_LDATA_D(M) * sizeof(sunrealtype));
  for (sunindextype j = 0; !dense && j < s->n; j++)
    for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++)
      SM_ELEMENT_D(D, SM_INDEXVALS_S(M)[p], j) += SM_DATA_S(M)[p];
  return D;
}

static int fill(stf_subject *s, sunrealtype *slow, SUNMatrix E)
{
  STEIF_TRY(steif_projector_find(s->ctx, s->linear.E, s->linear.F, NULL, slow));
  stf_gemm('N', 'N', s->n, s->n, s->n, 1, SM_DATA_D(E), s->n, slow, s->n, 0,
           SM_DATA_D(s->slow.E), s->n);
  return STEIF_OK;
}

static int claim(stf_subject *s)
{
  SUNMatrix E = dense_copy(s, s->linear.E);
  s->slow.E = E ? dense_copy(s, s->linear.E) : NULL;
  s->slow.F = s->slow.E ? dense_copy(s, s->linear.F) : NULL;
  sunrealtype *slow = stf_allocate(s->ctx, (size_t)s->n * (size_t)s->n, sizeof *slow);
  const int code = s->slow.F && slow ? fill(s, slow, E) : STEIF_NO_MEMORY;
  if (E) SUNMatDestroy(E);
  stf_release(s->ctx, slow);
  return code;
}

int stf_subject_reduce(stf_subject *s)
{
  const bool dense =
    !strcmp(s->structure.method, "staircase") || !strcmp(s->structure.method, "qz");
  s->slow = s->linear;
  if (s->index < 2 || !dense) return STEIF_OK;
  s->slow.E = s->slow.F = NULL, s->reduced = true;
  return claim(s);
}
