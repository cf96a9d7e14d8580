/* multishift.h: the sequence of pivots and the loops over it: what the files of multi-shift share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MULTISHIFT_H
#define STF_MULTISHIFT_H

#include "lu.h"
#include <SuiteSparse_config.h>

/* Symbolic: P (s E - A) Q = L U + F, block upper triangular, all numbers places in that
 * order. */
typedef struct stf_steps {
  stf_sequence face; /* what others see */
  steif_context *ctx;
  int n, blocks;
  int *first;                      /* place of each block; first[blocks] = n */
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
} stf_steps;

static inline const stf_steps *stf_steps_of(const stf_multishift *b)
{
  return (const stf_steps *)b->sequence;
}

/* r, which comes as b, becomes b - (s E - A) x, and error: E x and A x in twice the precision, so that
 * refinement finds x to rounding where the pencil is ill conditioned. */
void stf_multishift_residual(stf_multishift *batch);

/* The loops for the processor that is there (multishift_numeric.c). */
typedef struct stf_multishift_kernels {
  void (*factor)(stf_multishift *b, bool watched, bool solving);
  void (*load)(const stf_multishift *b, const stf_polynomial *g, double *x);
  void (*solve)(const stf_multishift *b, double *x);
  void (*residual)(stf_multishift *b, const stf_polynomial *g);
  void (*correct)(const stf_multishift *b, const bool *lanes); /* x += r in these */
} stf_multishift_kernels;
const stf_multishift_kernels *stf_multishift_here(void);

#endif
