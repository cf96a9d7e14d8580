/* linear_problem.c: E x' + F x = f as a problem for every solver, and the matrices of such a problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear_system.h"
#include "problem.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static bool sparse(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_SPARSE; }

static sunindextype order(SUNMatrix M)
{
  return sparse(M) ? SUNSparseMatrix_Rows(M) : SUNDenseMatrix_Rows(M);
}

static sunindextype entries(SUNMatrix M)
{
  return sparse(M) ? SUNSparseMatrix_IndexPointers(M)[order(M)] : SUNDenseMatrix_LData(M);
}

static void negate(SUNMatrix M)
{
  sunrealtype *x = sparse(M) ? SUNSparseMatrix_Data(M) : SUNDenseMatrix_Data(M);
  const sunindextype count = entries(M);
  for (sunindextype i = 0; i < count; i++) x[i] = -x[i];
}

/* To = M, which may be sparse where `to`, full of zeros, is dense. */
static int copy(SUNMatrix M, SUNMatrix to)
{
  if (sparse(M) == sparse(to)) return SUNMatCopy(M, to) ? -1 : 0;
  if (sparse(to)) return -1;
  for (sunindextype j = 0; j < order(M); j++)
    for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++)
      SM_ELEMENT_D(to, SM_INDEXVALS_S(M)[k], j) += SM_DATA_S(M)[k];
  return 0;
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp;
  return copy(((const steif_linear *)user)->E, E);
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp;
  if (copy(((const steif_linear *)user)->F, A)) return -1;
  negate(A);
  return 0;
}

static int forcing(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const steif_linear *l = user;
  return l->f(t, derivative, g, l->user);
}

int steif_linear_problem(steif_context *ctx, const steif_linear *l, const sunrealtype *x0,
                         sunrealtype t0, sunrealtype t1, steif_problem *p)
{
  STEIF_CHECK(l && l->E && l->F && x0 && p, ctx, STEIF_BAD_INPUT,
              "E, F, start values and a problem are needed, one is NULL");
  STEIF_CHECK(order(l->E) == order(l->F), ctx, STEIF_BAD_INPUT,
              "E and F must have one size: E has %lld rows, F has %lld", (long long)order(l->E),
              (long long)order(l->F));
  *p = (steif_problem){.name = "E x' + F x = f",
                       .n = order(l->E),
                       .t0 = t0,
                       .t1 = t1,
                       .y0 = x0,
                       .E = fill_E,
                       .A = fill_A,
                       .g = l->f ? forcing : NULL,
                       .user = (void *)l,
                       .storage = sparse(l->E) && sparse(l->F) ? STEIF_SPARSE : STEIF_DENSE,
                       .nnz = entries(l->F) + 1,
                       .nnz_E = entries(l->E) + 1,
                       .dae_index = -1,
                       .linear = 1};
  return STEIF_OK;
}

static SUNMatrix empty(steif_context *ctx, const steif_problem *p, sunindextype nnz)
{
  SUNContext sun = steif_sundials(ctx);
  if (nnz < 1) nnz = p->nnz > 0 ? p->nnz : p->n;
  SUNMatrix M = p->storage == STEIF_SPARSE ? SUNSparseMatrix(p->n, p->n, nnz, CSC_MAT, sun)
                                           : SUNDenseMatrix(p->n, p->n, sun);
  if (!M)
    STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld", (long long)p->n);
  return M;
}

static int fill_both(steif_context *ctx, const steif_problem *p, steif_linear *l)
{
  N_Vector y = N_VNew_Serial(p->n, steif_sundials(ctx));
  STEIF_CHECK(y, ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld", (long long)p->n);
  N_VConst(0, y);
  if (!sparse(l->E)) SUNMatZero(l->E), SUNMatZero(l->F);
  const int code = p->E(p->t0, y, y, l->E, p->user) || p->A(p->t0, y, y, l->F, p->user);
  N_VDestroy(y);
  STEIF_CHECK(!code, ctx, STEIF_CALLBACK, "E or A of problem '%s' could not be filled",
              p->name);
  negate(l->F);
  return STEIF_OK;
}

int steif_linear_of(steif_context *ctx, const steif_problem *p, steif_linear *l)
{
  STF_NAMED(p);
  const int form = steif_problem_form(ctx, p);
  if (!form) return steif_status(ctx);
  STEIF_CHECK(form == STEIF_DESCRIPTOR && p->E && p->A, ctx, STEIF_UNSUPPORTED,
              "problem '%s' has form %s: only E x' = A x + g has a pencil of its own "
              "(a model as text has, with 'form descriptor', where it is linear with constant "
              "coefficients)",
              p->name, steif_form_name(form));
  STEIF_CHECK(
    p->storage == STEIF_DENSE || p->storage == STEIF_SPARSE, ctx, STEIF_UNSUPPORTED,
    "problem '%s' keeps its matrices in band or no storage: take storage=dense or sparse",
    p->name);
  *l = (steif_linear){.f = p->g, .user = p->user};
  l->E = empty(ctx, p, p->nnz_E), l->F = l->E ? empty(ctx, p, 0) : NULL;
  const int code = l->F ? fill_both(ctx, p, l) : STEIF_NO_MEMORY;
  if (!code) return STEIF_OK;
  if (l->E) SUNMatDestroy(l->E);
  if (l->F) SUNMatDestroy(l->F);
  l->E = l->F = NULL;
  return code;
}
