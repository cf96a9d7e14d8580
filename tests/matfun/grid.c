/* grid.c: see grid.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "grid.h"
#include "gear.h"
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

SUNMatrix grid_tridiagonal(int n, double lower, double diagonal, double upper, SUNContext sun)
{
  SUNMatrix A = SUNSparseMatrix(n, n, 3 * n, CSC_MAT, sun);
  sunindextype k = 0;
  for (int j = 0; j < n; j++) {
    SM_INDEXPTRS_S(A)[j] = k;
    for (int i = j - 1; i <= j + 1; i++) {
      if (i < 0 || i >= n) continue;
      SM_INDEXVALS_S(A)[k] = i;
      SM_DATA_S(A)[k++] = i < j ? upper : i > j ? lower : diagonal;
    }
  }
  SM_INDEXPTRS_S(A)[n] = k;
  return A;
}

SUNMatrix grid_five_points(int side, SUNContext sun)
{
  static const int step[5][2] = {{0, -1}, {-1, 0}, {0, 0}, {1, 0}, {0, 1}};
  const sunindextype n = (sunindextype)side * side;
  SUNMatrix A = SUNSparseMatrix(n, n, 5 * n, CSC_MAT, sun);
  sunindextype k = 0;
  for (sunindextype j = 0; j < n; j++) {
    SM_INDEXPTRS_S(A)[j] = k;
    for (int d = 0; d < 5; d++) {
      const sunindextype x = j % side + step[d][0], y = j / side + step[d][1];
      if (x < 0 || x >= side || y < 0 || y >= side) continue;
      SM_INDEXVALS_S(A)[k] = x + side * y;
      SM_DATA_S(A)[k++] = d == 2 ? -4 : 1;
    }
  }
  SM_INDEXPTRS_S(A)[n] = k;
  return A;
}

double *grid_sines(int n)
{
  double *S = malloc((size_t)n * (size_t)n * sizeof *S);
  for (long k = 0; S && k < n; k++)
    for (long i = 0; i < n; i++)
      S[i + n * k] = sin(pi * (double)((i + 1) * (k + 1) % (2 * (n + 1))) / (n + 1));
  return S;
}

void grid_fill(int n, unsigned seed, double *v)
{
  for (int i = 0; i < n; i++) {
    const double x = (i + 1.0) / (n + 1);
    v[i] = seed ? gear_random(&seed) : x * (1 - x) * (1 + sin(13 * pi * x));
  }
}

/* y = S x */
static void transform(int n, const double *S, const double *x, double *y)
{
  memset(y, 0, (size_t)n * sizeof *y);
  for (int k = 0; k < n; k++)
    for (int i = 0; i < n; i++) y[i] += S[i + (long)n * k] * x[k];
}

/* An eigenvalue of tridiag(1, -2, 1). */
static double mode(int n, int k)
{
  const double s = sin((k + 1) * pi / (2 * (n + 1)));
  return -4 * s * s;
}

static double phi(int k, double z)
{
  double f[STEIF_PHI_MOST + 1];
  steif_phi_scalar(k, z, 0, f, NULL);
  return f[k];
}

void grid_heat(int n, const double *S, double t, int k, const double *v, double *w)
{
  double *c = malloc((size_t)n * sizeof *c);
  if (!c) return;
  transform(n, S, v, c);
  for (int m = 0; m < n; m++)
    c[m] *= phi(k, t * (n + 1.0) * (n + 1.0) * mode(n, m)) * 2 / (n + 1);
  transform(n, S, c, w);
  free(c);
}

/* Y = S X S */
static void transform_2d(int n, const double *S, const double *X, double *Y, double *T)
{
  for (long j = 0; j < n; j++) transform(n, S, X + n * j, Y + n * j);
  for (long j = 0; j < n; j++)
    for (long i = 0; i < n; i++) T[i + n * j] = Y[j + n * i];
  for (long j = 0; j < n; j++) transform(n, S, T + n * j, Y + n * j);
}

/* The second transform leaves the transposed array; after both it is straight again. */
void grid_heat_2d(int side, const double *S, double t, int k, const double *v, double *w)
{
  const long n = side;
  double *c = malloc(2 * (size_t)(n * n) * sizeof *c);
  if (!c) return;
  transform_2d(side, S, v, c, c + n * n);
  for (int j = 0; j < side; j++)
    for (int i = 0; i < side; i++)
      c[i + n * j] *=
        phi(k, t * (mode(side, i) + mode(side, j))) * 4 / ((side + 1.0) * (side + 1.0));
  transform_2d(side, S, c, w, c + n * n);
  free(c);
}

/* tridiag(-1, 0, 1) = D (i tridiag(1, 0, 1)) D^{-1}, D = diag((-i)^{-j}) = diag(i^j). */
void grid_waves(int n, const double *S, double t, const double *v, double *w)
{
  static const double complex power[4] = {1, I, -1, -I};
  double complex *c = malloc((size_t)n * sizeof *c);
  if (!c) return;
  for (int k = 0; k < n; k++) {
    c[k] = 0;
    for (int j = 0; j < n; j++) c[k] += S[j + (long)n * k] * conj(power[j % 4]) * v[j];
    c[k] *= cexp(I * t * 2 * cos((k + 1) * pi / (n + 1))) * 2 / (n + 1);
  }
  for (int j = 0; j < n; j++) {
    double complex sum = 0;
    for (int k = 0; k < n; k++) sum += S[j + (long)n * k] * c[k];
    w[j] = creal(power[j % 4] * sum);
  }
  free(c);
}

double grid_norm(int n, const double *v)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += v[i] * v[i];
  return sqrt(sum);
}

double grid_distance(int n, const double *v, const double *w)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += (v[i] - w[i]) * (v[i] - w[i]);
  return sqrt(sum);
}
