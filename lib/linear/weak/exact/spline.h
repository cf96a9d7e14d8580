/* spline.h: a test function as a piecewise polynomial, known to all digits: what is paired with a run in many
 * digits. Where it only nears the function it is another test function, as smooth as the index asks for,
 * with the same derivatives at 0 and at all knots.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPLINE_H
#define STF_SPLINE_H

#include "real.h"
#include "pairing.h"

typedef struct stf_spline {
  int limbs, cells, degree;
  long double *rounded; /* of each cell p, then p(1 - v) in powers of v; NULL: not asked for */
  stf_real *p, *primitive; /* of each cell: powers of u in [0, 1], of it and of int_0^t of it */
  stf_real width, inverse, t1,
    whole;            /* of a cell, 1 / width; the interval, and the integral on it */
  long double defect; /* |spline - g|, relative to the largest |g|, as far as seen */
} stf_spline;

/* How smooth it should be at an index: with derivatives at knots beyond those that impulses ask for. */
static inline int stf_smooth(int index) { return index + 3 > 8 ? index + 3 : 8; }
/* Of class C^smooth; rounded: for values in long double, too. */
int stf_spline_open(const stf_weight *g, int smooth, int limbs, bool rounded,
                    stf_spline *spline);
void stf_spline_close(steif_context *ctx, stf_spline *spline);
/* The value at t >= 0, 0 from t1 on; int_0^t of it. */
void stf_spline_at(const stf_spline *spline, int limbs, const stf_real *t, stf_real *value);
/* In long double, from the nearer end of the cell, so that it is accurate where the function ends in a zero
 * of high order; its rounding, and that of t, are about this size in units of long double. */
long double stf_spline_value(const stf_spline *spline, long double t);
long double stf_spline_size(const stf_spline *spline, long double t);
void stf_spline_integral(const stf_spline *spline, int limbs, const stf_real *t,
                         stf_real *value);

#endif
