/* mumps.h: factors of several shifts, and the room that solves with them take.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_MUMPS_H
#define STEIF_MPI_MUMPS_H

#include "factors.h"

enum { SLOTS = 4, COLUMNS = 16 }; /* of each arithmetic; right-hand sides at a time */

typedef struct slot {
  const factors_calls *with;
  void *m;
  sunrealtype re, im;
  bool ready;    /* for the values at hand */
  long revision; /* of the pattern that was analysed */
  long used;     /* when, for the choice of one to make anew */
  sunrealtype *value, *x;
  int *row_of_x, room, columns;       /* rows and right-hand sides that x holds */
  int *give, *give_at, *get, *get_at; /* how x returns to its owners ... */
  int *order, *place; /* ... own place of x sent as k-th; own row of the k-th that comes */
  sunrealtype *out, *in;
} slot;

typedef struct mumps {
  rows *r;
  factors_setting set;
  long revision, clock;
  slot slot[2 * SLOTS]; /* real ones, then complex ones */
  int *row_of_b;
  int columns; /* right-hand sides that these hold: */
  sunrealtype *b, *d,
    *own; /* as MUMPS reads them, residuals, solutions, halves one after the other */
} mumps;

/* What MUMPS answers, as a sentence when it is a failure. */
int mumps_told(const mumps *s, const factors_answer *a, const char *what, const slot *t);
/* Factors for the shift, or of one that differs by at most `part` of it. */
int mumps_serve(mumps *s, sunrealtype re, sunrealtype im, sunrealtype part, slot **found);
/* Room of `columns` solutions; it may grow with the pivots. */
int mumps_receive(mumps *s, slot *t, int count, int columns);
/* mumps_solve.c */
int mumps_solve(void *state, sunrealtype re, sunrealtype im, bool transposed, int count,
                const sunrealtype *const *b, sunrealtype *const *x);

#endif
