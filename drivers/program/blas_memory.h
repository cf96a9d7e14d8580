/* blas_memory.h: OpenBLAS waits without end for the memory of its buffers.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef BLAS_MEMORY_H
#define BLAS_MEMORY_H

#include "command_line.h"

/* Returns where there is as much; else ends the program at once, after a sentence. */
void need_blas_memory(const struct call *call);

#endif
