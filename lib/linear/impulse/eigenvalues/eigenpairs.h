/* eigenpairs.h: eigenvalues of a pencil with their vectors, as they are found.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EIGENPAIRS_H
#define STF_EIGENPAIRS_H

#include "analysis_options.h"
#include <complex.h>
#include <steif/eigenvalues.h>

/* A residual that certifies an eigenvalue. */
#define STF_RESIDUAL 1e-8
/* Below so much of the largest one an eigenvalue is 0 to rounding, which is what its residual is measured by. */
#define STF_NOTHING 1e-13
/* Arnoldi's method goes on until residuals are as small. */
#define STF_CONVERGED 1e-11

typedef struct stf_eigenpairs {
  steif_context *ctx;
  stf_pool *pool;
  SUNMatrix E, F;
  const steif_analysis *analysis;
  const steif_structure *structure;
  int n;
  long wanted; /* 0: all */
  double complex near;
  long count;              /* found: */
  steif_eigenvalue *value; /* from the pool */
  sunrealtype *norm[2];    /* 1-norms of the rows of E and F, in the units below */
  sunrealtype largest;     /* |s| of those looked at together; 0: of one at a time */
  sunrealtype *row, *unit; /* rows and unknowns are measured by these factors; NULL: 1 */
  double complex *r;       /* room for a residual */
} stf_eigenpairs;

/* All finite ones. */
int stf_eigenpairs_dense(stf_eigenpairs *p);
/* Up to p->wanted, and one more to complete a pair. */
int stf_eigenpairs_sparse(stf_eigenpairs *p);

/* y = E v or F v. */
void stf_eigenpairs_product(const stf_eigenpairs *p, char which, const double complex *v,
                            double complex *y);
/* s with what belongs to it, by its vector. */
steif_eigenvalue stf_eigenpairs_measure(const stf_eigenpairs *p, double complex s,
                                        const double complex *v);
/* Sort by the distance from p->near, then by imaginary parts. */
void stf_eigenpairs_sort(stf_eigenpairs *p);

#endif
