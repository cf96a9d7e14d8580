/* dense_lapack.c: LU of dense matrices of any size by LAPACK.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lapack.h"
#include "lu.h"

int stf_dense_factor(int n, double *A, int *pivot)
{
  int info;
  dgetrf_(&n, &n, A, &n, pivot, &info);
  return info;
}

int stf_dense_zfactor(int n, double *A, int *pivot)
{
  int info;
  zgetrf_(&n, &n, A, &n, pivot, &info);
  return info;
}

void stf_dense_solve(char trans, int n, int columns, const double *A, const int *pivot,
                     double *B)
{
  int info;
  dgetrs_(&trans, &n, &columns, A, &n, pivot, B, &n, &info, 1);
}
