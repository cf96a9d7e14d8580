/* multifrontal_transposed.c: solves with the transpose of the factors, front by front in the opposite
 * order. What a front does to its own unknowns x and the others X in a solve,
 *   x <- L11^{-1} P x, X <- X - L21 x    and then    x <- U11^{-1} (x - U12 X),
 * becomes
 *   x <- U11^{-T} x, X <- X - U12^T x    and then    x <- P^T L11^{-T} (x - L21^T X).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multifrontal.h"
#include "simd.h"

#define INLINE static inline __attribute__((always_inline))

/* sum_q -= the product of a column with each of `of` right-hand sides, which lie side by side. */
INLINE void less(const int of, int count, const double *restrict a, const double *restrict x,
                 double *restrict out)
{
  double sum[4][STF_FRONTS_COLUMNS] = {{0}};
  int i = 0;
  for (; i + 4 <= count; i += 4)
    for (int k = 0; k < 4; k++)
      for (int q = 0; q < of; q++) sum[k][q] += a[i + k] * x[of * (i + k) + q];
  for (; i < count; i++)
    for (int q = 0; q < of; q++) sum[0][q] += a[i] * x[of * i + q];
  for (int q = 0; q < of; q++) out[q] -= (sum[0][q] + sum[1][q]) + (sum[2][q] + sum[3][q]);
}

INLINE void through_upper(const int of, const stf_front *g, const int *rows, const double *L,
                          double *X)
{
  const sunindextype ld = g->width + g->below;
  const double *U = L + ld * g->width;
  double *x = X + (sunindextype)of * g->first;
  for (int k = 0; k < g->width; k++) {
    const double *column = L + ld * k;
    less(of, k, column, x, x + of * k);
    for (int q = 0; q < of; q++) x[of * k + q] *= column[k];
  }
  for (int i = 0; i < g->below; i++)
    less(of, g->width, U + (sunindextype)i * g->width, x, X + (sunindextype)of * rows[i]);
}

INLINE void through_lower(const int of, const stf_front *g, const int *rows, const double *L,
                          const int *pivot, double *X, double *work)
{
  const sunindextype ld = g->width + g->below;
  double *x = X + (sunindextype)of * g->first;
  for (int i = 0; i < g->below; i++)
    for (int q = 0; q < of; q++) work[of * i + q] = X[(sunindextype)of * rows[i] + q];
  for (int k = g->width; k-- > 0;) {
    const double *column = L + ld * k;
    less(of, g->below, column + g->width, work, x + of * k);
    less(of, g->width - 1 - k, column + k + 1, x + of * (k + 1), x + of * k);
  }
  for (int k = g->width; k-- > 0;)
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
