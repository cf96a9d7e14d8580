/* workprec.h: work against precision: whole solves, the cheapest that reach some digits, means.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef WORKPREC_H
#define WORKPREC_H

#include <steif/solver.h>

/* Work against precision: whole solves, from the creation of the solver to its destruction. Least
 * processor time of all threads over 5 solves and 20 ms; longer solves are repeated less. */
typedef struct steif_bench_solve {
  char problem[STEIF_SPEC_WORD], method[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype rtol, atol, cpu_s, mescd; /* mescd: digits, NaN when the run failed */
  sunrealtype due; /* -log10(rtol) - 1: a good run has more digits than this */
  int baseline;    /* CVODE, IDA or ARKODE */
  int code;        /* enum steif_code */
  int late;        /* ended for its time */
  char message[256];
} steif_bench_solve;

/* Problem or method i of the usual plan, NULL past the end. */
const char *steif_bench_problem(size_t i);
const char *steif_bench_method(size_t i);

/* Measure; a failed run is a result. STEIF_UNSUPPORTED: the method does not take the form of the
 * problem. longest: processor seconds after which a solve is ended; of a baseline wall-clock
 * seconds. */
int steif_bench_measure(steif_context *ctx, const char *problem, const char *method,
                        sunrealtype rtol, sunrealtype longest, steif_bench_solve *solve);

/* The cheapest run that reaches the digits; cpu_s = NaN and an empty name: none does. */
typedef struct steif_bench_pick {
  char method[STEIF_SPEC_WORD];
  sunrealtype rtol, atol, cpu_s, mescd;
} steif_bench_pick;
typedef struct steif_bench_match {
  char problem[STEIF_SPEC_WORD];
  sunindextype n;
  sunrealtype digits;
  steif_bench_pick ours, automatic, baseline; /* automatic: method "auto" */
  sunrealtype ratio, auto_ratio; /* to the baseline; NaN when one of them is missing */
  sunrealtype peer_s,
    peer_baseline_s; /* published: best peer, best of CVODE, IDA, ARKODE; or NaN */
  const char *peer;
} steif_bench_match;

/* Out of the runs on one problem. */
steif_bench_match steif_bench_compare(const steif_bench_solve *solve, size_t count,
                                      sunrealtype digits);

/* Geometric means over the matches with least_n < n <= most_n. */
typedef struct steif_bench_mean {
  sunindextype least_n, most_n;
  long count, auto_count, peer_count; /* ratios in each mean */
  long alone, beaten; /* digits that only steif reaches, that only a baseline reaches */
  sunrealtype ratio, auto_ratio; /* NaN: of nothing */
  sunrealtype peer_ratio;        /* to the best peer at the speed of this machine */
} steif_bench_mean;
void steif_bench_average(const steif_bench_match *match, size_t count, steif_bench_mean *mean);

/* Speed of this machine and this SUNDIALS against the published times: geometric mean of measured
 * over published seconds of the best of CVODE, IDA, ARKODE; NaN: of nothing. */
sunrealtype steif_bench_speed(const steif_bench_match *match, size_t count);

/* The members that come from print: peer, peer_s, peer_baseline_s. */
void stf_bench_published(steif_bench_match *m);

#endif
