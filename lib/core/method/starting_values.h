/* starting_values.h: starting procedure of methods that need more than y: values at equal distances
 * behind t.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BEGIN_H
#define STF_BEGIN_H

#include "method.h"

typedef struct stf_begin {
  int count;       /* values besides y */
  N_Vector *value; /* count + 1: y(t), y(t + d), .., d = h / count */
  stf_step inner;  /* implicit: Radau IIA */
  int rows;        /* explicit: rows of the extrapolation */
  N_Vector *row, slope, before;
} stf_begin;

/* Local errors of O(h^(order + 2)). To be called before s has a Newton iteration of its own. */
int stf_begin_open(stf_step *s, int count, int order, bool explicit_, stf_begin *begin);
/* Factors of s are lost. */
int stf_begin_run(stf_step *s, stf_begin *begin, sunrealtype h);

#endif
