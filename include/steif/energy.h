/* steif/energy.h: does an invariant drift (grow) or oscillate over a run, and is the map of one step
 * symplectic?
 *
 * A symplectic method with a constant step size keeps a modified energy: the energy itself
 * oscillates in a band whose width shrinks with the step size, for a very long time. With other
 * methods the energy drifts along a line. Which of the two a run shows is judged by the slope of the
 * line through the means of 16 equal parts of the run, against the scatter of the means about it,
 * and nine tenths of the way that the means go must be one way: oscillations within a part cancel,
 * and a random walk of rounding turns back.
 *
 * The map of one step y -> Phi(y) of a Hamiltonian system is symplectic if its Jacobian
 * satisfies J^T Omega J = Omega with Omega = [0 I; -I 0] for (q, p). det J = 1 is less than
 * that as soon as there are two positions.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_ENERGY_H
#define STEIF_ENERGY_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of one invariant I: max, min, final and mean of I(t) - I(t0) over all steps, start included. */
typedef struct steif_drift {
  sunrealtype start; /* I(t0) */
  sunrealtype max, min, final, mean;
  sunrealtype slope, slope_error; /* per unit of time, and its standard error */
  sunrealtype per_period;         /* slope times the period; NaN where there is none */
  int drifts; /* 1: above 5 standard errors, or the last mean is above 8 times the
                                     middle one, and one way; or nearly all the way is one, in 16 parts,
                                     and leads half as far as the extreme at least: lost for good */
} steif_drift;

typedef struct steif_energy {
  sunrealtype
    period; /* in: the period if known, 0: the mean distance of the maxima of the first
                          component; out: the one used, NaN for fewer than two maxima */
  steif_drift *drift; /* in: room for problem.invariants */
  size_t rows;        /* in: room in `row`; out: rows filled */
  sunrealtype
    *row;     /* rows of 1 + invariants numbers: t and the drifts, of steps at even distances */
  long steps; /* out */
  sunrealtype h,
    end; /* out: the constant step, 0: other steps; the end of the last one: t0 + N h */
} steif_energy;

/* Integrate to options.t1 (0: the problem's), with a constant step to the last whole step that is not
 * after it, and measure the drifts. options.observe is called as in any run. After STEIF_STOPPED (options.stop) all of this is of the steps made; steps = 0: of none. */
STEIF_EXPORT int steif_energy_measure(steif_context *ctx, const steif_problem *problem,
                                      const char *method, const steif_options *options,
                                      steif_energy *energy);

typedef struct steif_step_map {
  sunrealtype determinant; /* of J */
  sunrealtype symplectic;  /* largest entry of |J^T Omega J - Omega|; NaN without positions */
  sunrealtype reversal; /* largest component of R Phi R Phi(y) - y with R (q, p) = (q, -p), for
                              systems that R reverses; NaN without positions */
  sunrealtype
    radius; /* largest |multiplier|, eigenvalue of J: where the problem is linear and this is
                         above 1, the numbers grow */
  int
    border; /* 1: multipliers meet at -1, to 1e-6, with fewer vectors than there are of them: a linear problem is at
                 the border of stability (verlet: h times the frequency is 2), most starts grow like t. Where they
                 meet with as many (gauss:s=2: h times the frequency is 12^(1/2)) nothing grows */
} steif_step_map;

/* One step of length h from the start of the problem, and its Jacobian by differences of
 * order four (exact but for rounding where problem.linear). Omega: n x n by rows, NULL:
 * canonical, which needs positions = n/2. J: n x n by rows, NULL: not wanted. */
STEIF_EXPORT int steif_step_map_find(steif_context *ctx, const steif_problem *problem,
                                     const char *method, sunrealtype h,
                                     const sunrealtype *Omega, sunrealtype *J,
                                     steif_step_map *map);

#ifdef __cplusplus
}
#endif
#endif
