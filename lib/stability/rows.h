/* rows.h: algebra of small dense matrices by rows.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ROWS_H
#define STF_ROWS_H

#include "base.h"

typedef struct stf_rows {
  /* LU in place with rows exchanged; false when a pivot is 0 or NaN. B := A^{-1} B, n x m. */
  bool (*factor)(int n, sunrealtype *A, int *pivot);
  void (*substitute)(int n, int m, const sunrealtype *A, const int *pivot, sunrealtype *B);
  /* R^T R = W^T W, R upper triangular; false when that is not positive. */
  bool (*squares)(int d, int m, const sunrealtype *W, sunrealtype *R);
  /* X := X R^{-1}. */
  void (*divide)(int rows, int m, const sunrealtype *R, sunrealtype *X);
} stf_rows;

/* For the instruction set there is. */
const stf_rows *stf_rows_best(void);

#endif
