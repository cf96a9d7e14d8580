/* private_library.h: CVODES and IDAS export the names of CVODE and IDA, which the library and perhaps its caller are
 * linked with: their functions are looked up in a library of their own, which sees its own names first.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PRIVATE_LIBRARY_H
#define STF_PRIVATE_LIBRARY_H

#include "base.h"

typedef struct stf_library {
  steif_context *ctx;
  const char *package;
  void *handle;
} stf_library;

/* The library `file`, "" where there was none when steif was built, or the same below `path`; it is closed with the
 * pool. STEIF_UNSUPPORTED with the remedy. */
int stf_library_open(steif_context *ctx, stf_pool *pool, const char *package, const char *file,
                     const char *path, stf_library *library);
/* The address of a function into the pointer that `function` points to. */
int stf_library_function(stf_library *library, const char *name, void *function);

#endif
