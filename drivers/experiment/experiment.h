/* experiment.h: the experiment room inside: what an experiment is, and the three common kinds.
 *
 * Texts are literals: findings and curves keep the pointers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EXPERIMENT_H
#define STF_EXPERIMENT_H

#include "base.h"
#include "findings.h"
#include <steif/solver.h>

typedef struct stf_trial {
  steif_context *ctx;
  const void *data; /* of the shelf entry */
  stf_pool *pool;
  size_t count, room;
  steif_finding *finding;
  size_t curves;
  steif_curve *curve;
} stf_trial;

typedef struct steif_experiment {
  const char *about;
  steif_plot frame; /* the picture, without its curves */
  int (*run)(stf_trial *t);
  const void *data; /* of `run` */
} steif_experiment;

/* One more finding: `tolerance` is what the digits of the reference and rounding allow for, absolute;
 * the reference may be NaN. */
int stf_find(stf_trial *t, const char *of, sunrealtype h, const char *quantity,
             sunrealtype value, sunrealtype reference, sunrealtype tolerance);
/* Beside the last finding: what its source prints, and the value with the start of that source. */
void stf_beside(stf_trial *t, sunrealtype printed, sunrealtype imitated);
/* One more curve, and points of the last one. marks as of steif_curve. */
enum { STF_CURVES = 32 };
int stf_curve(stf_trial *t, const char *label, int marks);
int stf_curve_point(stf_trial *t, sunrealtype x, sunrealtype y);

/* Errors at t1 with steps h, h/2, ... of several methods on a problem whose solution is known. */
enum { STF_HALVINGS = 8 };
typedef struct stf_order_line {
  const char *method;
  sunrealtype error[STF_HALVINGS]; /* 0: not stated */
} stf_order_line;
typedef struct stf_orders {
  const char *problem;
  sunrealtype t1, h;
  size_t rows, lines;
  const stf_order_line *line;
  sunrealtype digits, floor; /* references are right to digits * error + floor */
} stf_orders;
int stf_order_table(stf_trial *t);

/* Numbers taken from one run with a constant step size. */
enum stf_what {
  STF_NOTHING,
  STF_MAX, /* of the first invariant's drift */
  STF_MIN,
  STF_FINAL,
  STF_MEAN,
  STF_PER_PERIOD, /* the slope through it, times the period */
  STF_SECOND,     /* largest |drift| of the second invariant */
  STF_FIRST_END,  /* components 0 and 1 at the end */
  STF_SECOND_END,
  STF_LATE,     /* largest |component 0| in the second half of the run */
  STF_CROSSING, /* time of the first upward zero of component 0, by the line through two points */
  STF_BLOWN,    /* number of the step after which a component is above 1e8 or not finite */
  STF_REJECTED /* 1: the equations of a step were not solved, and it was rejected */
};
typedef struct stf_known {
  enum stf_what what;
  sunrealtype reference, tolerance;
} stf_known;
typedef struct stf_constant_run {
  const char *problem, *method, *label; /* label: in the table, NULL: the method */
  sunrealtype h;
  long steps;
  bool drawn;
  stf_known known[6];
} stf_constant_run;
enum stf_picture { STF_DRIFT, STF_ORBIT, STF_COMPONENT };
typedef struct stf_constant_runs {
  enum stf_picture
    picture; /* drift of the first invariant over t, (q, p), component 0 over t */
  sunrealtype period;
  size_t lines;
  const stf_constant_run *line;
} stf_constant_runs;
int stf_constant_table(stf_trial *t);
/* The smallest h = step, 2 step, 3 step, ... with which a run to t1 blows up; 0: none up to most. */
int stf_blow_up(stf_trial *t, const char *problem, const char *method, sunrealtype step,
                sunrealtype most, sunrealtype t1, sunrealtype *h);

/* Backward Euler on van der Pol's equation from (2, 0), by the real root nearest the last value. */
typedef struct stf_cubic_line {
  const char *label;
  sunrealtype mu, h;
  long steps;
  sunrealtype q, p, late, several; /* references; NaN: not stated */
} stf_cubic_line;
int stf_cubic_table(stf_trial *t, const stf_cubic_line *line);

/* Largest |y - y_h| over the grid points of [0, 4] for q'' + q'/2 + k q = sin 2t, y = q, from rest. */
typedef struct stf_scheme_line {
  const char *scheme;
  sunrealtype error[5]; /* 0: not stated */
} stf_scheme_line;
typedef struct stf_schemes {
  sunrealtype k;
  size_t lines;
  const stf_scheme_line *line; /* dt = 0.4, 0.2, ... */
} stf_schemes;
int stf_scheme_table(stf_trial *t);

/* Local errors and growth of BDF2 on x' = A(t) x, in three ways: begun right, begun by rk4 without its
 * last stage, and as printed. NaN: not printed. */
enum {
  STF_LTE_MEAN,
  STF_LTE_MAX,
  STF_TAU,
  STF_MU, /* the printed one */
  STF_MU_LAST,
  STF_MU_PARTIAL,
  STF_MU_RUNNING,
  STF_MU_WINDOW,
  STF_DIAGNOSTICS
};
typedef struct stf_growth_line {
  const char *problem, *label;
  sunrealtype h, abscissa; /* of the picture */
  long steps;
  sunrealtype right[STF_DIAGNOSTICS], weak[STF_MU + 1], printed[STF_MU + 1];
} stf_growth_line;
typedef struct stf_growths {
  size_t lines;
  const stf_growth_line *line;
} stf_growths;
int stf_growth_table(stf_trial *t);

typedef struct stf_experiment_entry {
  const char *name;
  const steif_experiment *item;
} stf_experiment_entry;
extern const stf_experiment_entry stf_experiment_shelf[];
extern const size_t stf_experiment_count;

#endif
