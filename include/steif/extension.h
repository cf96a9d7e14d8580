/* steif/extension.h: for libraries that stand beside this one, with callbacks and solvers of their own: the
 * memory and the sentences of a context, and agreement of ranks. Users of problems do not need it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_EXTENSION_H
#define STEIF_EXTENSION_H

#include <stddef.h>
#include <steif/base.h>
#include <sundials/sundials_nvector.h>

#ifdef __cplusplus
extern "C" {
#endif

struct steif_problem; /* problem.h */

/* count * size bytes, zeroed, from the allocator of the context, or NULL with the sentence set. */
STEIF_EXPORT void *steif_allocate(steif_context *ctx, size_t count, size_t size);
/* NULL is accepted. */
STEIF_EXPORT void steif_release(steif_context *ctx, void *block);

/* Leave `code` and a sentence as printf makes it; returns the code. A callback that does so before it
 * returns a number other than 0 has its sentence shown instead of one about that number. */
STEIF_EXPORT int steif_fail(steif_context *ctx, int code, const char *format, ...)
  STEIF_PRINTF(3, 4);

/* The same decision on all ranks that `like` is spread over: 0 where `code` is 0 on all of them, else the code and
 * the sentence of one that failed. All of them call it at the same place. A vector that is not spread, or NULL:
 * `code`. The vector must have the operation nvdotprodmultiallreduce. */
STEIF_EXPORT int steif_agree(steif_context *ctx, N_Vector like, int code);

/* STEIF_BAD_INPUT with "ranks disagree in `what`" on all ranks where these bytes are not the same on all of them (NULL:
 * none); or the members of a problem that are to be the same, with their name. */
STEIF_EXPORT int steif_same(steif_context *ctx, N_Vector like, const char *what,
                            const void *bytes, size_t count);
STEIF_EXPORT int steif_same_problem(steif_context *ctx, N_Vector like,
                                    const struct steif_problem *problem);

/* A problem whose callbacks call those of another one has a user of its own, `user`; options.ewt, which the caller gives
 * beside it, is called with `own` in its place. STEIF_NO_MEMORY. steif_stand_down ends that, before `user` goes. */
STEIF_EXPORT int steif_stand_in(steif_context *ctx, const void *user, void *own);
STEIF_EXPORT void steif_stand_down(steif_context *ctx, const void *user);

#ifdef __cplusplus
}
#endif
#endif
