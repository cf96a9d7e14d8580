/* batch.h: s E - A at several complex shifts side by side, in the lanes of vector registers.
 *
 * The shifts share one pattern, one order and one sequence of pivots, those of a factorisation
 * by KLU: an entry is the real parts of all lanes and then their imaginary parts, so that
 * indices are read once for all of them. Vectors stand in the order of the pivots: equation
 * `equation[k]` of a right-hand side, unknown `unknown[k]` of a solution at place k. A lane's
 * results do not depend on what stands in the others.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BATCH_H
#define STF_BATCH_H

#include "pattern.h"

enum { STF_LANES = 4 }; /* an entry fills a line of cache */

/* Symbolic: P (s E - A) Q = L U + F, block upper triangular, all numbers places in that
 * order. */
typedef struct stf_sequence {
  steif_context *ctx;
  int n, blocks;
  int *first;                      /* place of each block; first[blocks] = n */
  int *equation, *unknown;         /* at each place */
  int *place;                      /* of each equation */
  SuiteSparse_long *lower, *upper; /* column k of L below, of U above the diagonal */
  int *below, *above;              /* their rows, ascending */
  int *run; /* so many columns of L from k on differ in nothing but their first rows */
  SuiteSparse_long *column,
    *inner;                      /* of s E - A: entries of column k, those of its block first */
  int *entry;                    /* their rows */
  SuiteSparse_long *row;         /* the same matrix by rows */
  int *across;                   /* their columns */
  double *e, *a, *row_e, *row_a; /* values of both */
  double growth;                 /* the reciprocal growth to be asked of these pivots */
} stf_sequence;

/* Of a slot that KLU has factored at a complex shift; n < 2^31. */
int stf_sequence_open(steif_pencil *p, int slot, stf_sequence **sequence);
void stf_sequence_close(stf_sequence **sequence);
/* The values of E and A, after an update of p that kept the pattern. */
void stf_sequence_fill(const steif_pencil *p, stf_sequence *sequence);

/* Right-hand sides g_0 + z g_1 + z^2 g_2 + ..., z = 1 / s, rows of n, times `scale` by
 * equations. */
typedef struct stf_polynomial {
  int powers;             /* beside the constant */
  const double *constant; /* n */
  const double *power;    /* powers x n */
  const double *scale;    /* NULL: 1 */
} stf_polynomial;

typedef struct stf_batch {
  const stf_sequence *sequence;
  steif_shift s[STF_LANES];
  double *l, *u, *pivot; /* factors; pivot: reciprocal diagonal of U */
  double *x, *r;         /* n each: the solution; scratch, in the end the residual */
  bool good[STF_LANES];  /* pivots were finite, not 0, and as large as was asked for */
  double growth[STF_LANES],
    log_det[STF_LANES]; /* growth: reciprocal, 1 unless asked for; 0: none */
  double
    error[STF_LANES]; /* root mean square of the rows' backward errors, when last looked at */
  int solves[STF_LANES]; /* of the last right-hand side */
  void *memory;
} stf_batch;

int stf_batch_open(const stf_sequence *sequence, stf_batch *batch);
void stf_batch_close(stf_batch *batch);

/* Factor at the shifts s, all lanes of them, and x from g, unless it is NULL. A lane is bad
 * where a column of U exceeds that of s E - A more than 1 / growth times, by largest entries;
 * growth 0: where a pivot is 0 or not finite. */
void stf_batch_factor(stf_batch *batch, double growth, const stf_polynomial *g);
/* x from another g with these factors. */
void stf_batch_solve(stf_batch *batch, const stf_polynomial *g);
/* Up to `sweeps` steps of refinement of x while the backward error is above `steady`, one
 * anyway; sweeps 0: the error alone. */
void stf_batch_refine(stf_batch *batch, const stf_polynomial *g, int sweeps, double steady);

/* residual.c: r, which comes as b, becomes b - (s E - A) x, and error: E x and A x in twice the
 * precision, so that refinement finds x to rounding where the pencil is ill conditioned. */
void stf_batch_residual(stf_batch *batch);

/* The loops for the processor that is there (sweep.c). */
typedef struct stf_sweeps {
  void (*factor)(stf_batch *b, bool watched, bool solving);
  void (*load)(const stf_batch *b, const stf_polynomial *g, double *x);
  void (*solve)(const stf_batch *b, double *x);
  void (*residual)(stf_batch *b, const stf_polynomial *g);
  void (*correct)(const stf_batch *b, const bool *lanes); /* x += r in these */
} stf_sweeps;
const stf_sweeps *stf_sweeps_here(void);

#endif
