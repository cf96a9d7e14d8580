/* dense_algebra.c: what dense analyses share: products, singular values, scaling by powers of 2,
 * and the resolvent of a pencil at random points. LAPACK Users' Guide, 3rd ed. (1999).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_algebra.h"
#include "dense_thresholds.h"
#include "lapack.h"
#include "scaling.h"
#include <math.h>
#include <string.h>

void stf_gemm(char opA, char opB, int m, int n, int k, sunrealtype alpha, const sunrealtype *A,
              int lda, const sunrealtype *B, int ldb, sunrealtype beta, sunrealtype *C, int ldc)
{
  if (m > 0 && n > 0)
    dgemm_(&opA, &opB, &m, &n, &k, &alpha, A, &lda, B, &ldb, &beta, C, &ldc, 1, 1);
}

sunrealtype stf_length(int n, const sunrealtype *x)
{
  sunrealtype most = 0, sum = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  if (!(most > 0)) return most;
  for (int i = 0; i < n; i++) sum += x[i] / most * (x[i] / most);
  return most * sqrt(sum);
}

sunrealtype stf_frobenius(int m, int n, const sunrealtype *A, int lda)
{
  sunrealtype norm = 0;
  for (int j = 0; j < n; j++) norm = hypot(norm, stf_length(m, A + (size_t)j * (size_t)lda));
  return norm;
}

sunrealtype *stf_pool_square(stf_pool *pool, int n)
{
  return stf_pool_array(pool, (size_t)n * (size_t)n, sizeof(sunrealtype));
}

int stf_svd_open(steif_context *ctx, stf_pool *pool, int n, stf_svd *svd)
{
  *svd = (stf_svd){.ctx = ctx, .n = n, .lwork = -1};
  sunrealtype best;
  int info;
  dgesdd_("A", &n, &n, NULL, &n, NULL, NULL, &n, NULL, &n, &best, &svd->lwork, NULL, &info, 1);
  STEIF_CHECK(info == 0, ctx, STEIF_UNSUPPORTED,
              "LAPACK's dgesdd does not take order %d: its integers are too short", n);
  svd->lwork = (int)best;
  svd->block = stf_pool_square(pool, n);
  svd->U = stf_pool_square(pool, n);
  svd->VT = stf_pool_square(pool, n);
  svd->sigma = stf_pool_array(pool, (size_t)n, sizeof *svd->sigma);
  svd->work = stf_pool_array(pool, (size_t)svd->lwork, sizeof *svd->work);
  svd->iwork = stf_pool_array(pool, 8 * (size_t)n, sizeof *svd->iwork);
  const bool got = svd->block && svd->U && svd->VT && svd->sigma && svd->work && svd->iwork;
  return got ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_svd_find(stf_svd *svd, int m, int k, const sunrealtype *A, int lda, bool vectors)
{
  const int n = svd->n;
  int info;
  for (int j = 0; j < k; j++)
    memcpy(svd->block + (size_t)j * (size_t)n, A + (size_t)j * (size_t)lda,
           (size_t)m * sizeof *A);
  dgesdd_(vectors ? "A" : "N", &m, &k, svd->block, &n, svd->sigma, svd->U, &n, svd->VT, &n,
          svd->work, &svd->lwork, svd->iwork, &info, 1);
  STEIF_CHECK(info == 0, svd->ctx, STEIF_NO_CONVERGENCE,
              "singular values of a %d x %d block did not converge (dgesdd: info = %d): scale "
              "the equations",
              m, k, info);
  return STEIF_OK;
}

/* G. L. Steele, D. Lea, S. Flood, Fast splittable pseudorandom number generators (2014). */
sunrealtype stf_draw(uint64_t *state)
{
  uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (sunrealtype)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

static sunrealtype largest(size_t count, const sunrealtype *A)
{
  sunrealtype most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(A[i]));
  return most;
}

/* max |F| / max |E|, the size of s where both parts weigh the same. */
static sunrealtype ratio(int n, const sunrealtype *E, const sunrealtype *F)
{
  const size_t count = (size_t)n * (size_t)n;
  const sunrealtype e = largest(count, E), f = largest(count, F);
  return e > 0 && f > 0 && isfinite(f / e) && f / e > 0 ? f / e : 1;
}

/* Rows and columns so near to each other are left as they are: scales would turn integers into
 * fractions and gain three digits at most. */
static const sunrealtype even = 0x1p10;

static void scale(int n, int count, const stf_summand *summand, sunrealtype *row,
                  sunrealtype *column, sunrealtype *work)
{
  stf_scales s = {.n = n, .row = row, .column = column, .largest = work, .even = even};
  stf_scaling_largest(&s, count, summand);
}

void stf_balance(int n, const sunrealtype *E, const sunrealtype *F, sunrealtype *row,
                 sunrealtype *column, sunrealtype *work)
{
  scale(n, 2, (stf_summand[]){{NULL, NULL, E, ratio(n, E, F)}, {NULL, NULL, F, 1}}, row, column,
        work);
}

/* s of three sizes about max |F| / max |E|, where the resolvent is looked at. */
enum { SAMPLES = 3 };
static void samples(int n, const sunrealtype *E, const sunrealtype *F, unsigned seed,
                    sunrealtype *s)
{
  static const sunrealtype size[SAMPLES] = {0.37, 1.91, 7.3};
  uint64_t state = seed;
  for (int i = 0; i < SAMPLES; i++) {
    const sunrealtype draw = stf_draw(&state), near = 1 + 0.05 * stf_draw(&state);
    s[i] = (draw < 0 ? -size[i] : size[i]) * near * ratio(n, E, F);
  }
}

/* S = s E + F, its rows and columns scaled by powers of 2. */
static void resolvent(int n, sunrealtype s, const sunrealtype *E, const sunrealtype *F,
                      sunrealtype *row, sunrealtype *column, sunrealtype *work, sunrealtype *S)
{
  const size_t count = (size_t)n * (size_t)n;
  for (size_t i = 0; i < count; i++) S[i] = s * E[i] + F[i];
  scale(n, 1, &(stf_summand){NULL, NULL, S, 1}, row, column, work);
  for (size_t i = 0; i < count; i++) S[i] *= row[i % (size_t)n] * column[i / (size_t)n];
}

/* rcond in the 1-norm; 0 when a pivot is 0. */
static sunrealtype reciprocal(int n, sunrealtype *S, int *pivot, sunrealtype *work, int *iwork)
{
  sunrealtype norm = 0, rcond = 0;
  int info;
  for (int j = 0; j < n; j++) {
    sunrealtype sum = 0;
    for (int i = 0; i < n; i++) sum += fabs(S[(size_t)j * (size_t)n + (size_t)i]);
    norm = fmax(norm, sum);
  }
  dgetrf_(&n, &n, S, &n, pivot, &info);
  if (info == 0) dgecon_("1", &n, S, &n, &norm, &rcond, work, iwork, &info, 1);
  return info == 0 ? rcond : 0;
}

int stf_best_rcond(stf_pool *pool, int n, const sunrealtype *E, const sunrealtype *F,
                   unsigned seed, sunrealtype *rcond)
{
  const size_t m = (size_t)n;
  sunrealtype s[SAMPLES], *S = stf_pool_square(pool, n);
  sunrealtype *work = stf_pool_array(pool, 8 * m, sizeof *work);
  int *integers = stf_pool_array(pool, 2 * m, sizeof *integers);
  if (!S || !work || !integers) return STEIF_NO_MEMORY;
  samples(n, E, F, seed, s);
  *rcond = 0;
  for (int i = 0; i < SAMPLES; i++) {
    resolvent(n, s[i], E, F, work, work + m, work + 2 * m, S);
    *rcond = fmax(*rcond, reciprocal(n, S, integers, work + 4 * m, integers + m));
  }
  return STEIF_OK;
}

int stf_list_large(steif_context *ctx, int n, const sunrealtype *x, sunindextype *count,
                   sunindextype **list)
{
  const sunrealtype least = STF_NAMED_PART * largest((size_t)n, x);
  *count = 0;
  for (int i = 0; i < n; i++) *count += x[i] >= least && x[i] > 0;
  const int code = stf_structure_list(ctx, *count, list);
  if (code != STEIF_OK) *count = 0;
  for (int i = 0, k = 0; code == STEIF_OK && i < n; i++)
    if (x[i] >= least && x[i] > 0) (*list)[k++] = i;
  return code;
}

int stf_null_offenders(steif_context *ctx, stf_svd *svd, int n, const sunrealtype *E,
                       const sunrealtype *F, unsigned seed, sunrealtype *work,
                       steif_structure *structure)
{
  const size_t m = (size_t)n;
  sunrealtype s[SAMPLES], *left = work, *right = work + m, *S = svd->U;
  samples(n, E, F, seed, s);
  resolvent(n, s[1], E, F, left, right, work + 2 * m, S);
  STEIF_TRY(stf_svd_find(svd, n, n, S, n, true));
  const sunrealtype null =
    fmax(svd->sigma[n - 1], STF_NULL_NOISE * n * STF_EPS * svd->sigma[0]);
  for (int i = 0; i < n; i++) left[i] = right[i] = 0;
  for (int k = 0; k < n; k++) {
    if (svd->sigma[k] > null) continue;
    for (int i = 0; i < n; i++) {
      left[i] = fmax(left[i], fabs(svd->U[(size_t)k * m + (size_t)i]));
      right[i] = fmax(right[i], fabs(svd->VT[(size_t)i * m + (size_t)k]));
    }
  }
  STEIF_TRY(stf_list_large(ctx, n, left, &structure->equations_count, &structure->equations));
  return stf_list_large(ctx, n, right, &structure->unknowns_count, &structure->unknowns);
}
