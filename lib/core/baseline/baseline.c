/* baseline.c: options in, sentences out: what the engines over CVODE, IDA and ARKODE share.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include "problem.h"
#include <math.h>
#include <string.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunlinsol/sunlinsol_spgmr.h>

/* --- what the package says --- */

static void keep(stf_baseline *base, const char *text)
{
  size_t used = 0;
  for (; *text && used < STF_SAID - 1; text++)
    if (*text != '\n') base->said[used++] = *text;
  base->said[used] = 0;
}

#if SUNDIALS_VERSION_MAJOR >= 7
static void hear(int line, const char *function, const char *file, const char *text,
                 SUNErrCode code, void *base, SUNContext sun)
{
  (void)line, (void)function, (void)file, (void)code, (void)sun;
  if (text) keep(base, text);
}

void stf_baseline_enter(stf_baseline *base, stf_run *run)
{
  base->run = run;
  base->said[0] = base->detail[0] = 0, base->fault.now = base->told = false;
  SUNContext_PushErrHandler(steif_sundials(run->ctx), hear, base);
}

void stf_baseline_leave(stf_baseline *base)
{
  SUNContext_PopErrHandler(steif_sundials(base->run->ctx));
}
#else
void stf_baseline_hear(int code, const char *module, const char *function, char *text,
                       void *base)
{
  (void)code, (void)module, (void)function;
  if (text) keep(base, text);
}

void stf_baseline_enter(stf_baseline *base, stf_run *run)
{
  base->run = run;
  base->said[0] = base->detail[0] = 0, base->fault.now = base->told = false;
}

void stf_baseline_leave(stf_baseline *base) { (void)base; }
#endif

/* --- opening --- */

int stf_baseline_weights(N_Vector y, N_Vector ewt, void *data)
{
  const stf_run *run = ((const stf_baseline *)data)->run;
  return run->options->ewt(y, ewt, run->user);
}

static int tolerances(stf_baseline *base)
{
  stf_run *run = base->run;
  if (!run->options->atols) return STEIF_OK;
  if (!(base->atol = stf_pool_vector(run->pool, run->like))) return STEIF_NO_MEMORY;
  sunindextype rows;
  sunrealtype *a = stf_own_rows(base->atol, &rows);
  STEIF_CHECK(a, run->ctx, STEIF_UNSUPPORTED,
              "%s cannot take options.atols with vectors without a host array: give atol",
              base->package);
  memcpy(a, run->options->atols, (size_t)rows * sizeof *a);
  return STEIF_OK;
}

/* The packages reject constraints that are 0 in all components. */
static int constraints(stf_baseline *base)
{
  stf_run *run = base->run;
  if (!run->problem->constraint) return STEIF_OK;
  N_Vector signs = stf_pool_vector(run->pool, run->like);
  if (!signs) return STEIF_NO_MEMORY;
  sunindextype rows;
  sunrealtype *c = stf_own_rows(signs, &rows);
  for (sunindextype i = 0; c && i < rows; i++) c[i] = run->problem->constraint[i];
  STEIF_TRY(stf_sum_gate(run->ctx));
  if (N_VMaxNorm(signs) > 0) base->constraint = signs;
  return STEIF_OK;
}

int stf_baseline_open(stf_baseline *base, stf_run *run, const char *package,
                      const stf_flag *flags)
{
  const steif_options *o = run->options;
  base->package = package, base->flags = flags, base->run = run;
  base->storage = o->force_storage ? o->storage : run->problem->storage;
  STEIF_CHECK(!o->mesh, run->ctx, STEIF_UNSUPPORTED,
              "%s cannot follow a given mesh (options.mesh); use a steif method for that",
              package);
  STEIF_CHECK(
    base->storage == run->problem->storage || base->storage == STEIF_DENSE ||
      base->storage == STEIF_KRYLOV,
    run->ctx, STEIF_UNSUPPORTED,
    "%s takes the matrices as the problem stores them, dense, or Krylov; other forced "
    "storage is rejected",
    package);
  base->preconditioned = base->storage == STEIF_KRYLOV && run->problem->precsolve;
  if (!(base->work = stf_pool_vector(run->pool, run->like))) return STEIF_NO_MEMORY;
  STEIF_CHECK(
    base->storage == STEIF_KRYLOV || stf_array(base->work), run->ctx, STEIF_UNSUPPORTED,
    "%s with matrices needs vectors with a host array; use storage = STEIF_KRYLOV", package);
  STEIF_TRY(constraints(base));
  STEIF_TRY(stf_coloured_open(base));
  return tolerances(base);
}

int stf_baseline_gate(const stf_baseline *base)
{
  const stf_run *run = base->run;
  return base->atol || base->constraint ? stf_sum_gate(run->ctx)
                                        : stf_clone_gate(run->ctx, run->y);
}

int stf_baseline_adaptive(const stf_baseline *base)
{
  const steif_options *o = base->run->options;
  STEIF_CHECK(!(o->h > 0), base->run->ctx, STEIF_UNSUPPORTED,
              "%s chooses its own steps, h = %g cannot be given; give rtol instead",
              base->package, o->h);
  return STEIF_OK;
}

static void free_solver(void *solver) { SUNLinSolFree(solver); }

SUNLinearSolver stf_baseline_solver(stf_baseline *base, SUNMatrix M)
{
  enum { AMD = 0 }; /* the ordering of KLU that suits grids; its default here is COLAMD */
  stf_run *run = base->run;
  SUNContext sun = steif_sundials(run->ctx);
  SUNLinearSolver solver = NULL;
  const int side = base->preconditioned ? SUN_PREC_LEFT : SUN_PREC_NONE;
  if (stf_clone_gate(run->ctx, run->y)) return NULL;
  switch (base->storage) {
  case STEIF_DENSE: solver = SUNLinSol_Dense(run->y, M, sun); break;
  case STEIF_BAND: solver = SUNLinSol_Band(run->y, M, sun); break;
  case STEIF_SPARSE: solver = SUNLinSol_KLU(run->y, M, sun); break;
  case STEIF_KRYLOV: solver = SUNLinSol_SPGMR(run->y, side, 0, sun); break;
  }
  if (!solver) {
    STEIF_FAIL(
      run->ctx, STEIF_UNSUPPORTED,
      "SUNDIALS makes no linear solver for these vectors and storage %d (0 dense, 1 band, "
      "2 sparse, 3 Krylov), or memory is short",
      (int)base->storage);
    return NULL;
  }
  if (base->storage == STEIF_SPARSE) SUNLinSol_KLUSetOrdering(solver, AMD);
  return stf_pool_adopt(run->pool, solver, free_solver) ? NULL : solver;
}

static sunindextype entries_of(const steif_problem *p)
{
  return p->nnz ? p->nnz : p->pattern ? p->pattern->column[p->n] : 0;
}

int stf_baseline_native(stf_baseline *base)
{
  const steif_problem *p = base->run->problem;
  base->A = stf_matrix_new(base->run, p->storage, entries_of(p));
  return base->A ? STEIF_OK : steif_status(base->run->ctx);
}

int stf_baseline_linear(stf_baseline *base, bool exact)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  STEIF_CHECK(
    base->storage != STEIF_SPARSE || exact, run->ctx, STEIF_UNSUPPORTED,
    "%s needs the entries of a sparse Jacobian or its pattern: give .jac (or .idajac) or "
    ".pattern, or force dense or Krylov storage",
    base->package);
  if (base->storage != STEIF_KRYLOV) {
    base->J = stf_matrix_new(run, base->storage, entries_of(p) + p->nnz_E + p->n);
    if (!base->J) return steif_status(run->ctx);
  }
  base->solver = stf_baseline_solver(base, base->J);
  return base->solver ? STEIF_OK : steif_status(run->ctx);
}

/* --- callbacks --- */

/* Every number is finite. */
static bool finite_numbers(sunindextype n, const sunrealtype *x)
{
  sunrealtype s[4] = {0, 0, 0, 0}; /* 0 * x is NaN exactly for the x that are not finite */
  sunindextype i = 0;
  for (; i + 4 <= n; i += 4)
    for (int k = 0; k < 4; k++) s[k] += 0 * x[i + k];
  for (; i < n; i++) s[0] += 0 * x[i];
  return s[0] + s[1] + s[2] + s[3] == 0;
}

int stf_baseline_tells(stf_baseline *base, long failures, int returned)
{
  base->told = returned < 0 && stf_failures(base->run->ctx) > failures;
  return returned;
}

bool stf_baseline_finite(N_Vector v)
{
  const sunrealtype *x = stf_array(v);
  return x ? finite_numbers(N_VGetLength(v), x) : isfinite(N_VL1Norm(v));
}

static void note(stf_baseline *base, const char *who, int verdict, sunrealtype t)
{
  base->fault.who = who, base->fault.verdict = verdict, base->fault.at = -1;
  base->fault.t = t, base->fault.now = true;
}

int stf_baseline_watch(stf_baseline *base, const char *who, int verdict, sunrealtype t,
                       N_Vector out)
{
  if (!verdict && stf_baseline_finite(out)) return 0;
  note(base, who, verdict, t);
  if (!verdict) base->fault.at = stf_not_finite(out);
  return verdict ? verdict : 1;
}

int stf_baseline_watch_matrix(stf_baseline *base, const char *who, int verdict, sunrealtype t,
                              SUNMatrix M)
{
  if (!verdict && stf_matrix_finite(M)) return 0;
  note(base, who, verdict, t);
  return verdict ? verdict : 1;
}

int stf_baseline_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  const int verdict = p->f(t, y, ydot, p->user);
  const sunrealtype *x = stf_array(ydot);
  if (verdict || !x) return stf_baseline_watch(base, "f", verdict, t, ydot);
  return finite_numbers(p->n, x) ? 0 : stf_baseline_watch(base, "f", 0, t, ydot);
}

bool stf_baseline_has_jac(const stf_baseline *base)
{
  const steif_problem *p = base->run->problem;
  return (p->jac || p->A || base->coloured) && p->storage != STEIF_KRYLOV;
}

int stf_baseline_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector tmp1, N_Vector tmp2, N_Vector tmp3)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  SUNMatrix M = base->A ? base->A : J;
  if (base->coloured) return stf_coloured_fill(base, 'A', t, y, base->run->yp, J);
  if (base->A) SUNMatZero(M);
  const int verdict = p->jac ? p->jac(t, y, fy, M, p->user, tmp1, tmp2, tmp3)
                             : p->A(t, y, base->run->yp, M, p->user);
  const int seen = stf_baseline_watch_matrix(base, "the Jacobian", verdict, t, M);
  if (!seen && M != J) stf_matrix_add(J, 1, M);
  return seen;
}

int stf_baseline_jv(N_Vector v, N_Vector Jv, sunrealtype t, N_Vector y, N_Vector fy, void *user,
                    N_Vector tmp)
{
  (void)fy, (void)tmp;
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  return stf_baseline_watch(base, "Av", p->Av(t, y, base->run->yp, v, Jv, p->user), t, Jv);
}
