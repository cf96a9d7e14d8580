/* lyapunov_equation.h: solutions P of A^T P + P A = 0 from the clusters of A.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SOLUTION_H
#define STF_SOLUTION_H

#include "cluster.h"
#include <steif/hamiltonian.h>

/* A cluster with its Jordan blocks and the cluster of opposite mean. */
typedef struct stf_partner {
  int other;   /* -1: none */
  int matched; /* 1, 0, -1: is the sum of the means 0? */
  int *weyr;   /* size + 1 numbers, as of stf_weyr */
  bool sure;
} stf_partner;

/* P = sum Pi^* Pi. */
int stf_canonical_solution(const stf_spectrum *s, double *P);
/* A random solution, sign = 1: symmetric, -1: skew. *found = false where a Jordan structure is too
 * large. */
int stf_random_solution(const stf_spectrum *s, const stf_partner *partner, int sign,
                        unsigned *seed, double *P, bool *found);
/* residual, condition (unless singular) and distance of f->P. */
int stf_solution_check(steif_context *ctx, int n, const double *A, bool singular,
                       steif_form_found *f);

#endif
