/* differences.c: Jacobians by differences, columns that share no row moved together (Curtis, Powell and
 * Reid 1974), and a probe that finds entries missing from a pattern.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

struct stf_groups {
  int count;
  sunindextype *column, *start; /* columns of group g: column[start[g]] .. */
  sunrealtype *step;            /* increment of each column */
  bool differences;             /* E or A is made by differences */
};

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
  g->differences = needs(s->problem, s->form);
  if (s->storage == STEIF_SPARSE && (g->differences || s->problem->pattern))
    STEIF_TRY(check_pattern(s));
  if (!g->differences) return STEIF_OK;
  sunindextype *group = stf_pool_array(pool, (size_t)n, sizeof *group);
  g->column = stf_pool_array(pool, (size_t)n, sizeof *g->column);
  g->start = stf_pool_array(pool, (size_t)n + 2, sizeof *g->start);
  g->step = stf_pool_array(pool, (size_t)n, sizeof *g->step);
  if (!group || !g->column || !g->start || !g->step) return STEIF_NO_MEMORY;
  const sunindextype width = s->problem->lower + s->problem->upper + 1;
  if (s->storage == STEIF_SPARSE)
    STEIF_TRY(colour_pattern(pool, s->problem->pattern, n, group));
  else
    for (sunindextype j = 0; j < n; j++) group[j] = s->storage == STEIF_BAND ? j % width : j;
  sort(g, n, group);
  return STEIF_OK;
}

/* -- evaluation ------------------------------------------------------------------------------ */

/* f for 'A' of the ode and mass forms, else F: into out. */
static int evaluate(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp, N_Vector out)
{
  return s->form == STEIF_IMPLICIT ? stf_system_residual(s, t, y, yp, out)
                                   : stf_system_rhs(s, t, y, out);
}

static void fill_pointers(stf_system *s, SUNMatrix M)
{
  const steif_pattern *p = s->problem->pattern;
  sunindextype *column = SUNSparseMatrix_IndexPointers(M),
               *row = SUNSparseMatrix_IndexValues(M);
  for (sunindextype j = 0; j <= s->space.n; j++) column[j] = p->column[j];
  for (sunindextype k = 0; k < p->column[s->space.n]; k++) row[k] = p->row[k];
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
    const steif_pattern *p = s->problem->pattern;
    sunrealtype *data = SUNSparseMatrix_Data(M);
    for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++) data[k] = d[p->row[k]] * by;
  }
}

/* An increment that a double represents exactly. Differences of linear systems are exact for any:
 * from 0 the increment 1 leaves them the rounding of their own column only. */
static sunrealtype increment(const stf_system *s, sunrealtype at)
{
  const sunrealtype scale = s->scale;
  if (s->linear) return 1;
  const sunrealtype wanted = sqrt(STF_EPS) * fmax(fabs(at), scale);
  const volatile sunrealtype moved = at + (at < 0 ? -wanted : wanted);
  return moved - at;
}

int stf_differ(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M)
{
  const stf_groups *g = s->groups;
  N_Vector base = s->work[3], moved = s->work[4], changed = s->work[5];
  const sunrealtype sign = which == 'A' && s->form == STEIF_IMPLICIT ? -1 : 1;
  if (s->storage == STEIF_SPARSE) fill_pointers(s, M);
  if (s->linear) stf_zero(&s->space, y = yp = s->work[2]);
  STEIF_TRY(evaluate(s, t, y, yp, base));
  stf_copy(&s->space, which == 'A' ? y : yp, moved);
  sunrealtype *m = N_VGetArrayPointer(moved), *d = N_VGetArrayPointer(changed);
  const sunrealtype *b = N_VGetArrayPointer(base),
                    *at = N_VGetArrayPointer(which == 'A' ? y : yp);
  for (int group = 0; group < g->count; group++) {
    const sunindextype from = g->start[group], to = g->start[group + 1];
    for (sunindextype k = from; k < to; k++) {
      const sunindextype j = g->column[k];
      g->step[j] = increment(s, m[j]);
      m[j] += g->step[j];
    }
    STEIF_TRY(which == 'A' ? evaluate(s, t, moved, yp, changed)
                           : evaluate(s, t, y, moved, changed));
    for (sunindextype i = 0; i < s->space.n; i++) d[i] -= b[i];
    for (sunindextype k = from; k < to; k++) {
      const sunindextype j = g->column[k];
      m[j] = at[j];
      put(s, M, j, d, sign / g->step[j]);
    }
  }
  return STEIF_OK;
}

/* -- probe ------------------------------------------------------------------------------------- */

static const sunrealtype move = 1e-6; /* relative size of the probing move */
enum { ASKED = 32 };                  /* rows looked at more closely */

static bool in_pattern(const stf_system *s, sunindextype i, sunindextype j)
{
  if (s->storage == STEIF_BAND) return i - j <= s->problem->lower && j - i <= s->problem->upper;
  const steif_pattern *p = s->problem->pattern;
  for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++)
    if (p->row[k] == i) return true;
  return false;
}

/* d = evaluate(moved in columns [from, to), for row >= 0 in those that its pattern leaves out) - base;
 * also leaves the direction in work[2]. */
static int shove(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp,
                 sunindextype from, sunindextype to, sunindextype row)
{
  N_Vector moved = s->work[4], d = s->work[5];
  const sunrealtype *at = N_VGetArrayPointer(which == 'A' ? y : yp);
  sunrealtype *m = N_VGetArrayPointer(moved), *v = N_VGetArrayPointer(s->work[2]);
  unsigned state = 12345;
  for (sunindextype j = 0; j < s->space.n; j++) {
    state = state * 1103515245u + 12345u;
    const sunrealtype factor = 0.5 + (sunrealtype)(state >> 16 & 1023) / 2048;
    const bool asked = j >= from && j < to && (row < 0 || !in_pattern(s, row, j));
    v[j] = asked ? move * factor * fmax(fabs(at[j]), s->scale) : 0;
    m[j] = at[j] + v[j];
  }
  STEIF_TRY(which == 'A' ? evaluate(s, t, moved, yp, d) : evaluate(s, t, y, moved, d));
  stf_axpy(&s->space, -1, s->work[3], d);
  return STEIF_OK;
}

/* Do the columns that the pattern of row i leaves out make the deviation `wrong` of that row? Then halve
 * them down to one of those that do. */
static int name(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp,
                sunindextype i, sunrealtype wrong)
{
  const sunrealtype *d = N_VGetArrayPointer(s->work[5]), *v = N_VGetArrayPointer(s->work[2]);
  char row[STEIF_SPEC_WORD], column[STEIF_SPEC_WORD];
  sunindextype from = 0, to = s->space.n;
  STEIF_TRY(shove(s, which, t, y, yp, from, to, i));
  if (!(fabs(d[i]) > wrong / 2)) return STEIF_OK;
  while (to - from > 1) {
    const sunindextype middle = from + (to - from) / 2;
    const sunrealtype whole = d[i];
    STEIF_TRY(shove(s, which, t, y, yp, from, middle, i));
    if (fabs(d[i]) >= fabs(whole - d[i]))
      to = middle;
    else
      from = middle;
    STEIF_TRY(shove(s, which, t, y, yp, from, to, i));
  }
  return STEIF_FAIL(
    s->ctx, STEIF_BAD_INPUT,
    "the %s of problem '%s' misses the derivative of %s with respect to %s, row %lld, column "
    "%lld: a probe at t = %g found about %.3g there; add it",
    s->storage == STEIF_BAND ? "band" : "pattern", s->problem->name,
    stf_equation(s->problem, i, row), stf_unknown(s->problem, from, column), (long long)i + 1,
    (long long)from + 1, t, d[i] / v[from]);
}

/* out = |M| |v|, what the terms of a row may come to. */
static void sizes(const stf_system *s, SUNMatrix M, const sunrealtype *v, sunrealtype *out)
{
  const sunindextype n = s->space.n;
  for (sunindextype i = 0; i < n; i++) out[i] = 0;
  for (sunindextype j = 0; j < n && s->storage == STEIF_SPARSE; j++) {
    const sunindextype *column = SUNSparseMatrix_IndexPointers(M);
    for (sunindextype k = column[j]; k < column[j + 1]; k++)
      out[SUNSparseMatrix_IndexValues(M)[k]] += fabs(SUNSparseMatrix_Data(M)[k] * v[j]);
  }
  for (sunindextype j = 0; j < n && s->storage == STEIF_BAND; j++) {
    const sunindextype first = j - s->problem->upper, last = j + s->problem->lower;
    for (sunindextype i = first < 0 ? 0 : first; i <= (last < n ? last : n - 1); i++)
      out[i] += fabs(SUNBandMatrix_Column(M, j)[i - j] * v[j]);
  }
}

static int probe(stf_system *s, char which, sunrealtype t, N_Vector y, N_Vector yp)
{
  STEIF_TRY(evaluate(s, t, y, yp, s->work[3]));
  STEIF_TRY(shove(s, which, t, y, yp, 0, s->space.n, -1));
  STEIF_TRY(steif_pencil_product(s->pencil, which, s->work[2], s->work[1]));
  const sunrealtype *d = N_VGetArrayPointer(s->work[5]), *base = N_VGetArrayPointer(s->work[3]);
  sunrealtype *wrong = N_VGetArrayPointer(s->work[1]), *size = N_VGetArrayPointer(s->work[0]);
  const sunrealtype sign = which == 'A' && s->form == STEIF_IMPLICIT ? -1 : 1;
  sizes(s, which == 'A' ? s->A : s->E, N_VGetArrayPointer(s->work[2]), size);
  for (sunindextype i = 0; i < s->space.n; i++) {
    wrong[i] = fabs(d[i] - sign * wrong[i]);
    if (!(wrong[i] > 1e-3 * fmax(size[i], fabs(d[i])) + 1e3 * STF_EPS * fabs(base[i])))
      wrong[i] = 0;
  }
  int code = STEIF_OK, asked = 0;
  for (sunindextype i = 0; i < s->space.n && asked < ASKED && !code; i++)
    if (wrong[i] > 0) asked++, code = name(s, which, t, y, yp, i, wrong[i]);
  return code;
}

int stf_probe(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  if (!s->groups || !s->groups->differences || s->storage == STEIF_DENSE) return STEIF_OK;
  int code = probe(s, 'A', t, y, yp);
  if (!code && s->form == STEIF_IMPLICIT) code = probe(s, 'E', t, y, yp);
  return code > 0 ? STEIF_OK : code;
}
