/* mumps.h: factors of several shifts, and the room that solves with them take.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_MUMPS_H
#define STEIF_MPI_MUMPS_H

#include "factors.h"

enum { SLOTS = 4, COLUMNS = 16 }; /* of each arithmetic; right-hand sides at a time */

/* How rows and columns are scaled. */
enum { UNITS_ROWS, UNITS_COLUMNS, UNITS_MEAN, UNITS };

typedef struct slot {
  const factors_calls *with;
  void *m;
  sunrealtype re, im;
  bool ready;    /* for the values at hand */
  long revision; /* of the pattern that was analysed */
  long used;     /* when, for the choice of one to make anew */
  sunrealtype *value, *x;
  sunrealtype *row, *column;    /* scales: of own rows; of own columns and those of the halo */
  int units;                    /* how they were found */
  bool sound;                   /* it is not singular to rounding */
  int *row_of_x, room, columns; /* rows and right-hand sides that x holds */
  bool
    way_across; /* what follows is of the transposed, whose solutions MUMPS spreads otherwise */
  int *give, *give_at, *get, *get_at; /* how x returns to its owners ... */
  int *order, *place; /* ... own place of x sent as k-th; own row of the k-th that comes */
  sunrealtype *out, *in;
} slot;

typedef struct mumps {
  rows *r;
  factors_setting set;
  long revision, clock;
  bool regular;         /* a c E - A of this pattern was sound */
  slot slot[2 * SLOTS]; /* real ones, then complex ones */
  int *row_of_b;
  int columns; /* right-hand sides that these hold: */
  sunrealtype *b, *d,
    *own; /* as MUMPS reads them, residuals, solutions, halves one after the other */
  sunrealtype *part[3]; /* of transposed products: own rows and the halo */
} mumps;

/* What MUMPS answers, as a sentence when it is a failure. */
int mumps_told(const mumps *s, const factors_answer *a, const char *what, const slot *t);
/* Factors for the shift, or of one that differs by at most `part` of it. */
int mumps_serve(mumps *s, sunrealtype re, sunrealtype im, sunrealtype part, slot **found);
/* Room of `columns` solutions; it may grow with the pivots. */
int mumps_receive(mumps *s, slot *t, int count, int columns);
/* mumps_scale.c: scales that are powers of two, of the matrix that is factored: rows, then columns, have entries
 * of size 1 at most, and near it. */
void mumps_scale(const mumps *s, slot *t);
/* mumps_solve.c: x += M^{-1} d, or that of M^T, for `count` columns, d and x the halves of each; `scaled`: M is
 * as it was factored. */
int mumps_room(mumps *s, slot *t, int columns); /* before it */
int mumps_correct(mumps *s, slot *t, bool transposed, bool scaled, int count,
                  sunrealtype *const *d, sunrealtype *const *x);
/* The part of a solution that rounding has made, 1 where the matrix is singular to rounding. */
int mumps_lost(mumps *s, slot *t, sunrealtype *part);
int mumps_solve(void *state, sunrealtype re, sunrealtype im, bool transposed, int count,
                const sunrealtype *const *b, sunrealtype *const *x);

#endif
