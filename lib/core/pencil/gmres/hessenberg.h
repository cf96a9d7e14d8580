/* hessenberg.h: the least squares problem of GMRES, min |norm e_0 - H y|, in complex numbers: H is brought to
 * triangular form R by Givens rotations, column by column.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_HESSENBERG_H
#define STF_HESSENBERG_H

#include "base.h"

typedef struct stf_number {
  double re, im;
} stf_number;

static inline stf_number stf_times(stf_number a, stf_number b)
{
  return (stf_number){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static inline stf_number stf_conjugate(stf_number a) { return (stf_number){a.re, -a.im}; }

static inline stf_number stf_minus(stf_number a, stf_number b)
{
  return (stf_number){a.re - b.re, a.im - b.im};
}

static inline stf_number stf_plus(stf_number a, stf_number b)
{
  return (stf_number){a.re + b.re, a.im + b.im};
}

static inline stf_number stf_scaled(double c, stf_number a)
{
  return (stf_number){c * a.re, c * a.im};
}

static inline double stf_square(stf_number a) { return a.re * a.re + a.im * a.im; }

static inline stf_number stf_quotient(stf_number a, stf_number b)
{
  return stf_scaled(1 / stf_square(b), stf_times(a, stf_conjugate(b)));
}

typedef struct stf_hessenberg {
  int dimension;
  double *cosine;
  stf_number *sine, *column, *R, *rest,
    *y; /* column: the next one; rest: of the right-hand side */
} stf_hessenberg;

int stf_hessenberg_open(stf_pool *pool, int dimension, stf_hessenberg *H);
/* No columns, and that right-hand side. */
void stf_hessenberg_begin(stf_hessenberg *H, double norm);
/* Column j, `column` and `under` below it; returns the norm that is left. */
double stf_hessenberg_add(stf_hessenberg *H, int j, double under);
/* y of so many columns. */
void stf_hessenberg_solve(stf_hessenberg *H, int count);
/* y, with a further component, becomes y + step (the residual). */
void stf_hessenberg_further(stf_hessenberg *H, int count, stf_number step);

#endif
