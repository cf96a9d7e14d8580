/* scaling.c: powers of 2 for rows and columns, by two policies.
 *
 * Largest entries: rows and columns are divided at once by the square roots of their largest entries
 * (D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices,
 * RAL-TR-2001-034); a matrix and its transpose get the same scales.
 *
 * Least squares of logarithms,
 *   min sum_E (log2 |e_ij| + r_i + c_j + t)^2 + sum_F (log2 |f_ij| + r_i + c_j)^2,
 * by conjugate gradients; t is a unit of time, which decides nothing (A. R. Curtis, J. K. Reid, On
 * the automatic scaling of matrices for Gaussian elimination, J. Inst. Maths Applics 10, 1972). Units
 * of equations and unknowns cancel whatever they are, where the largest entries let small ones
 * vanish: F = diag(1e300, 1e-300, 1) beside a shift E has all entries 1 in the right units.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scaling.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* -- by the largest entries ---------------------------------------------------------------- */

/* Each sweep halves the bits that rows and columns are apart: 2^64 comes down to 2. */
enum { SWEEPS = 6 };

/* The largest entries of the rows and columns as scaled now. */
static void survey(const stf_scales *s, const stf_summand *M)
{
  sunrealtype *of_row = s->largest, *of_column = s->largest + s->n;
  for (sunindextype j = 0, k = 0; j < s->n; j++) {
    const sunrealtype factor = M->factor * s->column[j];
    const sunindextype first = k, end = M->ptr ? M->ptr[j + 1] : first + s->n;
    for (; k < end; k++) {
      const sunindextype i = M->ptr ? M->row[k] : k - first;
      const sunrealtype a = fabs(M->value[k]) * factor * s->row[i];
      if (a > of_row[i]) of_row[i] = a;
      if (a > of_column[j]) of_column[j] = a;
    }
  }
}

/* k with 2^k nearest to 1 / sqrt(x); 0 where x is between 1/2 and 2. */
static int half(sunrealtype x)
{
  if ((x > 0.5 && x < 2) || !(x > 0) || !isfinite(x)) return 0;
  return -(int)lround(0.5 * log2(x));
}

/* How far the largest entries of rows, or of columns, are apart. */
static sunrealtype spread(sunindextype n, const sunrealtype *largest)
{
  sunrealtype low = INFINITY, high = 0;
  for (sunindextype i = 0; i < n; i++)
    if (largest[i] > 0) {
      low = fmin(low, largest[i]);
      high = fmax(high, largest[i]);
    }
  return high > 0 ? high / low : 1;
}

static bool empty(sunindextype n, const sunrealtype *largest)
{
  for (sunindextype i = 0; i < n; i++)
    if (!(largest[i] > 0)) return true;
  return false;
}

static bool improve(stf_scales *s)
{
  bool changed = false;
  for (sunindextype i = 0; i < 2 * s->n; i++) {
    sunrealtype *scale = i < s->n ? s->row + i : s->column + (i - s->n);
    const int k = half(s->largest[i]);
    if (!k) continue;
    *scale = ldexp(*scale, k);
    s->bits += k;
    changed = true;
  }
  return changed;
}

void stf_scaling_largest(stf_scales *s, int count, const stf_summand *summand)
{
  const sunindextype n = s->n;
  s->bits = 0;
  for (sunindextype i = 0; i < n; i++) s->row[i] = s->column[i] = 1;
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    memset(s->largest, 0, 2 * (size_t)n * sizeof *s->largest);
    for (int m = 0; m < count; m++) survey(s, &summand[m]);
    if (!sweep) s->empty = empty(2 * n, s->largest);
    if (!sweep && spread(n, s->largest) <= s->even && spread(n, s->largest + n) <= s->even)
      return;
    if (!improve(s)) return;
  }
}

/* -- by least squares of logarithms --------------------------------------------------------- */

/* Bits that entries are apart: scaled from FAR on; near to one size up to NEAR. Half the bits of a
 * double are 26: below, every entry keeps its part in sums with the largest one. */
enum { FAR = 40, NEAR = 26 };
/* Exponents stay within MOST, so that the product of a row's and a column's scale is representable;
 * conjugate gradients end after STEPS, or where no scale would move by `settled` bits. */
enum { STEPS = 100, MOST = 900 };
static const sunrealtype settled = 0.1;

typedef struct entry {
  sunindextype i, j;
  float bits;   /* log2 of its size */
  bool leading; /* of E */
} entry;

typedef struct least_squares {
  stf_pool *pool;
  sunindextype n, count;
  entry *entry;
  sunrealtype *z, *residual, *step, *image, *degree; /* 2 n + 1: rows, columns, t */
} least_squares;

static bool dense(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_DENSE; }
static sunindextype order(SUNMatrix M) { return dense(M) ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M); }
static sunindextype entries(SUNMatrix M)
{
  return dense(M) ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[order(M)];
}

/* log2 |a| of all entries that are not 0. */
static void gather(least_squares *f, SUNMatrix M, bool leading)
{
  const sunrealtype *a = dense(M) ? SM_DATA_D(M) : SM_DATA_S(M);
  for (sunindextype j = 0, k = 0; j < f->n; j++)
    for (const sunindextype end = dense(M) ? k + f->n : SM_INDEXPTRS_S(M)[j + 1]; k < end;
         k++) {
      if (a[k] == 0) continue;
      f->entry[f->count++] = (entry){dense(M) ? k % f->n : SM_INDEXVALS_S(M)[k], j,
                                     (float)log2(fabs(a[k])), leading};
    }
}

/* image = (B^T B) z with B the rows (1 of row i, 1 of column j, 1 of t). */
static void product(const least_squares *f, const sunrealtype *z, sunrealtype *image)
{
  memset(image, 0, (2 * (size_t)f->n + 1) * sizeof *image);
  for (const entry *e = f->entry; e < f->entry + f->count; e++) {
    const sunrealtype sum = z[e->i] + z[f->n + e->j] + (e->leading ? z[2 * f->n] : 0);
    image[e->i] += sum;
    image[f->n + e->j] += sum;
    if (e->leading) image[2 * f->n] += sum;
  }
}

static void begin(least_squares *f)
{
  for (const entry *e = f->entry; e < f->entry + f->count; e++) {
    const sunindextype part[] = {e->i, f->n + e->j, 2 * f->n};
    for (int k = 0; k < (e->leading ? 3 : 2); k++) {
      f->residual[part[k]] -= e->bits;
      f->degree[part[k]]++;
    }
  }
  for (sunindextype k = 0; k <= 2 * f->n; k++)
    if (!(f->degree[k] > 0)) f->degree[k] = 1;
}

/* Conjugate gradients with the diagonal as preconditioner; the equations are singular (a scale may
 * go from rows to columns) and consistent. */
static void minimise(least_squares *f)
{
  const sunindextype size = 2 * f->n + 1;
  sunrealtype before = 1;
  begin(f);
  for (int step = 0; step < STEPS; step++) {
    sunrealtype now = 0, most = 0, curvature = 0;
    for (sunindextype k = 0; k < size; k++) {
      const sunrealtype off = f->residual[k] / f->degree[k];
      now += f->residual[k] * off;
      most = fmax(most, fabs(off));
    }
    if (most < settled) break;
    for (sunindextype k = 0; k < size; k++)
      f->step[k] = f->residual[k] / f->degree[k] + (step ? now / before * f->step[k] : 0);
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
static void round_off(const least_squares *f, int *exponent)
{
  sunrealtype low = INFINITY, high = -INFINITY;
  for (sunindextype i = 0; i < f->n; i++) {
    low = fmin(low, f->z[i]);
    high = fmax(high, f->z[i]);
  }
  const sunrealtype middle = (low + high) / 2;
  for (sunindextype k = 0; k < 2 * f->n; k++) {
    const int e = (int)lround(f->z[k] + (k < f->n ? -middle : middle));
    exponent[k] = e > MOST ? MOST : e < -MOST ? -MOST : e;
  }
}

/* How far the entries of E, and those of F, are apart now. */
static sunrealtype apart(const least_squares *f, const int *exponent)
{
  sunrealtype low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (const entry *e = f->entry; e < f->entry + f->count; e++) {
    const sunrealtype bits = (sunrealtype)e->bits + exponent[e->i] + exponent[f->n + e->j];
    low[e->leading] = fmin(low[e->leading], bits);
    high[e->leading] = fmax(high[e->leading], bits);
  }
  return fmax(high[0] - low[0], high[1] - low[1]);
}

static int run(least_squares *f, SUNMatrix E, SUNMatrix F, int *exponent,
               enum stf_evenness *even)
{
  const size_t size = 2 * (size_t)f->n + 1;
  f->entry = stf_pool_array(f->pool, (size_t)(entries(E) + entries(F)), sizeof *f->entry);
  f->z = stf_pool_array(f->pool, 5 * size, sizeof *f->z);
  if (!f->entry || !f->z) return STEIF_NO_MEMORY;
  f->residual = f->z + size;
  f->step = f->residual + size;
  f->image = f->step + size;
  f->degree = f->image + size;
  gather(f, E, true);
  gather(f, F, false);
  minimise(f);
  round_off(f, exponent);
  *even = apart(f, exponent) <= NEAR ? STF_EVEN : STF_UNEVEN;
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

bool stf_scaling_needed(SUNMatrix E, SUNMatrix F) { return far(E) || far(F); }

int stf_scaling_logarithmic(steif_context *ctx, SUNMatrix E, SUNMatrix F, int *exponent,
                            enum stf_evenness *even)
{
  *even = STF_EVEN_AS_GIVEN;
  memset(exponent, 0, 2 * (size_t)order(E) * sizeof *exponent);
  if (!stf_scaling_needed(E, F)) return STEIF_OK;
  least_squares f = {.pool = stf_pool_new(ctx), .n = order(E)};
  if (!f.pool) return STEIF_NO_MEMORY;
  const int code = run(&f, E, F, exponent, even);
  stf_pool_free(&f.pool);
  return code;
}
