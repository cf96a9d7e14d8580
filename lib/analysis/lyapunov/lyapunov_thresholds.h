/* lyapunov_thresholds.h: the numbers that verdicts of this room depend on, and why they are what they
 * are.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LYAPUNOV_THRESHOLDS_H
#define STF_LYAPUNOV_THRESHOLDS_H

/* Relative rounding of a step size that is a part of a run: it adds no step and no window. */
#define STF_STEP_ROUNDING 1e-12
/* Steps of a run that long counters and t + h can tell apart. */
#define STF_STEPS_MOST 1e15
/* A method makes steps of the length it was given but for this. */
#define STF_STEP_OFF 1e-6
/* |M(inf)| below this is 0: the method forgets errors of algebraic components in one step. */
#define STF_FORGETS 1e-9
/* Pivots of a leading matrix below this part of the first are rounding: its rank. */
#define STF_RANK_PIVOT 1e-12
/* A function that is linear at five points to this is linear: sums of two images carry a few rounding
 * errors each. */
#define STF_LINEAR_OFF 1e-12
/* Nodes of a method that differ by less modulo 1 are one. */
#define STF_NODE_DISTANCE 1e-12
/* The parasitic modes of h = 0 have gone when they are below this, the rounding of what they disturb. */
#define STF_PARASITIC_GONE 1e-15
/* Diagonal entries of R further apart than this are left to reflections: eps 64^2 < 1e-12. */
#define STF_SQUARES_SPREAD 64.0
/* Diagonals of R whose squares neither overflow nor underflow. */
#define STF_SQUARES_LEAST 1e-130
#define STF_SQUARES_MOST 1e130

/* Lengths of refined divisions have this ratio, the one that whole numbers fit worst. */
#define STF_GOLDEN 1.6180339887498949
/* Quadrature of trace J: error of a panel relative to 1 + |mean|, and how far two divisions may be apart. */
#define STF_TRACE_PANEL 1e-9
#define STF_TRACE_AGREES 1e-6
/* Tolerance of runs that stand for the solution of a problem. */
#define STF_REFERENCE_RTOL 1e-8

/* Exponents: differences below this part of min(1, 1/h) + |value| are rounding of long sums of logarithms. */
#define STF_EXPONENT_ROUNDING 1e-9
/* |y'| below this part of its start: the solution has come to rest, and no exponent has to be 0. */
#define STF_AT_REST 1e-6
/* Multipliers below this part of the largest are rounding of the map of a period. */
#define STF_MULTIPLIER_ROUNDING 1e-9
/* A period is a whole number of steps to this part of it. */
#define STF_PERIOD_OFF 1e-12

/* The supervisor scales w when |w| leaves this range, far from the ends of double precision. */
#define STF_W_SMALLEST 1e-100
#define STF_W_LARGEST 1e100
/* First step of a solver that takes over, in steps of the one before: a multistep method begins with order
 * 1, whose error would tilt w as much as a whole window does later. */
#define STF_TAKE_OVER 0.1
/* c = this / (t1 - t0) of the step of backward Euler that makes w consistent: it is 1e-8 of the run, so
 * short that it moves algebraic components alone. */
#define STF_CONSISTENT_SHIFT 1e8

#endif
