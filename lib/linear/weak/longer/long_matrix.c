/* long_matrix.c: dense elimination in long double with partial pivoting.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "longer.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void swap(long double *a, long double *b, int n)
{
  for (int j = 0; j < n; j++) {
    const long double kept = a[j];
    a[j] = b[j];
    b[j] = kept;
  }
}

bool stf_long_factor(stf_long_matrix *m)
{
  const size_t n = (size_t)m->n;
  for (size_t k = 0; k < n; k++) {
    size_t best = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabsl(m->a[i * n + k]) > fabsl(m->a[best * n + k])) best = i;
    m->pivot[k] = (int)best;
    if (best != k) swap(m->a + k * n, m->a + best * n, m->n);
    const long double *top = m->a + k * n;
    if (!(fabsl(top[k]) > 0)) return false;
    for (size_t i = k + 1; i < n; i++) {
      long double *row = m->a + i * n;
      if (row[k] == 0) continue;
      row[k] /= top[k];
      for (size_t j = k + 1; j < n; j++) row[j] -= row[k] * top[j];
    }
  }
  return true;
}

void stf_long_solve(const stf_long_matrix *m, long double *x)
{
  const int n = m->n;
  for (int k = 0; k < n; k++) swap(x + k, x + m->pivot[k], 1);
  for (int i = 1; i < n; i++)
    for (int j = 0; j < i; j++) x[i] -= m->a[(size_t)i * (size_t)n + (size_t)j] * x[j];
  for (int i = n - 1; i >= 0; i--) {
    const long double *row = m->a + (size_t)i * (size_t)n;
    for (int j = i + 1; j < n; j++) x[i] -= row[j] * x[j];
    x[i] /= row[i];
  }
}

void stf_long_entries(SUNMatrix A, int n, long double *a)
{
  const size_t size = (size_t)n;
  memset(a, 0, size * size * sizeof *a);
  if (SUNMatGetID(A) == SUNMATRIX_DENSE) {
    for (size_t i = 0; i < size; i++)
      for (size_t j = 0; j < size; j++)
        a[i * size + j] = SM_ELEMENT_D(A, (sunindextype)i, (sunindextype)j);
    return;
  }
  const sunindextype *start = SM_INDEXPTRS_S(A), *row = SM_INDEXVALS_S(A);
  for (size_t j = 0; j < size; j++)
    for (sunindextype k = start[j]; k < start[j + 1]; k++)
      a[(size_t)row[k] * size + j] += SM_DATA_S(A)[k];
}

void stf_long_multiply(int n, const long double *a, long double factor, const long double *x,
                       long double *y)
{
  for (int i = 0; i < n; i++) {
    long double sum = 0;
    for (int j = 0; j < n; j++) sum += a[(size_t)i * (size_t)n + (size_t)j] * x[j];
    y[i] += factor * sum;
  }
}
