/* hamiltonian_thresholds.h: the numbers that verdicts of this room depend on, and why they are what they
 * are. Those on eigenvalues are public: STEIF_DOUBT, STEIF_NEAR.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_HAMILTONIAN_THRESHOLDS_H
#define STF_HAMILTONIAN_THRESHOLDS_H

/* A run in 16 parts. The slope through their means is a drift from this number of standard errors on
 * (Student's t with 14 degrees of freedom: 2e-4 by accident) ... */
#define STF_DRIFT_PARTS 16
#define STF_DRIFT_ERRORS 5
/* ... if this share of the way that the means go leads one way. */
#define STF_DRIFT_ONE_WAY 0.9
/* Or if the last mean is this many times the middle one: growth as of t^3 or faster, where a line fits
 * badly. */
#define STF_DRIFT_RUNS_AWAY 8
/* Or if nearly all of it does, in all parts, to where the run ends: energy that is lost comes to rest. */
#define STF_DRIFT_STRAIGHT 0.99
/* Rows at even distances: a step that ends this part of a row early fills it. */
#define STF_ROW_ROUNDING 1e-9
/* Solutions of A^T P + P A = 0 are drawn at random up to this often, until one has this condition. */
#define STF_FORM_DRAWS 4
#define STF_FORM_GOOD 100
/* Eigenvalues of a Jordan structure up to which P and K are looked for: the system for them has the square
 * of their number as its order. */
#define STF_JORDAN_LARGEST 20
/* Relative distance of differences of order four: near eps^(1/5), where their errors are least. */
#define STF_STEP_MAP_DIFFERENCE 2e-4
/* Newton's iteration in units of the tolerance: the Jacobian of a step is a difference of steps. */
#define STF_STEP_MAP_NEWTON 1e-6
/* Multipliers within this of -1 are there: a double one is known to the root of rounding, 1e-8. Room for dgeev and
 * dgesvd, in unknowns: 8 and those of their results. */
#define STF_STEP_MAP_TURNED 1e-6
#define STF_STEP_MAP_WORK 8

#endif
