/* scaled.c: the pencil s E + F equilibrated by powers of two, and its refined solves. Refinement
 * makes the backward error small entry by entry (R. D. Skeel, Math. Comp. 35, 1980): it keeps the
 * zero blocks that carry the index, which the error of a plain LU does not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include "pencil.h"
#include "scaling.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

sunrealtype stf_largest(SUNMatrix M)
{
  sunrealtype most = 0;
  for (sunindextype k = 0; k < SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)]; k++)
    most = fmax(most, fabs(SM_DATA_S(M)[k]));
  return most;
}

static void destroy_matrix(void *M) { SUNMatDestroy(M); }
static void destroy_vector(void *v) { N_VDestroy(v); }

static void destroy_pencil(void *p)
{
  steif_pencil *pencil = p;
  steif_pencil_free(&pencil);
}

static int copy(stf_scaled *s, SUNMatrix given, SUNMatrix *out)
{
  const sunindextype n = s->n, used = SM_INDEXPTRS_S(given)[n];
  SUNMatrix M = SUNSparseMatrix(n, n, used > 0 ? used : 1, CSC_MAT, steif_sundials(s->ctx));
  STEIF_CHECK(M, s->ctx, STEIF_NO_MEMORY, "no memory for a scaled copy of %lld entries",
              (long long)used);
  STEIF_TRY(stf_pool_adopt(s->pool, M, destroy_matrix));
  memcpy(SM_INDEXPTRS_S(M), SM_INDEXPTRS_S(given), (size_t)(n + 1) * sizeof(sunindextype));
  memcpy(SM_INDEXVALS_S(M), SM_INDEXVALS_S(given), (size_t)used * sizeof(sunindextype));
  *out = M;
  return STEIF_OK;
}

static int fill(stf_scaled *s)
{
  const size_t n = (size_t)s->n;
  if (!(s->pool = stf_pool_new(s->ctx))) return STEIF_NO_MEMORY;
  STEIF_TRY(copy(s, s->givenE, &s->E));
  STEIF_TRY(copy(s, s->givenF, &s->A));
  s->row = stf_pool_array(s->pool, n, sizeof *s->row);
  s->column = stf_pool_array(s->pool, n, sizeof *s->column);
  s->most = stf_pool_array(s->pool, 2 * n, sizeof *s->most);
  if (!s->row || !s->column || !s->most) return STEIF_NO_MEMORY;
  s->like = N_VNewEmpty_Serial(s->n, steif_sundials(s->ctx));
  STEIF_CHECK(s->like, s->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  STEIF_TRY(stf_pool_adopt(s->pool, s->like, destroy_vector));
  s->pencil = steif_pencil_new(s->ctx, s->E, s->A);
  if (!s->pencil) return steif_status(s->ctx);
  return stf_pool_adopt(s->pool, s->pencil, destroy_pencil);
}

int stf_scaled_open(steif_context *ctx, SUNMatrix E, SUNMatrix F, stf_scaled *s)
{
  *s = (stf_scaled){.ctx = ctx, .n = SM_COLUMNS_S(F), .givenE = E, .givenF = F};
  const int code = fill(s);
  if (code) stf_scaled_close(s);
  return code;
}

void stf_scaled_close(stf_scaled *s) { stf_pool_free(&s->pool); }

static stf_summand entries(SUNMatrix M, sunrealtype factor)
{
  return (stf_summand){SM_INDEXPTRS_S(M), SM_INDEXVALS_S(M), SM_DATA_S(M), factor};
}

static void equilibrate(stf_scaled *s, sunrealtype size)
{
  stf_scales scales = {.n = s->n, .row = s->row, .column = s->column, .largest = s->most};
  stf_scaling_largest(&scales, 2,
                      (stf_summand[]){entries(s->givenE, size), entries(s->givenF, 1)});
  s->log_scale = scales.bits * log(2);
}

/* to = sign scale(from); returns the largest column sum. */
static sunrealtype scale(const stf_scaled *s, SUNMatrix from, sunrealtype sign, SUNMatrix to)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(from), *row = SM_INDEXVALS_S(from);
  const sunrealtype *value = SM_DATA_S(from);
  sunrealtype *out = SM_DATA_S(to), most = 0;
  for (sunindextype j = 0; j < s->n; j++) {
    sunrealtype sum = 0;
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) {
      out[k] = sign * value[k] * s->row[row[k]] * s->column[j];
      sum += fabs(out[k]);
    }
    if (sum > most) most = sum;
  }
  return most;
}

int stf_scaled_set(stf_scaled *s, sunrealtype size)
{
  if (s->size > 0 && size <= STF_SCALES_SERVE * s->size && s->size <= STF_SCALES_SERVE * size)
    return STEIF_OK;
  equilibrate(s, size);
  s->norm[0] = scale(s, s->givenE, 1, s->E);
  s->norm[1] = scale(s, s->givenF, -1, s->A);
  s->size = size;
  return steif_pencil_update(s->pencil);
}

static bool holds(const stf_scaled *s, SUNMatrix from, sunrealtype sign, SUNMatrix to)
{
  const sunindextype n = s->n, *ptr = SM_INDEXPTRS_S(to), *row = SM_INDEXVALS_S(to);
  const sunrealtype *value = SM_DATA_S(from), *out = SM_DATA_S(to);
  if (memcmp(SM_INDEXPTRS_S(from), ptr, (size_t)(n + 1) * sizeof *ptr)) return false;
  if (memcmp(SM_INDEXVALS_S(from), row, (size_t)ptr[n] * sizeof *row)) return false;
  bool same = true;
  for (sunindextype j = 0; j < n && same; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
      same &= out[k] == sign * value[k] * s->row[row[k]] * s->column[j];
  return same;
}

bool stf_scaled_adopt(stf_scaled *s, SUNMatrix E, SUNMatrix F)
{
  if (!(s->size > 0) || s->n != SM_COLUMNS_S(E) || s->n != SM_COLUMNS_S(F)) return false;
  if (!holds(s, E, 1, s->E) || !holds(s, F, -1, s->A)) return false;
  s->givenE = E;
  s->givenF = F;
  return true;
}

void stf_scaled_direct(stf_scaled *s, int k, sunrealtype *b)
{
  stf_sparse_direct(s->pencil, k, b);
  s->pencil->stats.solves++;
}

bool stf_scaled_refine(stf_scaled *s, int k, bool anyway, sunrealtype *x, sunrealtype *r)
{
  const sunindextype length = stf_is_complex(s->pencil->shift[k]) ? 2 * s->n : s->n;
  const sunrealtype error = stf_sparse_residual(s->pencil, k, x, r, s->most);
  if (!anyway && error <= STF_STEADY) return false;
  stf_scaled_direct(s, k, r);
  for (sunindextype i = 0; i < length; i++) x[i] += r[i];
  return true;
}
