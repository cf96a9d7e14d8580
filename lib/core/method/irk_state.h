/* irk_state.h: the state of collocation, and its error.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_IRK_STATE_H
#define STF_IRK_STATE_H

#include "stage_polynomial.h"
#include "step_error.h"

typedef struct stf_irk_state {
  const steif_table *table;
  int s;
  stf_stage_polynomial u;
  sunrealtype *row_sum; /* B 1 */
  sunrealtype filter;   /* blended iteration: weight gamma_0 of the estimate */
  stf_estimate higher_order;
  sunrealtype omega;   /* frequency of the fastest part if that oscillates; 0: it does not */
  long omega_of;       /* Jacobians made when omega was found */
  long fails;          /* of Newton up to the accepted step */
  N_Vector *Z, *trial; /* of the last step and of the attempt, relative to y_n */
  N_Vector *base, *offset, *X;
  N_Vector before, work, imaginary; /* before: y_n of the last step */
  N_Vector lost, next_lost; /* what rounding took from y and from the trial; NULL: not kept */
  stf_parts parts;          /* of B and of w(1), where that is kept */
  bool history;
} stf_irk_state;

/* The filter of the estimate: v <- (lambda/h E - A)^{-1} v, its damped part where lambda is one of a pair. */
int stf_irk_filter(stf_step *s, sunrealtype h, N_Vector v);
int stf_irk_filter_all(stf_step *s, sunrealtype h, int count, N_Vector *v);
/* s->error of this attempt, what it may be, and a look between the stages. */
int stf_irk_estimate(stf_step *s, sunrealtype h);

#endif
