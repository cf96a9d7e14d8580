/* groups.h: columns of a pattern that share no row, and how the pattern grows.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_GROUPS_H
#define STF_GROUPS_H

#include "problem.h"

struct stf_groups {
  steif_context *ctx;
  const steif_pattern *pattern; /* the problem's, or that with what a probe has found: */
  steif_pattern grown;          /* owned; NULL without */
  int count;
  sunindextype *column, *start; /* columns of group g: column[start[g]] .. */
  sunindextype *of;             /* n: group of each column */
  sunrealtype *step;            /* increment of each column */
  bool differences;             /* E or A is made by differences */
};

/* f of the ode and mass forms, else F: into out. */
int stf_groups_evaluate(stf_system *system, sunrealtype t, N_Vector y, N_Vector yp,
                        N_Vector out);
/* After a change of the pattern. */
int stf_groups_colour(stf_system *system);
/* Frees what a probe has found; for a pool. */
void stf_groups_forget(void *groups);

#endif
