/* thin.c: see thin.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "thin.h"
#include <float.h>
#include <math.h>
#include <string.h>

static int bits(uint64_t x) { return __builtin_popcountll(x); }

static void close_pattern(int n, const uint64_t *pattern, uint64_t *rows)
{
  memcpy(rows, pattern, (size_t)n * sizeof *rows);
  for (int j = 0; j < n; j++)
    for (uint64_t set = pattern[j]; set;) rows[stf_take_row(&set)] |= (uint64_t)1 << j;
}

int stf_thin_order(int n, const uint64_t *pattern, int *column)
{
  uint64_t left = stf_all_rows(n), rows[STF_THIN];
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

bool stf_thin_look(stf_thin *t, const double *a)
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
  if (fresh) t->full = stf_thin_order(n, t->pattern, t->column) > STF_THIN_FULL * n * n;
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
  return own >= STF_THIN_KEEP * big ? diagonal : p;
}

static int list(uint64_t rows, unsigned char *row)
{
  int count = 0;
  while (rows) row[count++] = (unsigned char)stf_take_row(&rows);
  return count;
}

static void subtract(int count, const unsigned char *row, const double *restrict a, double x,
                     double *restrict b)
{
  for (int i = 0; i < count; i++) b[row[i]] -= a[row[i]] * x;
}

int stf_thin_factor(stf_thin *t, double *a)
{
  const int n = t->n;
  uint64_t live[STF_THIN], active = stf_all_rows(n);
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
    const int count = list(below, row);
    t->upper[k] = from + count;
    t->lower[k + 1] = from + count + list(live[c] & ~active & ~((uint64_t)1 << p), row + count);
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

void stf_thin_solve(const stf_thin *t, const double *a, double *b)
{
  const int n = t->n;
  double x[STF_THIN];
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
