/* gear.c: see gear.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include <complex.h>
#include <math.h>
#include <string.h>

double gear_random(unsigned *state)
{
  *state = (unsigned)((unsigned long long)*state * 48271u % 2147483647u);
  return 2 * (double)*state / 2147483647.0 - 1;
}

void gear_fill(gear *g, int n, bool identity, unsigned seed)
{
  memset(g, 0, sizeof *g);
  g->n = n;
  g->identity = identity;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      const int up = j - i;
      if (identity)
        g->E[i + n * j] = i == j;
      else if (up >= -1 && up <= 3 && i % 5 != 3)
        g->E[i + n * j] = gear_random(&seed) + 1.37 * (i == j);
      if (up >= -2 && up <= 1) g->A[i + n * j] = gear_random(&seed) - 2.83 * (i == j);
    }
}

static SUNMatrix sparse(const double *M, int n, SUNContext sun)
{
  SUNMatrix S = SUNSparseMatrix(n, n, n * n, CSC_MAT, sun);
  sunindextype k = 0;
  for (int j = 0; j < n; j++) {
    SM_INDEXPTRS_S(S)[j] = k;
    for (int i = n - 1; i >= 0; i--) /* falling rows: order must not matter */
      if (M[i + n * j] != 0) SM_INDEXVALS_S(S)[k] = i, SM_DATA_S(S)[k++] = M[i + n * j];
  }
  SM_INDEXPTRS_S(S)[n] = k;
  return S;
}

void gear_copy(const double *M, int n, SUNMatrix to)
{
  const SUNMatrix_ID id = SUNMatGetID(to);
  for (int j = 0; j < n; j++) {
    if (id == SUNMATRIX_SPARSE)
      for (sunindextype k = SM_INDEXPTRS_S(to)[j]; k < SM_INDEXPTRS_S(to)[j + 1]; k++)
        SM_DATA_S(to)[k] = M[SM_INDEXVALS_S(to)[k] + n * j];
    for (int i = 0; i < n; i++)
      if (id == SUNMATRIX_DENSE)
        SM_ELEMENT_D(to, i, j) = M[i + n * j];
      else if (id == SUNMATRIX_BAND && j - i <= SM_UBAND_B(to) && i - j <= SM_LBAND_B(to))
        SM_ELEMENT_B(to, i, j) = M[i + n * j];
  }
}

SUNMatrix gear_matrix(const double *M, int n, SUNMatrix_ID id, SUNContext sun)
{
  if (id == SUNMATRIX_SPARSE) return sparse(M, n, sun);
  int upper = 0, lower = 0;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++)
      if (M[i + n * j] != 0) {
        if (j - i > upper) upper = j - i;
        if (i - j > lower) lower = i - j;
      }
  SUNMatrix to =
    id == SUNMATRIX_DENSE ? SUNDenseMatrix(n, n, sun) : SUNBandMatrix(n, upper, lower, sun);
  gear_copy(M, n, to);
  return to;
}

N_Vector gear_vector(int n, unsigned seed, SUNContext sun)
{
  N_Vector v = N_VNew_Serial(n, sun);
  for (int i = 0; i < n; i++) NV_Ith_S(v, i) = gear_random(&seed);
  return v;
}

double gear_residual(const gear *g, steif_shift s, const double *xr, const double *xi,
                     const double *br, const double *bi)
{
  const int n = g->n;
  double worst = 0, norm = 0, x_max = 0, b_max = 0;
  for (int i = 0; i < n; i++) {
    const double complex b = br[i] + (bi ? bi[i] * I : 0), own = xr[i] + (xi ? xi[i] * I : 0);
    double complex r = -b;
    double row = 0;
    for (int j = 0; j < n; j++) {
      const double complex m = (s.re + s.im * I) * g->E[i + n * j] - g->A[i + n * j];
      r += m * (xr[j] + (xi ? xi[j] * I : 0));
      row += cabs(m);
    }
    worst = fmax(worst, cabs(r)), norm = fmax(norm, row);
    x_max = fmax(x_max, cabs(own)), b_max = fmax(b_max, cabs(b));
  }
  return worst / (norm * x_max + b_max);
}

static int times(const double *M, int n, bool transposed, N_Vector x, N_Vector out)
{
  const double *from = N_VGetArrayPointer(x);
  double *to = N_VGetArrayPointer(out);
  for (int i = 0; i < n; i++) {
    to[i] = 0;
    for (int j = 0; j < n; j++) to[i] += (transposed ? M[j + n * i] : M[i + n * j]) * from[j];
  }
  return 0;
}

static int times_E(N_Vector x, N_Vector out, void *user)
{
  const gear *g = user;
  return times(g->E, g->n, false, x, out);
}

static int times_A(N_Vector x, N_Vector out, void *user)
{
  const gear *g = user;
  return times(g->A, g->n, false, x, out);
}

static int turned_E(N_Vector x, N_Vector out, void *user)
{
  const gear *g = user;
  return times(g->E, g->n, true, x, out);
}

static int turned_A(N_Vector x, N_Vector out, void *user)
{
  const gear *g = user;
  return times(g->A, g->n, true, x, out);
}

steif_operator gear_operator(gear *g)
{
  return (steif_operator){.E = g->identity ? NULL : times_E,
                          .A = times_A,
                          .user = g,
                          .dimension = 2 * GEAR_MOST,
                          .tolerance = 1e-11};
}

steif_transposed gear_transposed(const gear *g)
{
  return (steif_transposed){.E = g->identity ? NULL : turned_E, .A = turned_A};
}
