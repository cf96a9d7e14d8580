/* multishift_residual.c: residuals of all lanes in twice the precision, beside the sizes of their terms.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multishift.h"
#include <math.h>

/* Sums of products as high + low without their roundings (T. Ogita, S. M. Rump & S. Oishi, SIAM
 * J. Sci. Comput. 26, 2005); complex ones by lanes. */
typedef struct twofold {
  double high[2][STF_LANES], low[2][STF_LANES];
} twofold;

/* A row without error may be without terms. */
INLINE double squared(double r, double size) { return r == 0 ? 0 : (r / size) * (r / size); }

INLINE void gain(double *high, double *low, double a, double b)
{
  const double p = a * b, rest = fma(a, b, -p), sum = *high + p, part = sum - *high;
  *low += (*high - (sum - part)) + (p - part) + rest;
  *high = sum;
}

/* One row of E x and A x, and the sizes of the terms of M x, |M| |x|. */
INLINE void products(const stf_multishift *b, SuiteSparse_long from, SuiteSparse_long to,
                     twofold *of_e, twofold *of_a, double *size)
{
  const stf_steps *q = stf_steps_of(b);
  for (SuiteSparse_long p = from; p < to; p++) {
    const double e = q->row_e[p], a = q->row_a[p];
    const double *x = b->x + 2 * STF_LANES * (SuiteSparse_long)q->across[p];
    for (int k = 0; k < STF_LANES; k++) {
      const double re = x[k], im = x[k + STF_LANES];
      gain(&of_e->high[0][k], &of_e->low[0][k], e, re);
      gain(&of_e->high[1][k], &of_e->low[1][k], e, im);
      gain(&of_a->high[0][k], &of_a->low[0][k], a, re);
      gain(&of_a->high[1][k], &of_a->low[1][k], a, im);
      size[k] += (fabs(b->s[k].re * e - a) + fabs(b->s[k].im * e)) * (fabs(re) + fabs(im));
    }
  }
}

/* b - s E x + A x of one lane; returns its backward error squared. */
INLINE double balance(steif_shift s, const twofold *of_e, const twofold *of_a, int k,
                      double size, double *r)
{
  const double sign[2] = {-1, 1}, given[2] = {r[k], r[k + STF_LANES]};
  for (int i = 0; i < 2; i++) {
    double high = given[i], low = of_a->low[i][k];
    gain(&high, &low, 1, of_a->high[i][k]);
    gain(&high, &low, -s.re, of_e->high[i][k]);
    gain(&high, &low, -sign[i] * s.im, of_e->high[1 - i][k]);
    low -= s.re * of_e->low[i][k] + sign[i] * s.im * of_e->low[1 - i][k];
    r[k + i * STF_LANES] = high + low;
  }
  return squared(fabs(r[k]) + fabs(r[k + STF_LANES]), size + fabs(given[0]) + fabs(given[1]));
}

INLINE void residual(stf_multishift *b)
{
  const stf_steps *q = stf_steps_of(b);
  double sum[STF_LANES] = {0};
  for (int i = 0; i < q->n; i++) {
    twofold of_e = {0}, of_a = {0};
    double size[STF_LANES] = {0}, *r = b->r + 2 * STF_LANES * (SuiteSparse_long)i;
    products(b, q->row[i], q->row[i + 1], &of_e, &of_a, size);
    for (int k = 0; k < STF_LANES; k++) sum[k] += balance(b->s[k], &of_e, &of_a, k, size[k], r);
  }
  for (int k = 0; k < STF_LANES; k++) b->error[k] = sqrt(sum[k] / q->n);
}

#ifdef STF_SIMD_X86
STF_AVX2 static void residual_fused(stf_multishift *b) { residual(b); }
#endif

void stf_multishift_residual(stf_multishift *b)
{
#ifdef STF_SIMD_X86
  if (stf_simd_width() >= 4)
    residual_fused(b);
  else
#endif
    residual(b);
}
