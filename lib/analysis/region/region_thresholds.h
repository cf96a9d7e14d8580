/* region_thresholds.h: the numbers that verdicts of this room depend on, and why they are what they are.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REGION_THRESHOLDS_H
#define STF_REGION_THRESHOLDS_H

/* rho - 1 up to which a boundary counts as reached, not crossed. */
#define STF_RHO_TOUCHES 1e-9
/* Rounding errors of rho for small matrices; what is above means growth. */
#define STF_RHO_NOISE 1e-13
/* rho(M(inf)) that counts as zero; a root of multiplicity r keeps an r-th of the digits. */
#define STF_RHO_DAMPED 1e-14
/* Eigenvalues of M(0) nearer than this to each other are one, nearer than this to the circle are on it: a
 * double root moves by the square root of rounding errors, a fourfold one by their fourth root. */
#define STF_ROOT_DISTANCE 1e-4
/* Maxima of rho along a ray are found to this in log10 |z|: rho is flat there. */
#define STF_PEAK_WIDTH 1e-9
/* Angles are bisected to this, in radians. */
#define STF_ANGLE_WIDTH 1e-13
/* Relative rounding of a time or of a step size that was made of others. */
#define STF_TIME_ROUNDING 1e-12
/* Steps of runs that tell rounding differ by this part, 2^-40; the largest of two differences is taken so many
 * times: of 80 errors of four methods on the oscillator, known in 60 digits, none is off by more. */
#define STF_SHAKEN_STEP 9.094947017729282e-13
#define STF_SHAKEN_MORE 4

#endif
