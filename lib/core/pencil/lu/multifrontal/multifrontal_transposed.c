/* multifrontal_transposed.c: solves with the transpose of the factors, front by front in the opposite
 * order. What a front does to its own unknowns x and the others X in a solve,
 *   x <- L11^{-1} P x, X <- X - L21 x    and then    x <- U11^{-1} (x - U12 X),
 * becomes
 *   x <- U11^{-T} x, X <- X - U12^T x    and then    x <- P^T L11^{-T} (x - L21^T X).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multifrontal.h"
#include "simd.h"

/* What stands at out_k is taken off the products of four columns with each of N right-hand sides, side by side in x. */
#define FOUR(N)                                                                                \
  INLINE void four##N(int count, const double *a, sunindextype ld, const double *x,            \
                      double *const out[4])                                                    \
  {                                                                                            \
    const double *b = a + ld, *c = b + ld, *d = c + ld;                                        \
    v##N sum[4] = {{0}};                                                                       \
    for (int i = 0; i < count; i++) {                                                          \
      const v##N u = *(const v##N *)(x + N * i);                                               \
      sum[0] += u * a[i], sum[1] += u * b[i], sum[2] += u * c[i], sum[3] += u * d[i];          \
    }                                                                                          \
    for (int k = 0; k < 4; k++) *(v##N *)out[k] -= sum[k];                                     \
  }                                                                                            \
  INLINE void one##N(int count, const double *a, const double *x, double *out)                 \
  {                                                                                            \
    v##N sum[2] = {{0}};                                                                       \
    int i = 0;                                                                                 \
    for (; i + 2 <= count; i += 2) {                                                           \
      sum[0] += *(const v##N *)(x + N * i) * a[i];                                             \
      sum[1] += *(const v##N *)(x + N * (i + 1)) * a[i + 1];                                   \
    }                                                                                          \
    if (i < count) sum[0] += *(const v##N *)(x + N * i) * a[i];                                \
    *(v##N *)out -= sum[0] + sum[1];                                                           \
  }
FOUR(4)
FOUR(8)

INLINE void four1(int count, const double *a, sunindextype ld, const double *x,
                  double *const out[4])
{
  const double *b = a + ld, *c = b + ld, *d = c + ld;
  double sum[4] = {0};
  for (int i = 0; i < count; i++)
    sum[0] += a[i] * x[i], sum[1] += b[i] * x[i], sum[2] += c[i] * x[i], sum[3] += d[i] * x[i];
  for (int k = 0; k < 4; k++) *out[k] -= sum[k];
}

INLINE void one1(int count, const double *a, const double *x, double *out)
{
  double sum[4] = {0};
  int i = 0;
  for (; i + 4 <= count; i += 4)
    for (int k = 0; k < 4; k++) sum[k] += a[i + k] * x[i + k];
  for (; i < count; i++) sum[0] += a[i] * x[i];
  *out -= (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

INLINE void less_four(const int of, int count, const double *a, sunindextype ld,
                      const double *x, double *const out[4])
{
  if (of == 1)
    four1(count, a, ld, x, out);
  else if (of == 4)
    four4(count, a, ld, x, out);
  else
    four8(count, a, ld, x, out);
}

INLINE void less(const int of, int count, const double *a, const double *x, double *out)
{
  if (of == 1)
    one1(count, a, x, out);
  else if (of == 4)
    one4(count, a, x, out);
  else
    one8(count, a, x, out);
}

INLINE void through_upper(const int of, const stf_front *g, const int *rows, const double *L,
                          double *X)
{
  const sunindextype ld = g->width + g->below, width = g->width;
  const double *U = L + ld * width;
  double *x = X + (sunindextype)of * g->first;
  for (int k = 0; k < g->width; k++) {
    const double *column = L + ld * k;
    less(of, k, column, x, x + of * k);
    for (int q = 0; q < of; q++) x[of * k + q] *= column[k];
  }
  int i = 0;
  for (; i + 4 <= g->below; i += 4) {
    double *const out[] = {X + (sunindextype)of * rows[i], X + (sunindextype)of * rows[i + 1],
                           X + (sunindextype)of * rows[i + 2],
                           X + (sunindextype)of * rows[i + 3]};
    less_four(of, g->width, U + i * width, width, x, out);
  }
  for (; i < g->below; i++)
    less(of, g->width, U + i * width, x, X + (sunindextype)of * rows[i]);
}

INLINE void through_lower(const int of, const stf_front *g, const int *rows, const double *L,
                          const int *pivot, double *X, double *work)
{
  const sunindextype ld = g->width + g->below;
  double *x = X + (sunindextype)of * g->first;
  for (int i = 0; i < g->below; i++)
    for (int q = 0; q < of; q++) work[of * i + q] = X[(sunindextype)of * rows[i] + q];
  int k = 0;
  for (; k + 4 <= g->width; k += 4) {
    double *const out[] = {x + of * k, x + of * (k + 1), x + of * (k + 2), x + of * (k + 3)};
    less_four(of, g->below, L + ld * k + g->width, ld, work, out);
  }
  for (; k < g->width; k++) less(of, g->below, L + ld * k + g->width, work, x + of * k);
  for (k = g->width; k-- > 0;)
    less(of, g->width - 1 - k, L + ld * k + k + 1, x + of * (k + 1), x + of * k);
  for (k = g->width; k-- > 0;)
    for (int q = 0; q < of && pivot[k] != k; q++) {
      const double t = x[of * k + q];
      x[of * k + q] = x[of * pivot[k] + q], x[of * pivot[k] + q] = t;
    }
}

INLINE void solve(const int of, const stf_multifrontal *f, const double *in, const int *pivot,
                  double *X)
{
  double *work = X + (sunindextype)of * f->n;
  for (int s = 0; s < f->count; s++) {
    const stf_front *g = &f->front[s];
    through_upper(of, g, f->rows + g->row, in + g->place, X);
  }
  for (int s = f->count; s-- > 0;) {
    const stf_front *g = &f->front[s];
    through_lower(of, g, f->rows + g->row, in + g->place, pivot + g->first, X, work);
  }
}

#define KERNEL(isa, attribute)                                                                 \
  attribute static void isa(int of, const stf_multifrontal *f, const double *in,               \
                            const int *pivot, double *X)                                       \
  {                                                                                            \
    switch (of) {                                                                              \
    case 1: solve(1, f, in, pivot, X); break;                                                  \
    case 4: solve(4, f, in, pivot, X); break;                                                  \
    default: solve(STF_FRONTS_COLUMNS, f, in, pivot, X);                                       \
    }                                                                                          \
  }

KERNEL(plain, )
#ifdef STF_SIMD_X86
KERNEL(avx2, STF_AVX2)
KERNEL(avx512, STF_AVX512)
#endif

static void best(int of, const stf_multifrontal *f, const double *in, const int *pivot,
                 double *X)
{
#ifdef STF_SIMD_X86
  if (stf_simd_width() == 8)
    avx512(of, f, in, pivot, X);
  else if (stf_simd_width() == 4)
    avx2(of, f, in, pivot, X);
  else
#endif
    plain(of, f, in, pivot, X);
}

void stf_multifrontal_solve_transposed(const stf_multifrontal *f, const double *in,
                                       const int *pivot, int nrhs, double *b, sunindextype ld,
                                       double *work)
{
  const int most = stf_simd_width() == STF_FRONTS_COLUMNS ? STF_FRONTS_COLUMNS : 4;
  for (; nrhs > 0; nrhs -= most, b += most * ld) {
    const int now = nrhs < most ? nrhs : most, of = now == 1 ? 1 : now <= 4 ? 4 : most;
    for (int k = 0; k < f->n; k++)
      for (int q = 0; q < of; q++) work[of * k + q] = q < now ? b[ld * q + f->order[k]] : 0;
    best(of, f, in, pivot, work);
    for (int q = 0; q < now; q++)
      for (int k = 0; k < f->n; k++) b[ld * q + f->order[k]] = work[of * k + q];
  }
}
