/* decay_thresholds.h: the numbers that step verdicts depend on, and why they are what they are.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DECAY_THRESHOLDS_H
#define STF_DECAY_THRESHOLDS_H

/* Unknowns of maps over a period: dense, n^3 a step. */
#define STF_DECAY_UNKNOWNS 64
/* A step is a fraction of the period to this, with numerators up to that many periods. */
#define STF_FRACTION_OFF 1e-12
#define STF_TURNS_MOST 4096
/* Multipliers of the equation agree relative to 1 + |exponent|; exponents by QR, which a finite run blurs. */
#define STF_MONODROMY_AGREES 1e-10
#define STF_FLOW_AGREES 1e-6
/* Refinements of the flow, and steps of one run: what a verdict may cost. */
#define STF_REFINEMENTS 8
#define STF_FLOW_STEPS 40000
/* Half-width of 95 % by Student's t with 15 degrees of freedom: exponents from 16 parts of a run. */
#define STF_STUDENT 2.131
/* The numbers decay as the equation does: to a tenth, and with no rise above e times its own. */
#define STF_DECAY_SHARE 0.1
#define STF_RISE_MORE 1.0
/* Errors that a sign is to be away from 0 in the search for h*. */
#define STF_SIGN_ERRORS 4
/* A step this near a fraction of the period samples it alike for 1000 steps. */
#define STF_NEAR_FRACTION 1e-3
/* The search: factor downwards, good steps in a row, steps of the grid in an octave, fewest steps in a run,
 * relative width of the bracket, smallest step as a part of the first, and steps in all, which take some seconds. */
#define STF_SEARCH_DOWN 0.618
#define STF_SEARCH_ROW 3
#define STF_SEARCH_GRID 24
#define STF_SEARCH_FEWEST 256
#define STF_SEARCH_WIDTH 1e-3
#define STF_SEARCH_LEAST 1e-4
#define STF_SEARCH_STEPS 4000000
/* Steps this close are one. */
#define STF_SEARCH_SMALLEST 1e-5
/* A period that is looked for. Every entry comes back at so many times, to so many roundings of t and of A; s
 * varies by more than this part of its size; a lag is tried below this part of the largest mean square, and
 * given up where s is off by more than that part of its range. A period that was told is one to so much of the
 * largest entry, as if written with six digits. */
#define STF_PERIOD_POINTS 256
#define STF_PERIOD_ROUNDING 16
#define STF_PERIOD_VARIES 1e-9
#define STF_PERIOD_MINIMUM 0.1
#define STF_PERIOD_NEAR 1e-6
#define STF_PERIOD_TOLD 1e-4
/* The tail: orders seen on two octaves agree to this. */
#define STF_TAIL_AGREES 0.2

#endif
