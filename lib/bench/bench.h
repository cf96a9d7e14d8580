/* bench.h: timing.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BENCH_H
#define STF_BENCH_H

#include "march.h"
#include <steif/bench.h>

/* Seconds of processor time of one call of work(data), least of several batches that each last at
 * least a few milliseconds. */
sunrealtype stf_time(void (*work)(void *data), void *data);

/* A step of a solver: the average over a run of `steps` equal steps, least of several runs. */
int stf_time_steps(steif_context *ctx, const char *problem, const char *method, int steps,
                   sunrealtype h, sunrealtype *seconds);

#endif
