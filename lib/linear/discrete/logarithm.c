/* logarithm.c: the continuous system behind a zero-order hold: the principal logarithm of
 * [Ad Bd; 0 1] is dt [A B; 0 0].
 *
 * Inverse scaling and squaring on the Schur form (N. J. Higham, Functions of Matrices, 2008,
 * 11.5): square roots until ||T - 1|| < 1/4, then int_0^1 X (1 + t X)^{-1} dt with X = T - 1 by
 * eight Gauss points, which is the [8/8] Pade approximant. The diagonal is taken exactly.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include "lapack.h"
#include <complex.h>
#include <math.h>
#include <string.h>

typedef double complex number;

/* Abscissae and weights of Gauss on (-1, 1), 8 points (M. Abramowitz and I. A. Stegun,
 * Handbook of Mathematical Functions, 1964, 25.4). */
static const double node[4] = {0.18343464249564980494, 0.52553240991632898582,
                               0.79666647741362673959, 0.96028985649753623168};
static const double gauss[4] = {0.36268378337836198297, 0.31370664587788728734,
                                0.22238103445337447054, 0.10122853629037625915};

typedef struct work {
  int n;
  number *T, *Q, *R, *L, *w, *buffer;
  double *real;
} work;

/* T becomes its principal square root, column by column (A. Bjorck and S. Hammarling, 1983). */
static void root(int n, number *T)
{
  for (int j = 0; j < n; j++) {
    T[j + n * j] = csqrt(T[j + n * j]);
    for (int i = j - 1; i >= 0; i--) {
      number sum = T[i + n * j];
      for (int k = i + 1; k < j; k++) sum -= T[i + n * k] * T[k + n * j];
      T[i + n * j] = sum / (T[i + n * i] + T[j + n * j]);
    }
  }
}

static double distance(int n, const number *T)
{
  double most = 0;
  for (int j = 0; j < n; j++) {
    double sum = cabs(T[j + n * j] - 1);
    for (int i = 0; i < j; i++) sum += cabs(T[i + n * j]);
    most = fmax(most, sum);
  }
  return most;
}

/* L += weight X (1 + t X)^{-1}, X = T - 1 upper triangular; row by row, R: n scratch. */
static void add(int n, double t, double weight, const number *T, number *R, number *L)
{
  for (int i = 0; i < n; i++)
    for (int j = i; j < n; j++) {
      number sum = T[i + n * j] - (i == j);
      for (int k = i; k < j; k++) sum -= R[k] * t * T[k + n * j];
      R[j] = sum / (1 + t * (T[j + n * j] - 1));
      L[i + n * j] += weight * R[j];
    }
}

/* The logarithm of T into L. */
static void logarithm(const work *x)
{
  enum { ROOTS = 100 };
  const int n = x->n;
  int roots = 0;
  for (; distance(n, x->T) >= 0.25 && roots < ROOTS; roots++) root(n, x->T);
  memset(x->L, 0, (size_t)n * (size_t)n * sizeof *x->L);
  for (int k = 0; k < 4; k++) {
    add(n, (1 - node[k]) / 2, ldexp(gauss[k], roots - 1), x->T, x->R, x->L);
    add(n, (1 + node[k]) / 2, ldexp(gauss[k], roots - 1), x->T, x->R, x->L);
  }
  for (int i = 0; i < n; i++) x->L[i + n * i] = clog(x->w[i]);
}

/* Is there a principal logarithm that is real? */
static int branch(steif_context *ctx, int n, const number *w)
{
  for (int i = 0; i < n; i++) {
    const double a = creal(w[i]), b = cimag(w[i]);
    STEIF_CHECK(
      cabs(w[i]) > 0, ctx, STEIF_UNSUPPORTED,
      "eigenvalue %d of Ad is 0: no finite A has e^{A dt} with it; remove the dead-beat "
      "states first",
      i);
    STEIF_CHECK(a > 0 || fabs(b) > 1e-14 * fabs(a), ctx, STEIF_UNSUPPORTED,
                "eigenvalue %d of Ad is %.9g: |Im l| dt = pi, the Nyquist limit, so no real "
                "principal logarithm exists; sample faster",
                i, a);
  }
  return STEIF_OK;
}

static int transform(steif_context *ctx, work *x)
{
  const int n = x->n, lwork = 4 * n;
  int info = 0, none = 0;
  zgees_("V", "N", NULL, &n, x->T, &n, &none, x->w, x->Q, &n, x->buffer, &lwork, x->real, &none,
         &info, 1, 1);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "the QR iteration for Ad stopped at eigenvalue %d; balance or rescale the matrix",
              info);
  STEIF_TRY(branch(ctx, n, x->w));
  logarithm(x);
  return STEIF_OK;
}

/* Re (Q L Q^*)(i, j) for the first `rows` rows, into A and B, divided by dt. */
static void back(const work *x, int rows, double dt, double *A, double *B)
{
  const int n = x->n;
  for (int i = 0; i < rows; i++) {
    for (int k = 0; k < n; k++) {
      x->R[k] = 0;
      for (int l = 0; l <= k; l++) x->R[k] += x->Q[i + n * l] * x->L[l + n * k];
    }
    for (int j = 0; j < n; j++) {
      double sum = 0;
      for (int k = 0; k < n; k++) sum += creal(x->R[k] * conj(x->Q[j + n * k]));
      *(j < rows ? &A[i + rows * j] : &B[i + rows * (j - rows)]) = sum / dt;
    }
  }
}

static void fill(const work *x, int n, int m, const double *Ad, const double *Bd)
{
  const int N = n + m;
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++) x->T[i + N * j] = Ad[i + n * j];
    for (int j = 0; j < m; j++) x->T[i + N * (n + j)] = Bd[i + n * j];
  }
  for (int i = n; i < N; i++) x->T[i + N * i] = 1;
}

int steif_d2c(steif_context *ctx, int n, int m, const double *Ad, const double *Bd, double dt,
              double *A, double *B)
{
  const steif_state_space s = {.n = n, .m = m, .A = Ad, .B = Bd};
  STEIF_TRY(stf_state_space_check(ctx, &s));
  STEIF_CHECK(isfinite(dt) && dt > 0, ctx, STEIF_BAD_INPUT,
              "dt = %g: the step is a finite number above 0", dt);
  const size_t N = (size_t)n + (size_t)m;
  number *z = stf_allocate(ctx, 3 * N * N + 7 * N, sizeof *z);
  if (!z) return STEIF_NO_MEMORY;
  work x = {.n = n + m, .T = z, .Q = z + N * N, .L = z + 2 * N * N, .w = z + 3 * N * N};
  x.R = x.w + N, x.buffer = x.R + N, x.real = (double *)(x.buffer + 4 * N);
  fill(&x, n, m, Ad, Bd);
  const int code = transform(ctx, &x);
  if (code == STEIF_OK) back(&x, n, dt, A, B);
  stf_release(ctx, z);
  return code;
}
