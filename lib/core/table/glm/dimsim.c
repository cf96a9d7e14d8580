/* dimsim.c: diagonally implicit multistage integration methods with U = 1, V = 1 v^T and as many
 * values as stages: the other coefficients from C, v and the order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"

enum { MOST = 8 };

/* x^j / j! */
static long double monomial(long double x, int j)
{
  long double value = 1;
  for (int i = 1; i <= j; i++) value *= x / i;
  return value;
}

/* X_i = Y_i - h sum_l C_il F_l in powers of h: p x (p + 1). */
static void values(int p, const long double *xi, const long double *C, long double *W)
{
  for (int i = 0; i < p; i++)
    for (int j = 0; j <= p; j++) {
      W[i * (p + 1) + j] = monomial(xi[i], j);
      for (int l = 0; l <= i && j > 0; l++)
        W[i * (p + 1) + j] -= C[i * p + l] * monomial(xi[l], j - 1);
    }
}

/* sum_l D_il xi_l^{j-1} / (j-1)! = sum_m W_im / (j - m)! - sum_l v_l W_lj, j = 1 .. p */
static void weights(int p, const long double *xi, const long double *v, const long double *W,
                    steif_glm *g)
{
  const int n = p + 1;
  stf_complex M[MOST * MOST], D[MOST * MOST];
  for (int j = 1; j <= p; j++)
    for (int i = 0; i < p; i++) {
      long double sum = 0;
      for (int m = 0; m <= j; m++) sum += W[i * n + m] * monomial(1, j - m);
      for (int l = 0; l < p; l++) sum -= v[l] * W[l * n + j];
      M[(j - 1) * p + i] = monomial(xi[i], j - 1), D[(j - 1) * p + i] = sum;
    }
  (void)stf_solve(p, p, M, D, 0); /* Vandermonde's */
  for (int i = 0; i < p; i++)
    for (int l = 0; l < p; l++) g->D[i * p + l] = (sunrealtype)creall(D[l * p + i]);
}

void stf_glm_dimsim(steif_glm *g, int p, long double lambda, const long double *x)
{
  const int n = p + 1;
  long double xi[MOST], v[MOST], C[MOST * MOST] = {0}, W[MOST * (MOST + 1)];
  g->k = g->r = g->order = p;
  for (int i = 0; i < p; i++) {
    xi[i] = (long double)i / (p - 1);
    for (int l = 0; l < i; l++) C[i * p + l] = *x++;
    C[i * p + i] = lambda, g->U[i * p + i] = 1;
  }
  v[p - 1] = 1;
  for (int i = 0; i < p - 1; i++) v[i] = *x++, v[p - 1] -= v[i];
  values(p, xi, C, W);
  weights(p, xi, v, W, g);
  for (int i = 0; i < p; i++) {
    g->xi[i] = (sunrealtype)xi[i];
    for (int l = 0; l < p; l++)
      g->C[i * p + l] = (sunrealtype)C[i * p + l], g->V[i * p + l] = (sunrealtype)v[l];
    for (int j = 0; j < n; j++) g->W[i * n + j] = (sunrealtype)W[i * n + j];
  }
}
