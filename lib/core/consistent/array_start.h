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

/* Weights of least movement in the norm of E: with masses on its diagonal M (v(t+) - v(t-)) = -G^T Lambda, as
 * after an impact. */
void stf_start_inertia(const stf_view *view, sunrealtype *weight);
/* steif_consistent with these weights. */
int stf_start_project(steif_context *ctx, const steif_problem *problem, const steif_point *at,
                      steif_start *start);

#endif
