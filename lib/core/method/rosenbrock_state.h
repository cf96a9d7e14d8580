/* rosenbrock_state.h: the state of a Rosenbrock method, for what carries derivatives through its steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ROSENBROCK_STATE_H
#define STF_ROSENBROCK_STATE_H

#include "lu.h"
#include "rosenbrock_data.h"
#include "step_error.h"

typedef struct stf_rosenbrock_state {
  const stf_rodas *r;
  N_Vector u[STF_RODAS_STAGES], old[STF_RODAS_STAGES]; /* of the trial, of the last step */
  N_Vector Y, sum, ft, f0, before, between, Ep, off;
  bool have_f0;  /* f0 = f(t_n, y_n), ft = df/dt there */
  bool unrolled; /* the stages run through `kernel` */
  stf_rosenbrock kernel;
  sunrealtype h_factored;
  stf_carried carried;
  sunrealtype wanted; /* what an estimate may be where all errors add */
} stf_rosenbrock_state;

/* carry_rosenbrock.c. */
extern const stf_carrier stf_rosenbrock_carrier;

#endif
