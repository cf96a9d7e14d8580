/* demand.h: a forcing of which only those derivatives are wanted that the solution depends on.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DEMAND_H
#define STF_DEMAND_H

#include "linear_system.h"

/* Component i of f enters the solution with derivatives up to the degree in s of column i of
 * (s E + F)^{-1}. A higher one that is not known, NaN in the answer of `f`, is taken as 0. The degree is
 * that of the cofactors, bounded by the pattern, less that of the determinant, the number of finite
 * eigenvalues: values that cancel what the pattern allows there raise it. */
typedef struct stf_demand {
  steif_context *ctx;
  SUNMatrix E, F;
  steif_forcing f;
  void *user;
  const steif_names *names;
  sunindextype finite;  /* eigenvalues; -1: not known, then all derivatives matter */
  sunindextype *degree; /* of each equation by the pattern; found when it is first asked for */
} stf_demand;

stf_demand stf_demand_of(steif_context *ctx, const steif_linear *linear,
                         const steif_analysis *analysis);
/* The same system with this forcing. */
steif_linear stf_demand_linear(stf_demand *demand);
/* A steif_forcing whose user is the stf_demand: > 0 with the message set, saying which component, when
 * one that matters is not known. */
int stf_demand_value(sunrealtype t, int derivative, N_Vector g, void *demand);
void stf_demand_close(stf_demand *demand);

#endif
