/* dense_algorithm.h: staircase and generalised Schur form, two ways to one answer for dense and small
 * pencils.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DENSE_ALGORITHM_H
#define STF_DENSE_ALGORITHM_H

#include "analysis_steps.h"

extern const stf_algorithm stf_dense_algorithm;

/* What both ways have found, in the units of the analysis. */
typedef struct stf_both_ways {
  const steif_structure *staircase, *schur;
  int other_index; /* of the same pencil in other units, the smaller of two; -1: the same */
  sunindextype carried;   /* finite eigenvalues in entries that are rounding */
  sunrealtype resolution; /* smallest eigenvalue that would pass for infinite */
  sunrealtype off;        /* relative difference of both x(0+) */
  sunrealtype moved;      /* of one x(0+) when entries are rounded otherwise */
  bool agreed;            /* x(0+) and all impulses */
} stf_both_ways;

/* Why the answer is not certified, in `text`, or a constant sentence; NULL when it is. */
const char *stf_dense_objection(const stf_both_ways *both, char *text, size_t length);
/* s->message of a structure that is filled but for it. reason: why it is not certified, or NULL; by:
 * the algorithm that certifies it. */
void stf_dense_message(steif_structure *s, const char *reason, const char *by);

#endif
