/* dense_blocked.c: Gaussian elimination with partial pivoting for 8 < n <= 16 by blocks of four rows: the
 * solution of a triangular system stays in vector registers. Products and differences are those of
 * dense_unrolled.c, one by one, so the same bits on every machine.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { WIDE = STF_LANES, BLOCKS = STF_UNROLLED / WIDE };

typedef long long mask __attribute__((vector_size(32), aligned(8), may_alias));

/* Of a block, the entries after the k-th, and those before it. */
static const mask after[WIDE] = {{0, -1, -1, -1}, {0, 0, -1, -1}, {0, 0, 0, -1}, {0, 0, 0, 0}};
static const mask before[WIDE] = {{0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, -1, 0, 0}, {-1, -1, -1, 0}};

#define LOAD(a) (*(const v4 *)(a))
#define MASKED(a, m) ((v4)((mask)(a) & (m)))

/* -- factor -------------------------------------------------------------------------------- */

static int pivot_row(const int n, const int k, const double *column)
{
  int p = k;
  double big = fabs(column[k]);
  for (int i = k + 1; i < n; i++)
    if (fabs(column[i]) > big) big = fabs(column[i]), p = i;
  return big >= DBL_MIN ? p : -1;
}

static void exchange(const int n, const int k, const int p, double (*w)[STF_UNROLLED],
                     int *perm)
{
  const int t = perm[k];
  perm[k] = perm[p], perm[p] = t;
  for (int j = 0; j < n; j++) {
    const double x = w[j][k];
    w[j][k] = w[j][p], w[j][p] = x;
  }
}

/* Column j of w is padded with zeros. Rows up to k have multipliers 0. */
INLINE void eliminate(const int n, const int k, double (*w)[STF_UNROLLED])
{
  const int first = (k + 1) / WIDE, last = (n - 1) / WIDE;
  v4 m[BLOCKS];
  for (int i = k + 1; i < n; i++) w[k][i] /= w[k][k];
  for (int b = first; b <= last; b++) m[b] = LOAD(w[k] + WIDE * b);
  if (k / WIDE == first) m[first] = MASKED(m[first], after[k % WIDE]);
  for (int j = k + 1; j < n; j++) {
    const double t = w[j][k];
    const v4 by = {t, t, t, t};
    for (int b = first; b <= last; b++) *(v4 *)(w[j] + WIDE * b) -= m[b] * by;
  }
}

INLINE int factor(const int n, double *a, int *perm)
{
  double w[STF_UNROLLED][STF_UNROLLED];
  for (int j = 0; j < n; j++) {
    memset(w[j] + WIDE * (n / WIDE), 0,
           (size_t)(STF_UNROLLED - WIDE * (n / WIDE)) * sizeof **w);
    memcpy(w[j], a + n * j, (size_t)n * sizeof *a);
  }
  for (int i = 0; i < n; i++) perm[i] = i;
  for (int k = 0; k < n; k++) {
    const int p = pivot_row(n, k, w[k]);
    if (p < 0) return k + 1;
    if (p != k) exchange(n, k, p, w, perm);
    eliminate(n, k, w);
  }
  for (int j = 0; j < n; j++) memcpy(a + n * j, w[j], (size_t)n * sizeof *a);
  return 0;
}

/* -- solve --------------------------------------------------------------------------------- */

/* x -= column k below row k times x_k; b and r are constants, so that x stays in registers. */
INLINE void down(const int blocks, const int n, const int b, const int r, const double *a,
                 v4 *x)
{
  const int k = WIDE * b + r;
  const double *column = a + n * k, t = x[b][r];
  const v4 by = {t, t, t, t};
  if (k >= n) return;
  if (r < WIDE - 1) x[b] -= MASKED(LOAD(column + WIDE * b), after[r]) * by;
  if (b < 1) x[1] -= LOAD(column + WIDE) * by;
  if (b < 2) x[2] -= LOAD(column + 2 * WIDE) * by;
  if (blocks > 3 && b < 3) x[3] -= LOAD(column + 3 * WIDE) * by;
}

INLINE void up(const int n, const int b, const int r, const double *a, v4 *x)
{
  const int k = WIDE * b + r;
  if (k >= n) return;
  const double *column = a + n * k, t = x[b][r] / column[k];
  const v4 by = {t, t, t, t};
  x[b][r] = t;
  if (r > 0) x[b] -= MASKED(LOAD(column + WIDE * b), before[r]) * by;
  if (b > 0) x[0] -= LOAD(column) * by;
  if (b > 1) x[1] -= LOAD(column + WIDE) * by;
  if (b > 2) x[2] -= LOAD(column + 2 * WIDE) * by;
}

INLINE void down_block(const int blocks, const int n, const int b, const double *a, v4 *x)
{
  down(blocks, n, b, 0, a, x), down(blocks, n, b, 1, a, x);
  down(blocks, n, b, 2, a, x), down(blocks, n, b, 3, a, x);
}

INLINE void up_block(const int n, const int b, const double *a, v4 *x)
{
  up(n, b, 3, a, x), up(n, b, 2, a, x), up(n, b, 1, a, x), up(n, b, 0, a, x);
}

INLINE void substitute(const int blocks, const int n, const double *a, const int *perm,
                       double *b)
{
  double start[STF_UNROLLED] = {0};
  for (int i = 0; i < n; i++) start[i] = b[perm[i]];
  v4 x[BLOCKS];
  for (int i = 0; i < blocks; i++) x[i] = LOAD(start + WIDE * i);
  down_block(blocks, n, 0, a, x), down_block(blocks, n, 1, a, x);
  down_block(blocks, n, 2, a, x);
  if (blocks > 3) down_block(blocks, n, 3, a, x), up_block(n, 3, a, x);
  up_block(n, 2, a, x), up_block(n, 1, a, x), up_block(n, 0, a, x);
  for (int i = 0; i < blocks; i++) *(v4 *)(start + WIDE * i) = x[i];
  memcpy(b, start, (size_t)n * sizeof *b);
}

INLINE void solve(const int n, const double *a, const int *perm, double *b)
{
  if (n <= 3 * WIDE)
    substitute(3, n, a, perm, b);
  else
    substitute(4, n, a, perm, b);
}

/* -- instances ------------------------------------------------------------------------------- */

#ifdef STF_SIMD_X86
#define AVX2 __attribute__((target("avx2"))) /* without fma: the same bits */
AVX2 static int factor_avx2(int n, double *a, int *perm) { return factor(n, a, perm); }
AVX2 static void solve_avx2(int n, const double *a, const int *perm, double *b)
{
  solve(n, a, perm, b);
}
#endif

int stf_blocked_factor(int n, double *a, int *perm)
{
#ifdef STF_SIMD_X86
  if (stf_simd_width() > 2) return factor_avx2(n, a, perm);
#endif
  return factor(n, a, perm);
}

void stf_blocked_solve(int n, const double *lu, const int *perm, double *b)
{
#ifdef STF_SIMD_X86
  if (stf_simd_width() > 2) {
    solve_avx2(n, lu, perm, b);
    return;
  }
#endif
  solve(n, lu, perm, b);
}
