/* orders.c: the BLAS with other orders of summation, to stand before the reference LAPACK by LD_PRELOAD.
 *
 * Processors and BLAS differ in the order in which sums are added up, and in whether a product is rounded
 * before it is added. STEIF_BLAS_ORDER = 1, 2, ... chooses one such order; what is exact in one is exact in all.
 * What a test promises must hold with every order.
 * SPDX-License-Identifier: BSD-3-Clause
 */
#include <complex.h>
#include <math.h>
#include <stdlib.h>

/* 2, 4, 8 or 1 partial sums in orders 1, 2, 3, 4 ...; from the end in every second order; products are not rounded
 * in orders 4 to 7. */
static int lanes = 1, backwards, fused;

__attribute__((constructor)) static void choose(void)
{
  const char *text = getenv("STEIF_BLAS_ORDER");
  const int order = text ? atoi(text) : 1;
  lanes = 1 << (order & 3), backwards = order & 1, fused = order >> 2 & 1;
}

static int is(const char *flag, char letter) { return (*flag & ~32) == letter; }

static double times_plus_d(double a, double b, double c)
{
  return fused ? fma(a, b, c) : c + a * b;
}
static double complex times_plus_z(double complex a, double complex b, double complex c)
{
  const double re =
                 times_plus_d(creal(a), creal(b), times_plus_d(-cimag(a), cimag(b), creal(c))),
               im =
                 times_plus_d(creal(a), cimag(b), times_plus_d(cimag(a), creal(b), cimag(c)));
  const union {
    double parts[2];
    double complex whole;
  } z = {{re, im}};
  return z.whole;
}

#define T double
#define F(name) d##name##_
#define PLUS times_plus_d
#define CONJ(x) (x)
#define IN(name) name##_d
#include "orders_of.h"
#undef T
#undef F
#undef PLUS
#undef CONJ
#undef IN

#define T double complex
#define F(name) z##name##_
#define PLUS times_plus_z
#define CONJ(x) conj(x)
#define IN(name) name##_z
#include "orders_of.h"

double ddot_(const int *n, const double *x, const int *sx, const double *y, const int *sy)
{
  return sum_d(*n, from_d(x, *n, *sx), *sx, 0, from_d(y, *n, *sy), *sy, 0);
}
double complex zdotu_(const int *n, const double complex *x, const int *sx,
                      const double complex *y, const int *sy)
{
  return sum_z(*n, from_z(x, *n, *sx), *sx, 0, from_z(y, *n, *sy), *sy, 0);
}
double complex zdotc_(const int *n, const double complex *x, const int *sx,
                      const double complex *y, const int *sy)
{
  return sum_z(*n, from_z(x, *n, *sx), *sx, 1, from_z(y, *n, *sy), *sy, 0);
}

static double norm(int n, const double *x, int step, int parts)
{
  double largest = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < parts; k++) {
      const double a = fabs(x[parts * i * step + k]);
      if (!isfinite(a)) return a;
      largest = fmax(largest, a);
    }
  if (largest == 0) return 0;
  int power;
  frexp(largest, &power);
  double s[8] = {0};
  for (int i = 0; i < n; i++)
    for (int k = 0; k < parts; k++) {
      const double a = ldexp(x[parts * (backwards ? n - 1 - i : i) * step + k], -power);
      s[i % lanes] = times_plus_d(a, a, s[i % lanes]);
    }
  for (int i = 1; i < lanes; i++) s[0] += s[i];
  return ldexp(sqrt(s[0]), power);
}
double dnrm2_(const int *n, const double *x, const int *step) { return norm(*n, x, *step, 1); }
double dznrm2_(const int *n, const double *x, const int *step) { return norm(*n, x, *step, 2); }

void drot_(const int *n, double *x, const int *sx, double *y, const int *sy, const double *c,
           const double *s)
{
  x = from_d(x, *n, *sx), y = from_d(y, *n, *sy);
  for (int i = 0; i < *n; i++, x += *sx, y += *sy) {
    const double a = *x, b = *y;
    *x = times_plus_d(*s, b, *c * a), *y = times_plus_d(*c, b, -*s * a);
  }
}

void dsyrk_(const char *uplo, const char *trans, const int *n, const int *k,
            const double *alpha, const double *a, const int *lda, const double *beta, double *c,
            const int *ldc)
{
  const int by = is(trans, 'N') ? 1 : *lda, along = is(trans, 'N') ? *lda : 1;
  for (int j = 0; j < *n; j++)
    for (int i = is(uplo, 'U') ? 0 : j; i < (is(uplo, 'U') ? j + 1 : *n); i++) {
      const double s = sum_d(*k, a + (long)i * by, along, 0, a + (long)j * by, along, 0);
      double *at = c + i + (long)j * *ldc;
      *at = *alpha * s + (*beta == 0 ? 0 : *beta * *at);
    }
}
