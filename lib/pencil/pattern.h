/* pattern.h: the union of the patterns of E and A and where their entries go in it.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PATTERN_H
#define STF_PATTERN_H

#include "pencil.h"
#include <klu.h>

typedef struct stf_pattern {
  sunindextype n, nnz;
  SuiteSparse_long *ptr, *row;   /* the union by columns, a row at most once in each */
  sunindextype *placeE, *placeA; /* entry k of E or A is entry place[k] of the union */
  sunindextype *ptrE, *ptrA;     /* column pointers as they were; ptrE also for the identity */
  bool straight;                 /* A is the union, in order */
  double *e, *a;                 /* values on the union; e NULL: identity, a NULL: straight */
  double most_e, most_a;         /* their largest sizes */
} stf_pattern;

/* Build for p->E and p->A, after checking their index arrays; p->E NULL counts as the
 * diagonal. */
int stf_pattern_build(steif_pencil *p, stf_pattern *u);
void stf_pattern_free(steif_pencil *p, stf_pattern *u);
/* The values of E and A as they are now, duplicate entries added up, after `analyse` (which builds)
 * where it has not been done for this pattern; `forget` when that fails. STEIF_NOT_FINITE with
 * the first entry that is NaN or infinite. */
int stf_pattern_update(steif_pencil *p, stf_pattern *u, bool analysed,
                       int (*analyse)(steif_pencil *), void (*forget)(steif_pencil *));
/* A on the union. */
const double *stf_pattern_A(const steif_pencil *p, const stf_pattern *u);
/* s E - A on the union, interleaved when s is complex, of the values filled in. */
void stf_pattern_assemble(const steif_pencil *p, const stf_pattern *u, steif_shift s,
                          double *value);
/* No entry of s E - A can overflow. */
bool stf_pattern_moderate(const stf_pattern *u, steif_shift s);

/* sparse.c: out = E x or A x. */
int stf_sparse_product(steif_pencil *p, char which, N_Vector x, N_Vector out);
/* The pattern of a sparse pencil and KLU's analysis of it; of a factored slot s E - A
 * on it, and its factors. */
const stf_pattern *stf_sparse_pattern(const steif_pencil *p);
klu_l_symbolic *stf_sparse_symbolic(const steif_pencil *p);
const double *stf_sparse_values(const steif_pencil *p, int slot);
klu_l_numeric *stf_sparse_factors(const steif_pencil *p, int slot);
/* The reciprocal growth down to which pivots in use are kept. */
double stf_sparse_growth(const steif_pencil *p, int slot);
/* Forget the factors of a slot by KLU: the next ones look for pivots. */
void stf_sparse_drop(steif_pencil *p, int slot);

#endif
