/* smooth_flow.h: the smooth solution with the slow part of a state, at many times.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SMOOTH_FLOW_H
#define STF_SMOOTH_FLOW_H

#include "circle.h"
#include "units.h"

/* Of a large sparse pencil. It stays where it is until it is closed. */
typedef struct stf_smooth_flow {
  steif_context *ctx;
  stf_pool *pool;
  SUNMatrix E;
  int index;
  stf_units units;
  stf_circle *circle; /* with the factors of all its nodes */
  N_Vector g;         /* a value of f */
  sunrealtype *rows;  /* E x, f, f', ... */
  sunrealtype *left;  /* scales of equations */
} stf_smooth_flow;

/* By the structure that circles have found and the radius of the impulse at the start. */
int stf_smooth_flow_open(steif_context *ctx, const steif_linear *linear,
                         const steif_analysis *analysis, const steif_structure *structure,
                         sunrealtype radius, stf_smooth_flow *flow);
void stf_smooth_flow_close(stf_smooth_flow *flow);
/* x <- Phi_{-1} E x + sum_j Phi_j f^(j)(t); f NULL: 0. */
int stf_smooth_flow_state(stf_smooth_flow *flow, sunrealtype t, steif_forcing f, void *user,
                          sunrealtype *x);

#endif
