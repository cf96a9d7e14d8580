/* extended.c: pairs of doubles, and two integrators with them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "extended.h"
#include <string.h>

/* -- pairs --------------------------------------------------------------------------------------- */

pair pair_of(double x) { return (pair){x, 0}; }

/* a + b without an error, |a| and |b| in any order (Knuth). */
static pair sum(double a, double b)
{
  const double s = a + b, other = s - a;
  return (pair){s, (a - (s - other)) + (b - other)};
}

static pair split(double a)
{
  const double shifted = 134217729 * a, high = shifted - (shifted - a); /* 2^27 + 1 */
  return (pair){high, a - high};
}

static pair product(double a, double b)
{
  const double p = a * b;
  const pair u = split(a), v = split(b);
  const double first = u.hi * v.hi, second = u.hi * v.lo, third = u.lo * v.hi;
  return (pair){p, ((first - p) + second + third) + u.lo * v.lo};
}

pair pair_add(pair a, pair b)
{
  pair s = sum(a.hi, b.hi);
  const pair low = sum(a.lo, b.lo);
  s = sum(s.hi, s.lo + low.hi);
  return sum(s.hi, s.lo + low.lo);
}

pair pair_multiply(pair a, pair b)
{
  const pair p = product(a.hi, b.hi);
  return sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

static pair minus(pair a) { return (pair){-a.hi, -a.lo}; }

pair pair_divide(pair a, double b)
{
  const double first = a.hi / b;
  const pair left = pair_add(a, minus(product(first, b)));
  return sum(first, left.hi / b);
}

/* -- Taylor series --------------------------------------------------------------------------------- */

enum { ORDER = 24, COLUMNS = 10 };

/* Coefficient k of the product of two components. */
static pair coefficient(const term *m, pair series[][LARGEST], int k)
{
  if (m->a == ONE && m->b == ONE) return pair_of(k == 0);
  if (m->a == ONE) return series[k][m->b];
  if (m->b == ONE) return series[k][m->a];
  pair c = pair_of(0);
  for (int j = 0; j <= k; j++)
    c = pair_add(c, pair_multiply(series[j][m->a], series[k - j][m->b]));
  return c;
}

void extended_taylor(int n, const term *terms, int count, pair *y, double t, int steps)
{
  const pair h = pair_divide(pair_of(t), steps);
  pair series[ORDER + 1][LARGEST];
  for (int step = 0; step < steps; step++) {
    memcpy(series[0], y, (size_t)n * sizeof *y);
    for (int k = 0; k < ORDER; k++) {
      for (int i = 0; i < n; i++) series[k + 1][i] = pair_of(0);
      for (const term *m = terms; m < terms + count; m++)
        series[k + 1][m->to] =
          pair_add(series[k + 1][m->to], pair_multiply(m->c, coefficient(m, series, k)));
      for (int i = 0; i < n; i++) series[k + 1][i] = pair_divide(series[k + 1][i], k + 1);
    }
    for (int i = 0; i < n; i++) {
      y[i] = series[ORDER][i];
      for (int k = ORDER; k-- > 0;) y[i] = pair_add(series[k][i], pair_multiply(h, y[i]));
    }
  }
}

/* -- the midpoint rule, extrapolated from 2, 4, .. substeps --------------------------------------------- */

/* out = from + h q(y) */
static void advance(int n, const term *terms, int count, const pair *from, pair h,
                    const pair *y, pair *out)
{
  pair slope[LARGEST];
  for (int i = 0; i < n; i++) slope[i] = pair_of(0);
  for (const term *m = terms; m < terms + count; m++) {
    pair c = m->a == ONE ? m->c : pair_multiply(m->c, y[m->a]);
    if (m->b != ONE) c = pair_multiply(c, y[m->b]);
    slope[m->to] = pair_add(slope[m->to], c);
  }
  for (int i = 0; i < n; i++) out[i] = pair_add(from[i], pair_multiply(h, slope[i]));
}

static void midpoints(int n, const term *terms, int count, const pair *y, pair h, int substeps,
                      pair *out)
{
  pair at[3][LARGEST];
  const pair small = pair_divide(h, substeps), twice = pair_add(small, small);
  memcpy(at[0], y, (size_t)n * sizeof *y);
  advance(n, terms, count, at[0], small, at[0], at[1]);
  for (int k = 2; k <= substeps; k++)
    advance(n, terms, count, at[(k - 2) % 3], twice, at[(k - 1) % 3], at[k % 3]);
  memcpy(out, at[substeps % 3], (size_t)n * sizeof *y);
}

void extended_midpoint(int n, const term *terms, int count, pair *y, double t, int steps)
{
  const pair h = pair_divide(pair_of(t), steps);
  pair table[COLUMNS][LARGEST];
  for (int step = 0; step < steps; step++) {
    for (int j = 0; j < COLUMNS; j++) {
      midpoints(n, terms, count, y, h, 2 * (j + 1), table[j]);
      for (int k = j; k-- > 0;) { /* table[k]: from k + 1 .. j + 1 */
        const int more = (j + 1) * (j + 1), fewer = (k + 1) * (k + 1);
        for (int i = 0; i < n; i++) {
          const pair change = pair_add(table[k + 1][i], minus(table[k][i]));
          const pair c = pair_divide(pair_multiply(change, pair_of(fewer)), more - fewer);
          table[k][i] = pair_add(table[k + 1][i], c);
        }
      }
    }
    memcpy(y, table[0], (size_t)n * sizeof *y);
  }
}
