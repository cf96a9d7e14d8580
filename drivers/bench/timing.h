/* timing.h: seconds, and the least time of repeated work.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef TIMING_H
#define TIMING_H

#include "integrator.h"

/* Processor seconds of all threads since the start of the process. */
sunrealtype stf_now(void);

/* Seconds of wall-clock time. */
sunrealtype stf_clock(void);

/* Seconds of processor time of one call of work(data), least of several batches that each last at
 * least a few milliseconds. */
sunrealtype stf_time(void (*work)(void *data), void *data);

/* A step of a solver: the average over a run of `steps` steps of length h, least of several runs. */
int stf_time_steps(steif_context *ctx, const char *problem, const char *method, int steps,
                   sunrealtype h, sunrealtype *seconds);

#endif
