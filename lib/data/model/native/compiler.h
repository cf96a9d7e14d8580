/* compiler.h: a text of C into a library that is open, by a compiler of the system.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COMPILER_H
#define STF_COMPILER_H

#include "base.h"

/* The shared library of a text: from `folder`, where one of the same text lies, else made there; NULL: in a
 * folder of its own that is removed at once. NULL with the sentence on failure. dlclose ends it. */
void *stf_library_of(steif_context *ctx, const char *compiler, const char *folder,
                     const char *text);

#endif
