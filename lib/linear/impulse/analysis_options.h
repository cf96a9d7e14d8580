/* analysis_options.h: the options of an analysis with the algorithm that they lead to.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ANALYSIS_OPTIONS_H
#define STF_ANALYSIS_OPTIONS_H

#include "linear_system.h"

/* STEIF_AUTOMATIC resolved; analysis NULL: {0}. */
steif_analysis stf_analysis_resolved(SUNMatrix E, SUNMatrix F, const steif_analysis *analysis);
int stf_analysis_check(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                       const steif_analysis *analysis);
/* By staircase and generalised Schur form? */
bool stf_analysis_dense(const steif_analysis *analysis);
/* Such a structure stays with them: no dense algorithm may know it. */
bool stf_found_by_circles(const steif_structure *structure);

#endif
