/* interleaved_complex.h: complex numbers by lanes, re[lanes] im[lanes], for the kernels of interleaved.c.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LANES_VECTOR_H
#define STF_LANES_VECTOR_H

#include "simd.h"

/* e = 1 / e in all lanes. */
INLINE void reciprocal(const int lanes, double *e)
{
  for (int k = 0; k < lanes; k++) {
    const double re = e[k], im = e[lanes + k], d = 1 / (re * re + im * im);
    e[k] = re * d, e[lanes + k] = -im * d;
  }
}

/* z -= x y and x = x y. */
INLINE void minus(const int lanes, double *restrict z, const double *restrict x,
                  const double *restrict y)
{
  for (int k = 0; k < lanes; k++) {
    z[k] -= x[k] * y[k] - x[lanes + k] * y[lanes + k];
    z[lanes + k] -= x[k] * y[lanes + k] + x[lanes + k] * y[k];
  }
}

INLINE void times(const int lanes, double *restrict x, const double *restrict y)
{
  for (int k = 0; k < lanes; k++) {
    const double re = x[k] * y[k] - x[lanes + k] * y[lanes + k];
    x[lanes + k] = x[k] * y[lanes + k] + x[lanes + k] * y[k];
    x[k] = re;
  }
}

/* z_i -= a_i x for i = from .. to - 1: independent, so that the processor may overlap them. */
#define VECTOR(N)                                                                              \
  INLINE void subtract##N(int from, int to, const double *a, const double *x, double *z)       \
  {                                                                                            \
    const v##N re = *(const v##N *)x, im = *(const v##N *)(x + N);                             \
    for (int i = from; i < to; i++) {                                                          \
      const v##N *e = (const v##N *)(a + i * 2 * N);                                           \
      v##N *w = (v##N *)(z + i * 2 * N);                                                       \
      w[0] -= e[0] * re - e[1] * im;                                                           \
      w[1] -= e[0] * im + e[1] * re;                                                           \
    }                                                                                          \
  }                                                                                            \
  /* The same for the rows of a list. */                                                       \
  INLINE void subtract_at##N(int count, const unsigned char *row, const double *a,             \
                             const double *x, double *z)                                       \
  {                                                                                            \
    const v##N re = *(const v##N *)x, im = *(const v##N *)(x + N);                             \
    for (int i = 0; i < count; i++) {                                                          \
      const v##N *e = (const v##N *)(a + row[i] * 2 * N);                                      \
      v##N *w = (v##N *)(z + row[i] * 2 * N);                                                  \
      w[0] -= e[0] * re - e[1] * im;                                                           \
      w[1] -= e[0] * im + e[1] * re;                                                           \
    }                                                                                          \
  }                                                                                            \
  /* r += x f for vectors of 2 N numbers. */                                                   \
  INLINE void add##N(double *r, const double *x, double f)                                     \
  {                                                                                            \
    v##N *to = (v##N *)r;                                                                      \
    const v##N *from = (const v##N *)x;                                                        \
    to[0] += from[0] * f, to[1] += from[1] * f;                                                \
  }                                                                                            \
  /* z = sum_{k < count} c_k x^(k+1) for vectors of 2 N numbers. */                            \
  INLINE void horner##N(int count, const double *c, const double *x, double *z)                \
  {                                                                                            \
    const v##N *at = (const v##N *)x;                                                          \
    v##N low = {0}, high = {0};                                                                \
    for (int k = count; k-- > 0;) low = (low + c[k]) * at[0], high = (high + c[k]) * at[1];    \
    ((v##N *)z)[0] = low, ((v##N *)z)[1] = high;                                               \
  }

VECTOR(2)
VECTOR(4)
VECTOR(8)
#define HAND(N, name, ...)                                                                     \
  if (half == N) {                                                                             \
    name##N(__VA_ARGS__);                                                                      \
    return;                                                                                    \
  }

INLINE void subtract(const int half, int from, int to, const double *a, const double *x,
                     double *z)
{
  HAND(2, subtract, from, to, a, x, z)
  HAND(4, subtract, from, to, a, x, z)
  HAND(8, subtract, from, to, a, x, z)
  for (int i = from; i < to; i++) minus(half, z + i * 2 * half, a + i * 2 * half, x);
}

INLINE void subtract_at(const int half, int count, const unsigned char *row, const double *a,
                        const double *x, double *z)
{
  HAND(2, subtract_at, count, row, a, x, z)
  HAND(4, subtract_at, count, row, a, x, z)
  HAND(8, subtract_at, count, row, a, x, z)
  for (int i = 0; i < count; i++) minus(half, z + row[i] * 2 * half, a + row[i] * 2 * half, x);
}

INLINE void horner(const int half, int count, const double *c, const double *x,
                   double *z){HAND(2, horner, count, c, x, z) HAND(4, horner, count, c, x, z)
                                HAND(8, horner, count, c, x, z)}

/* r += x f, 2 half numbers. */
INLINE void add(const int half, double *r, const double *x, double f)
{
  HAND(2, add, r, x, f)
  HAND(4, add, r, x, f)
  HAND(8, add, r, x, f)
  for (int k = 0; k < 2 * half; k++) r[k] += x[k] * f;
}

#endif
