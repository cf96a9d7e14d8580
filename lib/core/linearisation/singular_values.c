/* singular_values.c: the singular value decomposition of LAPACK and ranks by the widest gap.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "singular_values.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

/* Singular values below this part of the largest are rounding. */
static const sunrealtype rounding = 1e-15;

int stf_point_svd(steif_context *ctx, size_t m, size_t n, sunrealtype *A, sunrealtype *s,
                  sunrealtype *U, sunrealtype *VT)
{
  const int rows = (int)m, columns = (int)n, query = -1;
  const size_t least = m < n ? m : n;
  int info = 0;
  double wanted = 0;
  if (least == 0) {
    for (size_t i = 0; i < m * m; i++) U[i] = i % (m + 1) == 0;
    for (size_t i = 0; i < n * n; i++) VT[i] = i % (n + 1) == 0;
    return STEIF_OK;
  }
  int *whole = stf_allocate(ctx, 8 * least, sizeof *whole);
  if (!whole) return STEIF_NO_MEMORY;
  dgesdd_("A", &rows, &columns, A, &rows, s, U, &rows, VT, &columns, &wanted, &query, whole,
          &info, 1);
  const int room = (int)wanted + 1;
  double *work = stf_allocate(ctx, (size_t)room, sizeof *work);
  if (work)
    dgesdd_("A", &rows, &columns, A, &rows, s, U, &rows, VT, &columns, work, &room, whole,
            &info, 1);
  stf_release(ctx, whole);
  stf_release(ctx, work);
  if (!work) return STEIF_NO_MEMORY;
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "singular values of a %zu x %zu matrix were not found (dgesdd returned %d)", m, n,
              info);
  return STEIF_OK;
}

size_t stf_point_rank(const sunrealtype *s, size_t count, sunrealtype top, sunrealtype *gap)
{
  size_t rank = 0;
  const sunrealtype lowest = rounding * top;
  sunrealtype above = top;
  *gap = 0;
  for (size_t k = 0; k <= count; k++) {
    const sunrealtype below = k < count ? fmax(s[k], lowest) : lowest;
    if (above / below > *gap) *gap = above / below, rank = k;
    above = below;
  }
  return rank;
}
