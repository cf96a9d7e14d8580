/* dense_thresholds.h: what decides in the analyses of dense pencils, and why it is so large.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DENSE_THRESHOLDS_H
#define STF_DENSE_THRESHOLDS_H

/* -- ranks ---------------------------------------------------------------------------------------- */

/* Singular values up to 4 n eps of the largest are rounding of the entries: the error bound of a
 * computed singular value is a small multiple of eps, and sums of n products round n times. */
#define STF_RANK_NOISE 4
/* The smallest value kept over the largest dropped, above what other cuts offer, that decides a rank:
 * on random pencils of known structure, index 1 to 5 and transformations of condition up to 1e5, the
 * index was right wherever it was decided by more, and gaps were 1e5 or above. */
#define STF_DECIDED_GAP 1e3
/* Null vectors of a singular pencil: singular values up to 10 n eps of the largest, beyond the
 * rounding of the equilibrated sum s E + F itself. */
#define STF_NULL_NOISE 10
/* E_inf of the Schur form is rounding up to 1e3 n eps |E|: three digits above what orthogonal
 * transformations leave, for the reordering. */
#define STF_SCHUR_NOISE 1e3

/* -- agreement of both ways ----------------------------------------------------------------------- */

/* Relative difference of x(0+) and of impulses up to which both ways agree: as for circles, whose
 * difference follows the error up to 1e-2. */
#define STF_AGREEMENT 1e-3
/* Impulses this small beside E (x(0+) - x(0-)) are 0, three digits below the agreement asked for. */
#define STF_NEGLIGIBLE 1e-6
/* For a structure alone both ways may differ by STF_EXPLAINED times what other rounding of the entries
 * changes, up to one digit: a wrong part of the pencil taken for infinite differs in all digits. */
#define STF_EXPLAINED 10
#define STF_LEAST_AGREEMENT 0.1
/* Draws of rounded entries. What is in the entries already is often more than one rounding each, and where
 * one direction dominates, the largest of three draws may be small by chance: errors of 1e5 random
 * pencils of condition up to 1e3 were within ten times STF_DRAW_FACTOR times it. */
enum { STF_DRAWS = 3 };
#define STF_DRAW_FACTOR 4
/* A count of eigenvalues by Jensen's formula that is further off belongs to another number. */
#define STF_COUNT_OFF 0.5

/* -- sentences ------------------------------------------------------------------------------------- */

/* Equations and unknowns are named down to this part of the largest entry of a null vector or of the
 * leading Laurent coefficient. */
#define STF_NAMED_PART 0.1

#endif
