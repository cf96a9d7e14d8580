/* index_thresholds.h: what decides in the tests of the index, and why it is so large. Measured on 36
 * problems of known index.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INDEX_THRESHOLDS_H
#define STF_INDEX_THRESHOLDS_H

/* -- test S: the system Jacobian ------------------------------------------------------------------- */

/* Its reciprocal condition, equilibrated, that certifies the structure: entries that cancel leave the
 * error of differences, 1e-9 of their row. */
#define STF_REGULAR_RCOND 1e-9
/* The same of exact entries, of callbacks: they leave rounding alone. Between the two an unknown hangs on small entries,
 * as a node between diodes that are closed: the structure holds, and tells it. */
#define STF_REGULAR_EXACT 1e-13

/* -- test G: growth of the resolvent --------------------------------------------------------------- */

/* Shifts: the first over the fastest rate, their ratio, and how many; two in a row that agree decide. */
#define STF_FIRST_SHIFT 10.0
#define STF_SHIFT_RATIO 31.622776601683793
enum { STF_SHIFTS = 7 };
/* One random vector misjudges one to three components in 1e5 by accidental cancellation. */
enum { STF_RANDOM_VECTORS = 4, STF_RANDOM_VECTORS_LARGE = 2 };
/* Degrees this near to whole numbers are read off. */
#define STF_WHOLE_DEGREE 0.15
/* s E - A is singular where its reciprocal condition is below 50 n eps at three shifts. */
#define STF_SINGULAR_NOISE 50

/* -- test D: the derivative array ------------------------------------------------------------------ */

/* Parts of null vectors that vanish. */
#define STF_VANISHING 1e-6
/* Gaps of singular values that count at all, and that are certain: the smallest of right verdicts was
 * 2e9 with E and A given, 2e5 by central differences, 2e3 by one-sided ones. */
#define STF_LEAST_GAP 1e3
#define STF_CERTAIN_GAP 1e6
/* Unknowns up to which the array is looked at in any case, and up to which where the other tests do not
 * agree: its singular values take 27 ms for 50 unknowns, 1.3 s for 200. */
enum { STF_ALWAYS_ARRAY = 60, STF_ARRAY_LARGEST = 200 };

/* -- points ---------------------------------------------------------------------------------------- */

/* Points beside the given one are moved by this part of each component's own size, less where F cannot
 * be evaluated: starts 10 % off gave the right verdict for 19 of 21 problems. */
#define STF_POINTS_APART 0.01

#endif
