/* oscillator.h: q'' + c q' + k q = u with c = 1/2, by closed forms, and runs beside them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef OSCILLATOR_H
#define OSCILLATOR_H

#include <steif/discrete.h>

enum drive { NOTHING, ONE, RAMP, SINE }; /* u = 0, 1, t, sin 2t */

/* (q, q') at t of the solution with q(0) = q'(0) = 0; of NOTHING with q(0) = 1, q'(0) = 0. */
void exact(double k, enum drive drive, double t, double h[2]);

/* The system in s, with C = (1, 0); A holds four numbers. */
steif_state_space oscillator(double k, double A[4]);

/* What is changed of a scheme before it runs. */
typedef void (*change_fn)(steif_discrete *d, double *room);

/* Of an error (e, v): |e|, the 2-norm, the larger one. */
enum size { OUTPUT, LENGTH, LARGEST };
/* The largest error on the grid of [0, 4]; NaN after a failure. */
double worst(const char *scheme, double k, enum drive drive, double dt, enum size of,
             change_fn change);

#endif
