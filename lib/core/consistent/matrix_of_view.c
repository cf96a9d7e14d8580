/* matrix_of_view.c: sums of E = F_y' and B = F_y, column by column, as one sparse factor.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* by_value NULL: derivative E + value B; else column j is that of derivative E or of value B. */
static void fill(const stf_view *v, sunrealtype derivative, const bool *by_value,
                 sunrealtype value, SUNMatrix C)
{
  sunindextype used = 0;
  for (size_t j = 0; j < v->n; j++) {
    SM_INDEXPTRS_S(C)[j] = used;
    const sunrealtype e = by_value && by_value[j] ? 0 : derivative,
                      b = by_value && !by_value[j] ? 0 : value;
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      const sunrealtype entry = e * v->e[k] + b * v->b[k];
      if (entry == 0) continue;
      SM_INDEXVALS_S(C)[used] = v->row[k];
      SM_DATA_S(C)[used++] = entry;
    }
  }
  SM_INDEXPTRS_S(C)[v->n] = used;
}

int stf_view_factor_open(stf_repair *r, sunrealtype derivative, const bool *by_value,
                         sunrealtype value, stf_view_factor *c)
{
  const stf_view *v = &r->view;
  const sunindextype n = (sunindextype)v->n, room = v->column[v->n];
  SUNContext sun = steif_sundials(r->ctx);
  *c = (stf_view_factor){.C = SUNSparseMatrix(n, n, room > 0 ? room : 1, CSC_MAT, sun),
                         .zero = SUNSparseMatrix(n, n, 1, CSC_MAT, sun)};
  STEIF_CHECK(c->C && c->zero, r->ctx, STEIF_NO_MEMORY,
              "no memory for a sparse matrix of %lld entries", (long long)room);
  fill(v, derivative, by_value, value, c->C);
  memset(SM_INDEXPTRS_S(c->zero), 0, (v->n + 1) * sizeof(sunindextype));
  c->pencil = steif_pencil_new(r->ctx, c->C, c->zero);
  if (!c->pencil) return steif_status(r->ctx);
  r->factors++;
  return steif_pencil_factor(c->pencil, 1, &(steif_shift){1, 0});
}

void stf_view_factor_close(stf_view_factor *c)
{
  steif_pencil_free(&c->pencil);
  if (c->C) SUNMatDestroy(c->C);
  if (c->zero) SUNMatDestroy(c->zero);
  *c = (stf_view_factor){0};
}
