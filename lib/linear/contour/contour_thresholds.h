/* contour_thresholds.h: what decides in the analyses by circles, and why it is so large. Measured on the
 * families stokes, springs, ladder, hidden and on random dense pencils, index 1 to 5.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CONTOUR_THRESHOLDS_H
#define STF_CONTOUR_THRESHOLDS_H

#include "base.h"

/* -- counts of eigenvalues ------------------------------------------------------------------------ */

/* A count by Jensen's formula this near to a whole number is one: right counts were within 0.016 on
 * circles of three times the spectrum and more, wrong ones off by 0.2 and more. */
#define STF_WHOLE 0.05

/* -- moments: their gap decides the index --------------------------------------------------------- */

/* Moments that far apart decide. Dense random pencils have 1e9 and more at conditions of 1e3. */
#define STF_GAP 1e3
/* So far apart that, at the structural index, no further circle is needed. */
#define STF_CLEAR_GAP 1e6
/* They cannot part further in double precision: sparse systems with refined solves reach 5e14. */
#define STF_WIDE_GAP 1e12

/* -- regularity ------------------------------------------------------------------------------------ */

/* Reciprocal conditions of s E + F below this are looked at by ranks: singular pencils had 5e-18 at most,
 * regular ones of practice 9e-10 at least. */
#define STF_SUSPECT 1e-8

/* -- radii ---------------------------------------------------------------------------------------- */

/* Factors from circle to circle, up and down. */
#define STF_GROW 4.0
#define STF_SHRINK 16.0
/* How far beyond the estimate of the eigenvalues, max |F| / |E| over rows and columns, circles go, and
 * how far that may lie above max |F| / max |E|. */
#define STF_BEYOND 64.0
#define STF_SPREAD 1e12
/* How far circles go where ranks, or the pattern, tell that there are eigenvalues beyond, or where all are
 * inside and moments need more room: determinants that are small beside the entries make eigenvalues
 * large beside max |F| / |E|. */
#define STF_FAR 1e8
/* A radius over max |F| / max |E| where nothing is known. */
#define STF_GUESS 10.0
/* Scales serve radii up to this far from the one they were made for. */
#define STF_SCALES_SERVE 16.0

/* -- starts by two circles ------------------------------------------------------------------------ */

/* Difference of x(0+) by circles of R and 2 R that needs no further circle: rounding. */
#define STF_CIRCLES_AGREE 1e-12
/* That is certified: the difference follows the error up to 1e-2. */
#define STF_CIRCLES_CERTIFY 1e-3
/* Impulses this far apart decide beside x(0+); below, x(0+) alone tells which radius is better. */
#define STF_IMPULSES_AGREE 1e-6
/* What is below this part of the impulse that could be is 0. */
#define STF_IMPULSE_PART 1e-3
/* Circles for starts have at least this part of |F| / |E| as radius, however small the eigenvalues are:
 * s E must be seen beside F. Where eigenvalues were 0, circles of 1e-34 agreed on half an impulse: its
 * imaginary part alone. */
#define STF_LEAST_RADIUS 1e-4
/* From radius to radius, and how many, where circles of small eigenvalues lose the impulses. */
#define STF_RADIUS_STRIDE 16.0
enum { STF_RADII_MORE = 6 };
/* Factors of two that the radius may go down and up while neighbours agree better. */
enum { STF_RADIUS_DOWN = 3, STF_RADIUS_UP = 3 };

/* -- solves --------------------------------------------------------------------------------------- */

/* A backward error by rows that refinement does not lessen: that of the rounding of residuals. */
#define STF_STEADY (2 * STF_EPS)
/* One of a plain solve that is accepted. Where rounding fills zero blocks it is larger by orders of
 * magnitude. */
#define STF_PLAIN_SOLVE (256 * STF_EPS)

#endif
