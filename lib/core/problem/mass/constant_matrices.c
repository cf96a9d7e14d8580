/* constant_matrices.c: are the matrices of the forms M y' = f(t, y) and E x' = A x + g(t) constant? They are
 * filled again at other times and states and compared.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "varying_mass.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { PLACES = 4 };

/* Parts of the interval, and states: scale y + shift max(|y|, 1). Times alone, then states alone: the sentence
 * can tell them apart. */
static const struct place {
  sunrealtype part, scale, shift;
} places[PLACES] = {{0.381966, 1, 0}, {1, 1, 0}, {0, 1.0625, 0}, {0, 1, 0.015625}};

typedef struct look {
  steif_context *ctx;
  const steif_problem *problem;
  const char *who;
  sunrealtype t1;
  N_Vector y, yp, moved;
  int *variation; /* where it is only noted */
} look;

static sunrealtype time_of(const look *l, const struct place *at)
{
  const sunrealtype t0 = l->problem->t0;
  return at->part < 1 ? t0 + at->part * (l->t1 - t0) : l->t1;
}

static void move(look *l, const struct place *at)
{
  const sunrealtype size = N_VMaxNorm(l->y);
  N_VScale(at->scale, l->y, l->moved);
  if (at->shift > 0) N_VAddConst(l->moved, at->shift * fmax(size, 1), l->moved);
}

static int refuse(const look *l, char which, const char *place, sunrealtype a, sunrealtype b,
                  const struct place *at)
{
  const steif_problem *p = l->problem;
  const sunrealtype t = time_of(l, at);
  const bool product = place[0] == 0;
  char remedy[160];
  snprintf(remedy, sizeof remedy,
           p->f ? "%s does not take that; radau, bdf, dirk and ida do"
                : "%s takes constant matrices in this form; state E x' - A x - g(t) as .F, "
                  "which radau, bdf, dirk and ida take",
           l->who);
  if (l->variation) {
    *l->variation |= at->part > 0 ? STF_OF_TIME : STF_OF_STATE;
    return STEIF_OK;
  }
  return STEIF_FAIL(
    l->ctx, STEIF_UNSUPPORTED,
    "%c%s of problem '%s' is %.9g%s at the start, t = %.6g, and %.9g at t = %.6g%s: %s", which,
    place, p->name, a, product ? " in size" : "", p->t0, b, t,
    at->part > 0 ? "" : " for another state", remedy);
}

/* -- matrices -------------------------------------------------------------------------------- */

/* Are they apart by more than rounding? Values that are not finite say nothing. */
static bool apart(sunrealtype a, sunrealtype b)
{
  return isfinite(a) && isfinite(b) && fabs(a - b) > 64 * STF_EPS * fmax(fabs(a), fabs(b));
}

static sunrealtype *values(SUNMatrix M, sunindextype *count)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: *count = SM_LDATA_D(M); return SM_DATA_D(M);
  case SUNMATRIX_BAND: *count = SM_LDATA_B(M); return SM_DATA_B(M);
  default: *count = SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)]; return SM_DATA_S(M);
  }
}

/* Row and column of number k. */
static void place_of(SUNMatrix M, sunindextype k, sunindextype *i, sunindextype *j)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: *i = k % SM_ROWS_D(M), *j = k / SM_ROWS_D(M); return;
  case SUNMATRIX_BAND:
    *j = k / SM_LDIM_B(M);
    *i = k % SM_LDIM_B(M) - SM_SUBAND_B(M) + *j;
    return;
  default:
    *i = SM_INDEXVALS_S(M)[k];
    for (*j = 0; SM_INDEXPTRS_S(M)[*j + 1] <= k;) ++*j;
  }
}

/* Number k of one is number k of the other. */
static bool alike(const SUNMatrix M[2], sunindextype n, sunindextype count)
{
  if (SUNMatGetID(M[0]) != SUNMATRIX_SPARSE) return true;
  const size_t size = sizeof(sunindextype);
  return !memcmp(SM_INDEXPTRS_S(M[0]), SM_INDEXPTRS_S(M[1]), ((size_t)n + 1) * size) &&
         !memcmp(SM_INDEXVALS_S(M[0]), SM_INDEXVALS_S(M[1]), (size_t)count * size);
}

static int compare(const look *l, char which, const SUNMatrix M[2], const struct place *at)
{
  sunindextype count, other, i, j;
  const sunrealtype *a = values(M[0], &count), *b = values(M[1], &other);
  STEIF_CHECK(count == other && alike(M, l->problem->n, count), l->ctx, STEIF_BAD_INPUT,
              "%c of problem '%s' has other entries at t = %.6g than at the start: a sparse "
              "matrix is filled with the same pattern each time",
              which, l->problem->name, time_of(l, at));
  for (sunindextype k = 0; k < count; k++) {
    if (!apart(a[k], b[k])) continue;
    char row[STEIF_SPEC_WORD], column[STEIF_SPEC_WORD], place[3 * STEIF_SPEC_WORD];
    place_of(M[0], k, &i, &j);
    snprintf(place, sizeof place, " (entry of %s in %s)", stf_unknown(l->problem, j, column),
             stf_equation(l->problem, i, row));
    return refuse(l, which, place, a[k], b[k], at);
  }
  return STEIF_OK;
}

static SUNMatrix matrix(const look *l, char which)
{
  const steif_problem *p = l->problem;
  const sunindextype stated = which == 'E' ? p->nnz_E : p->nnz, n = p->n;
  const sunindextype pattern = p->pattern ? p->pattern->column[n] : 0;
  sunindextype room = stated > 0 ? stated : p->nnz;
  if (room < pattern) room = pattern;
  SUNContext sun = steif_sundials(l->ctx);
  switch (p->storage) {
  case STEIF_DENSE: return SUNDenseMatrix(n, n, sun);
  case STEIF_BAND: return SUNBandMatrix(n, p->upper, p->lower, sun);
  default: return SUNSparseMatrix(n, n, room > n ? room : n, CSC_MAT, sun);
  }
}

/* Has it been filled, and within its room? Whoever fills it for use says why not. */
static bool filled(look *l, char which, sunrealtype t, N_Vector y, SUNMatrix M)
{
  const steif_problem *p = l->problem;
  if (SUNMatZero(M) || (which == 'E' ? p->E : p->A)(t, y, l->yp, M, p->user)) return false;
  if (SUNMatGetID(M) != SUNMATRIX_SPARSE) return true;
  const sunindextype used = SM_INDEXPTRS_S(M)[p->n];
  return used >= 0 && used <= SM_NNZ_S(M);
}

static int fill_and_compare(look *l, char which, const SUNMatrix M[2])
{
  int code = STEIF_OK;
  if (!filled(l, which, l->problem->t0, l->y, M[0])) return STEIF_OK;
  for (int k = 0; !code && k < PLACES; k++) {
    move(l, places + k);
    if (filled(l, which, time_of(l, places + k), l->moved, M[1]))
      code = compare(l, which, M, places + k);
  }
  return code;
}

static int look_at_matrix(look *l, char which)
{
  const SUNMatrix M[] = {matrix(l, which), matrix(l, which)};
  const int code =
    M[0] && M[1] ? fill_and_compare(l, which, M)
                 : STEIF_FAIL(l->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
                              (long long)l->problem->n);
  for (int k = 0; k < 2; k++)
    if (M[k]) SUNMatDestroy(M[k]);
  return code;
}

/* -- products -------------------------------------------------------------------------------- */

/* The product with y + 1. */
static int look_at_product(look *l, char which, N_Vector x, N_Vector first, N_Vector other)
{
  const steif_problem *p = l->problem;
  const steif_product times = which == 'E' ? p->Ev : p->Av;
  N_VAddConst(l->y, 1, x);
  if (!times || times(p->t0, l->y, l->yp, x, first, p->user)) return STEIF_OK;
  for (int k = 0; k < PLACES; k++) {
    move(l, places + k);
    if (times(time_of(l, places + k), l->moved, l->yp, x, other, p->user)) continue;
    const sunrealtype a = N_VMaxNorm(first), b = N_VMaxNorm(other);
    N_VLinearSum(1, first, -1, other, l->moved);
    if (isfinite(a) && isfinite(b) && N_VMaxNorm(l->moved) > 1e3 * STF_EPS * fmax(a, b))
      return refuse(l, which, "", a, b, places + k);
  }
  return STEIF_OK;
}

static int look_at(look *l, char which, stf_pool *pool)
{
  const steif_problem *p = l->problem;
  if (p->storage != STEIF_KRYLOV)
    return (which == 'E' ? p->E : p->A) ? look_at_matrix(l, which) : STEIF_OK;
  N_Vector x[3];
  for (int k = 0; k < 3; k++)
    if (!(x[k] = stf_pool_vector(pool, l->y))) return STEIF_NO_MEMORY;
  return look_at_product(l, which, x[0], x[1], x[2]);
}

static int look_at_all(look *l, int form)
{
  stf_pool *pool = stf_pool_new(l->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  l->yp = stf_pool_vector(pool, l->y), l->moved = stf_pool_vector(pool, l->y);
  int code = l->yp && l->moved ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code) N_VConst(0, l->yp);
  if (!code) code = look_at(l, 'E', pool);
  if (!code && form == STEIF_DESCRIPTOR) code = look_at(l, 'A', pool);
  stf_pool_free(&pool);
  return code;
}

int stf_constant_matrices(steif_context *ctx, const steif_problem *problem, int form,
                          sunrealtype t1, N_Vector y, const char *who)
{
  if (form != STEIF_MASS && form != STEIF_DESCRIPTOR) return STEIF_OK;
  look l = {.ctx = ctx, .problem = problem, .who = who, .t1 = t1, .y = y};
  return look_at_all(&l, form);
}

int stf_mass_variation(steif_context *ctx, const steif_problem *problem, sunrealtype t1,
                       N_Vector y, int *variation)
{
  look l = {.ctx = ctx, .problem = problem, .t1 = t1, .y = y, .variation = variation};
  *variation = STF_CONSTANT;
  return look_at_all(&l, STEIF_MASS);
}
