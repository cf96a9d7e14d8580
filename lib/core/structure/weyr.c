/* weyr.c: from dimensions of kernels to the Weyr characteristic and the Jordan blocks of a nilpotent
 * matrix. F. R. Gantmacher, Theory of Matrices I (1959), ch. VII; H. Shapiro, The Weyr
 * characteristic, Amer. Math. Monthly 106 (1999).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weyr.h"

int stf_weyr_find(stf_kernel_dimension kernel, void *data, sunindextype all, int most,
                  sunindextype *weyr, int *count, bool *complete)
{
  sunindextype before = 0;
  *count = 0;
  while (*count < most && before < all) {
    sunindextype dimension;
    STEIF_TRY(kernel(data, *count + 1, &dimension));
    if (dimension <= before) break;
    weyr[*count] = dimension - before;
    before = dimension;
    ++*count;
  }
  *complete = before == all;
  return STEIF_OK;
}

int stf_weyr_block(const sunindextype *weyr, int count, sunindextype b)
{
  int size = 0;
  while (size < count && weyr[size] > b) size++;
  return size;
}
