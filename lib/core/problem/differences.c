/* differences.c: Jacobians by differences, columns that share no row moved together (Curtis, Powell and
 * Reid 1974).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "groups.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static bool needs(const steif_problem *p, int form)
{
  if (form == STEIF_IMPLICIT) return !p->idajac && (!p->A || !p->E);
  return form != STEIF_DESCRIPTOR && !p->A && !p->jac;
}

/* Smallest group not used by a column that shares a row with column j. */
static void colour(const steif_pattern *p, sunindextype n, const sunindextype *by_row,
                   const sunindextype *row_start, sunindextype *group, sunindextype *mark)
{
  for (sunindextype j = 0; j < n; j++) {
    for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++) {
      const sunindextype i = p->row[k];
      for (sunindextype l = row_start[i]; l < row_start[i + 1] && by_row[l] < j; l++)
        mark[group[by_row[l]]] = j + 1;
    }
    sunindextype g = 0;
    while (mark[g] == j + 1) g++;
    group[j] = g;
  }
}

static int colour_pattern(stf_pool *pool, const steif_pattern *p, sunindextype n,
                          sunindextype *group)
{
  const size_t count = (size_t)n, nnz = (size_t)p->column[n];
  sunindextype *row_start = stf_pool_array(pool, count + 2, sizeof *row_start);
  sunindextype *by_row = stf_pool_array(pool, nnz, sizeof *by_row);
  sunindextype *mark = stf_pool_array(pool, count + 1, sizeof *mark);
  if (!row_start || !by_row || !mark) return STEIF_NO_MEMORY;
  for (size_t k = 0; k < nnz; k++) row_start[p->row[k] + 2]++;
  for (size_t i = 2; i < count + 2; i++) row_start[i] += row_start[i - 1];
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++)
      by_row[row_start[p->row[k] + 1]++] = j;
  colour(p, n, by_row, row_start, group, mark);
  return STEIF_OK;
}

static int check_pattern(const stf_system *s)
{
  const steif_pattern *p = s->problem->pattern;
  const sunindextype n = s->space.n;
  STEIF_CHECK(p && p->column && p->row, s->ctx, STEIF_BAD_INPUT,
              "problem '%s' is sparse and has no Jacobian callback: give its .pattern for "
              "differences",
              s->problem->name);
  for (sunindextype j = 0; j < n; j++) {
    STEIF_CHECK(
      p->column[0] == 0 && p->column[j] <= p->column[j + 1], s->ctx, STEIF_BAD_INPUT,
      "pattern of problem '%s': column pointers must rise from 0, they fall at column %lld",
      s->problem->name, (long long)j + 1);
    for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++)
      STEIF_CHECK(p->row[k] >= 0 && p->row[k] < n &&
                    (k == p->column[j] || p->row[k] > p->row[k - 1]),
                  s->ctx, STEIF_BAD_INPUT,
                  "pattern of problem '%s': row indices of column %lld must "
                  "ascend within 0 .. %lld",
                  s->problem->name, (long long)j + 1, (long long)n - 1);
  }
  return STEIF_OK;
}

/* Columns sorted by group. */
static void sort(stf_groups *g, sunindextype n, const sunindextype *group)
{
  memset(g->start, 0, ((size_t)n + 2) * sizeof *g->start);
  g->count = 0;
  for (sunindextype j = 0; j < n; j++) g->start[group[j] + 1]++;
  for (sunindextype k = 0; k < n; k++) g->start[k + 1] += g->start[k];
  for (sunindextype j = n; j-- > 0;) g->column[--g->start[group[j] + 1]] = j;
  for (sunindextype k = 0; k < n; k++) g->start[k] = g->start[k + 1];
  g->start[n] = n;
  while (g->count < n && g->start[g->count] < n) g->count++;
}

int stf_groups_open(stf_pool *pool, stf_system *s)
{
  const sunindextype n = s->space.n;
  stf_groups *g = stf_pool_array(pool, 1, sizeof *g);
  if (!g) return STEIF_NO_MEMORY;
  s->groups = g;
  g->ctx = s->ctx;
  g->pattern = s->problem->pattern;
  g->differences = needs(s->problem, s->form);
  if (s->storage == STEIF_SPARSE && (g->differences || s->problem->pattern))
    STEIF_TRY(check_pattern(s));
  if (!g->differences) return STEIF_OK;
  g->of = stf_pool_array(pool, (size_t)n, sizeof *g->of);
  g->column = stf_pool_array(pool, (size_t)n, sizeof *g->column);
  g->start = stf_pool_array(pool, (size_t)n + 2, sizeof *g->start);
  g->step = stf_pool_array(pool, (size_t)n, sizeof *g->step);
  if (!g->of || !g->column || !g->start || !g->step) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_pool_adopt(pool, g, stf_groups_forget));
  return stf_groups_colour(s);
}

bool stf_groups_differ(const stf_system *s) { return s->groups && s->groups->differences; }

int stf_groups_colour(stf_system *s)
{
  const sunindextype n = s->space.n;
  stf_groups *g = s->groups;
  const sunindextype width = s->problem->lower + s->problem->upper + 1;
  int code = STEIF_OK;
  if (s->storage == STEIF_SPARSE) {
    stf_pool *work = stf_pool_new(s->ctx);
    code = work ? colour_pattern(work, s->groups->pattern, n, g->of) : STEIF_NO_MEMORY;
    stf_pool_free(&work);
  } else
    for (sunindextype j = 0; j < n; j++) g->of[j] = s->storage == STEIF_BAND ? j % width : j;
  if (!code) sort(g, n, g->of);
  return code;
}

/* -- evaluation ------------------------------------------------------------------------------ */

int stf_groups_evaluate(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp, N_Vector out)
{
  return s->form == STEIF_IMPLICIT ? stf_system_residual(s, t, y, yp, out)
                                   : stf_system_rhs(s, t, y, out);
}

static int fill_pointers(stf_system *s, SUNMatrix M)
{
  const steif_pattern *p = s->groups->pattern;
  const sunindextype entries = p->column[s->space.n];
  if (SM_NNZ_S(M) < entries)
    STEIF_CHECK(!SUNSparseMatrix_Reallocate(M, entries), s->ctx, STEIF_NO_MEMORY,
                "no memory for a sparse matrix of %lld entries", (long long)entries);
  sunindextype *column = SUNSparseMatrix_IndexPointers(M),
               *row = SUNSparseMatrix_IndexValues(M);
  for (sunindextype j = 0; j <= s->space.n; j++) column[j] = p->column[j];
  for (sunindextype k = 0; k < entries; k++) row[k] = p->row[k];
  return STEIF_OK;
}

/* Column j of M from the difference d of a move that touched no other column of its rows. */
static void put(stf_system *s, SUNMatrix M, sunindextype j, const sunrealtype *d,
                sunrealtype by)
{
  const sunindextype n = s->space.n;
  if (s->storage == STEIF_DENSE) {
    sunrealtype *column = SUNDenseMatrix_Column(M, j);
    for (sunindextype i = 0; i < n; i++) column[i] = d[i] * by;
  } else if (s->storage == STEIF_BAND) {
    sunrealtype *column = SUNBandMatrix_Column(M, j);
    const sunindextype first = j - s->problem->upper, last = j + s->problem->lower;
    for (sunindextype i = first < 0 ? 0 : first; i <= (last < n ? last : n - 1); i++)
      column[i - j] = d[i] * by;
  } else {
    const steif_pattern *p = s->groups->pattern;
    sunrealtype *data = SUNSparseMatrix_Data(M);
    for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++) data[k] = d[p->row[k]] * by;
  }
}

/* An increment that a double represents exactly. Differences of linear systems are exact for any:
 * from 0 the increment 1 leaves them the rounding of their own column only. */
static sunrealtype increment(const stf_system *s, sunindextype j, sunrealtype at)
{
  if (s->linear) return 1;
  const sunrealtype part = s->central ? cbrt(STF_EPS) : sqrt(STF_EPS);
  const sunrealtype wanted = part * fmax(fabs(at), stf_floor(s, j));
  const volatile sunrealtype moved = at + (at < 0 ? -wanted : wanted);
  return moved - at;
}

int stf_differ(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M)
{
  const stf_groups *g = s->groups;
  N_Vector base = s->work[3], moved = s->work[4], changed = s->work[5];
  const sunrealtype sign = which == 'A' && s->form == STEIF_IMPLICIT ? -1 : 1;
  if (s->storage == STEIF_SPARSE) STEIF_TRY(fill_pointers(s, M));
  if (s->linear) stf_zero(&s->space, y = yp = s->work[2]);
  STEIF_TRY(stf_groups_evaluate(s, t, y, yp, base));
  stf_copy(&s->space, which == 'A' ? y : yp, moved);
  sunrealtype *m = stf_array(moved), *d = stf_array(changed);
  const sunrealtype *b = stf_array(base), *at = stf_array(which == 'A' ? y : yp);
  for (int group = 0; group < g->count; group++) {
    const sunindextype from = g->start[group], to = g->start[group + 1];
    for (sunindextype k = from; k < to; k++) {
      const sunindextype j = g->column[k];
      g->step[j] = increment(s, j, m[j]);
      m[j] += g->step[j];
    }
    STEIF_TRY(which == 'A' ? stf_groups_evaluate(s, t, moved, yp, changed)
                           : stf_groups_evaluate(s, t, y, moved, changed));
    if (s->central) {
      for (sunindextype k = from; k < to; k++)
        m[g->column[k]] = at[g->column[k]] - g->step[g->column[k]];
      STEIF_TRY(which == 'A' ? stf_groups_evaluate(s, t, moved, yp, base)
                             : stf_groups_evaluate(s, t, y, moved, base));
    }
    for (sunindextype i = 0; i < s->space.n; i++) d[i] -= b[i];
    for (sunindextype k = from; k < to; k++) {
      const sunindextype j = g->column[k];
      m[j] = at[j];
      put(s, M, j, d, sign / (s->central ? 2 * g->step[j] : g->step[j]));
    }
  }
  return STEIF_OK;
}
