/* sparse_view.h: E = F_y' and B = F_y of a DAE by columns, for any n.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPARSE_VIEW_H
#define STF_SPARSE_VIEW_H

#include "linearisation.h"

/* E and B on the union of their patterns by columns; entries at rounding level are
 * dropped. Each call has the values of its point on the pattern of all points so far, for
 * one of them may be a zero of an entry. */
typedef struct stf_view {
  size_t n;
  sunindextype *column, *row; /* n + 1, column[n] */
  sunrealtype *e, *b;
  char *has; /* of each entry: 1 in E, 2 in B, at some point */
} stf_view;

int stf_view_take(stf_point *point, sunrealtype t, const sunrealtype *y, const sunrealtype *yp,
                  stf_view *view);
int stf_view_copy(stf_point *point, const stf_view *view, stf_view *copy);
void stf_view_free(stf_point *point, stf_view *view);
/* Rates |B|/|E| of the rows that have both, columns weighted by size: the smallest and the
 * largest; 1 without any. */
void stf_view_rates(stf_point *point, const stf_view *view, sunrealtype *slowest,
                    sunrealtype *fastest);

#endif
