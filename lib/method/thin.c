/* thin.c: is it worth to skip the zeros of a small matrix, and in which order?
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lanes.h"
#include "thin.h"

enum { LEAST = 8 }; /* unknowns: below, loops over all entries are faster */

void stf_lanes_look(stf_lanes *L, const double *J)
{
  const int n = L->n;
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
  L->thin = stf_thin_order(n, L->pattern, L->column) <= STF_THIN_FULL * n * n;
  L->full = !L->thin;
}
