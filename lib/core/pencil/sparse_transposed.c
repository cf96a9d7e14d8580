/* sparse_transposed.c: solves with the transpose of sparse factors. A complex slot turns a pair of real
 * vectors (u, v) into u + i v; the transpose of that real map is the conjugate transpose.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sparse.h"

static int columns(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld)
{
  const stf_sparse_blocks f = stf_sparse_fronts(p, slot);
  klu_l_common common;
  if (f.fronts) {
    stf_multifrontal_solve_transposed(f.fronts, f.factors, f.pivot, nrhs, b, ld, f.work);
    return STEIF_OK;
  }
  klu_l_defaults(&common);
  klu_l_symbolic *symbolic = stf_sparse_symbolic(p);
  klu_l_numeric *numeric = stf_sparse_factors(p, slot);
  if (stf_is_complex(p->shift[slot]))
    klu_zl_tsolve(symbolic, numeric, ld, nrhs, b, 1, &common);
  else
    klu_l_tsolve(symbolic, numeric, ld, nrhs, b, &common);
  return STEIF_OK;
}

int stf_sparse_transposed(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  return stf_columns(p, slot, nrhs, re, im, columns);
}
