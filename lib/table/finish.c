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

/* The fewest data that will do: X_{n+1}, with the slopes, with X_n too. Slopes of stages of an
 * order below p - 1 are of no use. */
int stf_glm_combination(steif_context *ctx, const steif_glm *g, const sunrealtype *target,
                        bool beyond, sunrealtype *d, bool *found)
{
  const int k = g->k, r = g->r, n = g->order + 2, count = beyond ? n : n - 1;
  const int data[] = {k, k + r, 2 * k + r}, levels = g->stage_order < g->order - 1 ? 1 : 3;
  sunrealtype M[STF_LEAST * (STEIF_PAST + 2)], Mt[(STEIF_PAST + 2) * STF_LEAST], off;
  if (g->order > STEIF_PAST) return *found = false, STEIF_OK;
  powers(g, M);
  *found = false;
  for (int level = 0; level < levels && !*found; level++) {
    const int rows = data[level];
    for (int i = 0; i < rows; i++)
      for (int j = 0; j < count; j++) Mt[j * rows + i] = M[i * n + j];
    memset(d, 0, (size_t)(2 * k + r) * sizeof *d);
    STEIF_TRY(stf_least_squares(ctx, count, rows, 1, Mt, target, d, &off));
    *found = off <= STF_GLM_TOLERANCE;
  }
  for (int i = 0; i < 2 * k + r; i++)
    if (fabs(d[i]) < 16 * STF_EPS) d[i] = 0;
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
