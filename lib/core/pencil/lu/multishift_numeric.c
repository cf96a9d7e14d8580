/* multishift_numeric.c: loops over columns of L and U and rows of s E - A, once for each
 * instruction set. Left-looking: column k of s E - A is scattered, less the columns of L that
 * its part of U names (J. R. Gilbert & T. Peierls, SIAM J. Sci. Stat. Comput. 9, 1988), those
 * with the same rows together as in supernodes (J. W. Demmel et al., SIAM J. Matrix Anal. Appl.
 * 20, 1999).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multishift.h"
#include <float.h>
#include <math.h>
#include <stdint.h>

/* Columns of L that are taken together, at most. */
enum { RUN = 4 };

/* Of a double. */
enum { BIAS = 1023, EXPONENT = 2047, MANTISSA = 52 };

typedef int64_t i4 __attribute__((vector_size(32), aligned(8), may_alias));
_Static_assert(STF_LANES == 4, "v4 has as many");

/* Entry k of a vector or a factor. */
INLINE v4 *at(const double *x, SuiteSparse_long k) { return (v4 *)x + 2 * k; }

INLINE void shifts(const stf_multishift *b, v4 *s)
{
  double *re = (double *)s, *im = (double *)(s + 1);
  for (int q = 0; q < STF_LANES; q++) re[q] = b->s[q].re, im[q] = b->s[q].im;
}

INLINE void larger(v4 *x, const v4 *y)
{
  const i4 which = (i4)(*x > *y);
  *x = (v4)(((i4)*x & which) | ((i4)*y & ~which));
}

INLINE void size(const v4 *z, v4 *size)
{
  const i4 sign = (i4){0} + INT64_MAX;
  *size = (v4)((i4)z[0] & sign) + (v4)((i4)z[1] & sign);
}

/* x_i -= sum_t a[t]_i z_t over `run` columns for the rows of a list. */
INLINE void minus(const int run, SuiteSparse_long count, const int *row, const double *const *a,
                  const v4 *z, double *x)
{
  v4 re[RUN], im[RUN];
  for (int t = 0; t < run; t++) re[t] = z[2 * t], im[t] = z[2 * t + 1];
  for (SuiteSparse_long p = 0; p < count; p++) {
    v4 *to = at(x, row[p]), sum[2] = {to[0], to[1]};
    for (int t = 0; t < run; t++) {
      const v4 *from = at(a[t], p);
      sum[0] = sum[0] - from[0] * re[t] + from[1] * im[t];
      sum[1] = sum[1] - from[0] * im[t] - from[1] * re[t];
    }
    to[0] = sum[0], to[1] = sum[1];
  }
}

INLINE void minus_one(SuiteSparse_long count, const int *row, const double *a, const v4 *z,
                      double *x)
{
  minus(1, count, row, &a, z, x);
}

/* x -= L z for columns j .. j + run - 1 of L, which have the same rows below: z are those
 * entries of x itself, each after the columns before it. */
INLINE void columns(const int run, const stf_multishift *b, int j, double *x, v4 *z)
{
  const stf_steps *q = stf_steps_of(b);
  const double *a[RUN];
  for (int t = 0; t < run; t++) {
    const v4 *from = at(x, j + t);
    z[2 * t] = from[0], z[2 * t + 1] = from[1];
    a[t] = (const double *)at(b->l, q->lower[j + t]);
    minus_one(run - 1 - t, q->below + q->lower[j + t], a[t], z + 2 * t, x);
    a[t] = (const double *)at(a[t], run - 1 - t);
  }
  const int last = j + run - 1;
  minus(run, q->lower[last + 1] - q->lower[last], q->below + q->lower[last], a, z, x);
}

/* As many columns from j on as may go together, of those that are left; returns how many
 * went. */
INLINE int together(const stf_multishift *b, int j, SuiteSparse_long left, double *x, v4 *z)
{
  const SuiteSparse_long run = left < stf_steps_of(b)->run[j] ? left : stf_steps_of(b)->run[j];
  if (run >= 4) {
    columns(4, b, j, x, z);
    return 4;
  }
  if (run >= 2) {
    columns(2, b, j, x, z);
    return 2;
  }
  columns(1, b, j, x, z);
  return 1;
}

/* ---- factors ----------------------------------------------------------------------------- */

/* Of the pivots so far |det|^2 = product 2^exponent, 1 <= product < 2; bad: one was zero or not
 * finite. least: of the squared ratios of largest entries of columns of s E - A and of U. */
typedef struct record {
  v4 product, least;
  i4 exponent, bad;
} record;

INLINE void assemble(const stf_steps *q, int k, const v4 *s, double *x)
{
  for (SuiteSparse_long p = q->lower[k]; p < q->lower[k + 1]; p++) {
    v4 *to = at(x, q->below[p]);
    to[0] = to[1] = (v4){0};
  }
  for (SuiteSparse_long p = q->upper[k]; p < q->upper[k + 1]; p++) {
    v4 *to = at(x, q->above[p]);
    to[0] = to[1] = (v4){0};
  }
  v4 *to = at(x, k);
  to[0] = to[1] = (v4){0};
  for (SuiteSparse_long p = q->column[k]; p < q->inner[k]; p++) {
    to = at(x, q->entry[p]);
    to[0] = s[0] * q->e[p] - q->a[p], to[1] = s[1] * q->e[p];
  }
}

/* Growth of column k, whose part of U is complete but for the pivot, of size `square`. */
INLINE void watch(const stf_multishift *b, int k, const v4 *s, const v4 *square, record *now)
{
  const stf_steps *q = stf_steps_of(b);
  v4 of_a = {0}, of_u = *square;
  for (SuiteSparse_long p = q->column[k]; p < q->inner[k]; p++) {
    const v4 re = s[0] * q->e[p] - q->a[p], im = s[1] * q->e[p], z = re * re + im * im;
    larger(&of_a, &z);
  }
  for (SuiteSparse_long p = q->upper[k]; p < q->upper[k + 1]; p++) {
    const v4 *u = at(b->u, p), z = u[0] * u[0] + u[1] * u[1];
    larger(&of_u, &z);
  }
  const v4 ratio = of_a / of_u;
  const i4 which = (i4)(ratio < now->least);
  now->least = (v4)(((i4)ratio & which) | ((i4)now->least & ~which));
}

INLINE void multiply(record *now, const v4 *square)
{
  const i4 bits = (i4)(now->product * *square), power = (bits >> MANTISSA) & EXPONENT;
  now->bad |= (i4)(power == 0) | (i4)(power == EXPONENT);
  now->exponent += power - BIAS;
  now->product = (v4)((bits & ((INT64_C(1) << MANTISSA) - 1)) | (i4)((v4){0} + 1));
}

INLINE void column(stf_multishift *b, int k, const v4 *s, bool watched, record *now)
{
  const stf_steps *q = stf_steps_of(b);
  double *x = b->r;
  assemble(q, k, s, x);
  for (SuiteSparse_long p = q->upper[k]; p < q->upper[k + 1];)
    p += together(b, q->above[p], q->upper[k + 1] - p, x, at(b->u, p));
  const v4 *z = at(x, k), square = z[0] * z[0] + z[1] * z[1];
  const v4 re = z[0] / square, im = -z[1] / square;
  v4 *pivot = at(b->pivot, k);
  pivot[0] = re, pivot[1] = im;
  if (watched) watch(b, k, s, &square, now);
  multiply(now, &square);
  for (SuiteSparse_long p = q->lower[k]; p < q->lower[k + 1]; p++) {
    v4 *l = at(b->l, p), *from = at(x, q->below[p]);
    l[0] = from[0] * re - from[1] * im, l[1] = from[0] * im + from[1] * re;
  }
}

/* ---- solutions --------------------------------------------------------------------------- */

/* The right-hand side of place k by Horner's rule in z. */
INLINE void horner(const stf_polynomial *g, SuiteSparse_long n, int i, const v4 *z, v4 *b)
{
  v4 re = {0}, im = {0};
  for (int j = g->powers - 1; j >= 0; j--) {
    const v4 p = re + g->power[j * n + i], w = im;
    re = z[0] * p - z[1] * w, im = z[0] * w + z[1] * p;
  }
  const double scale = g->scale ? g->scale[i] : 1;
  b[0] = (re + g->constant[i]) * scale, b[1] = im * scale;
}

/* 1 / s */
INLINE void inverse(const stf_multishift *b, v4 *z)
{
  v4 s[2];
  shifts(b, s);
  const v4 square = s[0] * s[0] + s[1] * s[1];
  z[0] = s[0] / square, z[1] = -s[1] / square;
}

INLINE void load(const stf_multishift *b, const stf_polynomial *g, double *x)
{
  const stf_steps *q = stf_steps_of(b);
  v4 z[2];
  inverse(b, z);
  for (int k = 0; k < q->n; k++) horner(g, q->n, q->face.equation[k], z, at(x, k));
}

INLINE void forward(const stf_multishift *b, int first, int end, double *x)
{
  v4 z[2 * RUN];
  for (int k = first; k < end;) k += together(b, k, end - k, x, z);
}

/* Back through U, and what the unknowns of a block give to equations before it. */
INLINE void backward(const stf_multishift *b, int first, int end, const v4 *s, double *x)
{
  const stf_steps *q = stf_steps_of(b);
  for (int k = end - 1; k >= first; k--) {
    v4 *here = at(x, k);
    const v4 *d = at(b->pivot, k), re = here[0] * d[0] - here[1] * d[1];
    const v4 im = here[0] * d[1] + here[1] * d[0];
    here[0] = re, here[1] = im;
    minus_one(q->upper[k + 1] - q->upper[k], q->above + q->upper[k],
              (const double *)at(b->u, q->upper[k]), here, x);
    for (SuiteSparse_long p = q->inner[k]; p < q->column[k + 1]; p++) {
      const v4 m[2] = {s[0] * q->e[p] - q->a[p], s[1] * q->e[p]};
      v4 *to = at(x, q->entry[p]);
      to[0] = to[0] - m[0] * re + m[1] * im;
      to[1] = to[1] - m[0] * im - m[1] * re;
    }
  }
}

INLINE void solve(const stf_multishift *b, double *x)
{
  const int *first = stf_steps_of(b)->first;
  v4 s[2];
  shifts(b, s);
  for (int i = stf_steps_of(b)->blocks - 1; i >= 0; i--) {
    forward(b, first[i], first[i + 1], x);
    backward(b, first[i], first[i + 1], s, x);
  }
}

/* Factors, and the solution while they are in the cache. */
INLINE void factor(stf_multishift *b, bool watched, bool solving)
{
  const stf_steps *q = stf_steps_of(b);
  const v4 one = (v4){0} + 1;
  record now = {one, one, {0}, {0}};
  v4 s[2];
  shifts(b, s);
  for (int i = q->blocks - 1; i >= 0; i--) {
    for (int k = q->first[i]; k < q->first[i + 1]; k++) {
      column(b, k, s, watched, &now);
      if (solving) columns(1, b, k, b->x, (v4[2]){{0}});
    }
    if (solving) backward(b, q->first[i], q->first[i + 1], s, b->x);
  }
  for (int k = 0; k < STF_LANES; k++) {
    b->good[k] = !now.bad[k];
    b->growth[k] = now.bad[k] ? 0 : sqrt(now.least[k]);
    b->log_det[k] = 0.5 * (log(now.product[k]) + (double)now.exponent[k] * log(2));
  }
}

/* r = b - M x by rows, beside the sizes of their terms. */
INLINE void residual(stf_multishift *b, const stf_polynomial *g)
{
  const stf_steps *q = stf_steps_of(b);
  v4 s[2], z[2], sum = {0};
  shifts(b, s);
  inverse(b, z);
  for (int i = 0; i < q->n; i++) {
    v4 *r = at(b->r, i), now[2], most, part, of_x;
    horner(g, q->n, q->face.equation[i], z, now);
    size(now, &most);
    for (SuiteSparse_long p = q->row[i]; p < q->row[i + 1]; p++) {
      const v4 m[2] = {s[0] * q->row_e[p] - q->row_a[p], s[1] * q->row_e[p]};
      const v4 *x = at(b->x, q->across[p]);
      now[0] = now[0] - m[0] * x[0] + m[1] * x[1];
      now[1] = now[1] - m[0] * x[1] - m[1] * x[0];
      size(m, &part), size(x, &of_x);
      most += part * of_x;
    }
    r[0] = now[0], r[1] = now[1];
    size(now, &part);
    part /= most + DBL_MIN; /* a row without terms has no error */
    sum += part * part;
  }
  for (int k = 0; k < STF_LANES; k++) b->error[k] = sqrt(sum[k] / q->n);
}

INLINE void correct(const stf_multishift *b, const bool *lanes)
{
  i4 mask;
  for (int k = 0; k < STF_LANES; k++) mask[k] = lanes[k] ? -1 : 0;
  for (int k = 0; k < b->sequence->n; k++) {
    v4 *x = at(b->x, k);
    const v4 *r = at(b->r, k);
    x[0] += (v4)((i4)r[0] & mask), x[1] += (v4)((i4)r[1] & mask);
  }
}

/* ---- instruction sets -------------------------------------------------------------------- */

#define SWEEPS(isa, attribute)                                                                 \
  attribute static void factor_##isa(stf_multishift *b, bool watched, bool solving)            \
  {                                                                                            \
    factor(b, watched, solving);                                                               \
  }                                                                                            \
  attribute static void load_##isa(const stf_multishift *b, const stf_polynomial *g,           \
                                   double *x)                                                  \
  {                                                                                            \
    load(b, g, x);                                                                             \
  }                                                                                            \
  attribute static void solve_##isa(const stf_multishift *b, double *x) { solve(b, x); }       \
  attribute static void residual_##isa(stf_multishift *b, const stf_polynomial *g)             \
  {                                                                                            \
    residual(b, g);                                                                            \
  }                                                                                            \
  attribute static void correct_##isa(const stf_multishift *b, const bool *lane)               \
  {                                                                                            \
    correct(b, lane);                                                                          \
  }                                                                                            \
  static const stf_multishift_kernels isa = {factor_##isa, load_##isa, solve_##isa,            \
                                             residual_##isa, correct_##isa};

SWEEPS(plain, )
#ifdef STF_SIMD_X86
SWEEPS(avx2, STF_AVX2)
SWEEPS(avx512, STF_AVX512)
#endif

const stf_multishift_kernels *stf_multishift_here(void)
{
#ifdef STF_SIMD_X86
  return stf_simd_width() == 8 ? &avx512 : stf_simd_width() == 4 ? &avx2 : &plain;
#else
  return &plain;
#endif
}
