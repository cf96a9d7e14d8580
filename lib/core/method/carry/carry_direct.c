/* carry_direct.c: the equations of few stages of few unknowns, all in one matrix K that is factored: no sweeps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "lu.h"

/* Unknowns of K that are worth it: n^3/3 against sweeps of n^2 for each column. */
enum { DIRECT_LARGEST = 60, DIRECT_ALONE = 12, DIRECT_BY_COLUMN = 12 };

int stf_carry_direct_open(stf_carry *T)
{
  stf_step *s = T->step;
  const size_t n = (size_t)s->problem->n, N = n * (size_t)T->size.stages;
  const size_t most = DIRECT_ALONE + DIRECT_BY_COLUMN * (size_t)T->count;
  T->K = NULL;
  if (N == 0 || s->system.linear || !stf_matrices_at_adds(&T->at)) return STEIF_OK;
  if (N > (most < DIRECT_LARGEST ? most : DIRECT_LARGEST)) return STEIF_OK;
  T->rhs = stf_pool_array(s->pool, N * (size_t)T->count, sizeof *T->rhs);
  T->pivot = stf_pool_array(s->pool, N, sizeof *T->pivot);
  T->K = stf_pool_array(s->pool, N * N, sizeof *T->K);
  return T->rhs && T->pivot && T->K ? STEIF_OK : STEIF_NO_MEMORY;
}

/* K_jm = B_jm/h E_j - delta_jm A_j. */
static void assemble(stf_carry *T, const stf_carry_stages *g)
{
  const size_t n = (size_t)T->step->problem->n, m = (size_t)g->m, N = n * m;
  for (size_t i = 0; i < N * N; i++) T->K[i] = 0;
  for (size_t j = 0; j < m; j++)
    for (size_t k = 0; k < m; k++) {
      sunrealtype *block = T->K + j * n * N + k * n;
      stf_matrices_at_add(&T->at, g->first + (int)j, 'E', g->B_over_h[j * m + k], block, N);
      if (j == k) stf_matrices_at_add(&T->at, g->first + (int)j, 'A', -1, block, N);
    }
}

/* dZ += K^{-1} r of all columns. */
static void correct(stf_carry *T, const stf_carry_stages *g)
{
  const int n = (int)T->step->problem->n, P = T->count;
  for (int k = 0; k < P; k++)
    for (int j = 0; j < g->m; j++)
      for (int i = 0; i < n; i++) T->rhs[(j * n + i) * P + k] = STF_ARRAY(T->r[k][j])[i];
  stf_rows_best()->substitute(n * g->m, P, T->K, T->pivot, T->rhs);
  T->step->solves += P;
  for (int k = 0; k < P; k++)
    for (int j = 0; j < g->m; j++)
      for (int i = 0; i < n; i++)
        STF_ARRAY(T->trial[k][g->to + j])[i] += T->rhs[(j * n + i) * P + k];
}

/* T->r of dZ = 0: A base - E offset - F_p. */
static int right_sides(stf_carry *T, const stf_carry_stages *g, int k)
{
  const stf_space *space = &T->step->system.space;
  for (int j = 0; j < g->m; j++) {
    N_Vector r = T->r[k][j], offset = g->offset ? g->offset[k] : NULL;
    if (!g->base) stf_zero(space, T->Y);
    STEIF_TRY(stf_carry_residual(T, g->first + j, k, g->base ? g->base[k] : T->Y, offset, r));
  }
  return STEIF_OK;
}

/* Blocks of E/h and A differ in size by h, and with indices above 1 that costs digits: refined there. */
int stf_carry_direct(stf_carry *T, const stf_carry_stages *g)
{
  const stf_space *space = &T->step->system.space;
  const int rounds = T->step->problem->dae_index > 1 ? 2 : 1;
  assemble(T, g);
  T->step->factors++;
  if (!stf_rows_best()->factor((int)space->n * g->m, T->K, T->pivot)) return STEIF_RETRY;
  for (int k = 0; k < T->count; k++)
    for (int j = 0; j < g->m; j++) stf_zero(space, T->trial[k][g->to + j]);
  for (int round = 0; round < rounds; round++) {
    for (int k = 0; k < T->count; k++)
      STEIF_TRY(round ? stf_carry_stage_residuals(T, g, k, T->r[k]) : right_sides(T, g, k));
    correct(T, g);
  }
  return STEIF_OK;
}
