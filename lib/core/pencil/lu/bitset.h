/* bitset.h: sets of rows as bits of words, for the eliminations that skip zeros.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BITSET_H
#define STF_BITSET_H

#include "lu.h"
#include <stdint.h>

/* A pivot on the diagonal is taken down to this part of the largest of its column. */
#define STF_BITSET_KEEP 0.1
/* With more than this share of L + U filled, loops over all entries are faster. */
#define STF_BITSET_FULL 0.8

/* The sets of rows 0 .. n - 1, the next row of a set, and all of them as a list. */
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
INLINE int stf_list_rows(uint64_t rows, unsigned char *row)
{
  int count = 0;
  while (rows) row[count++] = (unsigned char)stf_take_row(&rows);
  return count;
}

/* Minimum degree on the symmetric closure of the pattern; returns the entries of L + U with pivots on
 * the diagonal. */
int stf_bitset_order(int n, const uint64_t *pattern, int *column);

#endif
