/* weak.h: weak convergence of a method: what is asked, the measure, the picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef WEAK_H
#define WEAK_H

#include "curves.h"
#include "descriptor.h"

/* About a Jordan block, or a system. */
struct weak {
  long k;                 /* index of the block; 0: query has problem or linear */
  const char *kind;       /* "N-inc" */
  const char *convention; /* "P", "R", "C", "stage"; NULL: the usual one of the method */
  steif_weak_query query; /* method, start, h and rows are given, the rest is filled in */
  char problem[96];       /* of the Jordan block */
  double breaks[REALS_MOST];
  steif_weak_row row[HALVINGS];
  steif_weak_result result;
};

int weak_measure(steif_context *ctx, struct weak *w);
/* What a call asks for. */
struct weak weak_asked(const struct call *call);
/* A row of the report: what comes before its values, and after. */
void weak_row_begin(steif_report *r, const steif_weak_row *row);
void weak_row_end(steif_report *r, const steif_weak_row *row);
/* The picture; EXIT_UNCERTIFIED where the verdict is open. */
int weak_end(const struct call *call, const struct weak *w);
/* `steif weak METHOD E.mtx F.mtx` or PROBLEM: one component, or all; an exit code. */
int weak_system(struct call *call);
const char *convention_name(enum steif_convention convention);

#endif
