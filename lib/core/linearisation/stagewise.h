/* stagewise.h: one stage of a consistent start: which derivatives of equations determine which of unknowns.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STAGEWISE_H
#define STF_STAGEWISE_H

#include "consistent_start.h"
#include "nearest.h"
#include "total_derivatives.h"

typedef struct stf_stage {
  stf_start_task *task;
  const stf_offsets *offsets;
  size_t n;
  int deepest; /* orders kept */
  int stage;
  sunrealtype *u; /* y^(k)/k!, (deepest + 1) x n */
  sunrealtype *guess, *values;
  stf_view view; /* E and B at the current point */
  size_t rows, columns;
  size_t *equation, *unknown, *row; /* row[i] of equation i in this stage */
  int *order;                       /* n: of equation i in this stage, -1 */
  int chosen;                       /* how often nodes of derivatives were chosen in it */
  bool recalled;                    /* they are those of a point beside */
  stf_total_derivatives derivatives;
  stf_curve curve;
} stf_stage;

/* The order of unknown j that this stage determines; negative: none. */
static inline int stf_stage_order(const stf_stage *w, size_t j)
{
  return w->offsets->d[j] + w->stage;
}

/* Entry k, in column j of the view, of the system Jacobian; false: it has no place in this stage. */
bool stf_stage_entry(const stf_stage *w, size_t j, sunindextype k, sunrealtype *value);
/* stage_message.c: does the point found fulfil the equations of the stage, or why not? */
int stf_stage_judge(stf_stage *w, stf_nearest_point *m);

#endif
