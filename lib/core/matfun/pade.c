/* pade.c: rational approximants to phi_l on a scaled matrix.
 *
 * With P = N_l and Q = D_l of degree m,
 *   D_i = (-1)^i (2m+l-i)! m! / (i! (m-i)! (2m+l)!),   N_i = sum_{j<=i} D_j / (l+i-j)!,
 * Q^{-1} P agrees with phi_l up to z^{2m}. Polynomials are split into even and odd parts,
 * p(A) = V + A W, both in powers of A^2 (N. J. Higham, SIAM J. Matrix Anal. Appl. 26, 2005).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"
#include "lapack.h"
#include "lu.h"

enum { HIGHEST = 13 };

/* The sums for N cancel to a large extent: twice the working precision. */
void stf_pade_coefficients(int m, int l, double *numerator, double *denominator)
{
  stf_two D[HIGHEST + 1] = {{1, 0}};
  for (int i = 1; i <= m; i++)
    D[i] = stf_two_div(stf_two_mul(D[i - 1], stf_two_of(i - 1 - m)),
                       stf_two_of((2 * m + l - i + 1) * i));
  for (int i = 0; i <= m && denominator; i++) denominator[i] = D[i].hi;
  for (int i = 0; i <= m && numerator; i++) {
    stf_two sum = {0, 0};
    for (int j = 0; j <= i; j++)
      sum = stf_two_add(sum, stf_two_mul(D[j], stf_inverse_factorial(l + i - j)));
    numerator[i] = sum.hi;
  }
}

static void add_diagonal(int n, double c, double *X)
{
  for (int i = 0; i < n; i++) X[(size_t)i * (size_t)(n + 1)] += c;
}

/* out = k_odd I + k_{odd+2} A^2 + k_{odd+4} A^4 + ... up to degree m; out may be A8. */
static void sum_low(const stf_core *c, const double *k, int odd, double *out)
{
  const size_t count = (size_t)c->n * (size_t)c->n;
  const double *A2 = c->A2, *A4 = c->A4, *A6 = c->A6, *A8 = c->A8;
  const double k2 = k[odd + 2], k4 = c->m > 3 ? k[odd + 4] : 0, k6 = c->m > 5 ? k[odd + 6] : 0,
               k8 = c->m > 7 ? k[odd + 8] : 0;
  if (c->m == 3)
    for (size_t i = 0; i < count; i++) out[i] = k2 * A2[i];
  else if (c->m == 5)
    for (size_t i = 0; i < count; i++) out[i] = k2 * A2[i] + k4 * A4[i];
  else if (c->m == 9)
    for (size_t i = 0; i < count; i++)
      out[i] = k2 * A2[i] + k4 * A4[i] + (k6 * A6[i] + k8 * A8[i]);
  else
    for (size_t i = 0; i < count; i++) out[i] = k2 * A2[i] + k4 * A4[i] + k6 * A6[i];
  add_diagonal(c->n, k[odd], out);
}

/* out = the even (odd = 0) or odd (odd = 1) part of the polynomial k, the latter without the
 * factor A; c->U is lost for m = 13. */
static void part(stf_core *c, const double *k, int odd, double *out)
{
  sum_low(c, k, odd, out);
  if (c->m < HIGHEST) return;
  const size_t count = (size_t)c->n * (size_t)c->n;
  const double *A2 = c->A2, *A4 = c->A4, *A6 = c->A6;
  const double k8 = k[8 + odd], k10 = k[10 + odd], k12 = k[12 + odd];
  for (size_t i = 0; i < count; i++) c->U[i] = k8 * A2[i] + k10 * A4[i] + k12 * A6[i];
  stf_multiply(c->n, c->n, A6, c->U, 1, out);
}

/* X := V^{-1} X, n x n; V becomes its factors. */
static int divide(stf_core *c, double *X)
{
  const int column = stf_dense_factor(c->n, c->V, c->pivot);
  STEIF_CHECK(
    column == 0, c->ctx, STEIF_SINGULAR,
    "the denominator of the Pade approximant has no pivot in column %d: the matrix is "
    "scaled too badly; balance it first",
    column);
  stf_dense_solve('N', c->n, c->n, c->V, c->pivot, X);
  return STEIF_OK;
}

/* For l = 0, P(A) = Q(-A): with P = V + A W the approximant is I + 2 (V - A W)^{-1} A W. */
int stf_pade_expm(stf_core *c)
{
  const int n = c->n;
  const size_t count = (size_t)n * (size_t)n;
  double k[HIGHEST + 1];
  stf_pade_coefficients(c->m, 0, NULL, k);
  for (int i = 1; i <= c->m; i += 2) k[i] = -k[i];
  part(c, k, 0, c->V);
  part(c, k, 1, c->W);
  stf_multiply(n, n, c->A, c->W, 0, c->U);
  for (size_t i = 0; i < count; i++) c->V[i] -= c->U[i];
  STEIF_TRY(divide(c, c->U));
  const double factor = exp(ldexp(c->mu, -c->s));
  for (size_t i = 0; i < count; i++) c->U[i] *= 2 * factor;
  add_diagonal(n, factor, c->U);
  return STEIF_OK;
}

/* phi_p by its approximant, the others by phi_{l-1} = A phi_l + I/(l-1)!. */
int stf_pade_phi(stf_core *c, double *phi)
{
  const int n = c->n, p = c->p;
  const size_t count = (size_t)n * (size_t)n;
  double N[HIGHEST + 1], D[HIGHEST + 1], *top = phi + count * (size_t)p;
  stf_pade_coefficients(c->m, p, N, D);
  part(c, D, 0, c->V);
  part(c, D, 1, c->W);
  stf_multiply(n, n, c->A, c->W, 1, c->V);
  part(c, N, 0, top);
  part(c, N, 1, c->W);
  stf_multiply(n, n, c->A, c->W, 1, top);
  STEIF_TRY(divide(c, top));
  for (int l = p; l > 0; l--) {
    double *below = phi + count * (size_t)(l - 1);
    stf_multiply(n, n, c->A, phi + count * (size_t)l, 0, below);
    add_diagonal(n, stf_inverse_factorial(l - 1).hi, below);
  }
  return STEIF_OK;
}
