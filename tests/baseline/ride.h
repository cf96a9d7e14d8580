/* ride.h: a run of one engine without the frame of the march room.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef RIDE_H
#define RIDE_H

#include "baseline.h"

typedef struct ride {
  steif_context *ctx;
  stf_run run;
  steif_options options;
  const steif_engine *engine;
  void *state;
  int code; /* of the last call */
} ride;

/* Tolerances 1e-6, a million steps, nothing else set. */
steif_options ride_defaults(void);
/* Open `problem` with a spec such as "cvode:order=2"; options NULL: defaults. */
int ride_open(ride *r, const steif_problem *problem, const char *spec,
              const steif_options *options);
/* Step until the end t, at most. */
int ride_to(ride *r, sunrealtype t);
/* open and to the end of the problem. */
int ride_whole(ride *r, const steif_problem *problem, const char *spec,
               const steif_options *options);
sunrealtype ride_y(const ride *r, int i);
const char *ride_says(const ride *r);
void ride_close(ride *r);

#endif
