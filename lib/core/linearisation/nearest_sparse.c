/* nearest_sparse.c: steps of nearest.c with a sparse J. With A the row-scaled J W^{-1} and x = W dz,
 *
 *   | I  A^T | | x  |   | W (target - z) |
 *   | A  -d  | | mu | = |   -r, scaled   |
 *
 * is solved by sparse factors (A. Bjoerck, Numerical Methods for Least Squares Problems, SIAM 1996, 2.5.2),
 * with d > 0 where rows depend on each other. A square and regular A needs no more than A x = -r.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "nearest.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* d of rows that depend on each other: above the rounding of A A^T, below its regular part. */
static const sunrealtype shifted = 1e-13;
/* Rows are independent where a known mu, or x, is found from its right-hand side this well. */
static const sunrealtype found_to = 1e-3;

typedef struct linear_system {
  size_t order;
  SUNMatrix K, zero;
  steif_pencil *pencil;
  N_Vector x;
} linear_system;

struct stf_augmented {
  stf_pool *pool;
  bool dependent; /* d > 0 */
  linear_system square, whole, *now;
  sunindextype *next;    /* rows + 1 */
  sunrealtype *value;    /* of A, entry by entry of J */
  sunrealtype *b, *rest; /* rows + columns each */
};
typedef struct stf_augmented augmented;

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static void destroy_pencil(void *p)
{
  steif_pencil *pencil = p;
  steif_pencil_free(&pencil);
}

static int matrix(stf_pool *pool, steif_context *ctx, size_t rows, size_t columns, size_t room,
                  SUNMatrix *M)
{
  *M = SUNSparseMatrix((sunindextype)rows, (sunindextype)columns, (sunindextype)room, CSC_MAT,
                       steif_sundials(ctx));
  STEIF_CHECK(*M, ctx, STEIF_NO_MEMORY, "no memory for a matrix of %zu entries", room);
  return stf_pool_adopt(pool, *M, destroy_matrix);
}

static void destroy_vector(void *v) { N_VDestroy(v); }

static int open(stf_pool *pool, stf_nearest_point *m)
{
  const size_t rows = m->rows, most = rows + m->columns;
  augmented *a = m->augmented = stf_pool_array(pool, 1, sizeof *a);
  if (!a) return STEIF_NO_MEMORY;
  a->pool = pool;
  a->next = stf_pool_array(pool, rows + 1, sizeof *a->next);
  a->value = stf_pool_array(pool, m->entries + 1, sizeof *a->value);
  a->b = stf_pool_array(pool, 2 * most, sizeof *a->b);
  if (!a->next || !a->value || !a->b) return STEIF_NO_MEMORY;
  a->rest = a->b + most;
  return matrix(pool, m->ctx, rows, m->columns, m->entries + 1, &m->sparse);
}

/* A into value: rows scaled by left, those without entries by 0. */
static void scale(stf_nearest_point *m)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(m->sparse), *row = SM_INDEXVALS_S(m->sparse);
  const sunrealtype *J = SM_DATA_S(m->sparse);
  sunrealtype *A = m->augmented->value;
  memset(m->left, 0, m->rows * sizeof *m->left);
  for (size_t j = 0; j < m->columns; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
      m->left[row[k]] = fmax(m->left[row[k]], fabs(J[k]) / m->weight[j]);
  for (size_t i = 0; i < m->rows; i++) m->left[i] = m->left[i] > 0 ? 1 / m->left[i] : 0;
  for (size_t j = 0; j < m->columns; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
      A[k] = m->left[row[k]] * J[k] / m->weight[j];
}

/* -- the system -------------------------------------------------------------------------- */

static void fill_square(const stf_nearest_point *m, SUNMatrix K)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(m->sparse);
  const size_t entries = (size_t)ptr[m->columns];
  memcpy(SM_INDEXPTRS_S(K), ptr, (m->columns + 1) * sizeof *ptr);
  memcpy(SM_INDEXVALS_S(K), SM_INDEXVALS_S(m->sparse), entries * sizeof *ptr);
  memcpy(SM_DATA_S(K), m->augmented->value, entries * sizeof(sunrealtype));
}

/* Columns I, A first; then A^T, -d: column i of A^T takes its places as columns of A are read. */
static void fill_whole(const stf_nearest_point *m, SUNMatrix K)
{
  const augmented *a = m->augmented;
  const sunindextype *ptr = SM_INDEXPTRS_S(m->sparse), *row = SM_INDEXVALS_S(m->sparse);
  const sunindextype columns = (sunindextype)m->columns, rows = (sunindextype)m->rows;
  sunindextype *start = SM_INDEXPTRS_S(K), *index = SM_INDEXVALS_S(K), used = 0;
  sunrealtype *x = SM_DATA_S(K);
  for (sunindextype i = 0; i <= rows; i++) a->next[i] = 0;
  for (sunindextype j = 0; j < columns; j++) {
    start[j] = used;
    index[used] = j, x[used++] = 1;
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) {
      index[used] = columns + row[k], x[used++] = a->value[k];
      a->next[row[k]]++;
    }
  }
  for (sunindextype i = 0; i < rows; i++) {
    const sunindextype count = a->next[i];
    start[columns + i] = a->next[i] = used;
    used += count;
    index[used] = columns + i;
    x[used++] = m->left[i] > 0 ? (a->dependent ? -shifted : 0) : 1;
  }
  start[columns + rows] = used;
  for (sunindextype j = 0; j < columns; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) {
      const sunindextype to = a->next[row[k]]++;
      index[to] = j, x[to] = a->value[k];
    }
}

static int open_system(stf_nearest_point *m, linear_system *s, size_t order, size_t room)
{
  stf_pool *pool = m->augmented->pool;
  s->order = order;
  STEIF_TRY(matrix(pool, m->ctx, order, order, room, &s->K));
  STEIF_TRY(matrix(pool, m->ctx, order, order, 1, &s->zero));
  memset(SM_INDEXPTRS_S(s->zero), 0, (order + 1) * sizeof(sunindextype));
  s->x = N_VNew_Serial((sunindextype)order, steif_sundials(m->ctx));
  STEIF_CHECK(s->x, m->ctx, STEIF_NO_MEMORY, "no memory for a vector of %zu components", order);
  return stf_pool_adopt(pool, s->x, destroy_vector);
}

/* Pencils are made of filled matrices. */
static int factor_system(stf_nearest_point *m, linear_system *s)
{
  if (s->pencil) {
    STEIF_TRY(steif_pencil_update(s->pencil));
  } else {
    s->pencil = steif_pencil_new(m->ctx, s->K, s->zero);
    if (!s->pencil) return steif_status(m->ctx);
    STEIF_TRY(stf_pool_adopt(m->augmented->pool, s->pencil, destroy_pencil));
  }
  return steif_pencil_factor(s->pencil, 1, &(steif_shift){1, 0});
}

static int factor_now(stf_nearest_point *m)
{
  augmented *a = m->augmented;
  const bool square = m->rows == m->columns && !a->dependent;
  linear_system *s = a->now = square ? &a->square : &a->whole;
  const size_t order = square ? m->rows : m->rows + m->columns;
  if (!s->K)
    STEIF_TRY(open_system(m, s, order, square ? m->entries + 1 : 2 * m->entries + order));
  (square ? fill_square : fill_whole)(m, s->K);
  return factor_system(m, s);
}

/* rest -= K x */
static void subtract(const augmented *a, const sunrealtype *x, sunrealtype *rest)
{
  const SUNMatrix K = a->now->K;
  for (size_t j = 0; j < a->now->order; j++)
    for (sunindextype k = SM_INDEXPTRS_S(K)[j]; k < SM_INDEXPTRS_S(K)[j + 1]; k++)
      rest[SM_INDEXVALS_S(K)[k]] -= SM_DATA_S(K)[k] * x[j];
}

/* b becomes K^{-1} b, refined once. */
static int solve(augmented *a, sunrealtype *b)
{
  linear_system *s = a->now;
  const size_t bytes = s->order * sizeof *b;
  sunrealtype *x = stf_array(s->x);
  memcpy(a->rest, b, bytes);
  memset(b, 0, bytes);
  for (int k = 0; k < 2; k++) {
    memcpy(x, a->rest, bytes);
    STEIF_TRY(steif_pencil_solve(s->pencil, 0, 1, &s->x, NULL));
    for (size_t i = 0; i < s->order; i++) b[i] += x[i];
    if (k == 0) subtract(a, x, a->rest);
  }
  return STEIF_OK;
}

/* Is a vector of ones, of mu or of x alone, found from its right-hand side? */
static int probe(stf_nearest_point *m, bool *independent)
{
  augmented *a = m->augmented;
  linear_system *s = a->now;
  sunrealtype *x = stf_array(s->x), worst = 0;
  unsigned seed = 4711;
  for (size_t i = 0; i < s->order; i++) {
    x[i] = s->order > m->rows && i < m->columns ? 0 : 1 + 0.5 * stf_point_random(&seed);
    a->b[i] = 0;
  }
  subtract(a, x, a->b);
  STEIF_TRY(solve(a, a->b));
  seed = 4711;
  for (size_t i = 0; i < s->order; i++) {
    const bool zero = s->order > m->rows && i < m->columns;
    const sunrealtype known = zero ? 0 : 1 + 0.5 * stf_point_random(&seed);
    const sunrealtype off = fabs(a->b[i] + known);
    if (!(off <= worst)) worst = off;
  }
  *independent = worst < found_to;
  return STEIF_OK;
}

static size_t rows_with_entries(const stf_nearest_point *m)
{
  size_t count = 0;
  for (size_t i = 0; i < m->rows; i++) count += m->left[i] > 0;
  return count;
}

static int factor(stf_nearest_point *m)
{
  augmented *a = m->augmented;
  bool independent = false;
  scale(m);
  m->rank = rows_with_entries(m);
  m->rcond = 1;
  a->dependent = m->rank < m->rows;
  int code = a->dependent ? STEIF_SINGULAR : factor_now(m);
  if (!code) code = probe(m, &independent);
  if (code && code != STEIF_SINGULAR) return code;
  if (!code && independent) return STEIF_OK;
  if (code) steif_forget(m->ctx);
  a->dependent = true;
  m->rank = m->rank < m->rows ? m->rank : m->rows - 1;
  m->rcond = 0;
  return factor_now(m);
}

static sunrealtype pull(const stf_nearest_point *m, size_t j)
{
  return m->unpulled || isnan(m->target[j]) ? 0 : m->target[j] - m->z[j];
}

static int direction(stf_nearest_point *m, sunrealtype *dz)
{
  augmented *a = m->augmented;
  const size_t before = a->now->order - m->rows;
  for (size_t j = 0; j < before; j++) a->b[j] = m->weight[j] * pull(m, j);
  for (size_t i = 0; i < m->rows; i++) a->b[before + i] = -m->left[i] * m->r[i];
  STEIF_TRY(solve(a, a->b));
  for (size_t j = 0; j < m->columns; j++) dz[j] = a->b[j] / m->weight[j];
  return STEIF_OK;
}

static sunrealtype merit(const stf_nearest_point *m, const sunrealtype *r)
{
  sunrealtype sum = 0;
  for (size_t i = 0; i < m->rows; i++) sum += m->left[i] * r[i] * m->left[i] * r[i];
  return sqrt(sum);
}

const stf_nearest_solver stf_nearest_sparse = {open, factor, direction, merit};

int stf_nearest_null_vector(stf_nearest_point *m, sunrealtype *v)
{
  augmented *a = m->augmented;
  unsigned seed = 99;
  memset(v, 0, m->columns * sizeof *v);
  if (!a || a->now != &a->whole || m->rows != m->columns) return STEIF_OK;
  memset(a->b, 0, a->now->order * sizeof *a->b);
  for (size_t j = 0; j < m->columns; j++) a->b[j] = stf_point_random(&seed);
  STEIF_TRY(solve(a, a->b));
  for (size_t j = 0; j < m->columns; j++) v[j] = a->b[j] / m->weight[j];
  return STEIF_OK;
}
