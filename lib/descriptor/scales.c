/* scales.c: the units a dense pencil is analysed in, by the largest entries of rows and columns or by
 * all entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scales.h"
#include "dense.h"
#include "field.h"
#include "fit.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct scaled {
  sunrealtype *E, *F, *row, *column;
  steif_structure found;
} scaled;

static void spread(SUNMatrix M, int n, sunrealtype *A)
{
  for (int j = 0; j < n; j++) {
    sunrealtype *a = A + (size_t)j * (size_t)n;
    if (SUNMatGetID(M) == SUNMATRIX_DENSE)
      memcpy(a, SM_COLUMN_D(M, j), (size_t)n * sizeof *a);
    else
      for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++)
        a[SM_INDEXVALS_S(M)[p]] += SM_DATA_S(M)[p];
  }
}

/* A <- diag(2^row) A diag(2^column); nothing overflows on the way. */
static void shift(int n, const int *row, const int *column, sunrealtype *A)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      sunrealtype *a = A + (size_t)j * (size_t)n + (size_t)i;
      if (*a != 0) *a = ldexp(*a, row[i] + column[j]);
    }
}

/* Rows and columns by their largest entries, on top of the exponents given. */
static void even(int n, int *exponent, sunrealtype *room, scaled *s)
{
  shift(n, exponent, exponent + n, s->E), shift(n, exponent, exponent + n, s->F);
  stf_balance(n, s->E, s->F, s->row, s->column, room);
  for (int k = 0; k < 2 * n; k++) {
    sunrealtype *scale = k < n ? s->row + k : s->column + (k - n);
    const int more = ilogb(*scale);
    *scale = ldexp(*scale, exponent[k]);
    exponent[k] = more;
  }
  shift(n, exponent, exponent + n, s->E), shift(n, exponent, exponent + n, s->F);
}

static bool decided(const steif_structure *s) { return s->regular && s->index >= 0; }

/* The second scales are taken for a regular pencil that seems singular in the first; what is singular
 * in its own numbers is so in all units. Else they only may raise a doubt. */
static int compare(steif_context *ctx, SUNMatrix E, SUNMatrix F, const scaled *a,
                   const scaled *b, bool *second, int *torn)
{
  const steif_structure *one = &a->found, *two = &b->found;
  bool singular = true;
  if (!one->regular && two->regular) STEIF_TRY(stf_field_singular(ctx, E, F, &singular));
  *second = !singular;
  const bool differ = one->index != two->index || one->infinite != two->infinite;
  if (decided(one) && decided(two) && differ)
    *torn = one->index < two->index ? one->index : two->index;
  else if (*second)
    *torn = 0;
  return STEIF_OK;
}

static int claim(stf_pool *pool, int n, scaled *s)
{
  s->E = stf_claim_square(pool, n), s->F = stf_claim_square(pool, n);
  s->row = stf_claim(pool, 2 * (size_t)n, sizeof *s->row);
  if (!s->E || !s->F || !s->row) return STEIF_NO_MEMORY;
  s->column = s->row + n;
  return STEIF_OK;
}

static int look(steif_context *ctx, int n, const steif_analysis *analysis, scaled *s)
{
  return stf_staircase(ctx, n, s->E, s->F, analysis, NULL, NULL, &s->found, NULL, NULL);
}

static void replace(int n, const scaled *b, scaled *a)
{
  const size_t size = (size_t)n * (size_t)n * sizeof *a->E;
  memcpy(a->E, b->E, size), memcpy(a->F, b->F, size);
  memcpy(a->row, b->row, (size_t)n * sizeof *b->row);
  memcpy(a->column, b->column, (size_t)n * sizeof *b->row);
}

int stf_scales_choose(steif_context *ctx, stf_pool *pool, const steif_analysis *analysis,
                      SUNMatrix E, SUNMatrix F, int n, sunrealtype *e, sunrealtype *f,
                      sunrealtype *row, sunrealtype *column, int *torn)
{
  scaled a = {.E = e, .F = f, .row = row, .column = column}, b = {.E = NULL};
  enum stf_fitted fitted;
  bool second = true;
  int *none = stf_claim(pool, 4 * (size_t)n, sizeof *none);
  sunrealtype *room = stf_claim(pool, (size_t)n, sizeof *room);
  if (!none || !room) return STEIF_NO_MEMORY;
  int *exponent = none + 2 * n;
  *torn = -1;
  STEIF_TRY(stf_fit(ctx, E, F, exponent, &fitted));
  spread(E, n, e), spread(F, n, f);
  even(n, fitted == STF_FIT_ALL ? exponent : none, room, &a);
  if (fitted != STF_FIT_SOME) return STEIF_OK;
  STEIF_TRY(claim(pool, n, &b));
  spread(E, n, b.E), spread(F, n, b.F);
  even(n, exponent, room, &b);
  int code = look(ctx, n, analysis, &a);
  if (!code) code = look(ctx, n, analysis, &b);
  if (!code) code = compare(ctx, E, F, &a, &b, &second, torn);
  if (!code && second) replace(n, &b, &a);
  steif_structure_clear(ctx, &a.found), steif_structure_clear(ctx, &b.found);
  return code;
}

/* ---- what small entries carry ---------------------------------------------------------------------- */

static sunrealtype largest(size_t count, const sunrealtype *A)
{
  sunrealtype most = 0;
  for (size_t k = 0; k < count; k++) most = fmax(most, fabs(A[k]));
  return most;
}

/* The entries above `least`; NULL with the message set. */
static SUNMatrix pattern(steif_context *ctx, int n, const sunrealtype *A, sunrealtype least)
{
  const size_t m = (size_t)n;
  sunindextype count = 0;
  for (size_t k = 0; k < m * m; k++) count += fabs(A[k]) > least;
  SUNMatrix M = SUNSparseMatrix(n, n, count ? count : 1, CSC_MAT, steif_sundials(ctx));
  if (!M) STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a pattern of order %d", n);
  count = 0;
  for (int j = 0; M && j < n; j++) {
    for (int i = 0; i < n; i++) {
      if (!(fabs(A[(size_t)j * m + (size_t)i]) > least)) continue;
      SM_INDEXVALS_S(M)[count] = i;
      SM_DATA_S(M)[count++] = 1;
    }
    SM_INDEXPTRS_S(M)[j + 1] = count;
  }
  return M;
}

static int degree(steif_context *ctx, int n, const sunrealtype *e, sunrealtype least_e,
                  const sunrealtype *f, sunrealtype least_f, sunindextype *out)
{
  sunindextype rank;
  steif_structure found = {.degree = -1};
  SUNMatrix E = pattern(ctx, n, e, least_e), F = E ? pattern(ctx, n, f, least_f) : NULL;
  const int code = F ? stf_matching(ctx, E, F, &rank, &found) : STEIF_NO_MEMORY;
  *out = found.degree;
  steif_structure_clear(ctx, &found);
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}

int stf_scales_degree(steif_context *ctx, int n, const sunrealtype *e, const sunrealtype *f,
                      sunindextype *out)
{
  return degree(ctx, n, e, 0, f, 0, out);
}

int stf_scales_carried(steif_context *ctx, int n, const sunrealtype *e, const sunrealtype *f,
                       sunindextype *carried)
{
  const size_t count = (size_t)n * (size_t)n;
  const sunrealtype least_e = 4 * n * STF_EPS * largest(count, e);
  const sunrealtype least_f = 4 * n * STF_EPS * largest(count, f);
  sunindextype all, without;
  bool some = false;
  *carried = 0;
  for (size_t k = 0; k < count; k++)
    some |= (e[k] != 0 && fabs(e[k]) <= least_e) || (f[k] != 0 && fabs(f[k]) <= least_f);
  if (!some) return STEIF_OK;
  STEIF_TRY(degree(ctx, n, e, 0, f, 0, &all));
  STEIF_TRY(degree(ctx, n, e, least_e, f, least_f, &without));
  *carried = all > without ? all - without : 0;
  return STEIF_OK;
}
