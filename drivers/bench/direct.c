/* direct.c: what the direct programs over CVODE and IDA share.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direct.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

int direct_open(SUNContext sun, const steif_problem *p, direct *d)
{
  enum { AMD = 0 };
  const size_t size = (size_t)p->n * sizeof *p->y0;
  *d = (direct){.p = p, .y = N_VNew_Serial(p->n, sun), .yp = N_VNew_Serial(p->n, sun)};
  if (!d->y || !d->yp) return -1;
  memcpy(NV_DATA_S(d->y), p->y0, size);
  const bool dense = p->storage == STEIF_DENSE;
  d->J = dense ? SUNDenseMatrix(p->n, p->n, sun)
               : SUNSparseMatrix(p->n, p->n, p->nnz + p->n, CSC_MAT, sun);
  d->solver = dense ? SUNLinSol_Dense(d->y, d->J, sun) : SUNLinSol_KLU(d->y, d->J, sun);
  if (d->solver && !dense) SUNLinSol_KLUSetOrdering(d->solver, AMD);
  return d->J && d->solver ? 0 : -1;
}

void direct_close(direct *d)
{
  if (d->solver) SUNLinSolFree(d->solver);
  if (d->J) SUNMatDestroy(d->J);
  if (d->y) N_VDestroy(d->y);
  if (d->yp) N_VDestroy(d->yp);
}

sunrealtype direct_until(const steif_problem *p, int k)
{
  return k < p->break_count ? nextafter(p->breaks[k], -INFINITY) : p->t1;
}
