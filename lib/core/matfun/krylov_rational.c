/* krylov_rational.c: phi_k(tA) b by the Krylov space of (I - gamma A)^{-1} (J. van den Eshof and M.
 * Hochbruck, SIAM J. Sci. Comput. 27, 2006; I. Moret and P. Novati, BIT 44, 2004).
 *
 * Z V_m = V_m H + h v_{m+1} e_m^T with Z = (I - gamma A)^{-1} gives A V_m = V_m A_m + (h/gamma)
 * (I - gamma A) v_{m+1} e_m^T H^{-1}, A_m = (I - H^{-1})/gamma, and phi_k(tA) b is near ||b||
 * V_m phi_k(t A_m) e_1. The residual suggests the error (h t/gamma) |e_m^T H^{-1} phi_{k+1}(t
 * A_m) e_1| ||b||; the change since the last dimension tried guards it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"
#include "lapack.h"
#include "lu.h"
#include <string.h>

/* gamma = t/10 (or what is left from a near t); a dense exponential after every third solve. */
static const double poles = 10;
enum { EVERY = 3 };

static int factor(steif_action *a)
{
  const double ratio = a->gamma == 0 ? 0 : a->t / a->gamma;
  if (ratio >= 0.499 * poles && ratio <= 2.001 * poles) return STEIF_OK;
  a->gamma = 0;
  const long before = steif_pencil_statistics(a->pencil)->factors;
  STEIF_TRY(steif_pencil_factor(a->pencil, 1, &(steif_shift){poles / a->t, 0}));
  a->gamma = a->t / poles;
  a->report.factors += steif_pencil_statistics(a->pencil)->factors - before;
  return STEIF_OK;
}

/* basis[m] and column m - 1 of H, which another method may have used. */
static int extend(steif_action *a, int m)
{
  const size_t ld = (size_t)stf_order(a->dimension);
  double *h = a->H + (size_t)(m - 1) * ld;
  STEIF_TRY(stf_state_grow(a, m + 1));
  stf_state *next = a->basis + m;
  memset(h, 0, ld * sizeof *h);
  stf_copy(&a->space, a->basis[m - 1].v, next->v);
  STEIF_TRY(steif_pencil_solve(a->pencil, 0, 1, &next->v, NULL));
  a->report.solves++;
  stf_state_scale(a, 1 / a->gamma, next);
  stf_state_orthogonalise(a, m, h);
  return STEIF_OK;
}

/* a->R = H^{-1}, a->M = [tA_m e_1 0 ..; 0 J], of order m + k + 1; false if H has no inverse. */
static bool project(steif_action *a, int m, int k)
{
  const size_t ld = (size_t)stf_order(a->dimension), rows = (size_t)m, n = (size_t)(m + k + 1);
  const double ratio = a->t / a->gamma;
  int pivot[STF_DIMENSION];
  for (size_t j = 0; j < rows; j++) memcpy(a->M + rows * j, a->H + ld * j, rows * sizeof *a->M);
  memset(a->R, 0, rows * rows * sizeof *a->R);
  for (size_t j = 0; j < rows; j++) a->R[j * (rows + 1)] = 1;
  if (stf_dense_factor(m, a->M, pivot) != 0) return false;
  stf_dense_solve('N', m, m, a->M, pivot, a->R);
  memset(a->M, 0, n * n * sizeof *a->M);
  for (size_t j = 0; j < rows; j++)
    for (size_t i = 0; i < rows; i++) a->M[i + n * j] = ratio * ((i == j) - a->R[i + rows * j]);
  a->M[n * rows] = 1;
  for (size_t j = rows + 1; j < n; j++) a->M[j - 1 + n * j] = 1;
  return true;
}

/* a->column = coefficients of phi_k(tA) b in the basis, their norm and the estimated error. */
static double evaluate(steif_action *a, int m, int k, double beta, double *norm)
{
  const size_t ld = (size_t)stf_order(a->dimension), n = (size_t)(m + k + 1);
  *norm = 0;
  if (!project(a, m, k) || !stf_action_expm(a, m + k + 1)) return INFINITY;
  const double *c = k == 0 ? a->X : a->X + n * (size_t)(m + k - 1),
               *next = a->X + n * (size_t)(m + k);
  double change = 0, end = 0, size = 0;
  for (int i = 0; i < m; i++) {
    a->column[i] = beta * c[i];
    const double d = a->column[i] - a->last[i];
    change += d * d, size += a->column[i] * a->column[i];
    a->last[i] = a->column[i];
    end += a->R[m - 1 + m * i] * next[i];
  }
  *norm = sqrt(size);
  const double h = a->H[(size_t)m + ld * (size_t)(m - 1)];
  return fmax(beta * h * (a->t / a->gamma) * fabs(end), sqrt(change));
}

/* w += phi_k(tA) b_k, with its share of the error that is allowed for a result of norm `least`;
 * 0: of the norm of this term. */
static int term(steif_action *a, int k, double least, N_Vector w)
{
  const double beta = stf_vector_norm(&a->space, a->b[k]);
  double estimate = INFINITY, norm = 0;
  int m = 0;
  bool exact = false;
  if (beta == 0) return STEIF_OK;
  stf_scale(&a->space, 1 / beta, a->b[k], a->basis->v);
  for (int i = 0; i < a->dimension; i++) a->last[i] = 0;
  while (m < a->dimension && !exact &&
         !(estimate <= 0.5 * stf_action_allowed(a, least > 0 ? least : norm) / (a->p + 1))) {
    STEIF_TRY(extend(a, ++m));
    exact = a->H[(size_t)m + (size_t)stf_order(a->dimension) * (size_t)(m - 1)] == 0;
    if (m % EVERY == 0 || m == a->dimension || exact) estimate = evaluate(a, m, k, beta, &norm);
    if (exact && isfinite(estimate)) estimate = 0;
  }
  if (m > a->report.dimension) a->report.dimension = m;
  a->report.error += estimate + 8 * STF_EPS * beta * stf_inverse_factorial(k).hi;
  for (int j = 0; j < m && isfinite(estimate); j++)
    stf_axpy(&a->space, a->column[j], a->basis[j].v, w);
  return STEIF_OK;
}

static int terms(steif_action *a, double least, N_Vector w)
{
  a->report.error = 0;
  stf_zero(&a->space, w);
  for (int k = 0; k <= a->p; k++)
    if (a->b[k]) STEIF_TRY(term(a, k, least, w));
  a->report.norm = stf_vector_norm(&a->space, w);
  return STEIF_OK;
}

/* Every term to the tolerance of its own norm; again where the sum is much smaller. */
int stf_action_rational(steif_action *a, N_Vector w)
{
  a->dimension = a->o.dimension ? a->o.dimension : STF_RATIONAL;
  a->aux = 0;
  STEIF_TRY(stf_state_grow(a, 2));
  STEIF_TRY(factor(a));
  STEIF_TRY(terms(a, 0, w));
  int present = 0;
  for (int k = 0; k <= a->p; k++) present += a->b[k] != NULL;
  if (present < 2 || !isfinite(a->report.error) || a->report.norm == 0) return STEIF_OK;
  if (a->report.error <= stf_action_allowed(a, a->report.norm)) return STEIF_OK;
  return terms(a, a->report.norm, w);
}
