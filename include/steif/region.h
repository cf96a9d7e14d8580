/* steif/region.h: stability regions and observed orders.
 *
 * The step of a method on y' = lambda y is a matrix M(z), z = h lambda; the region is the set where
 * its spectral radius is at most 1. A method is A(alpha)-stable if the region holds the sector
 * |arg(-z)| < alpha, A-stable for alpha = 90 degrees, L-stable if moreover rho(M(inf)) = 0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_REGION_H
#define STEIF_REGION_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_region {
  int a_stable, l_stable;
  int zero_stable;        /* M(0) has spectral radius 1, simple on the circle */
  sunrealtype alpha_deg;  /* largest alpha in degrees, to about 1e-9; 0 if none */
  sunrealtype r_inf;      /* rho(M(inf)) */
  sunrealtype real_limit; /* the interval [-real_limit, 0] is stable; infinite if alpha > 0 */
  sunrealtype imag_limit; /* the same on the imaginary axis (to 1e-9 in rho) */
} steif_region;

STEIF_EXPORT int steif_region_find(steif_context *ctx, const char *method,
                                   steif_region *region);

/* Points of the boundary rho(M(z)) = 1, piece after piece (the longest first) with NaN between
 * pieces and after the last. star = 1: of the order star, rho(M(z)) = |e^z|, for
 * |Re z|, |Im z| <= 8: p + 1 sectors where the method grows more than the solution meet at the
 * origin (G. Wanner, E. Hairer and S. P. Norsett, BIT 18 (1978)). points: count pairs (re, im). */
STEIF_EXPORT int steif_region_boundary(steif_context *ctx, const char *method, int star,
                                       size_t count, sunrealtype *points);

/* rho(M(z)). */
STEIF_EXPORT int steif_spectral_radius(steif_context *ctx, const char *method,
                                       const sunrealtype z[2], sunrealtype *radius);

/* Errors with steps h, h/2, ... at `end` = t0 + N h, the last whole step that is not after t1, against the exact solution of the problem (or its reference),
 * in the maximum norm over components; order[i] = log2(error[i-1]/error[i]), order[0] = NaN. h = 0:
 * the largest step that divides the interval up to 1/16; 1/4 for methods of order 3 to 5 and 1/2 above,
 * which reach rounding errors soon. A reference has one time: STEIF_BAD_INPUT where h does not divide
 * the way to it. The end of a step of gauss:s= is a sum that loses digits, 1e6 roundings at s = 15: it is run with
 * compensated=1 (method.h) unless the spec says otherwise.
 * STEIF_STOPPED (options.stop): the rows made are there, the others have NaN. */
typedef struct steif_order_row {
  sunrealtype h, error, order, end;
  int compensated;      /* 1: with compensated sums, see below */
  sunrealtype rounding; /* level of `error`; NaN: not known */
} steif_order_row;
STEIF_EXPORT int steif_order_measure(steif_context *ctx, const steif_problem *problem,
                                     const char *method, const steif_options *options,
                                     sunrealtype h, size_t rows, steif_order_row *row);

/* Fills in `rounding` of such rows: four times the largest difference between errors of three runs with as many
 * steps, of lengths h and h (1 +- 2^-40), which change the method's own error by a part of 1e-12 times its
 * order, so that what else differs is rounding; and eps |y|. An order says something where errors are above 10
 * times it. Nothing is known where the problem has a reference at one time only. */
STEIF_EXPORT int steif_order_rounding(steif_context *ctx, const steif_problem *problem,
                                      const char *method, const steif_options *options,
                                      size_t rows, steif_order_row *row);

/* max |y_i(t_k) - known_ki| over the components and the times t_1 < t_2 < ... of a run of the method;
 * known: rows of n values. */
STEIF_EXPORT int steif_deviation(steif_context *ctx, const steif_problem *problem,
                                 const char *method, const steif_options *options, size_t count,
                                 const sunrealtype *t, const sunrealtype *known,
                                 sunrealtype *deviation);

#ifdef __cplusplus
}
#endif
#endif
