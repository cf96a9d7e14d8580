/* starting_values.h: starting procedure of methods that need more than y: values at equal distances
 * behind t.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BEGIN_H
#define STF_BEGIN_H

#include "method.h"

/* Of y, or of a column of its derivatives by parameters. */
typedef struct stf_begin_part {
  N_Vector *value;              /* count + 1: y(t), y(t + d), .., d = h / count */
  N_Vector *row, slope, before; /* explicit */
} stf_begin_part;

typedef struct stf_begin {
  int count; /* values besides y */
  int rows;  /* explicit: rows of the extrapolation; 0: implicit */
  int parts; /* 1, and the columns */
  stf_begin_part *part;
  stf_step inner;                 /* implicit: Radau IIA ... */
  struct stf_carry *carry, *over; /* of s, of `inner`; NULL: derivatives are not carried */
} stf_begin;

/* Local errors of O(h^(order + 2)). To be called before s has a Newton iteration of its own. */
int stf_begin_open(stf_step *s, int count, int order, bool explicit_, stf_begin *begin);
/* Derivatives of the values beside them, from T->S. */
int stf_begin_carry(struct stf_carry *T, stf_begin *begin);
/* Factors of s are lost. */
int stf_begin_run(stf_step *s, stf_begin *begin, sunrealtype h);

#endif
