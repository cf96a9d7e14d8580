/* nodes.c: nodes of Gauss, Radau and Lobatto on [0, 1], and Lagrange's basis on given points.
 *
 * With Q_k(c) = (-1)^k P_k(2c - 1), so Q_k(0) = 1, the nodes are the zeros of
 *   Gauss Q_s,   Radau right Q_s + Q_{s-1},   Radau left Q_s - Q_{s-1},
 *   Lobatto Q_s - Q_{s-2}.
 * The three-term recurrence is run on the differences E_k = Q_k - Q_{k-1},
 *   (k+1) E_{k+1} = k E_k - 2 (2k+1) c Q_k,
 * which do not cancel at small c: nodes near 0 keep their relative accuracy.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include <float.h>
#include <math.h>

#define PI 3.14159265358979323846264338L

/* f/f' of the polynomial of `kind` at c. */
static long double quotient(enum stf_node_kind kind, int s, long double c)
{
  long double q = 1, dq = 0, e = 0, de = 0, e0 = 0, de0 = 0;
  for (int k = 0; k < s; k++) {
    const long double slope = 2 * (2 * (long double)k + 1);
    e0 = e, de0 = de;
    de = (k * de - slope * (q + c * dq)) / (k + 1);
    e = (k * e - slope * c * q) / (k + 1);
    q += e, dq += de;
  }
  switch (kind) {
  case STF_GAUSS: return q / dq;
  case STF_RADAU_RIGHT: return (2 * q - e) / (2 * dq - de);
  case STF_RADAU_LEFT: return e / de;
  default: return (e + e0) / (de + de0);
  }
}

/* Newton's iteration from the cosine guess for zeros of Jacobi polynomials with exponents
 * alpha, beta in {0, 1} (1 where an end point is a node), converged in at most 5 steps. */
static long double zero(enum stf_node_kind kind, int s, int i)
{
  enum { STEPS = 12 };
  const int left = kind == STF_RADAU_LEFT || kind == STF_LOBATTO;
  const int right = kind == STF_RADAU_RIGHT || kind == STF_LOBATTO;
  const int inner = s - left - right;
  const long double half =
    sinl((2 * (i + 1) - 0.5L + left) * PI / (2 * inner + left + right + 1) / 2);
  long double c = half * half;
  for (int k = 0; k < STEPS; k++) {
    const long double step = quotient(kind, s, c);
    c -= step;
    if (fabsl(step) <= LDBL_EPSILON * c) break;
  }
  return c;
}

int stf_nodes(steif_context *ctx, enum stf_node_kind kind, int s, long double *c)
{
  const int left = kind == STF_RADAU_LEFT || kind == STF_LOBATTO;
  const int right = kind == STF_RADAU_RIGHT || kind == STF_LOBATTO;
  const int lowest = left + right > 1 ? 2 : 1, inner = s - left - right;
  STEIF_CHECK(s >= lowest && s <= STEIF_STAGES, ctx, STEIF_BAD_INPUT,
              "these nodes exist for %d to %d stages, not for %d", lowest, STEIF_STAGES, s);
  const bool symmetric = left == right;
  const int own = symmetric ? inner / 2 : inner;
  for (int i = 0; i < own; i++) c[left + i] = zero(kind, s, i);
  if (left) c[0] = 0;
  if (right) c[s - 1] = 1;
  if (!symmetric) return STEIF_OK;
  for (int i = 0; i < own; i++) c[s - 1 - left - i] = 1 - c[left + i];
  if (inner % 2) c[s / 2] = 0.5L;
  return STEIF_OK;
}

void stf_gauss(int m, long double *c, long double *w)
{
  (void)stf_nodes(NULL, STF_GAUSS, m, c);
  for (int i = 0; i < m; i++) {
    long double sum = 0, q = 1, e = 0; /* Christoffel: 1/w = sum (2k+1) Q_k(c)^2 */
    for (int k = 0; k < m; k++) {
      const long double odd = 2 * (long double)k + 1;
      sum += odd * q * q;
      e = (k * e - 2 * odd * c[i] * q) / (k + 1);
      q += e;
    }
    w[i] = 1 / sum;
  }
}

/* Product rule over the factors (x - p_k)/(p_j - p_k): no division by x - p_k, so x may be a
 * point. */
void stf_lagrange(int count, const long double *points, long double x, long double *value,
                  long double *slope)
{
  for (int j = 0; j < count; j++) {
    long double v = 1, d = 0;
    for (int k = 0; k < count; k++) {
      if (k == j) continue;
      const long double gap = points[j] - points[k], factor = (x - points[k]) / gap;
      d = d * factor + v / gap;
      v *= factor;
    }
    value[j] = v, slope[j] = d;
  }
}
