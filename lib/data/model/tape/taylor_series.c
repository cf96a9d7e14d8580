/* taylor_series.c: Taylor arithmetic: from the coefficients c_k = u^(k)(t) / k! of the arguments those of
 * the result (R. E. Moore, Interval Analysis, 1966; A. Griewank and A. Walther, Evaluating
 * Derivatives, 2nd ed., SIAM 2008, section 13.2). Each recurrence comes from a linear differential
 * equation of the function, e.g. u = exp(a): u' = a' u gives k u_k = sum_{j=1..k} j a_j u_{k-j}.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "series.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void copy(int n, const stf_series *a, stf_series *u)
{
  memcpy(u->c, a->c, (size_t)(n + 1) * sizeof *u->c);
}

void stf_series_constant(int n, sunrealtype value, stf_series *u)
{
  for (int k = 1; k <= n; k++) u->c[k] = 0;
  u->c[0] = value;
}

/* sum_{j=first..last} a_j b_{k-j} */
static sunrealtype product(const stf_series *a, const stf_series *b, int k, int first, int last)
{
  sunrealtype sum = 0;
  for (int j = first; j <= last; j++) sum += a->c[j] * b->c[k - j];
  return sum;
}

/* (1/k) sum_{j=1..last} j a_j b_{k-j}: coefficient k of the integral of a' b. */
static sunrealtype slope(const stf_series *a, const stf_series *b, int k, int last)
{
  sunrealtype sum = 0;
  for (int j = 1; j <= last; j++) sum += j * a->c[j] * b->c[k - j];
  return sum / k;
}

void stf_series_times(int n, const stf_series *a, const stf_series *b, stf_series *u)
{
  for (int k = 0; k <= n; k++) u->c[k] = product(a, b, k, 0, k);
}

const char *stf_series_over(int n, const stf_series *a, const stf_series *b, stf_series *u)
{
  if (b->c[0] == 0) return "division by zero";
  for (int k = 0; k <= n; k++) u->c[k] = (a->c[k] - product(b, u, k, 1, k)) / b->c[0];
  return NULL;
}

/* a = O(s^m), m >= 1: a^exponent = O(s^(m exponent)), known only when that is beyond order n. */
static const char *power_of_zero(int n, const stf_series *a, sunrealtype exponent,
                                 stf_series *u)
{
  int m = 1;
  while (m <= n && a->c[m] == 0) m++;
  if (exponent < 0) return "a negative power of zero";
  if (!(m * exponent > n))
    return "a power of zero whose derivative of this order is not finite";
  stf_series_constant(n, 0, u);
  return NULL;
}

/* u = a^p: a u' = p a' u. */
const char *stf_series_power(int n, const stf_series *a, sunrealtype exponent, stf_series *u)
{
  if (a->c[0] == 0) return power_of_zero(n, a, exponent, u);
  if (!(a->c[0] > 0)) return "a power of a negative number that is not whole";
  u->c[0] = exponent == 0.5 ? sqrt(a->c[0]) : pow(a->c[0], exponent);
  for (int k = 1; k <= n; k++) {
    sunrealtype sum = 0;
    for (int j = 1; j <= k; j++) sum += (exponent * j - (k - j)) * a->c[j] * u->c[k - j];
    u->c[k] = sum / (k * a->c[0]);
  }
  return NULL;
}

const char *stf_series_whole(int n, const stf_series *a, long exponent, stf_series *u,
                             stf_series w[2])
{
  stf_series *square = w, *next = w + 1;
  if (exponent < 0) {
    if (a->c[0] == 0) return "a negative power of zero";
    stf_series_constant(n, 1, next);
    stf_series_over(n, next, a, square);
  } else {
    copy(n, a, square);
  }
  stf_series_constant(n, 1, u);
  for (long rest = labs(exponent); rest; rest /= 2) {
    if (rest % 2) {
      stf_series_times(n, u, square, next);
      copy(n, next, u);
    }
    if (rest == 1) break;
    stf_series_times(n, square, square, next);
    copy(n, next, square);
  }
  return NULL;
}

/* a u' = a' */
const char *stf_series_log(int n, const stf_series *a, stf_series *u)
{
  if (!(a->c[0] > 0)) return "the logarithm of a number that is not positive";
  u->c[0] = log(a->c[0]);
  for (int k = 1; k <= n; k++) u->c[k] = (a->c[k] - slope(u, a, k, k - 1)) / a->c[0];
  return NULL;
}

void stf_series_exp(int n, const stf_series *a, stf_series *u)
{
  u->c[0] = exp(a->c[0]);
  for (int k = 1; k <= n; k++) u->c[k] = slope(a, u, k, k);
}

void stf_series_waves(int n, const stf_series *a, int sign, stf_series *sine,
                      stf_series *cosine)
{
  const sunrealtype x = a->c[0];
  sine->c[0] = sign < 0 ? sin(x) : sinh(x);
  cosine->c[0] = sign < 0 ? cos(x) : cosh(x);
  for (int k = 1; k <= n; k++) {
    sine->c[k] = slope(a, cosine, k, k);
    cosine->c[k] = sign * slope(a, sine, k, k);
  }
}

/* u' = a' w, w = 1 + sign u^2. */
const char *stf_series_tan(int n, const stf_series *a, int sign, stf_series *u, stf_series *w)
{
  u->c[0] = sign > 0 ? tan(a->c[0]) : tanh(a->c[0]);
  w->c[0] = 1 + sign * u->c[0] * u->c[0];
  if (sign < 0) {
    const sunrealtype c = cosh(a->c[0]);
    w->c[0] = 1 / (c * c);
  }
  for (int k = 1; k <= n; k++) {
    u->c[k] = slope(a, w, k, k);
    w->c[k] = sign * product(u, u, k, 0, k);
  }
  return isfinite(u->c[0]) ? NULL : "the tangent of this number";
}

/* w u' = a', w = 1 + a^2. */
void stf_series_atan(int n, const stf_series *a, stf_series *u, stf_series *w)
{
  stf_series_times(n, a, a, w);
  w->c[0] += 1;
  u->c[0] = atan(a->c[0]);
  for (int k = 1; k <= n; k++) u->c[k] = (a->c[k] - slope(u, w, k, k - 1)) / w->c[0];
}
