/* check.c: models as C programs, which the build has written and compiled, against the same models as text:
 * values of f and of the Jacobian at random points and whole runs, bit for bit.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <stdlib.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#define X(name, folder) extern const steif_problem model_##name;
MODELS(X)
#undef X

static const struct {
  const char *path;
  const steif_problem *problem;
} models[] = {
#define X(name, folder) {folder "/" #name ".steif", &model_##name},
  MODELS(X)
#undef X
};
enum { COUNT = sizeof models / sizeof *models };

static bool same(N_Vector a, N_Vector b)
{
  return !memcmp(N_VGetArrayPointer(a), N_VGetArrayPointer(b),
                 (size_t)N_VGetLength(a) * sizeof(double));
}

static SUNMatrix matrix_of(const steif_problem *p, sunindextype nnz, steif_context *ctx)
{
  return p->storage == STEIF_SPARSE
           ? SUNSparseMatrix(p->n, p->n, nnz, CSC_MAT, steif_sundials(ctx))
           : SUNDenseMatrix(p->n, p->n, steif_sundials(ctx));
}

static bool same_entries(SUNMatrix a, SUNMatrix b)
{
  if (SUNMatGetID(a) == SUNMATRIX_DENSE)
    return !memcmp(SM_DATA_D(a), SM_DATA_D(b), (size_t)SM_LDATA_D(a) * sizeof(double));
  const size_t columns = (size_t)SM_COLUMNS_S(a) + 1, size = sizeof(sunindextype);
  const size_t count = (size_t)SM_INDEXPTRS_S(a)[columns - 1];
  return !memcmp(SM_INDEXPTRS_S(a), SM_INDEXPTRS_S(b), columns * size) &&
         !memcmp(SM_INDEXVALS_S(a), SM_INDEXVALS_S(b), count * size) &&
         !memcmp(SM_DATA_S(a), SM_DATA_S(b), count * sizeof(double));
}

static void fill(const steif_problem *p, double t, N_Vector y, N_Vector yp, SUNMatrix A,
                 SUNMatrix E)
{
  if (p->storage != STEIF_SPARSE) SUNMatZero(A), SUNMatZero(E);
  if (p->jac)
    CHECK(!p->jac(t, y, yp, A, p->user, NULL, NULL, NULL));
  else
    CHECK(!p->A(t, y, yp, A, p->user));
  if (p->E) CHECK(!p->E(t, y, yp, E, p->user));
}

static int value(const steif_problem *p, double t, N_Vector y, N_Vector yp, N_Vector out)
{
  return p->F   ? p->F(t, y, yp, out, p->user)
         : p->g ? p->g(t, 0, out, p->user)
                : p->f(t, y, out, p->user);
}

static void values_agree(void)
{
  for (int i = 0; i < COUNT; i++) {
    steif_problem text;
    const steif_problem *c = models[i].problem;
    steif_context *ctx = steif_context_new(NULL);
    CU_ASSERT_FATAL(!steif_problem_find(ctx, models[i].path, &text));
    CU_ASSERT_FATAL(text.n == c->n && text.storage == c->storage && text.nnz == c->nnz);
    N_Vector y = N_VNew_Serial(c->n, steif_sundials(ctx)), yp = N_VClone(y), a = N_VClone(y),
             b = N_VClone(y);
    SUNMatrix M[4] = {matrix_of(c, c->nnz, ctx), matrix_of(c, c->nnz, ctx),
                      matrix_of(c, c->nnz_E + 1, ctx), matrix_of(c, c->nnz_E + 1, ctx)};
    if (c->begin) CHECK(!c->begin(c->t0, c->user));
    srand(11);
    for (int turn = 0; turn < 5; turn++) {
      for (int k = 0; k < c->n; k++) {
        NV_Ith_S(y, k) = text.y0[k] * (0.9 + 0.2 * rand() / RAND_MAX);
        NV_Ith_S(yp, k) = 2.0 * rand() / RAND_MAX - 1;
      }
      CHECK(value(c, 0.37, y, yp, a) == value(&text, 0.37, y, yp, b));
      CHECK(same(a, b));
      fill(c, 0.37, y, yp, M[0], M[2]);
      fill(&text, 0.37, y, yp, M[1], M[3]);
      CHECK(same_entries(M[0], M[1]) && (!c->E || same_entries(M[2], M[3])));
    }
    N_VDestroy(y), N_VDestroy(yp), N_VDestroy(a), N_VDestroy(b);
    for (int k = 0; k < 4; k++) SUNMatDestroy(M[k]);
    steif_problem_clear(ctx, &text);
    steif_context_free(&ctx);
  }
}

static void runs_agree(void)
{
  for (int i = 0; i < COUNT; i++) {
    steif_problem text;
    const steif_problem *c = models[i].problem;
    steif_context *ctx = steif_context_new(NULL);
    CU_ASSERT_FATAL(!steif_problem_find(ctx, models[i].path, &text));
    CU_ASSERT_FATAL((text.parameters ? text.parameters->count : 0) ==
                    (c->parameters ? c->parameters->count : 0));
    for (int k = 0; c->parameters && k < c->parameters->count; k++) {
      CU_ASSERT_STRING_EQUAL(c->parameters->name[k], text.parameters->name[k]);
      CHECK(c->parameters->value[k] == text.parameters->value[k]);
    }
    /* Start values that are computed are those of the BLAS of the build: alike to rounding. */
    for (int k = 0; k < c->n; k++) CLOSE_FLOOR(c->y0[k], text.y0[k], 1e-12, 1e-3);
    steif_problem started = *c;
    started.y0 = text.y0, started.yp0 = text.yp0;
    steif_solver *s[2];
    for (int k = 0; k < 2; k++) {
      s[k] = steif_solver_new(ctx, k ? &started : &text, "radau:s=3", NULL);
      CU_ASSERT_FATAL(s[k] != NULL);
      const int code = steif_solve_to(s[k], c->t1);
      if (code) printf("\n  %s: %s", models[i].path, steif_message(ctx));
      CHECK(code == STEIF_OK);
    }
    CHECK(same(steif_solution(s[0]), steif_solution(s[1])));
    steif_solver_free(&s[0]), steif_solver_free(&s[1]);
    steif_problem_clear(ctx, &text);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_programs[] = {
  {"values and Jacobians", values_agree}, {"runs", runs_agree}, CU_TEST_INFO_NULL};
SUITE_MAIN({.pName = "models as C programs", .pTests = tests_of_programs})
