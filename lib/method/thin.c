/* thin.c: is it worth to skip the zeros of a small matrix, and in which order?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lanes.h"
#include <string.h>

/* Below this size, or with more of the matrix filled than this, loops over all entries are faster. */
enum { LEAST = 8 };
#define FULL 0.8

static int bits(uint64_t x) { return __builtin_popcountll(x); }

/* Minimum degree on the symmetric pattern; returns the entries of L + U with pivots on the diagonal. */
static int order(int n, uint64_t *rows, int *column)
{
  uint64_t left = n < 64 ? ((uint64_t)1 << n) - 1 : ~(uint64_t)0;
  int entries = 0;
  for (int k = 0; k < n; k++) {
    int best = -1;
    for (int i = 0; i < n; i++)
      if (left >> i & 1 && (best < 0 || bits(rows[i] & left) < bits(rows[best] & left)))
        best = i;
    column[k] = best;
    left &= ~((uint64_t)1 << best);
    const uint64_t near = rows[best] & left;
    entries += 1 + 2 * bits(near);
    for (int i = 0; i < n; i++)
      if (near >> i & 1) rows[i] |= near;
  }
  return entries;
}

void stf_lanes_look(stf_lanes *L, const double *J)
{
  const int n = L->n;
  uint64_t rows[STF_LANES_LARGEST];
  bool same = true;
  if (n < LEAST || L->full) return;
  for (int j = 0; j < n; j++) {
    uint64_t column = (uint64_t)1 << j;
    for (int i = 0; i < n; i++)
      column |= (uint64_t)(J[i + n * j] != 0 || (L->M && L->M[i * n + j] != 0)) << i;
    if (column & ~L->pattern[j]) same = false;
    L->pattern[j] |= column;
  }
  if (same) return;
  memcpy(rows, L->pattern, (size_t)n * sizeof *rows);
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      if (L->pattern[j] >> i & 1) rows[i] |= (uint64_t)1 << j;
  L->thin = order(n, rows, L->column) < FULL * n * n;
  L->full = !L->thin;
}
