/* ida_start.c: slopes at the start and which components are algebraic, for IDA.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include <math.h>
#include <steif/index.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* --- E of an implicit problem --- */

/* dF/dy' = J(c = 1) - J(c = 0) of an IDA Jacobian. */
static int difference(stf_baseline *base)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  SUNMatrix kept = base->A, J[2] = {NULL, NULL};
  for (int c = 0; c < 2; c++) {
    STEIF_TRY(stf_baseline_native(base));
    J[c] = base->A;
  }
  base->A = kept;
  N_Vector *v = stf_pool_vectors(run->pool, 4, run->like);
  if (!v) return STEIF_NO_MEMORY;
  int seen = stf_lower_residual(run->t, run->y, run->yp, v[0], base);
  for (int c = 0; !seen && c < 2; c++)
    seen = p->idajac(run->t, c, run->y, run->yp, v[0], J[c], p->user, v[1], v[2], v[3]);
  STEIF_CHECK(!seen, run->ctx, STEIF_CALLBACK,
              "F or its Jacobian returned %d, or values that are not finite, at the start, "
              "t = %.12g",
              seen, run->t);
  stf_matrix_difference(J[1], J[0]);
  base->E = J[1];
  return STEIF_OK;
}

int stf_start_mass(stf_baseline *base)
{
  const steif_problem *p = base->run->problem;
  const bool open = !base->E && base->run->form == STEIF_IMPLICIT;
  return open && p->idajac && p->storage != STEIF_KRYLOV ? difference(base) : STEIF_OK;
}

/* --- slopes --- */

/* E y' = b row by row where a row of E has one entry; true if that settles every row. `count`
 * and `at` are the number of entries in a row and the column of one of them. */
static bool single_rows(SUNMatrix E, sunindextype n, const sunrealtype *b, sunrealtype *yp,
                        sunindextype *count, sunindextype *at, sunrealtype *value)
{
  for (sunindextype j = 0; j < n; j++) {
    stf_column c = stf_matrix_column(E, j);
    for (sunindextype k = 0; k < c.count; k++) {
      const sunindextype i = c.row ? c.row[k] : c.first + k;
      if (c.entry[k] == 0) continue;
      count[i]++, at[i] = j, value[i] = c.entry[k];
    }
  }
  bool all = true;
  for (sunindextype i = 0; i < n; i++) {
    if (count[i] == 1) yp[at[i]] = b[i] / value[i];
    all = all && count[i] <= 1;
  }
  return all;
}

static bool zero(N_Vector v) { return N_VMaxNorm(v) == 0; }

/* Solve E yp = b with the solver that IDA gets later; false if E is singular to rounding. */
static bool solve(stf_baseline *base, N_Vector b, N_Vector yp)
{
  const sunindextype n = base->run->problem->n;
  if (base->storage == STEIF_KRYLOV) return false;
  if (base->storage == STEIF_SPARSE && !base->merge.column) return false;
  SUNMatZero(base->J);
  if (base->storage == STEIF_SPARSE) {
    if (!stf_merge_fill(&base->merge, base->J, 1, base->E, NULL)) return false;
  } else {
    stf_matrix_add(base->J, 1, base->E);
  }
  if (SUNLinSolInitialize(base->solver) || SUNLinSolSetup(base->solver, base->J) ||
      SUNLinSolSolve(base->solver, base->J, yp, b, 0))
    return false;
  const sunrealtype *x = stf_array(yp), *f = stf_array(b);
  sunrealtype large = 0, most = 0;
  for (sunindextype i = 0; i < n; i++) {
    if (!isfinite(x[i])) return false;
    large = fmax(large, fabs(x[i])), most = fmax(most, fabs(f[i]));
  }
  return large * sqrt(STF_EPS) <= most; /* else pivots were rounding errors */
}

static int mass_slopes(stf_baseline *base)
{
  stf_run *run = base->run;
  const size_t n = (size_t)run->problem->n;
  sunindextype *count = stf_allocate(run->ctx, 2 * n, sizeof *count);
  sunrealtype *value = stf_allocate(run->ctx, n, sizeof *value);
  if (!base->pair) base->pair = stf_pool_vectors(run->pool, 2, run->like);
  N_Vector *v = base->pair;
  int code = count && value && v ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code && !stf_lower_residual(run->t, run->y, run->yp, v[0], base) && !zero(v[0])) {
    N_VScale(-1, v[0], v[0]);
    if (!single_rows(base->E, run->problem->n, stf_array(v[0]), stf_array(run->yp), count,
                     count + n, value) &&
        solve(base, v[0], v[1]))
      N_VScale(1, v[1], run->yp);
  }
  stf_release(run->ctx, count);
  stf_release(run->ctx, value);
  return code;
}

int stf_start_slopes(stf_baseline *base)
{
  stf_run *run = base->run;
  if (run->form == STEIF_ODE) {
    const int seen = stf_baseline_rhs(run->t, run->y, run->yp, base);
    STEIF_CHECK(!seen, run->ctx, base->fault.verdict ? STEIF_CALLBACK : STEIF_NOT_FINITE,
                "f cannot be evaluated at the start, t = %.12g: it returned %d%s", run->t,
                base->fault.verdict, base->fault.verdict ? "" : " with NaN or infinity");
    return STEIF_OK;
  }
  STEIF_TRY(stf_sum_gate(run->ctx));
  if (!zero(run->yp)) return STEIF_OK;
  STEIF_TRY(stf_start_mass(base));
  return base->E ? mass_slopes(base) : STEIF_OK;
}

/* --- which components are algebraic --- */

/* large[j] = change of F when y'_j moves, or of E when the unit vector j is multiplied. */
static int probe_columns(stf_baseline *base, sunrealtype *large)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  N_Vector *v = stf_pool_vectors(run->pool, 3, run->like);
  if (!v) return STEIF_NO_MEMORY;
  N_Vector moved = v[0], r = v[1], r0 = v[2];
  sunrealtype *x = stf_array(moved);
  const bool residual = run->form == STEIF_IMPLICIT;
  STEIF_CHECK(
    x, run->ctx, STEIF_UNSUPPORTED,
    "algebraic components are found with host arrays only; leave suppress and ic at 0");
  if (residual) N_VScale(1, run->yp, moved);
  int seen = residual ? stf_lower_residual(run->t, run->y, run->yp, r0, base) : 0;
  for (sunindextype j = 0; !seen && j < p->n; j++) {
    const sunrealtype kept = x[j];
    x[j] += 1 + fabs(kept);
    seen = residual ? stf_lower_residual(run->t, run->y, moved, r, base)
                    : p->Ev(run->t, run->y, run->yp, moved, r, p->user);
    x[j] = kept;
    if (residual) N_VLinearSum(1, r, -1, r0, r);
    large[j] = N_VMaxNorm(r);
  }
  STEIF_CHECK(
    !seen, run->ctx, STEIF_CALLBACK,
    "a callback returned %d at the start, t = %.12g, when the algebraic components were "
    "looked for",
    seen, run->t);
  return STEIF_OK;
}

static int by_columns(stf_baseline *base, sunrealtype *large)
{
  STEIF_TRY(stf_start_mass(base));
  if (base->E)
    stf_matrix_columns(base->E, large);
  else
    STEIF_TRY(probe_columns(base, large));
  for (sunindextype j = 0; j < base->run->problem->n; j++) large[j] = large[j] > 0;
  return STEIF_OK;
}

static int by_index(stf_baseline *base, sunrealtype *id)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  steif_diagnosis d = {.index = -1};
  if (!p->index) STEIF_TRY(steif_diagnose(run->ctx, p, NULL, &d));
  const int *index = p->index ? p->index : d.number;
  const bool known = p->index || d.index >= 0;
  for (sunindextype j = 0; known && j < p->n; j++) id[j] = index[j] <= 1;
  steif_diagnosis_clear(&d);
  STEIF_CHECK(known, run->ctx, STEIF_BAD_INPUT,
              "id=index needs the index of each component, and the index of '%s' is undecided: "
              "declare problem.index, or take id=E",
              p->name ? p->name : "the problem");
  return STEIF_OK;
}

int stf_start_id(stf_baseline *base, const char *which, N_Vector id)
{
  steif_context *ctx = base->run->ctx;
  const bool columns = !strcmp(which, "E"), ones = !strcmp(which, "ones");
  sunrealtype *x = stf_array(id);
  STEIF_CHECK(columns || ones || !strcmp(which, "index"), ctx, STEIF_BAD_INPUT,
              "id=%s is not known to ida: E (columns of dF/dy' that are not 0), index "
              "(components of index 1) or ones",
              which);
  if (base->run->form == STEIF_ODE || ones ||
      (!base->E && !base->run->problem->Ev && base->run->form != STEIF_IMPLICIT)) {
    N_VConst(1, id);
    return STEIF_OK;
  }
  STEIF_CHECK(
    x, ctx, STEIF_UNSUPPORTED,
    "algebraic components are found with host arrays only; leave suppress and ic at 0");
  return columns ? by_columns(base, x) : by_index(base, x);
}
