/* thin.h: LU of small dense matrices, real, whose zeros are skipped. Sets of rows are the bits of a
 * word; unknowns are taken in an order of little fill, pivots on the diagonal while they are not much
 * smaller than the largest of their column (thresholds after I. S. Duff, A. M. Erisman and J. K. Reid,
 * Direct Methods for Sparse Matrices, Oxford 1986, 5.2).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_THIN_H
#define STF_THIN_H

#include <stdbool.h>
#include <stdint.h>

enum { STF_THIN = 64 }; /* largest n */
/* A pivot on the diagonal is taken down to this part of the largest of its column. */
#define STF_THIN_KEEP 0.1
/* With more than this share of L + U filled, loops over all entries are faster. */
#define STF_THIN_FULL 0.8

typedef struct stf_thin {
  int n;
  bool full;                             /* too full: not used any more */
  uint64_t pattern[STF_THIN];            /* rows of all matrices so far, by columns */
  int column[STF_THIN], order[STF_THIN]; /* unknown and row of the pivot of each step */
  int lower[STF_THIN + 1], upper[STF_THIN];
  unsigned char
    row[STF_THIN * STF_THIN]; /* step k: rows below lower[k] .., above upper[k] .. */
} stf_thin;

/* The sets of rows 0 .. n - 1, and the next row of one. */
static inline uint64_t stf_all_rows(int n)
{
  return n < 64 ? ((uint64_t)1 << n) - 1 : ~(uint64_t)0;
}
static inline int stf_take_row(uint64_t *set)
{
  const int i = __builtin_ctzll(*set);
  *set &= *set - 1;
  return i;
}

/* Minimum degree on the symmetric closure of the pattern; returns the entries of L + U with pivots on
 * the diagonal. */
int stf_thin_order(int n, const uint64_t *pattern, int *column);

/* Is it worth to skip the zeros of a (n x n by columns)? Orders anew when entries appear. */
bool stf_thin_look(stf_thin *t, const double *a);
/* In place; 0, or 1 + the column whose pivot vanished. */
int stf_thin_factor(stf_thin *t, double *a);
void stf_thin_solve(const stf_thin *t, const double *a, double *b);

#endif
