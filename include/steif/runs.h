/* steif/runs.h: the solution of E x' + F x = f over time: jumps and impulses where they are, a method on the
 * smooth parts between them, or constant steps through the layers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_RUNS_H
#define STEIF_RUNS_H

#include <steif/impulse.h>
#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a run tells as it goes; either may be NULL, nonzero stops the run. */
typedef struct steif_linear_output {
  int (*jump)(sunrealtype t, const sunrealtype *x_minus, const steif_impulse *impulse,
              void *user);
  int (*step)(sunrealtype t, N_Vector x, void *user);
  void *user;
} steif_linear_output;

/* From x(t0-) = x0 to options.t1: at t0 and at every declared break (ascending, inside) the jump and
 * the impulses, then `method` from x(t+) with the options' steps to the next break. Given steps are
 * made on the system as it is. Chosen ones of dense and small systems of index k > 1 are made on one
 * of index 1 with the same smooth solutions, for which f is asked for derivatives up to k - 1 at all
 * times (up to k by methods with |R(inf)| > 0, such as Gauss's): tolerances are met for every index.
 * In large sparse systems an unknown of index k is judged by h^(k-1), as in RADAU5, and the fast
 * part is found anew at every step that is told, x(t) = Phi_{-1} E x(t) + sum_j Phi_j f^(j)(t): it has
 * the accuracy of the slow part, which no error of the fast one enters. Without an absolute tolerance
 * it is rtol times the size of the states, up to 1: max |x(t+)| so far, or what f may make of x = 0. */
STEIF_EXPORT int steif_linear_run(steif_context *ctx, const steif_linear *linear,
                                  const sunrealtype *x0, sunrealtype t0, const char *method,
                                  const steif_options *options, const steif_analysis *analysis,
                                  size_t break_count, const sunrealtype *breaks,
                                  const steif_linear_output *output);

typedef struct steif_linear_truth {
  sunrealtype accuracy;  /* relative difference at the last time to half as many parts */
  sunrealtype end, most; /* errors of the rows given, relative to max |x| over all times: at the
                           last time, at any */
} steif_linear_truth;

/* The smooth parts of the solution that starts as there, at the times t_0 < t_1 < ... after t0 (rows
 * of n into x; at a break its left limit): radau:s=5 in small parts of the steps between them, on a
 * system of index 1 where there is one (dense and small ones), else with the fast part from the
 * Laurent coefficients. f is asked for derivatives up to k - 1. made: rows of a run to be compared;
 * NULL: none. */
STEIF_EXPORT int steif_linear_exact(steif_context *ctx, const steif_linear *linear,
                                    const sunrealtype *x0, sunrealtype t0,
                                    const steif_analysis *analysis, size_t break_count,
                                    const sunrealtype *breaks, size_t count,
                                    const sunrealtype *t, const sunrealtype *made,
                                    sunrealtype *x, steif_linear_truth *truth);

/* E x' + F x = f from x(0-) as it is, without x(0+) and impulses being found first, by be, bdf:p=P or
 * radau:s=S with adaptive steps. Of index k, a run from values that are not consistent, or changed in
 * its length or order, makes a layer of p (k - 1) steps of BDF, k - 1 of Radau: the first one holds
 * the impulses, later ones errors of h^(p+2-k) for k > 2. So h and the order stay as they are
 * within layers; steps are accepted or rejected outside of them only, in blocks of constant size; and a
 * new length is run through its layer once more from before the last value kept, and what it makes
 * of later times is thrown away. Errors are kept below rtol |x| + atol by the difference of
 * order p + 1, for unknowns of every index: an error of h^p in the slow part adds up over 1/h steps,
 * and in the fast part has this size at once. Pointwise O(h^p) (Radau: O(h^(s+2-k))), also at k > 2.
 * BDF of order 2 and more starts as convolution quadrature: its first layer is longer by as many
 * steps as the other roots of the method take to die away. STEIF_STEP_SIZE where rounding, which
 * grows as h^-(k-1) or more, leaves no step to keep the tolerance with. Absolute tolerance: as above,
 * with x(0-). */
typedef struct steif_layers_stats {
  long steps, again, rejected, changes; /* told; made to come through layers and thrown away;
                                          rejected; new lengths */
  int width, opening;                   /* steps of a layer, of the first */
  sunrealtype shortest, longest;        /* steps told */
} steif_layers_stats;
/* Tells t, x (n values) and whether they are in the first layer, t ascending; nonzero stops the run. */
typedef int (*steif_layers_step)(sunrealtype t, const sunrealtype *x, int layer, void *user);
STEIF_EXPORT int steif_layers_run(steif_context *ctx, const steif_linear *linear,
                                  const sunrealtype *x0, sunrealtype t0, const char *method,
                                  const steif_options *options, const steif_analysis *analysis,
                                  steif_layers_step tell, void *user,
                                  steif_layers_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
