/* multifrontal_numeric.c: elimination and solves front by front. Dense loops over columns in vector registers; where the
 * compiler can, they exist once per instruction set and the processor decides.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multifrontal.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { BLOCK = 16 }; /* columns eliminated at a time */

/* -- dense ------------------------------------------------------------------------------------- */

/* A matrix by columns, ld apart. */
typedef struct block {
  double *x;
  sunindextype ld;
} block;

INLINE double *at(block b, int i, int j) { return b.x + i + b.ld * j; }
INLINE block from(block b, int i, int j) { return (block){at(b, i, j), b.ld}; }

/* C -= A B on 2 N x 4 entries, k terms. */
#define TILE(N)                                                                                \
  INLINE void tile##N(int k, block A, block B, block C)                                        \
  {                                                                                            \
    const double *b0 = B.x, *b1 = at(B, 0, 1), *b2 = at(B, 0, 2), *b3 = at(B, 0, 3);           \
    v##N s[8] = {{0}};                                                                         \
    for (int p = 0; p < k; p++) {                                                              \
      const v##N a = *(const v##N *)at(A, 0, p), b = *(const v##N *)at(A, N, p);               \
      s[0] += a * b0[p], s[1] += b * b0[p], s[2] += a * b1[p], s[3] += b * b1[p];              \
      s[4] += a * b2[p], s[5] += b * b2[p], s[6] += a * b3[p], s[7] += b * b3[p];              \
    }                                                                                          \
    for (int j = 0; j < 4; j++)                                                                \
      *(v##N *)at(C, 0, j) -= s[2 * j], *(v##N *)at(C, N, j) -= s[2 * j + 1];                  \
  }
TILE(2)
TILE(4)
TILE(8)

/* The same on a row of 4, and on one column of m rows. */
INLINE void row4(int k, block A, block B, block C)
{
  double s[4] = {0};
  for (int p = 0; p < k; p++)
    for (int j = 0; j < 4; j++) s[j] += *at(A, 0, p) * *at(B, p, j);
  for (int j = 0; j < 4; j++) *at(C, 0, j) -= s[j];
}

INLINE void column(int m, int k, block A, const double *restrict b, double *restrict c)
{
  for (int p = 0; p < k; p++) {
    const double *restrict a = at(A, 0, p), x = b[p];
    for (int i = 0; i < m; i++) c[i] -= a[i] * x;
  }
}

/* C -= A B, m x n, k terms. */
INLINE void update(const int wide, int m, int n, int k, block A, block B, block C)
{
  int j = 0;
  for (; j + 4 <= n; j += 4) {
    int i = 0;
    for (; wide == 8 && i + 16 <= m; i += 16)
      tile8(k, from(A, i, 0), from(B, 0, j), from(C, i, j));
    for (; wide >= 4 && i + 8 <= m; i += 8)
      tile4(k, from(A, i, 0), from(B, 0, j), from(C, i, j));
    for (; i + 4 <= m; i += 4) tile2(k, from(A, i, 0), from(B, 0, j), from(C, i, j));
    for (; i < m; i++) row4(k, from(A, i, 0), from(B, 0, j), from(C, i, j));
  }
  for (; j < n; j++) column(m, k, A, at(B, 0, j), at(C, 0, j));
}

INLINE void swap_rows(block B, int count, int i, int k)
{
  for (int j = 0; j < count; j++) {
    const double t = *at(B, i, j);
    *at(B, i, j) = *at(B, k, j), *at(B, k, j) = t;
  }
}

/* X := L^{-1} X for the unit lower triangle of k columns, X k x n. */
INLINE void lower(int k, int n, block L, block X)
{
  for (int j = 0; j < n; j++) {
    double *restrict x = at(X, 0, j);
    for (int p = 0; p < k; p++)
      for (int i = p + 1; i < k; i++) x[i] -= *at(L, i, p) * x[p];
  }
}

/* LU of columns k .. to - 1 of the panel L (height rows), pivots among rows < width; the diagonal
 * becomes its reciprocal. */
INLINE bool panel(int k, int to, int width, int height, block L, block U, int below, int *pivot)
{
  for (; k < to; k++) {
    double *d = at(L, 0, k);
    int p = k;
    for (int i = k + 1; i < width; i++)
      if (fabs(d[i]) > fabs(d[p])) p = i;
    if (!(fabs(d[p]) >= DBL_MIN)) return false;
    pivot[k] = p;
    if (p != k) swap_rows(L, width, k, p), swap_rows(U, below, k, p);
    const double r = d[k] = 1 / d[k];
    for (int i = k + 1; i < height; i++) d[i] *= r;
    for (int j = k + 1; j < to; j++) {
      double *restrict c = at(L, 0, j), t = c[k];
      for (int i = k + 1; i < height; i++) c[i] -= d[i] * t;
    }
  }
  return true;
}

/* Are all multipliers moderate? */
INLINE bool moderate(int width, int height, block L)
{
  int bad = 0;
  for (int j = 0; j < width; j++) {
    const double *l = at(L, 0, j);
    for (int i = width; i < height; i++) bad |= !(fabs(l[i]) <= STF_MULTIPLIER_MOST);
  }
  return !bad;
}

/* [L U; . C]: `width` columns eliminated. */
INLINE bool eliminate(const int wide, int width, int below, block L, block U, block C,
                      int *pivot)
{
  const int height = width + below;
  for (int k = 0; k < width; k += BLOCK) {
    const int to = width - k < BLOCK ? width : k + BLOCK, size = to - k, rest = width - to;
    if (!panel(k, to, width, height, L, U, below, pivot)) return false;
    lower(size, rest, from(L, k, k), from(L, k, to));
    update(wide, height - to, rest, size, from(L, to, k), from(L, k, to), from(L, to, to));
    lower(size, below, from(L, k, k), from(U, k, 0));
    update(wide, rest, below, size, from(L, to, k), from(U, k, 0), from(U, to, 0));
  }
  update(wide, below, below, width, from(L, width, 0), U, C);
  return moderate(width, height, L);
}

/* -- factor ---------------------------------------------------------------------------------------- */

/* The matrix C of a child added to the front it goes into. */
INLINE void add_child(const int *restrict into, int size, const double *restrict c, int width,
                      block L, block U, block C)
{
  int inner = 0; /* rows that are columns of this front */
  while (inner < size && into[inner] < width) inner++;
  for (int j = 0; j < size; j++, c += size) {
    if (into[j] < width) {
      double *restrict to = at(L, 0, into[j]);
      for (int i = 0; i < size; i++) to[into[i]] += c[i];
      continue;
    }
    double *restrict upper = at(U, 0, into[j] - width), *restrict to =
                                                          at(C, 0, into[j] - width);
    for (int i = 0; i < inner; i++) upper[into[i]] += c[i];
    for (int i = inner; i < size; i++) to[into[i] - width] += c[i];
  }
}

INLINE bool factor(const int wide, const stf_multifrontal *f, const double *value, double *out,
                   int *pivot, double *stack)
{
  double *top = stack; /* after the matrices of the children */
  memset(out, 0, (size_t)f->size * sizeof *out);
  for (int s = 0; s < f->count; s++) {
    const stf_front *g = &f->front[s];
    const size_t r = (size_t)g->below;
    const block L = {out + g->place, g->width + g->below};
    const block U = {L.x + L.ld * g->width, g->width}, C = {top, g->below};
    memset(top, 0, r * r * sizeof *top);
    for (sunindextype e = g->entry; e < g->entry + g->entries; e++)
      L.x[f->target[e]] += value[f->entry[e]];
    double *base = top;
    for (int c = g->child; c >= 0; c = f->front[c].sibling) {
      const stf_front *child = &f->front[c];
      base -= (size_t)child->below * (size_t)child->below;
      add_child(f->into + child->row, child->below, base, g->width, L, U, C);
    }
    if (!eliminate(wide, g->width, g->below, L, U, C, pivot + g->first)) return false;
    memmove(base, top, r * r * sizeof *top);
    top = base + r * r;
  }
  return true;
}

/* -- solve ------------------------------------------------------------------------------------------- */

/* y -= M x for M m x k by columns, `of` interleaved right-hand sides. */
INLINE void minus(const int of, int m, int k, const double *M, sunindextype ld, const double *x,
                  double *y)
{
  if (of == 1) {
    column(m, k, (block){(double *)M, ld}, x, y);
    return;
  }
  int p = 0;
#define MINUS(N)                                                                               \
  for (; p + 4 <= k; p += 4) {                                                                 \
    const double *a = M + ld * p, *b = a + ld, *c = b + ld, *d = c + ld;                       \
    const v##N *u = (const v##N *)(x + N * p), u0 = u[0], u1 = u[1], u2 = u[2], u3 = u[3];     \
    v##N *w = (v##N *)y;                                                                       \
    for (int i = 0; i < m; i++) w[i] -= u0 * a[i] + u1 * b[i] + (u2 * c[i] + u3 * d[i]);       \
  }                                                                                            \
  for (; p < k; p++) {                                                                         \
    const double *a = M + ld * p;                                                              \
    const v##N u = *(const v##N *)(x + N * p);                                                 \
    v##N *w = (v##N *)y;                                                                       \
    for (int i = 0; i < m; i++) w[i] -= u * a[i];                                              \
  }
  if (of == 4) {
    MINUS(4)
  } else {
    MINUS(8)
  }
}

INLINE void forward(const int of, const stf_front *g, const int *rows, const double *L,
                    const int *pivot, double *X, double *work)
{
  const sunindextype ld = g->width + g->below;
  double *x = X + (sunindextype)of * g->first;
  for (int k = 0; k < g->width; k++)
    for (int q = 0; q < of && pivot[k] != k; q++) {
      const double t = x[of * k + q];
      x[of * k + q] = x[of * pivot[k] + q], x[of * pivot[k] + q] = t;
    }
  for (int k = 0; k < g->width; k++)
    minus(of, g->width - 1 - k, 1, L + k + 1 + ld * k, ld, x + of * k, x + of * (k + 1));
  memset(work, 0, (size_t)(of * g->below) * sizeof *work);
  minus(of, g->below, g->width, L + g->width, ld, x, work);
  for (int i = 0; i < g->below; i++)
    for (int q = 0; q < of; q++) X[(sunindextype)of * rows[i] + q] += work[of * i + q];
}

INLINE void backward(const int of, const stf_front *g, const int *rows, const double *L,
                     double *X, double *work)
{
  const sunindextype ld = g->width + g->below;
  double *x = X + (sunindextype)of * g->first;
  for (int i = 0; i < g->below; i++)
    for (int q = 0; q < of; q++) work[of * i + q] = X[(sunindextype)of * rows[i] + q];
  minus(of, g->width, g->below, L + ld * g->width, g->width, work, x);
  for (int k = g->width; k-- > 0;) {
    for (int q = 0; q < of; q++) x[of * k + q] *= L[k + ld * k];
    minus(of, k, 1, L + ld * k, ld, x + of * k, x);
  }
}

INLINE void solve(const int of, const stf_multifrontal *f, const double *in, const int *pivot,
                  double *X)
{
  double *work = X + (sunindextype)of * f->n;
  for (int s = 0; s < f->count; s++) {
    const stf_front *g = &f->front[s];
    forward(of, g, f->rows + g->row, in + g->place, pivot + g->first, X, work);
  }
  for (int s = f->count; s-- > 0;) {
    const stf_front *g = &f->front[s];
    backward(of, g, f->rows + g->row, in + g->place, X, work);
  }
}

/* -- instruction sets -------------------------------------------------------------------------------- */

typedef struct kernels {
  bool (*factor)(const stf_multifrontal *f, const double *value, double *out, int *pivot,
                 double *stack);
  void (*solve)(int of, const stf_multifrontal *f, const double *in, const int *pivot,
                double *X);
} kernels;

#define KERNELS(isa, wide, attribute)                                                          \
  attribute static bool factor_##isa(const stf_multifrontal *f, const double *value,           \
                                     double *out, int *pivot, double *stack)                   \
  {                                                                                            \
    return factor(wide, f, value, out, pivot, stack);                                          \
  }                                                                                            \
  attribute static void solve_##isa(int of, const stf_multifrontal *f, const double *in,       \
                                    const int *pivot, double *X)                               \
  {                                                                                            \
    switch (of) {                                                                              \
    case 1: solve(1, f, in, pivot, X); break;                                                  \
    case 4: solve(4, f, in, pivot, X); break;                                                  \
    default: solve(8, f, in, pivot, X);                                                        \
    }                                                                                          \
  }                                                                                            \
  static const kernels isa = {factor_##isa, solve_##isa};

KERNELS(plain, 2, )
#ifdef STF_SIMD_X86
KERNELS(avx2, 4, STF_AVX2)
KERNELS(avx512, 8, STF_AVX512)
#endif

static const kernels *best(void)
{
#ifdef STF_SIMD_X86
  return stf_simd_width() == 8 ? &avx512 : stf_simd_width() == 4 ? &avx2 : &plain;
#else
  return &plain;
#endif
}

bool stf_multifrontal_factor(const stf_multifrontal *f, const double *value, double *out,
                             int *pivot, double *stack)
{
  return best()->factor(f, value, out, pivot, stack);
}

void stf_multifrontal_solve(const stf_multifrontal *f, const double *in, const int *pivot,
                            int nrhs, double *b, sunindextype ld, double *work)
{
  const int most = stf_simd_width() >= STF_LANES ? STF_FRONTS_COLUMNS : STF_LANES;
  for (int now; nrhs > 0; nrhs -= now, b += now * ld) {
    now = nrhs < most ? nrhs : most;
    if (now == STF_LANES + 1) now = STF_LANES; /* and one alone */
    const int of = now == 1 ? 1 : now <= STF_LANES ? STF_LANES : most;
    for (int k = 0; k < f->n; k++)
      for (int q = 0; q < of; q++) work[of * k + q] = q < now ? b[ld * q + f->order[k]] : 0;
    best()->solve(of, f, in, pivot, work);
    for (int q = 0; q < now; q++)
      for (int k = 0; k < f->n; k++) b[ld * q + f->order[k]] = work[of * k + q];
  }
}
