/* dense_units.h: in which units a dense pencil is analysed.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DENSE_UNITS_H
#define STF_DENSE_UNITS_H

#include "linear_system.h"

/* E = diag(row) E_given diag(column) and F likewise, n x n by columns, in powers of 2: units in which
 * all entries are near to one size, where there are such; else by the largest entries of rows and
 * columns, as rounding errors of other entries would have it. Then other_index says whether a
 * compromise between all entries shows something else: -1, or the index that both find at least. */
typedef struct stf_dense_units {
  int n;
  sunrealtype *E, *F, *row, *column;
  int other_index;
} stf_dense_units;

/* E and F: dense or CSC; all arrays from the pool. */
int stf_dense_units_choose(steif_context *ctx, stf_pool *pool, const steif_analysis *analysis,
                           SUNMatrix E, SUNMatrix F, stf_dense_units *units);

/* How many finite eigenvalues the pattern allows. */
int stf_dense_degree(steif_context *ctx, const stf_dense_units *units, sunindextype *degree);
/* How many finite eigenvalues the pattern has only by entries that are rounding beside the largest
 * one of their matrix. */
int stf_dense_carried(steif_context *ctx, const stf_dense_units *units, sunindextype *carried);

#endif
