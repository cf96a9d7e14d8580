/* scales.h: in which units a dense pencil is analysed.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SCALES_H
#define STF_SCALES_H

#include "structure.h"

/* e = diag(row) E diag(column) and f likewise, n x n by columns, in powers of 2: units in which all
 * entries are near to one size, where there are such; else by the largest entries of rows and
 * columns, as rounding errors of other entries would have it. Then *torn tells whether a compromise
 * between all entries shows something else: -1, or the index that both find at least. */
int stf_scales_choose(steif_context *ctx, stf_pool *pool, const steif_analysis *analysis,
                      SUNMatrix E, SUNMatrix F, int n, sunrealtype *e, sunrealtype *f,
                      sunrealtype *row, sunrealtype *column, int *torn);

/* How many finite eigenvalues the pattern allows. */
int stf_scales_degree(steif_context *ctx, int n, const sunrealtype *e, const sunrealtype *f,
                      sunindextype *degree);
/* How many finite eigenvalues the pattern has only by entries that are rounding beside the largest
 * one of their matrix; e and f as above. */
int stf_scales_carried(steif_context *ctx, int n, const sunrealtype *e, const sunrealtype *f,
                       sunindextype *carried);

#endif
