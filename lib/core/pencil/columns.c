/* columns.c: right-hand sides in vectors to columns of one array and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "simd.h"
#include <stdint.h>
#include <string.h>

int stf_columns_open(steif_pencil *p)
{
  p->work = stf_allocate(p->ctx, (size_t)p->n, STF_COLUMNS * sizeof *p->work);
  return p->work ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Sums of x - x are 0 or NaN; none of four waits for another. */
bool stf_all_finite(const double *x, size_t count)
{
  v2 sum[4] = {{0}, {0}, {0}, {0}};
  double rest = 0;
  size_t i = 0;
  for (; i + 8 <= count; i += 8)
    for (size_t j = 0; j < 4; j++) {
      const v2 at = *(const v2 *)(x + i + 2 * j);
      sum[j] += at - at;
    }
  for (; i < count; i++) rest += x[i] - x[i];
  sum[0] += sum[1] + sum[2] + sum[3];
  return sum[0][0] + sum[0][1] + rest == 0;
}

/* The distance between columns when the vectors are neighbours in memory already, or 0. Separate
 * arrays may not be subtracted as pointers, only as addresses. */
static sunindextype stride(sunindextype n, int nrhs, N_Vector *re)
{
  if (nrhs == 1) return n;
  const uintptr_t first = (uintptr_t)stf_array(re[0]), size = sizeof(double);
  const uintptr_t gap = (uintptr_t)stf_array(re[1]) - first, least = (uintptr_t)n * size;
  if (gap < least || gap > 2 * least || gap % size) return 0;
  for (int k = 2; k < nrhs; k++)
    if ((uintptr_t)stf_array(re[k]) - first != gap * (uintptr_t)k) return 0;
  return (sunindextype)(gap / size);
}

static int real(steif_pencil *p, int slot, int nrhs, N_Vector *re, stf_columns_solve *solve)
{
  const sunindextype ld = stride(p->n, nrhs, re);
  if (ld) return solve(p, slot, nrhs, stf_array(re[0]), ld);
  const size_t n = (size_t)p->n;
  for (int done = 0; done < nrhs; done += STF_COLUMNS) {
    const int now = nrhs - done < STF_COLUMNS ? nrhs - done : STF_COLUMNS;
    for (int k = 0; k < now; k++)
      memcpy(p->work + n * (size_t)k, stf_array(re[done + k]), n * sizeof(double));
    STEIF_TRY(solve(p, slot, now, p->work, p->n));
    for (int k = 0; k < now; k++)
      memcpy(stf_array(re[done + k]), p->work + n * (size_t)k, n * sizeof(double));
  }
  return STEIF_OK;
}

void stf_columns_join(size_t n, const double *restrict re, const double *restrict im,
                      double *restrict w)
{
  for (size_t i = 0; i < n; i++) w[2 * i] = re[i], w[2 * i + 1] = im[i];
}

void stf_columns_part(size_t n, const double *restrict w, double *restrict re,
                      double *restrict im)
{
  for (size_t i = 0; i < n; i++) re[i] = w[2 * i], im[i] = w[2 * i + 1];
}

int stf_columns(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im,
                stf_columns_solve *solve)
{
  if (!im) return real(p, slot, nrhs, re, solve);
  enum { WIDTH = STF_COLUMNS / 2 };
  const size_t n = (size_t)p->n;
  for (int done = 0; done < nrhs; done += WIDTH) {
    const int now = nrhs - done < WIDTH ? nrhs - done : WIDTH;
    for (int k = 0; k < now; k++)
      stf_columns_join(n, stf_array(re[done + k]), stf_array(im[done + k]),
                       p->work + 2 * n * (size_t)k);
    STEIF_TRY(solve(p, slot, now, p->work, p->n));
    for (int k = 0; k < now; k++)
      stf_columns_part(n, p->work + 2 * n * (size_t)k, stf_array(re[done + k]),
                       stf_array(im[done + k]));
  }
  return STEIF_OK;
}
