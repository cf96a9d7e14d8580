/* sum_pattern.h: the union of the patterns of E and A and where their entries go in it.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PATTERN_H
#define STF_PATTERN_H

#include "pencil.h"
#include <SuiteSparse_config.h>

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

#endif
