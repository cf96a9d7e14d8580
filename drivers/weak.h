/* weak.h: a question about weak convergence and its answer.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef WEAK_H
#define WEAK_H

#include "curves.h"

struct weak {
  long k;                 /* index */
  const char *kind;       /* "N-inc" */
  const char *convention; /* "P", "R", "C", "stage"; NULL: the usual one of the method */
  steif_weak_query query; /* method, start, h and rows are given, the rest is filled in */
  char problem[96];
  steif_weak_row row[HALVINGS];
  steif_weak_result result;
};

int weak_measure(steif_context *ctx, struct weak *w);
const char *convention_name(enum steif_convention convention);

#endif
