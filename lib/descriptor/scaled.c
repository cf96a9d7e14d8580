/* scaled.c: the pencil s E + F equilibrated by powers of two, and its refined solves. Refinement
 * makes the backward error small entry by entry (R. D. Skeel, Math. Comp. 35, 1980): it keeps the
 * zero blocks that carry the index, which the error of a plain LU does not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include "pencil.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SWEEPS = 6 };

/* Scales serve radii up to this far from the one they were made for. */
#define NEAR 16.0

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
  STEIF_TRY(stf_claim_owner(s->pool, M, destroy_matrix));
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
  s->row = stf_claim(s->pool, n, sizeof *s->row);
  s->column = stf_claim(s->pool, n, sizeof *s->column);
  s->most = stf_claim(s->pool, 2 * n, sizeof *s->most);
  if (!s->row || !s->column || !s->most) return STEIF_NO_MEMORY;
  s->like = N_VNewEmpty_Serial(s->n, steif_sundials(s->ctx));
  STEIF_CHECK(s->like, s->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  STEIF_TRY(stf_claim_owner(s->pool, s->like, destroy_vector));
  s->pencil = steif_pencil_new(s->ctx, s->E, s->A);
  if (!s->pencil) return steif_status(s->ctx);
  return stf_claim_owner(s->pool, s->pencil, destroy_pencil);
}

int stf_scaled_open(steif_context *ctx, SUNMatrix E, SUNMatrix F, stf_scaled *s)
{
  *s = (stf_scaled){.ctx = ctx, .n = SM_COLUMNS_S(F), .givenE = E, .givenF = F};
  const int code = fill(s);
  if (code) stf_scaled_close(s);
  return code;
}

void stf_scaled_close(stf_scaled *s) { stf_pool_free(&s->pool); }

/* Largest size |M_ij| of the rows and columns of M as scaled now. */
static void survey(const stf_scaled *s, SUNMatrix M, sunrealtype size)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M);
  const sunrealtype *value = SM_DATA_S(M);
  sunrealtype *of_row = s->most, *of_column = s->most + s->n;
  for (sunindextype j = 0; j < s->n; j++) {
    const sunrealtype factor = size * s->column[j];
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) {
      const sunrealtype a = fabs(value[k]) * factor * s->row[row[k]];
      if (a > of_row[row[k]]) of_row[row[k]] = a;
      if (a > of_column[j]) of_column[j] = a;
    }
  }
}

/* k with 2^k nearest to 1 / sqrt(x). */
static int half(sunrealtype x)
{
  if ((x > 0.5 && x < 2) || !(x > 0) || !isfinite(x)) return 0;
  return -(int)lround(0.5 * log2(x));
}

static bool multiply(sunrealtype *scale, int k)
{
  if (k) *scale = ldexp(*scale, k);
  return k != 0;
}

/* D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices,
 * RAL-TR-2001-034: both at once by the square roots of the largest entries. The logarithm of the
 * scales' product is a whole number of log 2. */
static void equilibrate(stf_scaled *s, sunrealtype size)
{
  const sunindextype n = s->n;
  sunrealtype twos = 0;
  bool changed = true;
  for (sunindextype i = 0; i < n; i++) s->row[i] = s->column[i] = 1;
  for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
    memset(s->most, 0, 2 * (size_t)n * sizeof *s->most);
    survey(s, s->givenE, size);
    survey(s, s->givenF, 1);
    changed = false;
    for (sunindextype i = 0; i < n; i++) {
      const int k = half(s->most[i]), m = half(s->most[n + i]);
      twos += k + m;
      changed |= multiply(&s->row[i], k);
      changed |= multiply(&s->column[i], m);
    }
  }
  s->log_scale = twos * log(2);
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
  if (s->size > 0 && size <= NEAR * s->size && s->size <= NEAR * size) return STEIF_OK;
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
  s->givenE = E, s->givenF = F;
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
