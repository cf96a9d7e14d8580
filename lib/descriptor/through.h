/* through.h: the smooth solution through the slow part of a state, again and again.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_THROUGH_H
#define STF_THROUGH_H

#include "circle.h"
#include "units.h"

/* Of a large sparse pencil. It stays where it is until it is closed. */
typedef struct stf_through {
  steif_context *ctx;
  stf_pool *pool;
  SUNMatrix E;
  int index;
  stf_units units;
  stf_circle *circle; /* with the factors of all its nodes */
  N_Vector g;         /* room for a value of f */
  sunrealtype *rows;  /* E x, f, f', ... */
  sunrealtype *left;  /* scales of equations */
} stf_through;

/* By the structure that circles have found and the radius of the impulse at the start. */
int stf_through_open(steif_context *ctx, const steif_linear *linear,
                     const steif_analysis *analysis, const steif_structure *structure,
                     sunrealtype radius, stf_through *through);
void stf_through_close(stf_through *through);
/* x <- Phi_{-1} E x + sum_j Phi_j f^(j)(t); f NULL: 0. */
int stf_through_state(stf_through *through, sunrealtype t, steif_forcing f, void *user,
                      sunrealtype *x);

#endif
