/* fit.c: scales of rows and columns by least squares of logarithms,
 *   min sum_E (log2 |e_ij| + r_i + c_j + t)^2 + sum_F (log2 |f_ij| + r_i + c_j)^2,
 * by conjugate gradients; t is a unit of time, which decides nothing. Units of equations and
 * unknowns cancel whatever they are, where scaling by the largest entries lets small ones vanish:
 * F = diag(1e300, 1e-300, 1) beside a shift E has all entries 1 in the right units.
 * A. R. Curtis, J. K. Reid, On the automatic scaling of matrices for Gaussian elimination,
 * J. Inst. Maths Applics 10 (1972).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fit.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { SWEEPS = 100, FAR = 40, EVEN = 26, MOST = 900 };
static const sunrealtype near = 0.1; /* bits that are not worth another sweep */

typedef struct entry {
  sunindextype i, j;
  float bits;
  bool lead; /* of E */
} entry;

typedef struct fit {
  stf_pool *pool;
  sunindextype n, count;
  entry *entry;
  sunrealtype *z, *residual, *step, *image, *degree; /* 2 n + 1: rows, columns, t */
} fit;

static bool dense(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_DENSE; }
static sunindextype order(SUNMatrix M) { return dense(M) ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M); }
static sunindextype entries(SUNMatrix M)
{
  return dense(M) ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[order(M)];
}

/* log2 |a| of all entries that are not 0. */
static void gather(fit *f, SUNMatrix M, bool lead)
{
  const sunrealtype *a = dense(M) ? SM_DATA_D(M) : SM_DATA_S(M);
  for (sunindextype j = 0, k = 0; j < f->n; j++)
    for (const sunindextype end = dense(M) ? k + f->n : SM_INDEXPTRS_S(M)[j + 1]; k < end;
         k++) {
      if (a[k] == 0) continue;
      f->entry[f->count++] =
        (entry){dense(M) ? k % f->n : SM_INDEXVALS_S(M)[k], j, (float)log2(fabs(a[k])), lead};
    }
}

/* image = (B^T B) z with B the rows (1 of row i, 1 of column j, 1 of t). */
static void product(const fit *f, const sunrealtype *z, sunrealtype *image)
{
  memset(image, 0, (2 * (size_t)f->n + 1) * sizeof *image);
  for (const entry *e = f->entry; e < f->entry + f->count; e++) {
    const sunrealtype sum = z[e->i] + z[f->n + e->j] + (e->lead ? z[2 * f->n] : 0);
    image[e->i] += sum;
    image[f->n + e->j] += sum;
    if (e->lead) image[2 * f->n] += sum;
  }
}

static void begin(fit *f)
{
  for (const entry *e = f->entry; e < f->entry + f->count; e++) {
    f->residual[e->i] -= e->bits, f->degree[e->i]++;
    f->residual[f->n + e->j] -= e->bits, f->degree[f->n + e->j]++;
    if (e->lead) f->residual[2 * f->n] -= e->bits, f->degree[2 * f->n]++;
  }
  for (sunindextype k = 0; k <= 2 * f->n; k++)
    if (!(f->degree[k] > 0)) f->degree[k] = 1;
}

/* Conjugate gradients with the diagonal as preconditioner; the equations are singular (a scale may
 * go from rows to columns) and consistent. */
static void minimise(fit *f)
{
  const sunindextype size = 2 * f->n + 1;
  sunrealtype before = 1;
  begin(f);
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    sunrealtype now = 0, most = 0, curvature = 0;
    for (sunindextype k = 0; k < size; k++) {
      const sunrealtype off = f->residual[k] / f->degree[k];
      now += f->residual[k] * off, most = fmax(most, fabs(off));
    }
    if (most < near) break;
    for (sunindextype k = 0; k < size; k++)
      f->step[k] = f->residual[k] / f->degree[k] + (sweep ? now / before * f->step[k] : 0);
    product(f, f->step, f->image);
    for (sunindextype k = 0; k < size; k++) curvature += f->step[k] * f->image[k];
    if (!(curvature > 0)) break;
    for (sunindextype k = 0; k < size; k++) {
      f->z[k] += now / curvature * f->step[k];
      f->residual[k] -= now / curvature * f->image[k];
    }
    before = now;
  }
}

/* Whole numbers, what all rows have in common left to the columns. */
static void settle(const fit *f, int *exponent)
{
  sunrealtype low = INFINITY, high = -INFINITY;
  for (sunindextype i = 0; i < f->n; i++) low = fmin(low, f->z[i]), high = fmax(high, f->z[i]);
  const sunrealtype middle = (low + high) / 2;
  for (sunindextype k = 0; k < 2 * f->n; k++) {
    const int e = (int)lround(f->z[k] + (k < f->n ? -middle : middle));
    exponent[k] = e > MOST ? MOST : e < -MOST ? -MOST : e;
  }
}

/* How far the entries of E, and those of F, are apart now. */
static sunrealtype apart(const fit *f, const int *exponent)
{
  sunrealtype low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (const entry *e = f->entry; e < f->entry + f->count; e++) {
    const sunrealtype bits = (sunrealtype)e->bits + exponent[e->i] + exponent[f->n + e->j];
    low[e->lead] = fmin(low[e->lead], bits), high[e->lead] = fmax(high[e->lead], bits);
  }
  return fmax(high[0] - low[0], high[1] - low[1]);
}

static int run(fit *f, SUNMatrix E, SUNMatrix F, int *exponent, enum stf_fitted *fitted)
{
  const size_t size = 2 * (size_t)f->n + 1;
  f->entry = stf_claim(f->pool, (size_t)(entries(E) + entries(F)), sizeof *f->entry);
  f->z = stf_claim(f->pool, 5 * size, sizeof *f->z);
  if (!f->entry || !f->z) return STEIF_NO_MEMORY;
  f->residual = f->z + size, f->step = f->residual + size, f->image = f->step + size;
  f->degree = f->image + size;
  gather(f, E, true), gather(f, F, false);
  minimise(f);
  settle(f, exponent);
  *fitted = apart(f, exponent) <= EVEN ? STF_FIT_ALL : STF_FIT_SOME;
  return STEIF_OK;
}

static bool far(SUNMatrix M)
{
  const sunrealtype *a = dense(M) ? SM_DATA_D(M) : SM_DATA_S(M);
  sunrealtype low = INFINITY, high = 0;
  for (sunindextype k = 0; k < entries(M); k++) {
    const sunrealtype size = fabs(a[k]);
    if (size > high) high = size;
    if (size < low && size > 0) low = size;
  }
  return high * ldexp(1, -FAR) > low;
}

bool stf_fit_needed(SUNMatrix E, SUNMatrix F) { return far(E) || far(F); }

int stf_fit(steif_context *ctx, SUNMatrix E, SUNMatrix F, int *exponent,
            enum stf_fitted *fitted)
{
  *fitted = STF_FIT_NONE;
  memset(exponent, 0, 2 * (size_t)order(E) * sizeof *exponent);
  if (!stf_fit_needed(E, F)) return STEIF_OK;
  fit f = {.pool = stf_pool_new(ctx), .n = order(E)};
  if (!f.pool) return STEIF_NO_MEMORY;
  const int code = run(&f, E, F, exponent, fitted);
  stf_pool_free(&f.pool);
  return code;
}
