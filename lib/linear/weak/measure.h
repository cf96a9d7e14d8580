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
    *level;           /* n each: of every component; of the last run; its rounding */
  long double *sum;   /* 4 x n: work, in the coordinates of the run */
  N_Vector room;      /* n */
  stf_events *events; /* 3: of the run in double, in long double, shaken; NULL: not wanted */
  sunrealtype h;      /* first step */
  int first, count;   /* components paired */
  bool cq;
  bool longer; /* there is a second run in long double */
} stf_measure;

/* Does the query make sense, as far as it can be seen without the system? */
int stf_measure_check(steif_context *ctx, const steif_weak_query *query);
int stf_measure_open(steif_context *ctx, const steif_weak_query *query, stf_measure *measure);
void stf_measure_close(stf_measure *measure);
/* first and count. */
int stf_measure_components(stf_measure *measure);
/* The longest step that resolves the system, f and g, and what asks for it. */
int stf_measure_longest(const stf_measure *measure, sunrealtype *longest, const char **fastest);
/* A run with so many steps h: value and level. */
int stf_measure_run(stf_measure *measure, sunrealtype h, size_t steps);

/* The same run in many digits, unshaken and shaken: sums 0 and 1; defect: of the test function, relative. */
int stf_exact_sums(stf_measure *measure, stf_apart *apart, sunrealtype h, size_t steps,
                   long double *defect);

/* Takes back `converges` where impulses too small to be seen do not. */
int stf_measure_orders(const stf_measure *measure, steif_weak_result *result);

/* The method "cobb": value and level of (E + eps F) x' + F x = f. */
bool stf_is_cobb(const char *method);
int stf_cobb_run(stf_measure *measure, sunrealtype eps);

#endif
