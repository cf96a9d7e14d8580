/* eigen.c: eigenvalues of a small real matrix: LAPACK's, then Newton's iteration in long
 * double on
 *   M v = lambda v,  w^H v = 1
 * (Peters, Wilkinson: Inverse iteration, ill-conditioned equations and Newton's method, SIAM
 * Review 21 (1979)). The eigenvalues of A^{-1} are ill-conditioned for many stages: 3.7 times
 * worse with each.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include "lapack.h"
#include <float.h>
#include <math.h>

enum { N = STEIF_STAGES, BORDERED = STEIF_STAGES + 1 };

/* Insert z so that the imaginary parts ascend. */
static void insert(stf_complex *list, int count, stf_complex z)
{
  for (; count > 0 && cimagl(list[count - 1]) > cimagl(z); count--)
    list[count] = list[count - 1];
  list[count] = z;
}

int stf_eigen_values(steif_context *ctx, int n, const long double *M, stf_complex *lambda,
                     int *count)
{
  double a[N * N], re[N], im[N], none[1], work[8 * N];
  const int one = 1, lwork = 8 * N;
  int info = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) a[j * n + i] = (double)M[i * n + j];
  dgeev_("N", "N", &n, a, &n, re, im, none, &one, none, &one, work, &lwork, &info, 1, 1);
  STEIF_CHECK(!info, ctx, STEIF_NO_CONVERGENCE,
              "LAPACK's dgeev found no eigenvalues of a %d x %d matrix (info %d); check the "
              "coefficients of the table",
              n, n, info);
  *count = 0;
  for (int i = 0; i < n; i++)
    if (im[i] >= 0) insert(lambda, (*count)++, (long double)re[i] + (long double)im[i] * I);
  return STEIF_OK;
}

static void normalise(int n, stf_complex *v)
{
  long double sum = 0;
  for (int i = 0; i < n; i++) sum += creall(v[i] * conjl(v[i]));
  for (int i = 0; i < n; i++) v[i] /= sqrtl(sum);
}

/* [M - lambda, column; w^H, 0] x = right, with x in place of `right`. */
static bool border(int n, const long double *M, stf_complex lambda, const stf_complex *column,
                   const stf_complex *w, stf_complex *right)
{
  stf_complex K[BORDERED * BORDERED];
  const int m = n + 1;
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) K[i * m + j] = M[i * n + j] - (i == j ? lambda : 0);
    K[i * m + n] = column[i];
    K[n * m + i] = conjl(w[i]);
  }
  K[n * m + n] = 0;
  return stf_solve(m, 1, K, right, 0);
}

/* r = lambda v - M v; its largest entry relative to the largest row sum of M. */
static long double residual(int n, const long double *M, stf_complex lambda,
                            const stf_complex *v, stf_complex *r)
{
  long double most = 0, norm = 0;
  for (int i = 0; i < n; i++) {
    long double sum = 0;
    r[i] = lambda * v[i];
    for (int j = 0; j < n; j++) r[i] -= v[j] * M[i * n + j], sum += fabsl(M[i * n + j]);
    most = fmaxl(most, cabsl(r[i])), norm = fmaxl(norm, sum);
  }
  return most / norm;
}

/* Singular vectors v, u of the smallest singular value of M - lambda, by turns from the
 * bordered matrix and its adjoint (Govaerts: Numerical methods for bifurcations, 2000): M v -
 * lambda v is as small as it can be for this lambda, however far from normal M is. */
static void start(int n, const long double *M, stf_complex lambda, stf_complex *v)
{
  enum { TURNS = 3 };
  stf_complex u[N], x[BORDERED];
  long double Mt[N * N];
  for (int i = 0; i < n * n; i++) Mt[i % n * n + i / n] = M[i];
  for (int i = 0; i < n; i++) u[i] = v[i] = cosl(1.7L * i * i + 0.3L);
  for (int turn = 0; turn < 2 * TURNS; turn++) {
    const bool right = turn % 2 == 0;
    stf_complex *to = right ? v : u;
    for (int i = 0; i < n; i++) x[i] = 0;
    x[n] = 1;
    if (!border(n, right ? M : Mt, right ? lambda : conjl(lambda), right ? u : v, to, x))
      return;
    for (int i = 0; i < n; i++) to[i] = x[i];
    normalise(n, to);
    if (right && residual(n, M, lambda, v, x) <= 4 * STF_EPS) return;
  }
}

/* One step for v and lambda with w^H v fixed; returns the change of lambda. */
static long double improve(int n, const long double *M, const stf_complex *w,
                           stf_complex *lambda, stf_complex *v)
{
  stf_complex minus[N], x[BORDERED];
  residual(n, M, *lambda, v, x);
  for (int i = 0; i < n; i++) minus[i] = -v[i];
  x[n] = 0;
  if (!border(n, M, *lambda, minus, w, x)) return 0;
  for (int i = 0; i < n; i++) v[i] += x[i];
  *lambda += x[n];
  return cabsl(x[n]);
}

bool stf_eigen_refine(int n, const long double *M, stf_complex *lambda, stf_complex *v)
{
  enum { STEPS = 10 };
  stf_complex first[N], r[N], near = *lambda;
  long double change = INFINITY;
  start(n, M, near, first);
  for (int i = 0; i < n; i++) v[i] = first[i];
  /* convergence is quadratic: after a change of 1e-13 the rest is below long double's rounding
   * */
  for (int k = 0; k < STEPS && change > 1e-13L * cabsl(near); k++)
    change = improve(n, M, first, &near, v);
  normalise(n, v);
  if (residual(n, M, near, v, r) <= 100 * LDBL_EPSILON)
    *lambda = near;
  else
    for (int i = 0; i < n; i++) v[i] = first[i];
  return residual(n, M, *lambda, v, r) <= 10 * STF_EPS;
}
