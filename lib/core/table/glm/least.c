/* least.c: small least-squares problems by singular values.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include "lapack.h"
#include <math.h>

int stf_least_squares(steif_context *ctx, int m, int n, int count, const sunrealtype *M,
                      const sunrealtype *B, sunrealtype *X, sunrealtype *residual)
{
  enum { N = STF_LEAST, SCRATCH = 8 * STF_LEAST };
  double a[N * N], b[N * N], s[N], work[SCRATCH], rcond = 1e-10;
  const int lwork = SCRATCH, rows = m > n ? m : n;
  int rank, info;
  for (int i = 0; i < m; i++)
    for (int j = 0; j < n; j++) a[j * m + i] = M[i * n + j];
  for (int j = 0; j < count; j++)
    for (int i = 0; i < rows; i++) b[j * rows + i] = i < m ? B[i * count + j] : 0;
  dgelss_(&m, &n, &count, a, &m, b, &rows, s, &rcond, &rank, work, &lwork, &info);
  STEIF_CHECK(
    !info, ctx, STEIF_NO_CONVERGENCE,
    "LAPACK's dgelss found no singular values of a %d x %d matrix (info %d); check the "
    "coefficients of the table",
    m, n, info);
  *residual = 0;
  for (int j = 0; j < count; j++) {
    for (int l = 0; l < n; l++) X[l * count + j] = b[j * rows + l];
    for (int i = 0; i < m; i++) {
      sunrealtype off = -B[i * count + j];
      for (int l = 0; l < n; l++) off += M[i * n + l] * X[l * count + j];
      *residual = fmax(*residual, fabs(off));
    }
  }
  return STEIF_OK;
}
