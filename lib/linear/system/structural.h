/* structural.h: what the pattern of a pencil s E + F says of it. E and F: CSC.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STRUCTURAL_H
#define STF_STRUCTURAL_H

#include "linear_system.h"
#include "matching.h"

/* The graph whose edges are the entries of E or F that are not zero, of weight 1 those of E;
 * index arrays out of order are STEIF_BAD_INPUT. */
int stf_structural_graph(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F,
                         stf_graph *g);
/* Structural rank; of *structure the degree (weight of a perfect matching) and the lists: equations
 * and unknowns of the over- and under-determined parts when there is no perfect matching, else those
 * that raise the index. */
int stf_structural_rank(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                        steif_structure *structure);
/* The same together with the structural index; -1 without a perfect matching. */
int stf_structural_index(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                         sunindextype *index, steif_structure *structure);
/* The equations and unknowns of a singular pencil that depend on others of their list, for the numbers
 * as given. */
int stf_structural_dependent(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                             steif_structure *structure);

#endif
