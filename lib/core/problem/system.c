/* system.c: residual and pencil of any form.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* "", or what a callback was asked for where the problem has another storage of its own. */
static const char *asked(const stf_system *s, const char *what)
{
  static const char *const words[] = {
    [STEIF_DENSE] = "; it was asked for dense matrices, and the problem has others of its own",
    [STEIF_BAND] = "; it was asked for band matrices, and the problem has others of its own",
    [STEIF_SPARSE] =
      "; it was asked for sparse matrices, and the problem has others of its own"};
  const size_t storage = (size_t)s->storage;
  const bool own = s->storage == s->problem->storage || what[0] == 'f' || what[0] == 'F';
  return own || storage >= sizeof words / sizeof *words || !words[storage] ? ""
                                                                           : words[storage];
}

/* A callback's return value as ours, with the sentence. */
static int callback(stf_system *s, int returned, const char *what, sunrealtype t)
{
  if (returned == 0) return STEIF_OK;
  if (returned > 0)
    return STEIF_RECOVER(
      s->ctx, STEIF_CALLBACK,
      "%s of problem '%s' could not be evaluated at t = %.12g (it returned %d)", what,
      s->problem->name, t, returned);
  return STEIF_FAIL(s->ctx, STEIF_CALLBACK,
                    "%s of problem '%s' stopped the run at t = %.12g (it returned %d)%s", what,
                    s->problem->name, t, returned, asked(s, what));
}

int stf_system_rhs(stf_system *s, sunrealtype t, N_Vector y, N_Vector out)
{
  s->nfe++;
  const int returned = s->problem->f(t, y, out, s->problem->user);
  return returned ? callback(s, returned, "f", t) : STEIF_OK;
}

static int mass_residual(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp, N_Vector r)
{
  STEIF_TRY(stf_system_rhs(s, t, y, s->work[0]));
  STEIF_TRY(steif_pencil_product(s->pencil, 'E', yp, r));
  stf_axpy(&s->space, -1, s->work[0], r);
  return STEIF_OK;
}

static int descriptor_residual(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp,
                               N_Vector r)
{
  const steif_problem *p = s->problem;
  STEIF_TRY(steif_pencil_product(s->pencil, 'E', yp, r));
  STEIF_TRY(steif_pencil_product(s->pencil, 'A', y, s->work[0]));
  stf_axpy(&s->space, -1, s->work[0], r);
  if (!p->g) return STEIF_OK;
  s->nfe++;
  STEIF_TRY(callback(s, p->g(t, 0, s->work[0], p->user), "g", t));
  stf_axpy(&s->space, -s->weight, s->work[0], r);
  return STEIF_OK;
}

int stf_system_residual(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp, N_Vector r)
{
  switch (s->form) {
  case STEIF_ODE:
    STEIF_TRY(stf_system_rhs(s, t, y, r));
    stf_sum(&s->space, 1, yp, -1, r, r);
    return STEIF_OK;
  case STEIF_MASS: return mass_residual(s, t, y, yp, r);
  case STEIF_DESCRIPTOR: return descriptor_residual(s, t, y, yp, r);
  default: s->nfe++; return callback(s, s->problem->F(t, y, yp, r, s->problem->user), "F", t);
  }
}

/* Dense and band matrices arrive zeroed at a fill; a sparse one is filled whole. */
static void clear(SUNMatrix M)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE)
    memset(SM_DATA_D(M), 0, (size_t)SM_LDATA_D(M) * sizeof(sunrealtype));
  else if (SUNMatGetID(M) == SUNMATRIX_BAND)
    SUNMatZero(M);
}

static int check_filled(stf_system *s, SUNMatrix M, const char *what)
{
  if (SUNMatGetID(M) != SUNMATRIX_SPARSE) return STEIF_OK;
  const sunindextype used = SUNSparseMatrix_IndexPointers(M)[s->space.n];
  STEIF_CHECK(used >= 0 && used <= SUNSparseMatrix_NNZ(M), s->ctx, STEIF_BAD_INPUT,
              "%s of problem '%s' filled %lld entries into room for %lld: correct .nnz", what,
              s->problem->name, (long long)used, (long long)SUNSparseMatrix_NNZ(M));
  return STEIF_OK;
}

static int fill_direct(stf_system *s, steif_matrix_fill fill, const char *what, sunrealtype t,
                       N_Vector y, N_Vector yp, SUNMatrix M)
{
  clear(M);
  STEIF_TRY(callback(s, fill(t, y, yp, M, s->problem->user), what, t));
  return check_filled(s, M, what);
}

static sunrealtype *values(SUNMatrix M, sunindextype *count)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: *count = SUNDenseMatrix_LData(M); return SUNDenseMatrix_Data(M);
  case SUNMATRIX_BAND: *count = SM_LDATA_B(M); return SUNBandMatrix_Data(M);
  default:
    *count = SUNSparseMatrix_IndexPointers(M)[SUNSparseMatrix_NP(M)];
    return SUNSparseMatrix_Data(M);
  }
}

/* Both filled by one callback: entry k of one is entry k of the other. */
static bool alike(SUNMatrix A, SUNMatrix E)
{
  if (SUNMatGetID(A) != SUNMATRIX_SPARSE) return true;
  const size_t columns = (size_t)SUNSparseMatrix_NP(A) + 1, size = sizeof(sunindextype);
  const sunindextype *a = SUNSparseMatrix_IndexPointers(A),
                     *e = SUNSparseMatrix_IndexPointers(E);
  return !memcmp(a, e, columns * size) &&
         !memcmp(SUNSparseMatrix_IndexValues(A), SUNSparseMatrix_IndexValues(E),
                 (size_t)a[columns - 1] * size);
}

/* J(c) = F_y + c F_y' is affine in c: A = -J(0), E = (J(c) - J(0))/c with c of the size of
 * J(0). */
static int separate(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  const steif_problem *p = s->problem;
  N_Vector *w = s->work;
  clear(s->A);
  STEIF_TRY(stf_system_residual(s, t, y, yp, w[3]));
  STEIF_TRY(
    callback(s, p->idajac(t, 0, y, yp, w[3], s->A, p->user, w[0], w[1], w[2]), "idajac", t));
  STEIF_TRY(check_filled(s, s->A, "idajac"));
  sunindextype count;
  sunrealtype *a = values(s->A, &count), c = 0;
  for (sunindextype i = 0; i < count; i++) c = fmax(c, fabs(a[i]));
  if (!(c > 0)) c = 1;
  clear(s->E);
  STEIF_TRY(
    callback(s, p->idajac(t, c, y, yp, w[3], s->E, p->user, w[0], w[1], w[2]), "idajac", t));
  STEIF_TRY(check_filled(s, s->E, "idajac"));
  STEIF_CHECK(alike(s->A, s->E), s->ctx, STEIF_BAD_INPUT,
              "idajac of problem '%s' filled other entries with c = %g than with c = 0: its "
              "pattern must not depend on c",
              p->name, c);
  sunrealtype *e = values(s->E, &count);
  for (sunindextype i = 0; i < count; i++) e[i] = (e[i] - a[i]) / c, a[i] = -a[i];
  return STEIF_OK;
}

static int fill_A(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  const steif_problem *p = s->problem;
  N_Vector *w = s->work;
  if (p->A) return fill_direct(s, p->A, "A", t, y, yp, s->A);
  if (!p->jac) return stf_differ(s, 'A', t, y, yp, s->A);
  clear(s->A);
  STEIF_TRY(stf_system_rhs(s, t, y, w[3]));
  STEIF_TRY(callback(s, p->jac(t, y, w[3], s->A, p->user, w[0], w[1], w[2]), "jac", t));
  return check_filled(s, s->A, "jac");
}

static int fill_E(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  const steif_problem *p = s->problem;
  if (p->E) return fill_direct(s, p->E, "E", t, y, yp, s->E);
  return stf_differ(s, 'E', t, y, yp, s->E);
}

static int fill(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  const bool constant_E = s->form == STEIF_ODE || (s->form != STEIF_IMPLICIT && s->filled);
  if (s->storage == STEIF_KRYLOV) return stf_operator_remember(s, t, y, yp);
  if (s->form == STEIF_IMPLICIT && s->problem->idajac && !(s->problem->E && s->problem->A))
    return separate(s, t, y, yp);
  if (!constant_E) STEIF_TRY(fill_E(s, t, y, yp));
  return fill_A(s, t, y, yp);
}

int stf_system_matrices(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  s->nje++;
  STEIF_TRY(fill(s, t, y, yp));
  s->filled = true;
  return STEIF_OK;
}

static int update(stf_system *s)
{
  if (s->near) STEIF_TRY(steif_pencil_update(s->near));
  return s->pencil ? steif_pencil_update(s->pencil) : STEIF_OK;
}

/* Entries that the pattern misses are found one or many at a time, until there are no more. */
static int probe(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  const bool sparse = s->storage == STEIF_SPARSE || s->storage == STEIF_BAND;
  for (bool grown = sparse && stf_groups_differ(s); grown;) {
    STEIF_TRY(stf_probe(s, 'A', t, y, yp, s->A, &grown));
    if (!grown && s->form == STEIF_IMPLICIT)
      STEIF_TRY(stf_probe(s, 'E', t, y, yp, s->E, &grown));
    if (!grown) break;
    STEIF_TRY(stf_system_matrices(s, t, y, yp));
    STEIF_TRY(update(s));
  }
  return STEIF_OK;
}

/* Derivatives that are 0 at the start are not there later: the 2nd, 4th, 8th ... Jacobian is probed too, and
 * those that follow a failure of Newton's iteration. */
int stf_system_linearise(stf_system *s, sunrealtype t, N_Vector y, N_Vector yp)
{
  if (s->linear && s->filled) return STEIF_OK;
  STEIF_TRY(stf_system_matrices(s, t, y, yp));
  STEIF_TRY(update(s));
  const bool asked = s->doubted || (s->nje & (s->nje - 1)) == 0;
  s->doubted = false;
  if (!s->pencil || !asked) return STEIF_OK;
  const int code = probe(s, t, y, yp);
  return code > 0 ? STEIF_OK : code;
}

/* -- opening ------------------------------------------------------------------------------- */

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

void stf_system_destroy_pencil(void *p)
{
  steif_pencil *pencil = p;
  steif_pencil_free(&pencil);
}

static sunindextype larger(sunindextype a, sunindextype b) { return a > b ? a : b; }

/* Entries of a sparse matrix: as stated, and what differences or an IDA Jacobian put there. */
static sunindextype room(const steif_problem *p, sunindextype stated)
{
  if (stated < 1 || p->idajac) stated = larger(stated, p->nnz);
  if (p->pattern) stated = larger(stated, p->pattern->column[p->n]);
  return larger(stated, 1);
}

static int matrix(stf_pool *pool, stf_system *s, sunindextype nnz, SUNMatrix *M)
{
  const steif_problem *p = s->problem;
  const sunindextype n = s->space.n;
  SUNContext sun = steif_sundials(s->ctx);
  switch (s->storage) {
  case STEIF_DENSE: *M = SUNDenseMatrix(n, n, sun); break;
  case STEIF_BAND: *M = SUNBandMatrix(n, p->upper, p->lower, sun); break;
  default: *M = SUNSparseMatrix(n, n, room(p, nnz), CSC_MAT, sun);
  }
  STEIF_CHECK(*M, s->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)n);
  return stf_pool_adopt(pool, *M, destroy_matrix);
}

static int open_matrices(stf_pool *pool, stf_system *s)
{
  const steif_problem *p = s->problem;
  STEIF_CHECK(s->space.serial || stf_array(s->space.like), s->ctx, STEIF_UNSUPPORTED,
              "vectors of problem '%s' have no host array: only Krylov storage can serve them",
              p->name);
  const bool fills = s->form == STEIF_DESCRIPTOR ? p->E && p->A : s->form != STEIF_MASS || p->E;
  STEIF_CHECK(
    fills, s->ctx, STEIF_UNSUPPORTED,
    "problem '%s' of form %s gives products without matrices: fill .E%s, or take Krylov "
    "storage",
    p->name, steif_form_name(s->form), s->form == STEIF_MASS ? "" : " and .A");
  STEIF_TRY(stf_groups_open(pool, s));
  STEIF_TRY(matrix(pool, s, p->nnz, &s->A));
  return s->form == STEIF_ODE ? STEIF_OK : matrix(pool, s, p->nnz_E, &s->E);
}

static int open_pencil(stf_pool *pool, stf_system *s)
{
  s->pencil = steif_pencil_new(s->ctx, s->E, s->A);
  if (!s->pencil) return steif_status(s->ctx);
  return stf_pool_adopt(pool, s->pencil, stf_system_destroy_pencil);
}

int stf_system_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem, int form,
                    enum steif_storage storage, sunrealtype scale, const sunrealtype *floors,
                    N_Vector y, N_Vector yp, stf_system *s)
{
  *s = (stf_system){.ctx = ctx, .problem = problem, .form = form, .storage = storage};
  s->linear = problem->linear || form == STEIF_DESCRIPTOR;
  s->scale = scale, s->floors = floors, s->weight = 1;
  stf_space_open(&s->space, y);
  s->space.sums = &s->sums;
  s->krylov = storage == STEIF_KRYLOV;
  const bool near = stf_operator_has_near(s);
  if (near) s->storage = STEIF_SPARSE;
  for (int i = 0; i < 6; i++)
    if (!(s->work[i] = stf_pool_vector(pool, y))) return STEIF_NO_MEMORY;
  const bool matrices = s->storage != STEIF_KRYLOV;
  STEIF_TRY(stf_storage_check(ctx, problem, storage));
  STEIF_TRY(matrices ? open_matrices(pool, s) : stf_operator_open(pool, s));
  const int code = stf_system_linearise(s, problem->t0, y, yp);
  if (code) return code > 0 ? STEIF_CALLBACK : code;
  if (!matrices) return STEIF_OK;
  STEIF_TRY(near ? stf_operator_open_near(pool, s) : open_pencil(pool, s));
  const int missing = probe(s, problem->t0, y, yp);
  if (missing < 0) return missing;
  return stf_index_check(s);
}
