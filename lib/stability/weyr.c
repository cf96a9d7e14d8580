/* weyr.c: Jordan blocks of nilpotent matrices by a staircase of null spaces (V. N. Kublanovskaya
 * 1966; G. H. Golub and J. H. Wilkinson, SIAM Review 18, 1976), and null vectors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "cluster.h"
#include <math.h>
#include <steif/hamiltonian.h>
#include <string.h>

void zgesvd_(const char *jobu, const char *jobvt, const int *m, const int *n, stf_number *a,
             const int *lda, double *s, stf_number *u, const int *ldu, stf_number *vt,
             const int *ldvt, stf_number *work, const int *lwork, double *rwork, int *info,
             size_t jobu_length, size_t jobvt_length);

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

/* An error of size `radius` turns the null space by radius / sigma_rank, which changes what is left of
 * B by ||B|| times that. */
static int staircase(steif_context *ctx, int m, stf_number *B, double radius, int *weyr,
                     bool *sure, stf_number *scratch)
{
  stf_number *VT = scratch, *C = VT + m * m;
  double *sigma = (double *)(C + m * m);
  for (int p = 0, left = m; left > 0; p++) {
    int rank = 0;
    memcpy(C, B, (size_t)(left * left) * sizeof *C);
    STEIF_TRY(decompose(ctx, left, C, sigma, VT));
    for (; rank < left && sigma[rank] > radius; rank++)
      *sure = *sure && sigma[rank] > STEIF_DOUBT * radius;
    weyr[p] = left - rank;
    if (weyr[p] == 0) {
      *sure = false;
      return STEIF_OK;
    }
    deflate(left, rank, VT, B, C);
    left = rank;
    if (rank > 0) radius *= sigma[0] / sigma[rank - 1];
  }
  return STEIF_OK;
}

int stf_weyr(steif_context *ctx, int m, const stf_number *N, double radius, int *weyr,
             bool *sure)
{
  const size_t square = (size_t)m * (size_t)m;
  stf_number *B = stf_allocate(ctx, 3 * square + (size_t)m, sizeof *B);
  if (!B) return STEIF_NO_MEMORY;
  memcpy(B, N, square * sizeof *B);
  memset(weyr, 0, (size_t)m * sizeof *weyr);
  *sure = true;
  const int code = staircase(ctx, m, B, radius, weyr, sure, B + square);
  stf_release(ctx, B);
  return code;
}
