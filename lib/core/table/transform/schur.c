/* schur.c: real Schur form of B in long double by deflation, shift by shift in order of ascending
 * imaginary parts, each pair acting as one complex number (Golub, Van Loan: Matrix
 * Computations, 7.4 and 7.6).
 *
 * With v an eigenvector of the trailing block, a reflection carries v (or Re v, then Im v) to
 * the leading axis (axes) of that block. The phase of v = p + iq is chosen so that p and q are
 * orthogonal: in the basis p, -q the block is then [re -im; im re] without further change.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "transform.h"
#include <math.h>

/* x := x - 2 v (v . x)/(v . v) for n entries `stride` apart. */
static void mirror(int n, const long double *v, long double *x, int stride)
{
  long double vv = 0, vx = 0;
  for (int i = 0; i < n; i++) vv += v[i] * v[i], vx += v[i] * x[i * stride];
  for (int i = 0; i < n && vv > 0; i++) x[i * stride] -= 2 * vx / vv * v[i];
}

/* M := H M H and T := T H with the reflection H that carries x (entries k .. s-1) to a multiple
 * of e_k. The factor is returned; `other` is carried along. */
static long double reflect(int s, int k, const long double *x, long double *other,
                           long double *M, long double *T)
{
  long double v[STEIF_STAGES] = {0}, sum = 0;
  const int n = s - k;
  for (int i = 0; i < n; i++) v[i] = x[i], sum += x[i] * x[i];
  const long double length = x[0] > 0 ? -sqrtl(sum) : sqrtl(sum);
  v[0] -= length;
  for (int j = 0; j < s; j++) mirror(n, v, M + k * s + j, s);
  for (int i = 0; i < s; i++) mirror(n, v, M + i * s + k, 1), mirror(n, v, T + i * s + k, 1);
  if (other) mirror(n, v, other, 1);
  return length;
}

static void scale(int s, int k, long double factor, long double *T)
{
  for (int i = 0; i < s; i++) T[i * s + k] *= factor;
}

/* Deflate the pair of v at row k. */
static void deflate_pair(int s, int k, const stf_complex *v, long double *M, long double *T)
{
  const int n = s - k;
  stf_complex vv = 0;
  long double p[STEIF_STAGES], q[STEIF_STAGES];
  for (int i = 0; i < n; i++) vv += v[i] * v[i];
  const stf_complex phase = cabsl(vv) > 0 ? csqrtl(conjl(vv) / cabsl(vv)) : 1;
  for (int i = 0; i < n; i++) p[i] = creall(phase * v[i]), q[i] = cimagl(phase * v[i]);
  const long double a = reflect(s, k, p, q, M, T), b = reflect(s, k + 1, q + 1, NULL, M, T);
  const long double r = sqrtl(fabsl(a / b));
  scale(s, k, a > 0 ? r : -r, T);
  scale(s, k + 1, (b > 0 ? -1 : 1) / r, T);
}

/* The eigenvalue of the n x n matrix with the smallest imaginary part, and its vector. */
static int lowest(steif_context *ctx, int n, const long double *block, stf_complex *lambda,
                  stf_complex *v)
{
  stf_complex all[STEIF_STAGES];
  int count;
  STEIF_TRY(stf_eigen_values(ctx, n, block, all, &count));
  *lambda = all[0];
  STEIF_CHECK(stf_eigen_refine(n, block, lambda, v), ctx, STEIF_NO_CONVERGENCE,
              "no vector was found for the eigenvalue %g %+gi of a table; take fewer stages",
              (double)creall(all[0]), (double)cimagl(all[0]));
  return STEIF_OK;
}

/* Deflate the next shift of the trailing block of M at row k; returns the rows it took, 0 with
 * *code set when there was none. */
static int deflate(steif_context *ctx, int s, int k, long double *M, stf_transform_work *w,
                   int *code)
{
  const int n = s - k;
  stf_complex lambda, v[STEIF_STAGES];
  long double block[STEIF_STAGES * STEIF_STAGES], x[STEIF_STAGES];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) block[i * n + j] = M[(k + i) * s + k + j];
  *code = lowest(ctx, n, block, &lambda, v);
  if (*code) return 0;
  w->row[w->shifts] = k, w->lambda[w->shifts++] = lambda;
  if (cimagl(lambda) > 0) {
    deflate_pair(s, k, v, M, w->T);
    return 2;
  }
  for (int i = 0; i < n; i++) x[i] = creall(v[i]);
  reflect(s, k, x, NULL, M, w->T);
  return 1;
}

/* S = Tinv B T right of the shifts' own blocks. */
static void couple(int s, stf_transform_work *w)
{
  long double BT[STEIF_STAGES * STEIF_STAGES] = {0};
  for (int i = 0; i < s; i++)
    for (int k = 0; k < s; k++)
      for (int j = 0; j < s; j++) BT[i * s + j] += w->B[i * s + k] * w->T[k * s + j];
  for (int i = 0; i < s * s; i++) w->S[i] = 0;
  for (int k = 0; k + 1 < w->shifts; k++)
    for (int i = w->row[k]; i < w->row[k + 1]; i++)
      for (int j = w->row[k + 1]; j < s; j++)
        for (int l = 0; l < s; l++) w->S[i * s + j] += w->Tinv[i * s + l] * BT[l * s + j];
}

/* On A, whose entries are known relatively, eigenvalues are better determined than by deflation
 * of B, which is known in norm: taken where the two agree, so that T^{-1} B T keeps its blocks.
 * */
static void sharpen(int s, stf_transform_work *w)
{
  stf_complex v[STEIF_STAGES];
  for (int k = 0; k < w->shifts; k++) {
    stf_complex mu = 1 / w->lambda[k];
    if (!stf_eigen_refine(s, w->A, &mu, v)) continue;
    if (cabsl(1 / mu - w->lambda[k]) <= 2e-14L * cabsl(w->lambda[k])) w->lambda[k] = 1 / mu;
  }
}

int stf_transform_schur(steif_context *ctx, int s, stf_transform_work *w)
{
  long double M[STEIF_STAGES * STEIF_STAGES];
  int code;
  for (int i = 0; i < s * s; i++) M[i] = w->B[i], w->T[i] = i % (s + 1) == 0;
  w->shifts = 0;
  for (int k = 0, rows; k < s; k += rows)
    if (!(rows = deflate(ctx, s, k, M, w, &code))) return code;
  STEIF_CHECK(stf_transform_invert(s, w->T, 0, w->Tinv), ctx, STEIF_NO_CONVERGENCE,
              "the Schur form of a %d x %d table broke down; check its coefficients", s, s);
  couple(s, w);
  sharpen(s, w);
  return STEIF_OK;
}
