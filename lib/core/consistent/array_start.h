/* array_start.h: consistent start values from the evidence on the index.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ARRAY_START_H
#define STF_ARRAY_START_H

#include "consistent_start.h"
#include "evidence.h"

/* From the whole derivative array, where the structure cannot order the equations. */
int stf_start_array(stf_start_task *task, const stf_derivative_array *a, const int *number);
/* The consistent start nearest to the point, which may have moved since it was diagnosed. */
int stf_start_from(stf_evidence *evidence, const steif_diagnosis *diagnosis,
                   const steif_request *request, steif_start *start);
/* With nodes of points before; NULL: none. */
int stf_start_with(stf_evidence *evidence, const steif_diagnosis *diagnosis,
                   const steif_request *request, stf_start_nodes *nodes, steif_start *start);

/* kinetic_jump.c: *start, found by stages, with the jump of differential components in which E y, momenta and charges,
 * changes by impulses of the constraints alone: E and their directions as at y(t-) and as at y(t+). Where the two
 * differ by more than 10 tolerances: STEIF_BAD_INPUT with both. Where it is not found *start stays. */
struct stf_repair;
int stf_keep_momenta(struct stf_repair *repair, stf_evidence *evidence,
                     const steif_diagnosis *diagnosis, const steif_request *request,
                     steif_start *start);
/* used_index.c: the numbers of the components go to the problem and the report of *repair. */
int stf_use_index(struct stf_repair *repair, const stf_evidence *evidence,
                  const steif_diagnosis *diagnosis);

/* Weights of least movement in the norm of E: with masses on its diagonal M (v(t+) - v(t-)) = -G^T Lambda, as
 * after an impact. */
void stf_start_inertia(const stf_view *view, sunrealtype *weight);
/* The same by stages alone: STEIF_UNSUPPORTED where the structure is not regular at the point and beside it. number (n;
 * NULL: not wanted): index of each unknown there. */
int stf_start_beside(steif_context *ctx, const steif_problem *problem, const steif_point *at,
                     stf_start_nodes *nodes, steif_start *start, int *number);
/* steif_consistent with these weights. */
int stf_start_project(steif_context *ctx, const steif_problem *problem, const steif_point *at,
                      steif_start *start);

#endif
