/* dense_bitset.c: dense real matrices whose zeros are skipped; the fill is found on the way.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bitset.h"
#include <float.h>
#include <math.h>
#include <string.h>

struct stf_bitset {
  int n;
  bool full;                                 /* too full: not used any more */
  uint64_t pattern[STF_BITSET];              /* rows of all matrices so far, by columns */
  int column[STF_BITSET], order[STF_BITSET]; /* unknown and row of the pivot of each step */
  int lower[STF_BITSET + 1], upper[STF_BITSET];
  unsigned char
    row[STF_BITSET * STF_BITSET]; /* step k: rows below lower[k] .., above upper[k] .. */
};

stf_bitset *stf_bitset_new(steif_context *ctx, int n)
{
  stf_bitset *t = stf_allocate(ctx, 1, sizeof *t);
  if (t) t->n = n;
  return t;
}

size_t stf_bitset_size(void) { return sizeof(stf_bitset); }

static int bits(uint64_t x) { return __builtin_popcountll(x); }

static void close_pattern(int n, const uint64_t *pattern, uint64_t *rows)
{
  memcpy(rows, pattern, (size_t)n * sizeof *rows);
  for (int j = 0; j < n; j++)
    for (uint64_t set = pattern[j]; set;) rows[stf_take_row(&set)] |= (uint64_t)1 << j;
}

int stf_bitset_order(int n, const uint64_t *pattern, int *column)
{
  uint64_t left = stf_all_rows(n), rows[STF_BITSET];
  int entries = 0;
  close_pattern(n, pattern, rows);
  for (int k = 0; k < n; k++) {
    int best = -1;
    for (uint64_t set = left; set;) {
      const int i = stf_take_row(&set);
      if (best < 0 || bits(rows[i] & left) < bits(rows[best] & left)) best = i;
    }
    column[k] = best;
    left &= ~((uint64_t)1 << best);
    const uint64_t near = rows[best] & left;
    entries += 1 + 2 * bits(near);
    for (uint64_t set = near; set;) rows[stf_take_row(&set)] |= near;
  }
  return entries;
}

bool stf_bitset_look(stf_bitset *t, const double *a)
{
  const int n = t->n;
  uint64_t fresh = 0;
  if (t->full) return false;
  for (int j = 0; j < n; j++) {
    uint64_t column = (uint64_t)1 << j;
    for (int i = 0; i < n; i++) column |= (uint64_t)(a[i + n * j] != 0) << i;
    fresh |= column & ~t->pattern[j];
    t->pattern[j] |= column;
  }
  if (fresh) t->full = stf_bitset_order(n, t->pattern, t->column) > STF_BITSET_FULL * n * n;
  return !t->full;
}

/* The row of the pivot among `rows` of a column; -1: all vanish. */
static int pivot_row(uint64_t rows, const double *a, int diagonal)
{
  double big = 0;
  int p = -1;
  const double own = rows >> diagonal & 1 ? fabs(a[diagonal]) : 0;
  while (rows) {
    const int i = stf_take_row(&rows);
    if (fabs(a[i]) > big) big = fabs(a[i]), p = i;
  }
  if (!(big >= DBL_MIN)) return -1;
  return own >= STF_BITSET_KEEP * big ? diagonal : p;
}

static void subtract(int count, const unsigned char *row, const double *restrict a, double x,
                     double *restrict b)
{
  for (int i = 0; i < count; i++) b[row[i]] -= a[row[i]] * x;
}

int stf_bitset_factor(stf_bitset *t, double *a)
{
  const int n = t->n;
  uint64_t live[STF_BITSET], active = stf_all_rows(n);
  memcpy(live, t->pattern, (size_t)n * sizeof *live);
  t->lower[0] = 0;
  for (int k = 0; k < n; k++) {
    const int c = t->column[k], from = t->lower[k];
    double *column = a + c * n;
    const int p = t->order[k] = pivot_row(live[c] & active, column, c);
    if (p < 0) return c + 1;
    active &= ~((uint64_t)1 << p);
    unsigned char *row = t->row + from;
    const uint64_t below = live[c] & active;
    const int count = stf_list_rows(below, row);
    t->upper[k] = from + count;
    t->lower[k + 1] =
      from + count + stf_list_rows(live[c] & ~active & ~((uint64_t)1 << p), row + count);
    const double r = column[p] = 1 / column[p];
    for (int i = 0; i < count; i++) column[row[i]] *= r;
    for (int m = k + 1; m < n; m++) {
      const int j = t->column[m];
      if (!(live[j] >> p & 1)) continue;
      live[j] |= below;
      subtract(count, row, column, a[p + j * n], a + j * n);
    }
  }
  return 0;
}

void stf_bitset_solve(const stf_bitset *t, const double *a, double *b)
{
  const int n = t->n;
  double x[STF_BITSET];
  for (int k = 0; k < n; k++)
    subtract(t->upper[k] - t->lower[k], t->row + t->lower[k], a + t->column[k] * n,
             b[t->order[k]], b);
  for (int k = n; k-- > 0;) {
    const int c = t->column[k];
    const double *column = a + c * n, y = x[c] = b[t->order[k]] * column[t->order[k]];
    subtract(t->lower[k + 1] - t->upper[k], t->row + t->upper[k], column, y, b);
  }
  memcpy(b, x, (size_t)n * sizeof *b);
}

/* U^T from the first pivot on, then L^T from the last; values stand at the rows of their pivots. */
void stf_bitset_solve_transposed(const stf_bitset *t, const double *a, double *b)
{
  const int n = t->n;
  double x[STF_BITSET];
  for (int k = 0; k < n; k++) {
    const int c = t->column[k], p = t->order[k];
    const double *column = a + c * n;
    double sum = b[c];
    for (int i = t->upper[k]; i < t->lower[k + 1]; i++) sum -= column[t->row[i]] * x[t->row[i]];
    x[p] = sum * column[p];
  }
  for (int k = n; k-- > 0;) {
    const double *column = a + t->column[k] * n;
    for (int i = t->lower[k]; i < t->upper[k]; i++)
      x[t->order[k]] -= column[t->row[i]] * x[t->row[i]];
  }
  memcpy(b, x, (size_t)n * sizeof *b);
}
