/* refined_factor.c: s E + F_y or the system Jacobian, equilibrated by powers of two and factored
 * with its transpose; solutions are refined twice, the condition is estimated from a few
 * of them. W. W. Hager, SIAM J. Sci. Stat. Comput. 5 (1984) 311-316.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "refined_factor.h"
#include "scaling.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { REFINEMENTS = 2, ESTIMATES = 6 };

struct stf_factor {
  stf_point *point;
  stf_pool *pool;
  size_t n;
  SUNMatrix P[2], zero[2]; /* the matrix and its transpose */
  steif_pencil *pencil[2];
  sunindextype *place;       /* of entry k in the transpose */
  sunrealtype *left, *right; /* rows and columns are multiplied with these */
  sunrealtype *work;         /* 3 n */
  N_Vector x;
};

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static void destroy_pencil(void *p)
{
  steif_pencil *pencil = p;
  steif_pencil_free(&pencil);
}

/* Pattern of the view, or of its transpose, into M. */
static void set_pattern(const stf_view *v, bool transposed, SUNMatrix M, sunindextype *place)
{
  sunindextype *ptr = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M);
  const sunindextype n = (sunindextype)v->n, nnz = v->column[n];
  if (!transposed) {
    memcpy(ptr, v->column, (v->n + 1) * sizeof *ptr);
    memcpy(row, v->row, (size_t)nnz * sizeof *row);
    return;
  }
  memset(ptr, 0, (v->n + 1) * sizeof *ptr);
  for (sunindextype k = 0; k < nnz; k++) ptr[v->row[k] + 1]++;
  for (sunindextype i = 0; i < n; i++) ptr[i + 1] += ptr[i];
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      const sunindextype to = ptr[v->row[k]]++;
      row[to] = j;
      if (place) place[k] = to;
    }
  for (sunindextype i = n; i > 0; i--) ptr[i] = ptr[i - 1];
  ptr[0] = 0;
}

static int matrix(stf_factor *f, const stf_view *v, bool transposed, SUNMatrix *M,
                  sunindextype *place)
{
  const sunindextype n = (sunindextype)v->n, nnz = v->column[v->n];
  *M = SUNSparseMatrix(n, n, nnz > 0 ? nnz : 1, CSC_MAT, steif_sundials(f->point->ctx));
  STEIF_CHECK(*M, f->point->ctx, STEIF_NO_MEMORY, "no memory for a matrix of %lld entries",
              (long long)nnz);
  STEIF_TRY(stf_pool_adopt(f->pool, *M, destroy_matrix));
  set_pattern(v, transposed, *M, place);
  memset(SUNSparseMatrix_Data(*M), 0, (size_t)nnz * sizeof(sunrealtype));
  return STEIF_OK;
}

static int open(stf_factor *f, const stf_view *v)
{
  const size_t n = v->n;
  f->n = n;
  f->place = stf_pool_array(f->pool, (size_t)v->column[n] + 1, sizeof *f->place);
  f->left = stf_pool_array(f->pool, 5 * n, sizeof *f->left);
  f->x = stf_pool_vector(f->pool, f->point->y);
  if (!f->place || !f->left || !f->x) return STEIF_NO_MEMORY;
  f->right = f->left + n, f->work = f->left + 2 * n;
  for (int k = 0; k < 2; k++) {
    STEIF_TRY(matrix(f, v, k, &f->P[k], k ? f->place : NULL));
    STEIF_TRY(matrix(f, v, k, &f->zero[k], NULL));
    f->pencil[k] = steif_pencil_new(f->point->ctx, f->P[k], f->zero[k]);
    if (!f->pencil[k]) return steif_status(f->point->ctx);
    STEIF_TRY(stf_pool_adopt(f->pool, f->pencil[k], destroy_pencil));
  }
  return STEIF_OK;
}

int stf_factor_open(stf_point *point, const stf_view *view, stf_factor **factor)
{
  *factor = NULL;
  stf_pool *pool = stf_pool_new(point->ctx);
  stf_factor *f = pool ? stf_pool_array(pool, 1, sizeof *f) : NULL;
  if (!f) {
    stf_pool_free(&pool);
    return STEIF_NO_MEMORY;
  }
  f->point = point, f->pool = pool;
  const int code = open(f, view);
  if (code)
    stf_pool_free(&pool);
  else
    *factor = f;
  return code;
}

void stf_factor_free(stf_factor **f)
{
  if (!*f) return;
  stf_pool *pool = (*f)->pool; /* which holds *f itself */
  *f = NULL;
  stf_pool_free(&pool);
}

/* P <- diag(row) P diag(column), rows and columns near to one size. False: one of them is empty. */
static bool equilibrate(stf_factor *f)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(f->P[0]), *row = SM_INDEXVALS_S(f->P[0]);
  sunrealtype *x = SM_DATA_S(f->P[0]), *column = f->work;
  for (size_t j = 0; j < f->n; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) x[k] *= f->right[j];
  stf_scales s = {.n = (sunindextype)f->n, .row = f->left, .column = column};
  s.largest = column + f->n;
  stf_scaling_largest(&s, 1, &(stf_summand){ptr, row, x, 1});
  if (s.empty) return false;
  for (size_t j = 0; j < f->n; j++) {
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) x[k] *= f->left[row[k]] * column[j];
    f->right[j] *= column[j];
  }
  return true;
}

static int factor_one(stf_factor *f, int which)
{
  STEIF_TRY(steif_pencil_update(f->pencil[which]));
  return steif_pencil_factor(f->pencil[which], 1, &(steif_shift){1, 0});
}

static int factor(stf_factor *f)
{
  const sunindextype nnz = SM_INDEXPTRS_S(f->P[0])[f->n];
  if (!equilibrate(f)) return STEIF_SINGULAR;
  for (sunindextype k = 0; k < nnz; k++)
    SM_DATA_S(f->P[1])[f->place[k]] = SM_DATA_S(f->P[0])[k];
  STEIF_TRY(factor_one(f, 0));
  return factor_one(f, 1);
}

static void sum(stf_factor *f, const stf_view *v, sunrealtype s)
{
  memcpy(f->right, f->point->size, f->n * sizeof *f->right);
  for (sunindextype k = 0; k < v->column[f->n]; k++)
    SM_DATA_S(f->P[0])[k] = s * v->e[k] + v->b[k];
}

int stf_factor_shift(stf_factor *f, const stf_view *v, sunrealtype s)
{
  sum(f, v, s);
  return factor(f);
}

/* Pivots that vanish exactly hide the null vector, which rounding of the entries shows. */
int stf_factor_lost(stf_factor *f, const stf_view *v, sunrealtype s, bool rounded,
                    sunrealtype *work, sunrealtype *part)
{
  const size_t nnz = (size_t)v->column[f->n];
  const stf_shifted M = {v, s, f->left, f->right};
  sunrealtype *x = SM_DATA_S(f->P[0]);
  unsigned seed = 4099u;
  sum(f, v, s);
  if (!equilibrate(f)) return STEIF_SINGULAR;
  for (size_t k = 0; rounded && k < nnz; k++) x[k] *= 1 + 4 * STF_EPS * stf_point_random(&seed);
  STEIF_TRY(factor_one(f, 0));
  return stf_lost_part(f->pencil[0], &M, f->x, work, part);
}

int stf_factor_jacobian(stf_factor *f, const stf_view *v, const int *c, const int *d)
{
  sunrealtype slow, fast;
  stf_view_rates(f->point, v, &slow, &fast);
  const sunrealtype rate = exp2(round(0.5 * log2(slow * fast)));
  for (size_t j = 0; j < f->n; j++) {
    f->right[j] = f->point->size[j] * pow(rate, d[j]);
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      const int order = d[j] - c[v->row[k]];
      SM_DATA_S(f->P[0])[k] = order == 1 ? v->e[k] : order == 0 ? v->b[k] : 0;
    }
  }
  return factor(f);
}

/* r -= P x for the equilibrated matrix or its transpose. */
static void subtract(const stf_factor *f, int which, const sunrealtype *x, sunrealtype *r)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(f->P[which]), *row = SM_INDEXVALS_S(f->P[which]);
  const sunrealtype *p = SM_DATA_S(f->P[which]);
  for (size_t j = 0; j < f->n; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) r[row[k]] -= p[k] * x[j];
}

static int solve(stf_factor *f, int which, const sunrealtype *b, sunrealtype *x)
{
  const size_t bytes = f->n * sizeof *x;
  sunrealtype *v = stf_array(f->x);
  memset(x, 0, bytes);
  for (int k = 0; k <= REFINEMENTS; k++) {
    memcpy(v, b, bytes);
    if (k) subtract(f, which, x, v);
    STEIF_TRY(steif_pencil_solve(f->pencil[which], 0, 1, &f->x, NULL));
    for (size_t i = 0; i < f->n; i++) x[i] += v[i];
  }
  return STEIF_OK;
}

int stf_factor_solve(stf_factor *f, bool transposed, sunrealtype *x)
{
  const sunrealtype *in = transposed ? f->right : f->left,
                    *out = transposed ? f->left : f->right;
  sunrealtype *b = f->work, *z = f->work + f->n;
  for (size_t i = 0; i < f->n; i++) b[i] = in[i] * x[i];
  STEIF_TRY(solve(f, transposed, b, z));
  for (size_t i = 0; i < f->n; i++) x[i] = out[i] * z[i];
  return STEIF_OK;
}

static sunrealtype norm(const stf_factor *f)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(f->P[0]);
  sunrealtype largest = 0;
  for (size_t j = 0; j < f->n; j++) {
    sunrealtype sum = 0;
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) sum += fabs(SM_DATA_S(f->P[0])[k]);
    largest = fmax(largest, sum);
  }
  return largest;
}

/* ||P^{-1}||_1 = max over the vertices of the unit ball: climb along the gradient. */
int stf_factor_rcond(stf_factor *f, sunrealtype *rcond)
{
  const size_t n = f->n;
  sunrealtype *x = f->work, *z = f->work + n, best = 0;
  for (size_t i = 0; i < n; i++) x[i] = 1.0 / (sunrealtype)n;
  for (int round = 0; round < ESTIMATES; round++) {
    STEIF_TRY(solve(f, 0, x, z));
    sunrealtype sum = 0;
    for (size_t i = 0; i < n; i++) sum += fabs(z[i]), x[i] = z[i] < 0 ? -1 : 1;
    if (!isfinite(sum)) {
      *rcond = 0;
      return STEIF_OK;
    }
    if (sum <= best) break;
    best = sum;
    STEIF_TRY(solve(f, 1, x, z));
    size_t at = 0;
    for (size_t i = 1; i < n; i++)
      if (fabs(z[i]) > fabs(z[at])) at = i;
    memset(x, 0, n * sizeof *x);
    x[at] = 1;
  }
  *rcond = best > 0 ? 1 / (best * norm(f)) : 0;
  return STEIF_OK;
}
