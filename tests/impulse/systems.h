/* systems.h: descriptor systems of the collection as matrices, sources and exact answers.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SYSTEMS_H
#define SYSTEMS_H

#include "known_structure.h"
#include "linear_system.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Orders of derivatives of f that are kept. */
enum { SYSTEM_ORDERS = 4 };

typedef struct system {
  steif_context *ctx;
  steif_problem problem;
  sunindextype n;
  SUNMatrix E, F;
  sunrealtype *Ex0, *f;
  stf_sources sources;
  stf_exact_start exact;
} system_;

/* Sparse E or A of a problem whose fill wants dense or sparse storage. */
static inline SUNMatrix system_matrix(steif_context *ctx, const steif_problem *p,
                                      steif_matrix_fill fill, sunindextype nnz, double sign)
{
  SUNContext sun = steif_sundials(ctx);
  const int sparse = p->storage == STEIF_SPARSE;
  SUNMatrix M =
    sparse ? SUNSparseMatrix(p->n, p->n, nnz, CSC_MAT, sun) : SUNDenseMatrix(p->n, p->n, sun);
  fill(p->t0, NULL, NULL, M, p->user);
  if (!sparse) {
    SUNMatrix dense = M;
    M = SUNSparseFromDenseMatrix(dense, 0, CSC_MAT);
    SUNMatDestroy(dense);
  }
  for (sunindextype k = 0; k < SM_INDEXPTRS_S(M)[p->n]; k++) SM_DATA_S(M)[k] *= sign;
  return M;
}

static inline void system_sources(system_ *s)
{
  const sunindextype n = s->n;
  s->Ex0 = stf_allocate(s->ctx, (size_t)n, sizeof *s->Ex0);
  s->f = stf_allocate(s->ctx, (size_t)n * SYSTEM_ORDERS, sizeof *s->f);
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = SM_INDEXPTRS_S(s->E)[j]; k < SM_INDEXPTRS_S(s->E)[j + 1]; k++)
      s->Ex0[SM_INDEXVALS_S(s->E)[k]] += SM_DATA_S(s->E)[k] * s->problem.y0[j];
  N_Vector g = N_VNew_Serial(n, steif_sundials(s->ctx));
  for (int d = 0; d < SYSTEM_ORDERS; d++) {
    s->problem.g(0, d, g, s->problem.user);
    memcpy(s->f + d * n, NV_DATA_S(g), (size_t)n * sizeof *s->f);
  }
  N_VDestroy(g);
  s->sources = (stf_sources){n, SYSTEM_ORDERS - 1, s->Ex0, s->f};
}

static inline void system_open(system_ *s, const steif_setup *setup, const char *spec)
{
  memset(s, 0, sizeof *s);
  s->ctx = steif_context_new(setup);
  if (steif_problem_find(s->ctx, spec, &s->problem)) printf("\n  %s", steif_message(s->ctx));
  CU_ASSERT_FATAL(s->problem.n > 0);
  s->n = s->problem.n;
  s->E = system_matrix(s->ctx, &s->problem, s->problem.E, s->problem.nnz_E, 1);
  s->F = system_matrix(s->ctx, &s->problem, s->problem.A, s->problem.nnz, -1);
  system_sources(s);
}

static inline void system_close(system_ *s)
{
  stf_exact_start_clear(s->ctx, &s->exact);
  stf_release(s->ctx, s->Ex0);
  stf_release(s->ctx, s->f);
  SUNMatDestroy(s->E);
  SUNMatDestroy(s->F);
  steif_problem_clear(s->ctx, &s->problem);
  steif_context_free(&s->ctx);
}

/* Structure and start by circles; the structure is new. */
static inline steif_analysis system_by_circles(const steif_analysis *analysis)
{
  steif_analysis by = {0};
  if (analysis) by = *analysis;
  by.algorithm = STEIF_CONTOUR;
  return by;
}

static inline int system_structure(const system_ *s, const steif_analysis *analysis,
                                   steif_structure *structure)
{
  const steif_analysis by = system_by_circles(analysis);
  return steif_structure_find(s->ctx, s->E, s->F, &by, structure);
}

static inline int system_start(const system_ *s, const steif_analysis *analysis,
                               const steif_structure *structure, steif_impulse *impulse)
{
  const steif_analysis by = system_by_circles(analysis);
  return steif_impulse_find(s->ctx, s->E, s->F, s->problem.y0, 0, s->problem.g, s->problem.user,
                            &by, structure, impulse);
}

/* A sparse matrix from an array by rows; zeros are no entries. */
static inline SUNMatrix system_dense(steif_context *ctx, int n, const double *a)
{
  SUNMatrix D = SUNDenseMatrix(n, n, steif_sundials(ctx));
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) SM_ELEMENT_D(D, i, j) = a[i * n + j];
  SUNMatrix M = SUNSparseFromDenseMatrix(D, 0, CSC_MAT);
  SUNMatDestroy(D);
  return M;
}

/* ||a - b|| / ||b||. */
static inline double system_error(sunindextype n, const sunrealtype *a, const sunrealtype *b)
{
  double off = 0, size = 0;
  for (sunindextype i = 0; i < n; i++)
    off += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
  return sqrt(off / size);
}

#endif
