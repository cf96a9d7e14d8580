/* ida_form.c: the four forms as F(t, y, y') = 0 for IDA, with dF/dy + c dF/dy' = c E - A.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include <math.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* --- E and A filled by callbacks --- */

static int fill(stf_baseline *base, char which, sunrealtype t, N_Vector y, N_Vector yp)
{
  const steif_problem *p = base->run->problem;
  SUNMatrix M = which == 'E' ? base->E : base->A;
  const char *who = which == 'E' ? "the matrix E" : "the matrix A";
  if (base->coloured && (which == 'A' || base->run->form == STEIF_IMPLICIT))
    return stf_coloured_fill(base, which, t, y, yp, M);
  SUNMatZero(M);
  const int verdict = (which == 'E' ? p->E : p->A)(t, y, yp, M, p->user);
  return stf_baseline_watch_matrix(base, who, verdict, t, M);
}

/* A constant matrix, at the start values. */
static int fill_start(stf_baseline *base, char which)
{
  stf_run *run = base->run;
  const int seen = fill(base, which, run->t, run->y, run->yp);
  if (!seen) return STEIF_OK;
  const bool said = base->fault.verdict != 0;
  return STEIF_FAIL(run->ctx, said ? STEIF_CALLBACK : STEIF_NOT_FINITE,
                    said ? "the callback of the matrix %c returned %d at the start, t = %.12g"
                         : "the matrix %c (callback returned %d) is not finite at t = %.12g",
                    which, base->fault.verdict, run->t);
}

int stf_lower_mass(stf_baseline *base)
{
  const steif_problem *p = base->run->problem;
  if (!p->E) return STEIF_OK;
  base->E = stf_matrix_new(base->run, p->storage, p->nnz_E ? p->nnz_E : p->n);
  if (!base->E) return steif_status(base->run->ctx);
  return fill_start(base, 'E');
}

int stf_fill_mass(stf_baseline *base, sunrealtype t)
{
  return fill(base, 'E', t, base->run->y, base->run->yp);
}

bool stf_lower_has_jac(const stf_baseline *base)
{
  const steif_problem *p = base->run->problem;
  if (p->storage == STEIF_KRYLOV) return false;
  if (base->coloured) return true;
  if (base->run->form == STEIF_IMPLICIT) return p->idajac || (p->E && p->A);
  return p->jac || p->A;
}

/* df/dy or A into base->A. */
static int fill_A(stf_baseline *base, sunrealtype t, N_Vector y, N_Vector yp, N_Vector fy,
                  N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  const steif_problem *p = base->run->problem;
  if (base->run->form == STEIF_DESCRIPTOR) return 0;
  if (base->run->form == STEIF_IMPLICIT || !p->jac) return fill(base, 'A', t, y, yp);
  SUNMatZero(base->A);
  const int verdict = p->jac(t, y, fy, base->A, p->user, tmp1, tmp2, tmp3);
  return stf_baseline_watch_matrix(base, "the Jacobian", verdict, t, base->A);
}

/* The pattern of a sparse c E - A, from a first evaluation at the start. */
static int merge(stf_baseline *base)
{
  stf_run *run = base->run;
  N_Vector *v = stf_pool_vectors(run->pool, 4, run->like);
  if (!v) return STEIF_NO_MEMORY;
  if (!base->E && !(base->E = stf_matrix_identity(run))) return steif_status(run->ctx);
  int seen = 0;
  if (run->form == STEIF_IMPLICIT) seen = fill(base, 'E', run->t, run->y, run->yp);
  if (!seen && run->problem->f) seen = stf_baseline_rhs(run->t, run->y, v[0], base);
  if (!seen) seen = fill_A(base, run->t, run->y, run->yp, v[0], v[1], v[2], v[3]);
  STEIF_CHECK(!seen, run->ctx, base->fault.verdict ? STEIF_CALLBACK : STEIF_NOT_FINITE,
              "%s at the start, t = %.12g: it returned %d%s", base->fault.who, run->t,
              base->fault.verdict,
              base->fault.verdict ? "" : " and values that are not finite");
  return stf_merge_open(run, base->E, base->A, &base->merge);
}

int stf_lower_open(stf_baseline *base)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  const bool matrices = p->storage != STEIF_KRYLOV;
  const bool jac = stf_lower_has_jac(base) && base->storage != STEIF_KRYLOV;
  if (base->coloured && run->form == STEIF_IMPLICIT) {
    base->E = stf_matrix_new(run, STEIF_SPARSE, p->pattern->column[p->n]);
    if (!base->E) return steif_status(run->ctx);
  }
  if (matrices && p->E && !base->E) STEIF_TRY(stf_lower_mass(base));
  if ((jac && !p->idajac) || (matrices && run->form == STEIF_DESCRIPTOR))
    STEIF_TRY(stf_baseline_native(base));
  if (jac && p->idajac && base->storage != p->storage) STEIF_TRY(stf_baseline_native(base));
  if (base->A && run->form == STEIF_DESCRIPTOR) STEIF_TRY(fill_start(base, 'A'));
  STEIF_TRY(stf_baseline_linear(base, jac));
  return base->storage == STEIF_SPARSE && !p->idajac ? merge(base) : STEIF_OK;
}

/* --- the residual --- */

/* out += a E x or a A x. */
static int product(stf_baseline *base, char which, sunrealtype a, sunrealtype t, N_Vector y,
                   N_Vector yp, N_Vector x, N_Vector out)
{
  const steif_problem *p = base->run->problem;
  SUNMatrix M = which == 'E' ? base->E : base->A;
  const steif_product apply = which == 'E' ? p->Ev : p->Av;
  if (M) {
    stf_matrix_times(M, a, stf_array(x), stf_array(out));
    return 0;
  }
  if (!apply) {
    N_VLinearSum(a, x, 1, out, out);
    return 0;
  }
  const int verdict = apply(t, y, yp, x, base->work, p->user);
  if (stf_baseline_watch(base, which == 'E' ? "Ev" : "Av", verdict, t, base->work))
    return verdict ? verdict : 1;
  N_VLinearSum(a, base->work, 1, out, out);
  return 0;
}

static void negate(N_Vector r)
{
  sunrealtype *x = stf_array(r);
  if (!x) {
    N_VScale(-1, r, r);
    return;
  }
  const sunindextype n = N_VGetLength(r);
  for (sunindextype i = 0; i < n; i++) x[i] = -x[i];
}

/* r = -f(t, y), -A y - g(t) or F(t, y, y') without E y'. */
static int without_slopes(stf_baseline *base, sunrealtype t, N_Vector y, N_Vector yp,
                          N_Vector r)
{
  const steif_problem *p = base->run->problem;
  if (base->run->form != STEIF_DESCRIPTOR) {
    const int seen = stf_baseline_watch(base, "f", p->f(t, y, r, p->user), t, r);
    if (!seen) negate(r);
    return seen;
  }
  N_VConst(0, r);
  if (p->g) {
    const int seen = stf_baseline_watch(base, "g", p->g(t, 0, r, p->user), t, r);
    if (seen) return seen;
    negate(r);
  }
  return product(base, 'A', -1, t, y, yp, y, r);
}

/* out = yp - x in a loop of our own: a call of SUNDIALS for few numbers costs more than they do. */
static void slopes_less(N_Vector yp, N_Vector x, N_Vector out)
{
  const sunrealtype *p = stf_array(yp), *a = stf_array(x);
  sunrealtype *b = stf_array(out);
  if (!p || !a || !b) {
    N_VLinearSum(1, yp, -1, x, out);
    return;
  }
  const sunindextype n = N_VGetLength(yp);
  for (sunindextype i = 0; i < n; i++) b[i] = p[i] - a[i];
}

/* r = y' - f(t, y), looked at in the same loop. */
static int ode_residual(stf_baseline *base, sunrealtype t, N_Vector y, N_Vector yp, N_Vector r)
{
  const steif_problem *p = base->run->problem;
  const int verdict = p->f(t, y, r, p->user);
  const sunrealtype *slope = stf_array(yp);
  sunrealtype *x = stf_array(r), sum = 0; /* 0 * x is NaN exactly where x is not finite */
  if (verdict || !slope || !x) {
    const int failed = stf_baseline_watch(base, "f", verdict, t, r);
    if (!failed) slopes_less(yp, r, r);
    return failed;
  }
  for (sunindextype i = 0; i < p->n; i++) {
    x[i] = slope[i] - x[i];
    sum += 0 * x[i];
  }
  return sum == 0 ? 0 : stf_baseline_watch(base, "f", 0, t, r);
}

int stf_lower_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  if (base->run->form == STEIF_IMPLICIT)
    return stf_baseline_watch(base, "F", p->F(t, y, yp, r, p->user), t, r);
  if (base->run->form == STEIF_ODE) return ode_residual(base, t, y, yp, r);
  const int seen = without_slopes(base, t, y, yp, r);
  if (seen) return seen;
  return product(base, 'E', 1, t, y, yp, yp, r);
}

/* --- its matrix --- */

static void add_diagonal(SUNMatrix J, sunrealtype c, sunindextype n)
{
  for (sunindextype j = 0; j < n; j++) {
    const stf_column column = stf_matrix_column(J, j);
    column.entry[j - column.first] += c;
  }
}

/* The patterns of differences have grown. */
static bool merge_anew(stf_baseline *base, SUNMatrix J)
{
  if (stf_merge_open(base->run, base->E, base->A, &base->merge)) return false;
  const sunindextype entries = base->merge.column[base->run->problem->n];
  return SM_NNZ_S(J) >= entries || !SUNSparseMatrix_Reallocate(J, entries);
}

static int assemble(stf_baseline *base, sunrealtype t, sunrealtype c, SUNMatrix J)
{
  if (base->storage == STEIF_SPARSE) {
    if (stf_merge_fill(&base->merge, J, c, base->E, base->A)) return 0;
    if (base->coloured && merge_anew(base, J) &&
        stf_merge_fill(&base->merge, J, c, base->E, base->A))
      return 0;
    base->fault.who = "a sparse matrix (its pattern changed)", base->fault.at = -1;
    base->fault.t = t, base->fault.now = true;
    return base->fault.verdict = -1;
  }
  if (base->E)
    stf_matrix_add(J, c, base->E);
  else
    add_diagonal(J, c, base->run->problem->n);
  stf_matrix_add(J, -1, base->A);
  return 0;
}

/* J = c I - df/dy of the dense ode form in place: J arrives zeroed. */
static int ode_jac(stf_baseline *base, sunrealtype t, sunrealtype c, N_Vector y, SUNMatrix J,
                   N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  const steif_problem *p = base->run->problem;
  const int verdict = p->jac(t, y, base->work, J, p->user, tmp1, tmp2, tmp3);
  sunrealtype *x = SM_DATA_D(J), sum = 0;
  for (sunindextype k = 0; k < p->n * p->n; k++) {
    x[k] = -x[k];
    sum += 0 * x[k];
  }
  for (sunindextype j = 0; j < p->n; j++) x[j * (p->n + 1)] += c;
  return !verdict && sum == 0 ? 0
                              : stf_baseline_watch_matrix(base, "the Jacobian", verdict, t, J);
}

int stf_lower_jac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *user, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  if (base->run->form == STEIF_IMPLICIT && p->idajac) {
    SUNMatrix M = base->A ? base->A : J;
    if (base->A) SUNMatZero(M);
    const int verdict = p->idajac(t, c, y, yp, r, M, p->user, tmp1, tmp2, tmp3);
    const int seen = stf_baseline_watch_matrix(base, "the Jacobian", verdict, t, M);
    if (!seen && base->A) stf_matrix_add(J, 1, M);
    return seen;
  }
  int seen = 0;
  if (base->run->form == STEIF_IMPLICIT) seen = fill(base, 'E', t, y, yp);
  if (p->f && p->jac && base->run->form == STEIF_ODE) {
    slopes_less(yp, r, base->work);
    if (base->storage == STEIF_DENSE && p->storage == STEIF_DENSE)
      return ode_jac(base, t, c, y, J, tmp1, tmp2, tmp3);
  } else if (p->f && p->jac) { /* f = E y' - F */
    N_VScale(-1, r, base->work);
    product(base, 'E', 1, t, y, yp, yp, base->work);
  }
  if (!seen) seen = fill_A(base, t, y, yp, base->work, tmp1, tmp2, tmp3);
  return seen ? seen : assemble(base, t, c, J);
}

int stf_lower_jv(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector v, N_Vector Jv,
                 sunrealtype c, void *user, N_Vector tmp1, N_Vector tmp2)
{
  (void)r, (void)tmp1, (void)tmp2;
  stf_baseline *base = user;
  N_VConst(0, Jv);
  const int seen = product(base, 'E', c, t, y, yp, v, Jv);
  return seen ? seen : product(base, 'A', -1, t, y, yp, v, Jv);
}
