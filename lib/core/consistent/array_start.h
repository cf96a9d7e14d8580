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

#endif
