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
} stf_pattern;

/* Build for p->E and p->A, after checking their index arrays; p->E NULL counts as the diagonal. */
int stf_pattern_build(steif_pencil *p, stf_pattern *u);
bool stf_pattern_same(const steif_pencil *p, const stf_pattern *u);
void stf_pattern_free(steif_pencil *p, stf_pattern *u);
/* s E - A on the union, interleaved when s is complex; duplicate entries add up. */
void stf_pattern_assemble(const steif_pencil *p, const stf_pattern *u, steif_shift s,
                          double *value);

#endif
