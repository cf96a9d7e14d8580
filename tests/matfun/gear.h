/* gear.h: numbers from a small generator, an allocator that fails on request.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GEAR_H
#define GEAR_H

#include <steif/phi.h>

/* Unit round-off. */
#define U 1.1102230246251565e-16

/* In (-1, 1): D. H. Lehmer's generator with the multiplier of S. K. Park, K. W. Miller and
 * P. K. Stockmeyer (CACM 36, 1993). */
double gear_random(unsigned *state);
void gear_fill(int n, double scale, unsigned seed, double *A);
/* ||X - Y||_1 / ||Y||_1 for columns. */
double gear_distance(int n, const double *X, const double *Y);
/* Z = X Y */
void gear_times(int n, const double *X, const double *Y, double *Z);

/* Calls run(ctx) with the first, the second ... allocation failing until it succeeds; every
 * failure must be STEIF_NO_MEMORY. Returns the number of allocations. */
int gear_hunger(int (*run)(steif_context *ctx));

#endif
