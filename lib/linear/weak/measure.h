/* measure.h: runs of a method paired with the test function, and their rounding.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MEASURE_H
#define STF_MEASURE_H

#include "subject.h"

typedef struct stf_measure {
  steif_context *ctx;
  const steif_weak_query *query;
  stf_subject subject;
  sunrealtype *exact, *value,
    *level;         /* n each: of every component; of the last run; its rounding */
  long double *sum; /* 4 x n: work, in the coordinates of the run */
  N_Vector room;    /* n */
  sunrealtype h;    /* first step */
  int first, count; /* components paired */
  bool cq;
  bool longer; /* there is a second run in long double */
} stf_measure;

int stf_measure_open(steif_context *ctx, const steif_weak_query *query, stf_measure *measure);
void stf_measure_close(stf_measure *measure);
/* A run with so many steps h: value and level. */
int stf_measure_run(stf_measure *measure, sunrealtype h, size_t steps);

#endif
