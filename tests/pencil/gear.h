/* gear.h: one pencil in every storage, with entries from a small generator, and the residual of a
 * solution measured against plain arrays.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GEAR_H
#define GEAR_H

#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/pencil.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { GEAR_MOST = 60, GEAR_LOWER = 2, GEAR_UPPER = 3 };

/* Column-major, entry (i, j) at i + n j. E has bandwidths 1, 3 and every fifth row empty (it is
 * singular); A has bandwidths 2, 1: neither pattern holds the other. */
typedef struct gear {
  int n;
  bool identity;
  double E[GEAR_MOST * GEAR_MOST], A[GEAR_MOST * GEAR_MOST];
} gear;

/* In (-1, 1): the high bits of D. H. Lehmer's generator with the multiplier of Park and Miller
 * (CACM 31, 1988, with the multiplier of their 1993 reply). */
double gear_random(unsigned *state);
void gear_fill(gear *g, int n, bool identity, unsigned seed);
SUNMatrix gear_matrix(const double *M, int n, SUNMatrix_ID id, SUNContext sun);
void gear_copy(const double *M, int n, SUNMatrix to);
N_Vector gear_vector(int n, unsigned seed, SUNContext sun);
/* max |(s E - A) x - b| / (norm max |x| + max |b|), the normwise backward error. */
double gear_residual(const gear *g, steif_shift s, const double *xr, const double *xi,
                     const double *br, const double *bi);
/* The operator of g for vectors with host arrays. */
steif_operator gear_operator(gear *g);
steif_transposed gear_transposed(const gear *g);

#endif
