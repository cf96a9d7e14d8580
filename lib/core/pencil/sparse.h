/* sparse.h: what sparse.c holds for a pencil: KLU's objects, or fronts.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SPARSE_H
#define STF_SPARSE_H

#include "lu.h"
#include "sum_pattern.h"
#include <klu.h>

/* out = E x or A x. */
int stf_sparse_product(steif_pencil *p, char which, N_Vector x, N_Vector out);
/* The pattern of a sparse pencil and KLU's analysis of it; of a factored slot s E - A
 * on it, and its factors. */
const stf_pattern *stf_sparse_pattern(const steif_pencil *p);
klu_l_symbolic *stf_sparse_symbolic(const steif_pencil *p);
const double *stf_sparse_values(const steif_pencil *p, int slot);
klu_l_numeric *stf_sparse_factors(const steif_pencil *p, int slot);
/* What fronts have of a slot: NULL where KLU's factors are in use, factors, pivots, scratch of solves. */
typedef struct stf_sparse_blocks {
  const stf_multifrontal *fronts;
  const double *factors;
  const int *pivot;
  double *work;
} stf_sparse_blocks;
stf_sparse_blocks stf_sparse_fronts(const steif_pencil *p, int slot);
/* sparse_transposed.c */
int stf_sparse_transposed(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im);
/* saved/klu_image.c: KLU's factors, made where there are none to be read into. */
void stf_klu_keep(const klu_l_symbolic *symbolic, bool wide, klu_l_numeric **numeric,
                  klu_l_common *common, stf_image *m);
/* The reciprocal pivot growth down to which pivots in use are kept. */
double stf_sparse_growth(const steif_pencil *p, int slot);

#endif
