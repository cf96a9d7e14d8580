/* residues.c: entries of matrices modulo a prime, and diagonals that are the negative sums of their rows
 * but for rounding, as assembling 0.1 + 0.2 leaves them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "residues.h"
#include "prime_field.h"
#include <math.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

stf_columns stf_columns_of(SUNMatrix M)
{
  if (SUNMatGetID(M) == SUNMATRIX_DENSE)
    return (stf_columns){SM_COLUMNS_D(M), SM_LDATA_D(M), NULL, NULL, SM_DATA_D(M)};
  const sunindextype n = SM_COLUMNS_S(M), *ptr = SM_INDEXPTRS_S(M);
  return (stf_columns){n, ptr[n], ptr, SM_INDEXVALS_S(M), SM_DATA_S(M)};
}

/* high + low += x without rounding of the first order. */
static void add(sunrealtype x, sunrealtype *high, sunrealtype *low)
{
  const volatile sunrealtype sum = *high + x, part = sum - *high;
  *low += (*high - (sum - part)) + (x - part);
  *high = sum;
}

/* Is d the negative of the sum of the others, but for the rounding of d? */
static bool is_rounded(sunrealtype d, sunrealtype high, sunrealtype low)
{
  if (d == 0 || (high == 0 && low == 0)) return false;
  add(d, &high, &low);
  const sunrealtype off = fabs(high + low), ulp = ldexp(STF_EPS, ilogb(d));
  return off > 0 && off <= STF_SNAP_ULPS * ulp;
}

/* sums: 3 n, the diagonal entries and the sums of the others, high and low parts. */
static void sum_rows(const stf_columns *c, sunrealtype *sums)
{
  const sunindextype n = c->n;
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = stf_columns_start(c, j); k < stf_columns_start(c, j + 1); k++) {
      const sunindextype i = stf_columns_row(c, k);
      if (i == j)
        sums[i] += c->value[k];
      else
        add(c->value[k], sums + n + i, sums + 2 * n + i);
    }
}

int stf_field_rounded_rows(steif_context *ctx, SUNMatrix M, unsigned char *rounded)
{
  const stf_columns c = stf_columns_of(M);
  sunrealtype *sums = stf_allocate(ctx, 3 * (size_t)c.n, sizeof *sums);
  if (!sums) return STEIF_NO_MEMORY;
  sum_rows(&c, sums);
  for (sunindextype i = 0; i < c.n; i++)
    rounded[i] = is_rounded(sums[i], sums[c.n + i], sums[2 * c.n + i]);
  stf_release(ctx, sums);
  return STEIF_OK;
}

/* The residues of rounded diagonals become the negative sums of the others of their rows. */
static void snap_diagonals(const stf_columns *c, const stf_modulus *m,
                           const unsigned char *rounded, uint64_t *sum, uint64_t *out)
{
  for (int pass = 0; pass < 2; pass++)
    for (sunindextype j = 0; j < c->n; j++)
      for (sunindextype k = stf_columns_start(c, j); k < stf_columns_start(c, j + 1); k++) {
        const sunindextype i = stf_columns_row(c, k);
        if (!rounded[i]) continue;
        if (!pass && i != j) sum[i] = stf_modular_sum(m, sum[i], out[k]);
        if (!pass || i != j) continue;
        out[k] = stf_modular_negative(m, sum[i]);
        sum[i] = 0; /* an entry that is there twice */
      }
}

static int snap_all(steif_context *ctx, const stf_columns *c, SUNMatrix M, const stf_modulus *m,
                    uint64_t *out)
{
  const size_t n = (size_t)c->n;
  uint64_t *sum = stf_allocate(ctx, n, sizeof *sum);
  unsigned char *rounded = sum ? stf_allocate(ctx, n, 1) : NULL;
  int code = rounded ? stf_field_rounded_rows(ctx, M, rounded) : STEIF_NO_MEMORY;
  if (!code) snap_diagonals(c, m, rounded, sum, out);
  stf_release(ctx, rounded);
  stf_release(ctx, sum);
  return code;
}

int stf_residues_find(steif_context *ctx, SUNMatrix M, bool snap, const stf_modulus *m,
                      uint64_t *out)
{
  const stf_columns c = stf_columns_of(M);
  for (sunindextype k = 0; k < c.count; k++) out[k] = stf_modular_double(m, c.value[k]);
  return snap ? snap_all(ctx, &c, M, m, out) : STEIF_OK;
}

/* -- sizes ------------------------------------------------------------------------------------ */

/* The exponents of the largest power of 2 above all entries of a row and of the lowest bit in it. */
typedef struct extent {
  int above, lowest;
  sunindextype count;
} extent;

static void meet(sunrealtype x, extent *of)
{
  int e;
  if (x == 0) return;
  const int64_t m = (int64_t)ldexp(frexp(x, &e), 53);
  const int lowest = e - 53 + __builtin_ctzll((unsigned long long)m);
  if (!of->count || e > of->above) of->above = e;
  if (!of->count || lowest < of->lowest) of->lowest = lowest;
  of->count++;
}

int stf_residues_bits(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunrealtype *bits)
{
  const stf_columns c[2] = {stf_columns_of(E), stf_columns_of(F)};
  extent *row = stf_allocate(ctx, (size_t)c[0].n, sizeof *row);
  if (!row) return STEIF_NO_MEMORY;
  for (int which = 0; which < 2; which++)
    for (sunindextype k = 0; k < c[which].count; k++)
      meet(c[which].value[k], row + stf_columns_row(c + which, k));
  *bits = 0;
  for (sunindextype i = 0; i < c[0].n; i++)
    if (row[i].count) *bits += row[i].above - row[i].lowest + log2((sunrealtype)row[i].count);
  stf_release(ctx, row);
  return STEIF_OK;
}
