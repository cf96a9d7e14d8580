/* slope_case.h: a system of the collection and a direction, for derivatives of its jump.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SLOPE_CASE_H
#define SLOPE_CASE_H

#include "suite.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/data.h>
#include <steif/slopes.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct bench {
  steif_context *ctx;
  steif_problem problem;
  steif_linear system;
  sunindextype n;
  SUNMatrix dE, dF; /* dense, 0 */
  steif_impulse_direction along;
  steif_impulse_slope slope;
} bench;

static inline void set_up(bench *b, const char *name)
{
  *b = (bench){.ctx = steif_context_new(NULL)};
  CHECK(steif_problem_find(b->ctx, name, &b->problem) == STEIF_OK);
  CHECK(steif_linear_of(b->ctx, &b->problem, &b->system) == STEIF_OK);
  b->n = b->problem.n;
  b->dE = SUNDenseMatrix(b->n, b->n, steif_sundials(b->ctx));
  b->dF = SUNDenseMatrix(b->n, b->n, steif_sundials(b->ctx));
}

static inline void clear(bench *b)
{
  steif_impulse_slope_clear(b->ctx, &b->slope);
  SUNMatZero(b->dE), SUNMatZero(b->dF);
  b->along = (steif_impulse_direction){0};
}

static inline void tear_down(bench *b)
{
  clear(b);
  SUNMatDestroy(b->dE), SUNMatDestroy(b->dF);
  SUNMatDestroy(b->system.E), SUNMatDestroy(b->system.F);
  steif_problem_clear(b->ctx, &b->problem);
  steif_context_free(&b->ctx);
}

static inline int find(bench *b)
{
  b->along.E = b->dE, b->along.F = b->dF;
  return steif_impulse_slope_find(b->ctx, &b->system, b->problem.y0, b->problem.t0, NULL, NULL,
                                  &b->along, &b->slope);
}

#endif
