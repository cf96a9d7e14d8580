/* residues.h: entries of matrices, dense or CSC, as numbers modulo a prime.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RESIDUES_H
#define STF_RESIDUES_H

#include "modular.h"
#include <sundials/sundials_matrix.h>

/* A matrix by columns, whatever its storage: entries `from` .. `to` - 1 of column j. */
typedef struct stf_columns {
  sunindextype n, count;
  const sunindextype *ptr, *row; /* NULL: dense */
  const sunrealtype *value;
} stf_columns;
stf_columns stf_columns_of(SUNMatrix M);
static inline sunindextype stf_columns_start(const stf_columns *c, sunindextype j)
{
  return c->ptr ? c->ptr[j] : j * c->n;
}
static inline sunindextype stf_columns_row(const stf_columns *c, sunindextype k)
{
  return c->row ? c->row[k] : k % c->n;
}

/* out[k] of entry k; snap: see prime_field.h. */
int stf_residues_find(steif_context *ctx, SUNMatrix M, bool snap, const stf_modulus *modulus,
                      uint64_t *out);
/* log2 of a bound of prod_i (||E_i|| + ||F_i||) over rows scaled by powers of 2 to whole numbers. */
int stf_residues_bits(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunrealtype *bits);

#endif
