/* lost_digits.h: how much of a solution with a factored matrix is rounding.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LOST_DIGITS_H
#define STF_LOST_DIGITS_H

#include "sparse_view.h"

/* Parts from which on a matrix is singular to rounding. */
#define STF_LOST 0.05

/* M = diag(left) (s E + B) diag(right), scales of ones where NULL. */
typedef struct stf_shifted {
  const stf_view *view;
  sunrealtype s;
  const sunrealtype *left, *right;
} stf_shifted;

/* Rounding makes of M a matrix M + D, whose inverse is met: a sweep of refinement changes x = (M + D)^{-1} b by
 * (M + D)^{-1} D x. Where M is singular, x is nearly in its null space, M x = 0, and the change is as long as x; else it
 * is as much shorter as x has digits. *part: the largest ratio of the lengths for a few b, in even units of rows and
 * columns. Slot 0 of p has factors of M, v is scratch, work 4 n: after that work[0 .. n-1] is x in those units. */
int stf_lost_part(steif_pencil *p, const stf_shifted *M, N_Vector v, sunrealtype *work,
                  sunrealtype *part);

#endif
