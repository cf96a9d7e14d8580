/* scaled.c: the pencil s E + F equilibrated by powers of two, and its refined solves. Refinement
 * makes the backward error small entry by entry (R. D. Skeel, Math. Comp. 35, 1980): it keeps the
 * zero blocks that carry the index, which the error of a plain LU does not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SWEEPS = 6 };

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

/* to = sign scale(from); adds size times the column sums. */
static void scale(const stf_scaled *s, SUNMatrix from, sunrealtype sign, sunrealtype size,
                  SUNMatrix to)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(from), *row = SM_INDEXVALS_S(from);
  const sunrealtype *value = SM_DATA_S(from);
  sunrealtype *out = SM_DATA_S(to);
  for (sunindextype j = 0; j < s->n; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) {
      out[k] = sign * value[k] * s->row[row[k]] * s->column[j];
      s->most[j] += size * fabs(out[k]);
    }
}

int stf_scaled_set(stf_scaled *s, sunrealtype size)
{
  equilibrate(s, size);
  memset(s->most, 0, (size_t)s->n * sizeof *s->most);
  scale(s, s->givenE, 1, size, s->E);
  scale(s, s->givenF, -1, 1, s->A);
  s->norm = 0;
  for (sunindextype j = 0; j < s->n; j++) s->norm = fmax(s->norm, s->most[j]);
  return steif_pencil_update(s->pencil);
}

/* r -= (a + i b) M x. */
static void subtract(const stf_scaled *s, SUNMatrix M, steif_shift a, const N_Vector x[2],
                     N_Vector r[2])
{
  const sunindextype *restrict ptr = SM_INDEXPTRS_S(M), *restrict row = SM_INDEXVALS_S(M);
  const sunrealtype *restrict value = SM_DATA_S(M), *restrict xr = NV_DATA_S(x[0]),
                              *restrict xi = x[1] ? NV_DATA_S(x[1]) : NULL;
  sunrealtype *restrict rr = NV_DATA_S(r[0]), *restrict ri = xi ? NV_DATA_S(r[1]) : NULL;
  for (sunindextype j = 0; j < s->n; j++) {
    const sunrealtype re = a.re * xr[j] - (xi ? a.im * xi[j] : 0);
    const sunrealtype im = xi ? a.re * xi[j] + a.im * xr[j] : 0;
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) {
      rr[row[k]] -= value[k] * re;
      if (ri) ri[row[k]] -= value[k] * im;
    }
  }
}

int stf_scaled_solve(stf_scaled *s, int k, steif_shift at, int refinements, const N_Vector b[2],
                     N_Vector x[2], N_Vector r[2])
{
  const int parts = b[1] ? 2 : 1;
  const size_t bytes = (size_t)s->n * sizeof(sunrealtype);
  for (int c = 0; c < parts; c++) memcpy(NV_DATA_S(x[c]), NV_DATA_S(b[c]), bytes);
  STEIF_TRY(steif_pencil_solve(s->pencil, k, 1, x, parts > 1 ? x + 1 : NULL));
  for (int sweep = 0; sweep < refinements; sweep++) {
    for (int c = 0; c < parts; c++) memcpy(NV_DATA_S(r[c]), NV_DATA_S(b[c]), bytes);
    subtract(s, s->E, at, x, r);
    subtract(s, s->A, (steif_shift){-1, 0}, x, r);
    STEIF_TRY(steif_pencil_solve(s->pencil, k, 1, r, parts > 1 ? r + 1 : NULL));
    for (int c = 0; c < parts; c++)
      for (sunindextype i = 0; i < s->n; i++) NV_Ith_S(x[c], i) += NV_Ith_S(r[c], i);
  }
  return STEIF_OK;
}
