/* finish.c: solution, derivatives and error of a general linear method from what a step leaves
 * behind.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <math.h>
#include <string.h>

/* Rows (X_{n+1}; h F; X_n) in powers h^j y^(j)(t_{n+1}), j = 0 .. p + 1, as many equal steps
 * leave them. */
static void powers(const steif_glm *g, sunrealtype *M)
{
  const int k = g->k, p = g->order, n = p + 2;
  memset(M, 0, (size_t)((2 * k + g->r) * n) * sizeof *M);
  for (int i = 0; i < k; i++) {
    memcpy(M + i * n, g->W + i * (p + 1), (size_t)(p + 1) * sizeof *M);
    M[i * n + p + 1] = g->shift[i] + g->error * g->W[i * (p + 1)];
  }
  for (int l = 0; l < g->r; l++) {
    sunrealtype term = 1;
    for (int j = 1; j < n; j++, term *= (g->xi[l] - 1) / (j - 1)) M[(k + l) * n + j] = term;
  }
  for (int i = 0; i < k; i++) {
    sunrealtype *row = M + (k + g->r + i) * n;
    for (int j = 0; j <= p; j++) {
      sunrealtype term = g->W[i * (p + 1) + j];
      for (int m = j; m < n; m++, term *= -1.0 / (m - j)) row[m] += term;
    }
    row[p + 1] += g->shift[i];
  }
}

/* The data where y' = lambda y, lambda = infinity, as functions of X_n: X_{n+1} = M(inf) X_n,
 * h F = -C^{-1} U X_n. Q: (2 k + r) x k, 0 and false where C is singular. */
static bool stiff_data(const steif_glm *g, sunrealtype *Q)
{
  const int k = g->k, r = g->r;
  stf_complex C[STEIF_STAGES * STEIF_STAGES], F[STEIF_STAGES * STEIF_PAST];
  memset(Q, 0, (size_t)((2 * k + r) * k) * sizeof *Q);
  for (int i = 0; i < r * r; i++) C[i] = -g->C[i];
  for (int i = 0; i < r * k; i++) F[i] = g->U[i];
  if (!stf_solve(r, k, C, F, 0)) return false;
  for (int j = 0; j < k; j++) {
    for (int i = 0; i < k; i++) {
      Q[i * k + j] = g->V[i * k + j];
      for (int l = 0; l < r; l++)
        Q[i * k + j] += g->D[i * r + l] * (sunrealtype)creall(F[l * k + j]);
      Q[(k + r + i) * k + j] = i == j;
    }
    for (int l = 0; l < r; l++) Q[(k + l) * k + j] = (sunrealtype)creall(F[l * k + j]);
  }
  return true;
}

/* L (rows x rows) with L L^T = Q Q^T + small, Q the stiff data; 1 where C is singular. */
static void weighting(const steif_glm *g, int rows, sunrealtype *L)
{
  const int k = g->k;
  const sunrealtype small = 1e-4;
  sunrealtype Q[STF_LEAST * STEIF_PAST];
  const bool regular = stiff_data(g, Q);
  for (int i = 0; i < rows; i++) /* Cholesky */
    for (int j = 0; j <= i; j++) {
      sunrealtype sum = i != j ? 0 : regular ? small : 1;
      for (int m = 0; m < k; m++) sum += Q[i * k + m] * Q[j * k + m];
      for (int m = 0; m < j; m++) sum -= L[i * rows + m] * L[j * rows + m];
      L[i * rows + j] = i == j ? sqrt(fmax(sum, small / 2)) : sum / L[j * rows + j];
    }
}

/* M^T L^{-T}, count x rows. */
static void scaled(int rows, int n, int count, const sunrealtype *M, const sunrealtype *L,
                   sunrealtype *Mt)
{
  for (int j = 0; j < count; j++)
    for (int i = 0; i < rows; i++) {
      sunrealtype sum = M[i * n + j];
      for (int m = 0; m < i; m++) sum -= L[i * rows + m] * Mt[j * rows + m];
      Mt[j * rows + i] = sum / L[i * rows + i];
    }
}

/* target - d M */
static void missing(int rows, int n, int count, const sunrealtype *M, const sunrealtype *target,
                    const sunrealtype *d, sunrealtype *out)
{
  for (int j = 0; j < count; j++) {
    long double sum = target[j];
    for (int i = 0; i < rows; i++) sum -= (long double)d[i] * M[i * n + j];
    out[j] = (sunrealtype)sum;
  }
}

/* The smallest |L^T d| with d M = target: what is damped most where the problem is stiff, then
 * what is smallest. Solved again for what is missing: an estimate by weights whose sum is not 0 to
 * rounding has a part of y itself, which no step is short enough for. */
static int least_weights(steif_context *ctx, const steif_glm *g, int rows, int n, int count,
                         const sunrealtype *M, const sunrealtype *target, sunrealtype *d,
                         sunrealtype *off)
{
  enum { TIMES = 3 };
  sunrealtype L[STF_LEAST * STF_LEAST], Mt[(STEIF_PAST + 2) * STF_LEAST], x[STF_LEAST],
    rest[STEIF_PAST + 2], left;
  weighting(g, rows, L);
  scaled(rows, n, count, M, L, Mt);
  for (int time = 0; time < TIMES; time++) {
    missing(rows, n, count, M, target, d, rest);
    STEIF_TRY(stf_least_squares(ctx, count, rows, 1, Mt, rest, x, time ? &left : off));
    for (int i = rows - 1; i >= 0; i--) {
      for (int m = i + 1; m < rows; m++) x[i] -= L[m * rows + i] * x[m];
      x[i] /= L[i * rows + i];
    }
    for (int i = 0; i < rows; i++) d[i] += x[i];
  }
  return STEIF_OK;
}

/* X_{n+1} alone where that will do, else with h F and X_n, whose combinations are the stage
 * values too. Slopes of stages of an order below p - 1 are of no use. */
int stf_glm_combination(steif_context *ctx, const steif_glm *g, const sunrealtype *target,
                        bool beyond, sunrealtype *d, bool *found)
{
  const int k = g->k, r = g->r, n = g->order + 2, count = beyond ? n : n - 1;
  const int data[] = {k, 2 * k + r}, levels = g->stage_order < g->order - 1 ? 1 : 2;
  sunrealtype M[STF_LEAST * (STEIF_PAST + 2)], off;
  if (g->order > STEIF_PAST) return *found = false, STEIF_OK;
  powers(g, M);
  *found = false;
  for (int level = 0; level < levels && !*found; level++) {
    memset(d, 0, (size_t)(2 * k + r) * sizeof *d);
    STEIF_TRY(least_weights(ctx, g, data[level], n, count, M, target, d, &off));
    *found = off <= STF_GLM_TOLERANCE;
  }
  for (int i = 0; i < 2 * k + r; i++)
    if (fabs(d[i]) < 1e-15) d[i] = 0;
  return STEIF_OK;
}

int stf_glm_solution(steif_context *ctx, const steif_glm *g, sunrealtype *d)
{
  sunrealtype target[STEIF_PAST + 2] = {1};
  bool found;
  if (g->k == 1) return *d = 1 / g->W[0], STEIF_OK; /* Runge-Kutta of any order */
  STEIF_TRY(stf_glm_combination(ctx, g, target, false, d, &found));
  STEIF_CHECK(found, ctx, STEIF_UNSUPPORTED,
              "'%s' does not hold the solution to order %d in what its steps leave", g->name,
              g->order);
  return STEIF_OK;
}

/* c = Vandermonde^{-1} y for the nodes i / count, X_i = sum_j W_ij j! c_j. */
void stf_glm_first(const steif_glm *g, int count, sunrealtype *weights)
{
  const int n = count + 1;
  stf_complex M[STEIF_PAST * STEIF_PAST + STF_LEAST],
    inverse[STEIF_PAST * STEIF_PAST + STF_LEAST];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      M[i * n + j] = j ? M[i * n + j - 1] * ((long double)i / count) : 1;
      inverse[i * n + j] = i == j;
    }
  (void)stf_solve(n, n, M, inverse, 0);
  for (int i = 0; i < g->k; i++)
    for (int j = 0; j < n; j++) {
      long double sum = 0, factorial = 1;
      for (int m = 0; m < n; m++, factorial *= m)
        sum += g->W[i * (g->order + 1) + m] * factorial * creall(inverse[m * n + j]);
      weights[i * n + j] = (sunrealtype)sum;
    }
}

int stf_glm_powers(const steif_glm *g)
{
  int highest = g->order;
  for (; highest > 0; highest--)
    for (int i = 0; i < g->k; i++)
      if (g->W[i * (g->order + 1) + highest] != 0) return highest;
  return 0;
}

static int radius(steif_context *ctx, int n, const sunrealtype *M, sunrealtype *most)
{
  long double copy[STEIF_PAST * STEIF_PAST];
  stf_complex lambda[STEIF_STAGES];
  int count;
  for (int i = 0; i < n * n; i++) copy[i] = (long double)M[i];
  STEIF_TRY(stf_eigen_values(ctx, n, copy, lambda, &count));
  *most = 0;
  for (int i = 0; i < count; i++) *most = fmax(*most, (sunrealtype)cabsl(lambda[i]));
  return STEIF_OK;
}

/* X' = W z, z_j = d_j (X_{n+1}; h F; X_n), and the data are Q X_n. */
int stf_glm_rescales(steif_context *ctx, const steif_glm *g, bool *damps)
{
  const int k = g->k, n = g->order + 1, data = 2 * k + g->r;
  sunrealtype Q[STF_LEAST * STEIF_PAST],
    S[STEIF_PAST * STEIF_PAST] = {0}, d[STF_LEAST], target[STEIF_PAST + 2] = {0}, step, change;
  *damps = true;
  if (!stiff_data(g, Q)) return STEIF_OK;
  STEIF_TRY(radius(ctx, k, Q, &step));
  for (int j = 0; j < n && step < 1; j++) {
    bool found;
    target[j] = 1;
    STEIF_TRY(stf_glm_combination(ctx, g, target, false, d, &found));
    target[j] = 0;
    for (int m = 0; m < k && found; m++) {
      sunrealtype sum = 0;
      for (int i = 0; i < data; i++) sum += d[i] * Q[i * k + m];
      for (int i = 0; i < k; i++) S[i * k + m] += g->W[i * n + j] * sum;
    }
  }
  STEIF_TRY(radius(ctx, k, S, &change));
  *damps = change < 1;
  return STEIF_OK;
}
