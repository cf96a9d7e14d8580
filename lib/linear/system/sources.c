/* sources.c: the right-hand sides of the Laurent formulas, E x and f with its derivatives.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "linear_system.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

void stf_sources_product(SUNMatrix E, const sunrealtype *x, sunrealtype *y)
{
  const bool dense = SUNMatGetID(E) == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(E) : SM_COLUMNS_S(E);
  for (sunindextype j = 0; j < n; j++)
    if (dense)
      for (sunindextype i = 0; i < n; i++) y[i] += SM_ELEMENT_D(E, i, j) * x[j];
    else
      for (sunindextype p = SM_INDEXPTRS_S(E)[j]; p < SM_INDEXPTRS_S(E)[j + 1]; p++)
        y[SM_INDEXVALS_S(E)[p]] += SM_DATA_S(E)[p] * x[j];
}

/* Why derivative j is not there. */
static int missing(steif_context *ctx, sunrealtype t, int j, int derivatives)
{
  char words[320] = "";
  if (steif_status(ctx)) snprintf(words, sizeof words, ": %s", steif_message(ctx));
  return STEIF_FAIL(ctx, STEIF_BAD_INPUT,
                    "derivative %d of the forcing is not known at t = %g; index %d needs "
                    "derivatives up to %d where equations are differentiated%s",
                    j, t, derivatives + 1, derivatives, words);
}

int stf_sources_force(steif_context *ctx, steif_forcing f, void *user, sunrealtype t,
                      int derivatives, N_Vector g, sunrealtype *rows)
{
  const size_t n = (size_t)N_VGetLength(g);
  steif_forget(ctx);
  for (int j = 0; j <= derivatives; j++) {
    const int code = f(t, j, g, user);
    if (code < 0 && steif_status(ctx) == STEIF_NO_MEMORY) return STEIF_NO_MEMORY;
    STEIF_CHECK(code >= 0, ctx, STEIF_CALLBACK,
                "the forcing returned %d for derivative %d at t = %g", code, j, t);
    if (code > 0) return missing(ctx, t, j, derivatives);
    const sunrealtype *value = N_VGetArrayPointer(g);
    STEIF_CHECK(stf_all_finite(value, n), ctx, STEIF_NOT_FINITE,
                "derivative %d of the forcing is not finite at t = %g", j, t);
    memcpy(rows + (size_t)j * n, value, n * sizeof *rows);
  }
  return STEIF_OK;
}

sunrealtype stf_sources_length(sunindextype n, const sunrealtype *x)
{
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

sunrealtype stf_sources_frobenius(SUNMatrix M)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype count = dense ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)];
  return stf_sources_length(count, dense ? SM_DATA_D(M) : SM_DATA_S(M));
}

sunrealtype stf_sources_measure(const stf_sources *s, sunrealtype plus, sunrealtype E,
                                sunrealtype F)
{
  static const sunrealtype part = 1e-3;
  sunrealtype scale = 0;
  if (E > 0) scale = stf_sources_length(s->n, s->Ex0) / E;
  sunrealtype over = F > 0 ? 1 / F : 0; /* F^-1 (E / F)^j: what f^(j) is multiplied by */
  for (int j = 0; s->f && j <= s->derivatives; j++, over *= E / F)
    scale = fmax(scale, over * stf_sources_length(s->n, s->f + j * s->n));
  return fmax(plus, part * scale);
}
