/* descent.h: shared inside the room: one descent, its runs, and what is made of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_FIT_H
#define STF_FIT_H

#include "base.h"
#include <steif/fit.h>

/* A datum and where it stands in the order of the user. */
typedef struct stf_datum {
  sunrealtype t;
  size_t place;
} stf_datum;

/* Where a descent has ended, and what has become of a parameter. */
enum stf_end { STF_AT_A_MINIMUM, STF_AT_A_FLAT, STF_AWAY, STF_AT_A_WALL, STF_AGAINST_SLOPES };
enum stf_fate {
  STF_FOUND,
  STF_IDLE,     /* chi2 has no slope along it, and is not less elsewhere, ... */
  STF_NO_SLOPE, /* ... or less, ... */
  STF_AT_REST,  /* ... or more to both sides */
  STF_TO_ZERO,
  STF_TO_INFINITY
};

/* theta is counted from the start of the descent: p = p0 exp(x), or p0 + x unit. */
typedef struct stf_descent {
  steif_context *ctx;
  stf_pool *pool;
  steif_problem *problem;
  const char *method;
  steif_options run;
  const steif_measurements *data;
  stf_datum *sorted;
  int P;
  const int *parameter;
  bool log;
  const sunrealtype *unit, *low, *high; /* of p; bounds may be infinite */
  sunrealtype *p0, *p, *from; /* from: where the descent began; at the end, the best one */
  N_Vector S;
  size_t outputs;                       /* of a model, if some are measured; 0 */
  sunrealtype *output, *slope, *toward; /* their values and derivatives; a direction of p */
  sunrealtype *at;                      /* x of the last good run ... */
  sunrealtype *r, *J;                   /* ... its residuals, and dr/dx by columns ... */
  sunrealtype *column;                  /* ... whose lengths, bounds aside, are these */
  sunrealtype *
    best; /* p, r, J of the run of least chi2 in all descents, for a search that is stopped ... */
  sunrealtype least; /* ... its chi2, and in which descent */
  int descent, best_descent;
  bool known;
  sunrealtype chi2;
  sunrealtype hold;    /* weight of the residuals that keep x where the data do not */
  sunrealtype *values; /* of all parameters when it began */
  int evaluations;
  long runs, failed, iterations;
  long blocked; /* failed runs of the descent; at the end, of the best one */
  enum stf_fate *fate;
  enum stf_end end;
  bool none;         /* of the parameters is determined */
  sunrealtype share; /* of chi2 that J promises it to fall by */
  int stopped;       /* the code of a failed run that other parameters do not cure; 0 */
  char failure[500];
  char used[200]; /* the method of the last good run */
} stf_descent;

/* --- measurements.c --- */
/* Where measurements end at the latest: t1, or (0) the end of the problem, which may have none. */
sunrealtype stf_fit_end(const steif_problem *p, sunrealtype t1);
/* How many outputs the problem has, a model. */
size_t stf_fit_outputs(const steif_problem *p);

/* --- fit_run.c --- */
/* r and J at x, projected to the bounds: STEIF_OK, or STEIF_RETRY where the run failed: the sentence is kept, and
 * `stopped` set where other parameters would not cure it. */
int stf_fit_run(stf_descent *d, const sunrealtype *x);
/* Parameter i at x; *bound: at -1 low, 1 high, 0 between. */
sunrealtype stf_fit_value(const stf_descent *d, const sunrealtype *x, int i, int *bound);
int stf_fit_restore(stf_descent *d);
/* p, r, J and chi2 of the best run. */
void stf_fit_recall(stf_descent *d);

/* --- fit_descent.c --- */
/* From p0: p, r, J, chi2 at the end; *exhausted: evaluations were used up. STEIF_RETRY: the first run failed. */
int stf_fit_descend(stf_descent *d, int *exhausted);

/* --- fit_verdict.c --- */
/* Is this share of chi2 more than errors of the runs are? */
bool stf_fit_above_noise(const stf_descent *d, sunrealtype share);
/* fate of parameters along which chi2 has no slope: by runs in other places, and one more at p0. */
int stf_fit_look_around(stf_descent *d);
/* In words, where parameter i is. */
const char *stf_fit_place(const stf_descent *d, int i);
/* fate and end, by singular values; `share`: of chi2 that J promises it to fall by. */
void stf_fit_end_of(stf_descent *d, const steif_fit *fit, sunrealtype share);

/* --- fit_statistics.c --- */
/* Everything of `fit` that follows from p, r and J. */
int stf_fit_judge(stf_descent *d, steif_fit *fit);
/* An entry of (J^T J)^-1, of what is determined. */
sunrealtype stf_fit_variance(const steif_fit *fit, int i, int j);

/* --- fit_sentence.c --- */
/* Parameter i of those fitted; `room` of STEIF_SPEC_WORD bytes. */
const char *stf_fit_name(const stf_descent *d, int i, char *room);
void stf_fit_say(const stf_descent *d, steif_fit *fit);

#endif
