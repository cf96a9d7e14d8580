/* interleaved_sparse.h: elimination and solves that skip zeros, for the kernels of interleaved.c. Rows stay where they
 * are; sets of rows are the bits of a word, so that the fill is found on the way.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LANES_SPARSE_H
#define STF_LANES_SPARSE_H

#include "interleaved.h"
#include "interleaved_complex.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* The entries of the pattern, all lanes. */
INLINE void assemble_sparse(stf_shifts *L, const int lanes, const double *J, double h)
{
  const int n = L->face.n;
  double s[2 * STF_INTERLEAVED_LANES];
  for (int k = 0; k < 2 * lanes; k++) s[k] = L->lambda[k] / h;
  for (int j = 0; j < n; j++)
    for (uint64_t rows = L->pattern[j]; rows;) {
      const int i = stf_take_row(&rows);
      const double m = L->M ? L->M[i * n + j] : i == j, a = J[i + n * j];
      double *e = L->lu + (j * n + i) * 2 * lanes;
      for (int k = 0; k < lanes; k++) e[k] = s[k] * m - a, e[lanes + k] = s[lanes + k] * m;
    }
}

/* The row of the pivot among `rows` of a column, by lane 0; -1: all vanish. */
INLINE int pivot_sparse(const int lanes, uint64_t rows, const double *a, int diagonal)
{
  double big = 0, own = 0;
  int p = -1;
  while (rows) {
    const int i = stf_take_row(&rows);
    const double *e = a + i * 2 * lanes, size = fabs(e[0]) + fabs(e[lanes]);
    if (size > big) big = size, p = i;
    if (i == diagonal) own = size;
  }
  if (!(big >= DBL_MIN)) return -1;
  return own >= STF_BITSET_KEEP * big ? diagonal : p;
}

INLINE void eliminate_sparse(stf_shifts *L, const int n, const int lanes, const double *J,
                             double h, int *failed)
{
  const int step = 2 * lanes;
  uint64_t live[STF_INTERLEAVED], active = stf_all_rows(n);
  memcpy(live, L->pattern, (size_t)n * sizeof *live);
  assemble_sparse(L, lanes, J, h);
  L->lower[0] = 0;
  for (int k = 0; k < n; k++) {
    const int c = L->column[k], from = L->lower[k];
    double *column = L->lu + c * n * step;
    const int p = L->order[k] = pivot_sparse(lanes, live[c] & active, column, c);
    if (p < 0) {
      *failed = c + 1;
      return;
    }
    const uint64_t below = live[c] & active & ~((uint64_t)1 << p);
    unsigned char *row = L->row + from;
    const int count = stf_list_rows(below, row);
    L->upper[k] = from + count;
    L->lower[k + 1] = from + count + stf_list_rows(live[c] & ~active, row + count);
    active &= ~((uint64_t)1 << p);
    reciprocal(lanes, column + p * step);
    for (int i = 0; i < count; i++) times(lanes, column + row[i] * step, column + p * step);
    for (int m = k + 1; m < n; m++) {
      const int j = L->column[m];
      if (!(live[j] >> p & 1)) continue;
      double *other = L->lu + j * n * step;
      for (uint64_t fill = below & ~live[j]; fill;)
        memset(other + stf_take_row(&fill) * step, 0, (size_t)step * sizeof *other);
      live[j] |= below;
      subtract_at(lanes, count, row, column, other + p * step, other);
    }
  }
}

/* rhs is overwritten. */
INLINE void solve_sparse(stf_shifts *L, const int n, const int lanes, double *restrict rhs,
                         double *restrict x)
{
  const int step = 2 * lanes;
  for (int k = 0; k < n; k++)
    subtract_at(lanes, L->upper[k] - L->lower[k], L->row + L->lower[k],
                L->lu + L->column[k] * n * step, rhs + L->order[k] * step, rhs);
  for (int k = n; k-- > 0;) {
    const int c = L->column[k], p = L->order[k];
    const double *column = L->lu + c * n * step;
    double *y = x + c * step;
    for (int i = 0; i < step; i++) y[i] = rhs[p * step + i];
    times(lanes, y, column + p * step);
    subtract_at(lanes, L->lower[k + 1] - L->upper[k], L->row + L->upper[k], column, y, rhs);
  }
}

#endif
