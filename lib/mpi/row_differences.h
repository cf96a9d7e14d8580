/* row_differences.h: own rows of A and E by differences of f or F in a given pattern of own rows.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_ROW_DIFFERENCES_H
#define STEIF_MPI_ROW_DIFFERENCES_H

#include "own_rows.h"
#include <sunmatrix/sunmatrix_sparse.h>

/* Entries of the union of the patterns sorted by the colour of their column. */
struct row_differences {
  int colours;
  sunindextype *start, *entry, *row; /* colours + 1; entries each */
  sunrealtype *colour, *step;        /* own columns, then those of the halo */
  N_Vector base, moved, changed, zero;
  bool implicit, of_E; /* F instead of f; E too */
};

/* Is A to come from differences? Then the pattern is that of own rows: what is wrong with it, if anything. */
bool differences_needed(const steif_problem *p);
int differences_check(const rows *r, const steif_problem *p);
/* The pattern into A and E; values 0. */
void differences_pattern(const rows *r, const steif_problem *p);
/* For the pattern that r has now, its halo open. */
int differences_open(rows *r, const steif_problem *p);
void differences_close(rows *r);
/* Values of A, and E of F, at (t, y, yp). All ranks evaluate equally often, whatever fails. */
int differences_fill(rows *r, const steif_problem *p, sunrealtype t, N_Vector y, N_Vector yp);
/* Of linear problems, whose differences are exact: do they explain a move of all unknowns? Else the pattern has less
 * entries than f or F. */
int differences_verify(rows *r, const steif_problem *p, sunrealtype t);

/* colouring.c: colours of own columns, and how many there are of all. */
int rows_colour(const rows *r, int *colours, sunrealtype *colour);

#endif
