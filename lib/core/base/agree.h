/* agree.h: one decision for all ranks that vectors are spread over.
 *
 * Control flow may depend on numbers only that are the same on all ranks. What one of them alone knows (a
 * callback that failed, a clock, a flag) becomes such a number by a sum over the communicator of a vector, which
 * every vector of SUNDIALS over MPI offers (N_VDotProdMultiAllReduce), so that nothing here is linked to MPI.
 * No rank waits for ever: each function here is called by all ranks at the same place, with the same vector, and
 * makes as many sums on each of them. With vectors that are not spread all of them return what they are given.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_AGREE_H
#define STF_AGREE_H

#include "space.h"

/* `like` may be NULL in all of these: not spread. Can its ranks agree? */
int stf_agree_check(steif_context *ctx, N_Vector like);

/* 0 if `code` is 0 on all ranks; else the code and the sentence of one that failed, fatal ones first. */
int stf_agree(steif_context *ctx, N_Vector like, int code);

/* The same, and flags as by stf_agree_any, at most 7, in one sum. */
int stf_agree_flags(steif_context *ctx, N_Vector like, int code, int count, bool *flag);

/* The same for what callbacks return, without sentences: one < 0, else one > 0. */
int stf_agree_returned(N_Vector like, int returned);

/* What callbacks returned on this rank that the others have not heard of: carried along by the next sum that is made
 * anyway (gmres.h). Until then the rank that failed goes on with numbers that do not matter. */
typedef struct stf_deferred {
  bool on;
  bool opening, gone; /* see stf_deferred_gate */
  int returned;       /* the worst, 0: all well; < 0 before > 0 */
  long id;            /* of the callback */
  const char *(*name)(long id);
  int rank;      /* the lowest that failed last, where ranks know their numbers; else -1 */
  long *sums;    /* counts what was made to agree */
  N_Vector like; /* of the solver */
} stf_deferred;

/* While a solver is made a rank may fail alone, for want of memory, and leave: `opening`. Whatever waits for all
 * ranks is preceded by this, which the rank that leaves calls once, in stf_deferred_leave. Not 0: some rank has
 * left, `gone`, and nothing more is to be waited for. */
int stf_deferred_gate(N_Vector like, stf_deferred *d);
/* The same with a sentence, of the solver that the context opens, if it does: before sums over vectors, and before
 * those like this one are cloned, wherever that is. Vectors of parts duplicate their communicator then, for which all
 * ranks must be there. */
int stf_sum_gate(steif_context *ctx);
int stf_clone_gate(steif_context *ctx, N_Vector like);
/* At the end of it, with the code of this rank: that of all, with the sentence of one that failed itself. */
int stf_deferred_leave(steif_context *ctx, N_Vector like, stf_deferred *d, int code);

/* Of one callback: at once, or later where it is on. Returns what is agreed, or 0. */
int stf_deferred_add(N_Vector like, stf_deferred *d, int returned, long id);
/* Once a sum has shown that some rank failed: what was returned there, by which callback. */
int stf_deferred_settle(N_Vector like, stf_deferred *d, const char **name);

/* Is one of `count` flags set on any rank? They become the same everywhere. */
void stf_agree_any(N_Vector like, int count, bool *flag);

/* The lowest of the ranks that are at fault here, of which there is one: its number in the communicator, -1 where
 * ranks do not know theirs, and the number, from 0, of its first row of these. True on that rank (on all of them where
 * numbers are not known). */
bool stf_agree_lowest(N_Vector like, bool fault, sunindextype rows, int *rank,
                      long long *first);

/* The sum over all ranks, exact below 2^53. */
long long stf_agree_total(N_Vector like, long long part);

/* Are these bytes the same on all ranks? */
bool stf_agree_same(N_Vector like, const void *bytes, size_t count);

/* The first of these numbers that is not the same on all ranks, -1: they all are, which takes one sum. */
long stf_agree_different(N_Vector like, size_t count, const unsigned long long *number);

#endif
