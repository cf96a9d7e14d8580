/* fixture.h: a problem with a context, vectors and matrices of its storage, for the tests here.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct fixture {
  steif_context *ctx;
  steif_problem p;
  N_Vector y, yp, r, w; /* zeroed */
} fixture;

static inline int fixture_open(fixture *s, const char *spec)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  const int code = steif_problem_find(s->ctx, spec, &s->p);
  if (code) {
    printf("\n  %s: %s", spec, steif_message(s->ctx));
    CU_FAIL("find");
    steif_context_free(&s->ctx);
    return code;
  }
  N_Vector *all[] = {&s->y, &s->yp, &s->r, &s->w};
  for (int i = 0; i < 4; i++) {
    *all[i] = N_VNew_Serial(s->p.n, steif_sundials(s->ctx));
    N_VConst(0, *all[i]);
  }
  return 0;
}

static inline void fixture_close(fixture *s)
{
  N_VDestroy(s->y), N_VDestroy(s->yp), N_VDestroy(s->r), N_VDestroy(s->w);
  steif_problem_clear(s->ctx, &s->p);
  steif_context_free(&s->ctx);
}

static inline SUNMatrix fixture_matrix(const fixture *s, sunindextype nnz)
{
  const SUNContext sun = steif_sundials(s->ctx);
  SUNMatrix M;
  if (s->p.storage == STEIF_BAND)
    M = SUNBandMatrix(s->p.n, s->p.upper, s->p.lower, sun);
  else if (s->p.storage == STEIF_SPARSE)
    M = SUNSparseMatrix(s->p.n, s->p.n, nnz, CSC_MAT, sun);
  else
    M = SUNDenseMatrix(s->p.n, s->p.n, sun);
  SUNMatZero(M);
  return M;
}

/* M_ij, whatever the storage; rows of a sparse column must ascend. */
static inline double fixture_element(SUNMatrix M, sunindextype i, sunindextype j)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) return SM_ELEMENT_D(M, i, j);
  if (SUNMatGetID(M) == SUNMATRIX_BAND)
    return j - i <= SM_UBAND_B(M) && i - j <= SM_LBAND_B(M) ? SM_ELEMENT_B(M, i, j) : 0;
  double value = 0;
  for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++) {
    if (k > SM_INDEXPTRS_S(M)[j]) CHECK(SM_INDEXVALS_S(M)[k] > SM_INDEXVALS_S(M)[k - 1]);
    if (SM_INDEXVALS_S(M)[k] == i) value += SM_DATA_S(M)[k];
  }
  return value;
}

/* F(t, y, y') of any form into s->r, at s->y and s->yp; s->w is scratch. */
static inline int fixture_residual(fixture *s, double t)
{
  const steif_problem *p = &s->p;
  if (p->F) return p->F(t, s->y, s->yp, s->r, p->user);
  if (p->f) {
    const int code = p->f(t, s->y, s->r, p->user);
    N_VLinearSum(1, s->yp, -1, s->r, s->r);
    return code;
  }
  SUNMatrix E = fixture_matrix(s, p->nnz_E), A = fixture_matrix(s, p->nnz);
  int code = p->E(t, s->y, s->yp, E, p->user) || p->A(t, s->y, s->yp, A, p->user);
  code = code || p->g(t, 0, s->r, p->user);
  for (sunindextype i = 0; i < p->n; i++) {
    double sum = -NV_Ith_S(s->r, i);
    for (sunindextype j = 0; j < p->n; j++)
      sum += fixture_element(E, i, j) * NV_Ith_S(s->yp, j) -
             fixture_element(A, i, j) * NV_Ith_S(s->y, j);
    NV_Ith_S(s->r, i) = sum;
  }
  SUNMatDestroy(E), SUNMatDestroy(A);
  return code;
}

static inline double fixture_largest(N_Vector v) { return N_VMaxNorm(v); }

/* y'(t) by central differences of order 8 of `state`, into s->yp. */
static inline void fixture_difference(fixture *s, steif_state state, double t, double h)
{
  static const double weight[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  N_VConst(0, s->yp);
  for (int q = 1; q <= 4; q++)
    for (int sign = -1; sign <= 1; sign += 2) {
      CHECK(state(t + sign * q * h, s->w, NULL, s->p.user) == 0);
      N_VLinearSum(1, s->yp, sign * weight[q - 1] / h, s->w, s->yp);
    }
}

#endif
