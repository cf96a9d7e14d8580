/* factors.h: one factorisation by MUMPS, real or complex, behind the same calls. Numbers are pairs (re, im) where it
 * is complex, else single.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_FACTORS_H
#define STEIF_MPI_FACTORS_H

#include "own_rows.h"

enum { FACTORS_METIS = 1 }; /* an order that MUMPS is given */

/* What the spec says, the own entries of the matrix in MUMPS's integers, from 1, and the ordering: on rank 0
 * the place of each unknown among the pivots, found once for the matrices of all shifts. */
typedef struct factors_setting {
  int refine, order; /* sweeps at most; ICNTL(7), or < 0: by all ranks */
  int memory;        /* MB a rank, 0: as much as it takes */
  int *row, *column;
  int *place;
  bool placed;
} factors_setting;

/* Answers of MUMPS that decide: INFOG(1), INFOG(2), INFO(2) and so on. */
typedef struct factors_answer {
  int code, detail, null_pivots, memory, rows; /* rows of the solution on this rank */
  int estimate;                                /* MB of the rank that takes most */
  bool here;                                   /* the error is that of this rank */
} factors_answer;

typedef struct factors_calls {
  bool complex;
  void *(*open)(rows *r);
  void (*analyse)(void *m, const rows *r, factors_setting *set, factors_answer *out);
  /* values: as many as entries; workspace: per cent beyond the estimate. */
  void (*factor)(void *m, sunrealtype *values, int workspace, factors_answer *out);
  /* b: own rows of `columns` right-hand sides; x, `room` rows a column, and its row numbers from 1 as MUMPS spreads
   * them. */
  void (*solve)(void *m, bool transposed, int columns, sunrealtype *b, int *row_of_b, int count,
                sunrealtype *x, int *row_of_x, int room, factors_answer *out);
  void (*close)(void *m, rows *r);
} factors_calls;
extern const factors_calls factors_real, factors_complex;

/* The defaults of a spec and what it says otherwise. */
int factors_read(const rows *r, const steif_spec *spec, factors_setting *set);

/* Places from 1 of all unknowns among the pivots, on rank 0, by nested dissection; place is not read on others. All
 * ranks return the same. */
int factors_dissect(const rows *r, const factors_setting *set, int *place);

#endif
