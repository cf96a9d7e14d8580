/* weyr.h: Weyr characteristics and Jordan blocks from dimensions of kernels.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_WEYR_H
#define STF_WEYR_H

#include "base.h"

/* The rank decision. Of N^level, of a matrix that stands for it, or of what deflations leave of N:
 * *dimension = dim ker N^level, called for level = 1, 2, ... in turn; -1: not decided. */
typedef int (*stf_kernel_dimension)(void *data, int level, sunindextype *dimension);

/* weyr[p] = dim ker N^(p+1) - dim ker N^p, *count numbers, at most `most`. They end where the kernel
 * has the dimension `all`, then *complete, or grows no more, or is not decided. */
int stf_weyr_find(stf_kernel_dimension kernel, void *data, sunindextype all, int most,
                  sunindextype *weyr, int *count, bool *complete);

/* The size of Jordan block number b = 0, 1, ..., the largest first; 0: there are no more. The sizes
 * are the conjugate partition. */
int stf_weyr_block(const sunindextype *weyr, int count, sunindextype b);

#endif
