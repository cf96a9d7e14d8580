/* pairing.h: <x_h, g> of a run while it is made, all components at once.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PAIRING_H
#define STF_PAIRING_H

#include "base.h"
#include <steif/weak.h>

enum { STF_BOX = 8, STF_DERIVATIVES = 64 }; /* points of Gauss's rule on a step */

/* A test function on [0, t1]; given NULL: (1 - t)_+^8. */
typedef struct stf_weight {
  steif_context *ctx;
  const steif_weight *given;
  long double t1, node[STF_BOX], weight[STF_BOX];
  int parts;                       /* of a step, each with its rule */
  const struct stf_spline *smooth; /* for values; NULL: from `given` */
} stf_weight;
stf_weight stf_weight_of(steif_context *ctx, const steif_weight *given);
/* Derivatives 0 .. order at t, 0 at t1 and beyond. */
int stf_weight_at(const stf_weight *g, long double t, int order, long double *derivative);
/* The same at t1, from the left. */
int stf_weight_end(const stf_weight *g, int order, long double *derivative);
/* int_a^b g by Gauss's rule, which ends at t1. */
int stf_weight_box(const stf_weight *g, long double a, long double b, long double *value);
/* As many parts as boxes of long steps h take: more than one where g is rough for its rule. */
int stf_weight_resolve(stf_weight *g, long double h);
/* The largest |g| of a few hundred places on [0, t1], and the largest rate at which it changes, 1/time:
 * |g'| and sqrt |g''| in units of it. */
int stf_weight_scale(const stf_weight *g, long double *most, long double *rate);

/* A run as a distribution, for norms: values of a constant density on each step, or masses at (i + c) h;
 * rows of n. */
typedef struct stf_events {
  size_t count, room;
  bool masses;
  long double *at;    /* in units of the pairing: of masses, or where a density ends */
  long double *value; /* densities, or masses */
  int most;           /* I^j of the run behind each, j = 1 .. most, as rows of `state`: */
  long double *state; /* rows of n x most; NULL: not known to more digits than values tell */
} stf_events;

/* Equal steps from one time to another. */
typedef struct stf_segment {
  long double from, to, h;
  size_t steps;
} stf_segment;

/* Gregory's weights w_0, w_1, ... of order p, then 1: sum_i w_i F(i h) h is the integral from 0 on, to order
 * p. */
enum { STF_GREGORY = 5 };
long double stf_gregory(int p, size_t i);

/* Of values x_i at from + i h and stages. */
typedef struct stf_pairing {
  const stf_weight *g;
  enum steif_convention convention;
  bool solved; /* x_0 is a value of the run, not x(0-): the comb has it */
  int ends;    /* order of Gregory's weights of a comb at the end of the segment; 0: none */
  size_t steps;
  long double from, h;
  long double unit; /* of times of events; the first segment starts at 0 */
  int n;
  stf_events *events; /* all of it, too; NULL: not wanted */
  long double *sum;   /* n */
  long double
    *square; /* n: sums of squares of terms, with sizes of weights; NULL: not wanted */
} stf_pairing;
/* What rounding of weights makes of a sum of terms with this sum of squares: two standard deviations. */
long double stf_weight_noise(const stf_weight *g, long double square);
int stf_pairing_node(stf_pairing *p, size_t i, const long double *x);
/* Stage X at (i + c) h with weight b. */
int stf_pairing_stage(stf_pairing *p, size_t i, long double c, long double b,
                      const long double *X);

#endif
