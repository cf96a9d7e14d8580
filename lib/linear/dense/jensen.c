/* jensen.c: the number of finite eigenvalues of a dense pencil by Jensen's formula, from determinants
 * alone: neither the staircase nor the generalised Schur form has a part in it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "staircase.h"
#include "dense_algebra.h"
#include "lapack.h"
#include <complex.h>
#include <math.h>
#include <string.h>

static const sunrealtype pi = 3.14159265358979323846;

/* Circles at a quarter and at half of the annulus, on a logarithmic scale, which is taken as 10^3 wide
 * at most: rounding acts on infinite eigenvalues like a power of the radius. Few points are enough
 * where (inner / outer)^(points / 4) is below 10^-6. */
enum { FEW = 8, MANY = 16 };
static const sunrealtype wide = 1e3;

typedef struct jensen {
  int n, *pivot;
  const sunrealtype *E, *F;
  double complex *S;
} jensen;

/* log |det(s E + F)|; NaN where a pivot is 0. */
static sunrealtype log_det(const jensen *j, double complex s)
{
  const size_t n = (size_t)j->n;
  sunrealtype sum = 0;
  int info;
  for (size_t k = 0; k < n * n; k++) j->S[k] = s * j->E[k] + j->F[k];
  zgetrf_(&j->n, &j->n, (double *)j->S, &j->n, j->pivot, &info);
  if (info) return NAN;
  for (size_t k = 0; k < n; k++) sum += log(cabs(j->S[k * n + k]));
  return sum;
}

static sunrealtype mean(const jensen *j, sunrealtype R, int points)
{
  sunrealtype sum = 0;
  for (int k = 0; k < points / 2; k++)
    sum += log_det(j, R * cexp(2 * pi * I * (k + 0.5) / points));
  return 2 * sum / points;
}

/* All eigenvalues have |s| >= 1 / ||F^{-1} E||: there the circles start where none is finite. */
static int empty_disc(stf_pool *pool, const jensen *j, sunrealtype *radius)
{
  const size_t count = (size_t)j->n * (size_t)j->n;
  sunrealtype *LU = stf_pool_square(pool, j->n), *N = stf_pool_square(pool, j->n);
  int info;
  if (!LU || !N) return STEIF_NO_MEMORY;
  memcpy(LU, j->F, count * sizeof *LU);
  memcpy(N, j->E, count * sizeof *N);
  dgetrf_(&j->n, &j->n, LU, &j->n, j->pivot, &info);
  if (!info) dgetrs_("N", &j->n, &j->n, LU, &j->n, j->pivot, N, &j->n, &info, 1);
  const sunrealtype norm = info ? NAN : stf_frobenius(j->n, j->n, N, j->n);
  *radius = norm > 0 ? 1 / norm : 1;
  return STEIF_OK;
}

int stf_jensen(stf_pool *pool, int n, const sunrealtype *E, const sunrealtype *F,
               sunrealtype inner, sunrealtype outer, sunrealtype *count)
{
  const jensen j = {n, stf_pool_array(pool, (size_t)n, sizeof *j.pivot), E, F,
                    stf_pool_array(pool, (size_t)n * (size_t)n, sizeof *j.S)};
  if (!j.pivot || !j.S) return STEIF_NO_MEMORY;
  if (!(inner > 0)) STEIF_TRY(empty_disc(pool, &j, &inner));
  const sunrealtype step = pow(fmin(outer / inner, wide), 0.25), R = inner * step;
  const int points = outer / inner >= wide ? FEW : MANY;
  *count = step > 1 ? (mean(&j, R * step, points) - mean(&j, R, points)) / log(step) : NAN;
  return STEIF_OK;
}
