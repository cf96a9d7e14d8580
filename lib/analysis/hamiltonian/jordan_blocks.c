/* jordan_blocks.c: Jordan blocks of nilpotent matrices by a staircase of null spaces (V. N. Kublanovskaya
 * 1966; G. H. Golub and J. H. Wilkinson, SIAM Review 18, 1976), and null vectors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "cluster.h"
#include "lapack.h"
#include "weyr.h"
#include <math.h>
#include <steif/hamiltonian.h>
#include <string.h>

/* A = U diag(sigma) VT, of which sigma and VT; A, m x m, is overwritten. */
static int decompose(steif_context *ctx, int m, stf_number *A, double *sigma, stf_number *VT)
{
  const int room = 8 * m;
  int info = 0;
  stf_number none, *work = stf_allocate(ctx, (size_t)(room + 3 * m), sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  zgesvd_("N", "A", &m, &m, A, &m, sigma, &none, &m, VT, &m, work, &room,
          (double *)(work + room), &info, 1, 1);
  stf_release(ctx, work);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "singular values of a %d x %d block were not found (zgesvd: %d); rescale A", m, m,
              info);
  return STEIF_OK;
}

int stf_null_vectors(steif_context *ctx, int m, stf_number *A, int count, stf_number *V)
{
  stf_number *VT = stf_allocate(ctx, (size_t)m * (size_t)(m + 1), sizeof *VT);
  if (!VT) return STEIF_NO_MEMORY;
  const int code = decompose(ctx, m, A, (double *)(VT + m * m), VT);
  for (int k = 0; code == STEIF_OK && k < count; k++)
    for (int i = 0; i < m; i++) V[i + m * k] = conj(VT[m - 1 - k + m * i]);
  stf_release(ctx, VT);
  return code;
}

/* B (m x m) becomes V_1^* B V_1 of order `rank`, V_1 the first right singular vectors: what is left of
 * B on the quotient by its null space. C: room for m x m. */
static void deflate(int m, int rank, const stf_number *VT, stf_number *B, stf_number *C)
{
  for (int j = 0; j < rank; j++)
    for (int i = 0; i < m; i++) {
      C[i + m * j] = 0;
      for (int p = 0; p < m; p++) C[i + m * j] += B[i + m * p] * conj(VT[j + m * p]);
    }
  for (int j = 0; j < rank; j++)
    for (int i = 0; i < rank; i++) {
      stf_number sum = 0;
      for (int p = 0; p < m; p++) sum += VT[i + m * p] * C[p + m * j];
      B[i + rank * j] = sum;
    }
}

/* What deflations have left of N. */
typedef struct quotient {
  steif_context *ctx;
  int left;      /* its order, the kernels so far taken out */
  int all;       /* order of N */
  double radius; /* singular values below are 0 */
  bool *sure;
  stf_number *B, *VT, *C;
  double *sigma;
} quotient;

/* An error of size `radius` turns the null space by radius / sigma_rank, which changes what is left
 * of B by ||B|| times that. */
static int kernel(void *data, int level, sunindextype *dimension)
{
  quotient *q = data;
  const int left = q->left;
  int rank = 0;
  (void)level;
  memcpy(q->C, q->B, (size_t)(left * left) * sizeof *q->C);
  STEIF_TRY(decompose(q->ctx, left, q->C, q->sigma, q->VT));
  for (; rank < left && q->sigma[rank] > q->radius; rank++)
    *q->sure = *q->sure && q->sigma[rank] > STEIF_DOUBT * q->radius;
  *dimension = q->all - rank;
  if (rank == left) return STEIF_OK;
  deflate(left, rank, q->VT, q->B, q->C);
  q->left = rank;
  if (rank > 0) q->radius *= q->sigma[0] / q->sigma[rank - 1];
  return STEIF_OK;
}

int stf_weyr(steif_context *ctx, int m, const stf_number *N, double radius, int *weyr,
             bool *sure)
{
  const size_t square = (size_t)m * (size_t)m;
  int count = 0;
  bool complete = false;
  stf_number *B = stf_allocate(ctx, 3 * square + (size_t)m, sizeof *B);
  sunindextype *found = B ? stf_allocate(ctx, (size_t)m, sizeof *found) : NULL;
  int code = found ? STEIF_OK : STEIF_NO_MEMORY;
  *sure = true;
  memset(weyr, 0, (size_t)m * sizeof *weyr);
  if (!code) {
    memcpy(B, N, square * sizeof *B);
    quotient q = {ctx, m, m, radius, sure, B, B + square, B + 2 * square, NULL};
    q.sigma = (double *)(B + 3 * square);
    code = stf_weyr_find(kernel, &q, m, m, found, &count, &complete);
  }
  if (!code) *sure = *sure && complete;
  for (int p = 0; p < count && !code; p++) weyr[p] = (int)found[p];
  stf_release(ctx, found);
  stf_release(ctx, B);
  return code;
}
