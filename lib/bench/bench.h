/* bench.h: timing.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BENCH_H
#define STF_BENCH_H

#include "march.h"
#include <steif/bench.h>

/* Processor seconds of all threads since the start of the process. */
sunrealtype stf_now(void);

/* Seconds by the clock. */
sunrealtype stf_clock(void);

/* Seconds of processor time of one call of work(data), least of several batches that each last at
 * least a few milliseconds. */
sunrealtype stf_time(void (*work)(void *data), void *data);

/* A step of a solver: the average over a run of `steps` equal steps, least of several runs. */
int stf_time_steps(steif_context *ctx, const char *problem, const char *method, int steps,
                   sunrealtype h, sunrealtype *seconds);

/* --- threads.c --- */
/* n, step_s, floor_s: a step by two threads and by one; STEIF_NOT_CERTIFIED where they disagree. */
int stf_bench_threads(steif_context *ctx, const char *problem, const char *method,
                      sunrealtype h, steif_bench_row *row);

/* --- published.c --- */
/* The members that come from print: peer, peer_s, peer_baseline_s. */
void stf_bench_published(steif_bench_match *m);

#endif
