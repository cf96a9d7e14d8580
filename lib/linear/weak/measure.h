/* measure.h: runs of a method paired with the test function, and their rounding.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MEASURE_H
#define STF_MEASURE_H

#include "longer.h"
#include "subject.h"
#include "turned.h"
#include "spline.h"

/* The steps of the first row: from break to break where a run begins anew at the breaks of f, else one
 * segment. Row i has 2^i times as many. */
typedef struct stf_mesh {
  size_t count;
  stf_segment *segment; /* allocated */
  bool able, anew;      /* it can; it does */
  int ends; /* order of Gregory's weights at breaks, for convolution quadrature; 0: none */
} stf_mesh;

typedef struct stf_measure {
  steif_context *ctx;
  const steif_weak_query *query;
  stf_subject subject;
  sunrealtype *exact, *value, *level,
    *away;            /* n each: of every component; of the last run; its rounding; work */
  long double *sum;   /* 5 x n: work, in the coordinates of runs; the last: x at breaks */
  N_Vector room;      /* n */
  stf_events *events; /* 3: of the run in double, in long double, shaken; NULL: not wanted */
  stf_mesh mesh;
  sunrealtype h;                /* first step, the longest */
  int halvings;                 /* of the row that is made */
  stf_turned turned[STF_TURNS]; /* where the run has coordinates of its own */
  stf_spline smooth;            /* the test function, where it is given */
  int first, count;             /* components paired */
  bool cq;
  bool as_given; /* a run in many digits takes E and F as they are */
  bool longer;   /* there is a second run in long double */
} stf_measure;

/* Does the query make sense, as far as it can be seen without the system? */
int stf_measure_check(steif_context *ctx, const steif_weak_query *query);
int stf_measure_open(steif_context *ctx, const steif_weak_query *query, stf_measure *measure);
void stf_measure_close(stf_measure *measure);
/* first and count. */
int stf_measure_components(stf_measure *measure);
/* The longest step that resolves the system, f and g, and what asks for it. */
int stf_measure_longest(const stf_measure *measure, sunrealtype *longest, const char **fastest);
/* The rate of f; bad input where f or a derivative that counts jumps at no break. */
int stf_forcing_rate(stf_measure *measure);
/* The run of row `row`: value and level. */
int stf_measure_run(stf_measure *measure, size_t row);
/* Row i is made: tells who asked to know. */
int stf_measure_tell(const stf_measure *measure, size_t i);
/* Segments of the mesh, and in the row that is made: one of them, its longest step, and its steps on the
 * interval of the test function if all were as long. */
int stf_mesh_open(stf_measure *measure);
stf_segment stf_measure_segment(const stf_measure *measure, size_t i);
sunrealtype stf_measure_step(const stf_measure *measure);
size_t stf_measure_steps(const stf_measure *measure);
/* The steps of the first row in words, where a run begins anew at breaks. */
void stf_mesh_say(const stf_mesh *mesh, char *text, size_t room);

/* Where a run is made: the system, coordinates of it (NULL: its own), its unknowns in another order. */
typedef struct stf_frame {
  const steif_linear *linear;
  const sunrealtype *x0;
  const stf_apart *apart;
  const stf_turned *turned;
} stf_frame;
stf_frame stf_measure_frame(stf_measure *measure);
stf_frame stf_measure_turn(const stf_measure *measure, int i);
/* x_m of z. */
long double stf_frame_component(const stf_frame *frame, int m, const long double *z);
/* The run there, without its pairing. */
stf_longer stf_measure_longer(const stf_measure *measure, const stf_frame *frame, bool shaken);
/* Segment i of it; the first begins at x(0-). */
void stf_longer_segment(stf_longer *run, const stf_segment *part, size_t i);
/* The same in many digits: a row of sums, and the defect of the test function. */
int stf_exact_sums(stf_measure *measure, const stf_frame *frame, bool shaken, int row);
/* The run in many digits as events with their integrals, not paired. */
int stf_exact_events(stf_measure *measure, bool shaken, stf_events *events);

/* Looks at impulses of every order, and at the smooth part, by themselves: takes a verdict back that they
 * contradict, and lowers its order to theirs. */
int stf_measure_parts(stf_measure *measure, steif_weak_result *result);
/* A measure by its rows alone. */
int stf_weak_rows(steif_context *ctx, const steif_weak_query *query, steif_weak_row *row,
                  steif_weak_result *result);

/* The method "cobb": value and level of (E + eps F) x' + F x = f. */
bool stf_is_cobb(const char *method);
int stf_cobb_run(stf_measure *measure, sunrealtype eps);

#endif
