/* component_index.h: the index of each component of a descriptor system.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COMPONENT_INDEX_H
#define STF_COMPONENT_INDEX_H

#include "linear_system.h"

/* The index of each component up to 3 from the Laurent coefficients at infinity (stf_release it); NULL
 * where all are 1. */
int stf_component_index(steif_context *ctx, const steif_linear *linear,
                        const steif_analysis *analysis, const steif_structure *structure,
                        int **index);

#endif
