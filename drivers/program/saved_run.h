/* saved_run.h: checkpoints of a run of the program: the words and options of the call and the rows kept so far
 * beside the state of the solver.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SAVED_RUN_H
#define SAVED_RUN_H

#include "integration.h"
#include "trajectory.h"

/* Rows of an option table, and the rule that belongs to them. */
/* clang-format off */
#define CHECKPOINT_OPTIONS                                                                     \
  {"--checkpoint", OUTPUT, "FILE", "save the run there, now and then: 'steif resume FILE' goes on", NULL}, \
  {"--every", POSITIVE, "S", "seconds of wall-clock time between two of them", "60"}
#define CHECKPOINT_RULE {"--every", NEEDS, "--checkpoint"}
/* clang-format on */

/* After a step: save when the time has come. Nonzero when not even the first checkpoint could be written. */
int saved_run_tick(trajectory *tr, steif_solver *s);
/* At the end of a run, however it came, unless it failed. */
void saved_run_end(trajectory *tr, steif_solver *s, const outcome *o);

/* The solver and the rows of call->continues; an exit code after a sentence. */
int saved_run_load(struct call *call, const steif_problem *p, const steif_options *options,
                   trajectory *tr, steif_solver **s);

/* The arguments of the call that a note holds, those of `call` before them, for call_parse: one block. NULL: no
 * memory, or no such note. */
char **saved_run_arguments(const struct call *call, const void *note, size_t bytes, int *argc);

#endif
