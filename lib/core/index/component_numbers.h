/* component_numbers.h: the index of a problem and of its components, without a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COMPONENT_NUMBERS_H
#define STF_COMPONENT_NUMBERS_H

#include <steif/index.h>

/* As steif_diagnose at the start of the problem, with no array (test D) where the other two tests agree. */
int stf_index_of_components(steif_context *ctx, const steif_problem *problem,
                            steif_diagnosis *d);

#endif
