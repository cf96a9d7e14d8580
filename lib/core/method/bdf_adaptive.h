/* bdf_adaptive.h: the state of BDF with variable steps, for what carries derivatives through them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BDF_ADAPTIVE_H
#define STF_BDF_ADAPTIVE_H

#include "carry.h"
#include "step_error.h"

enum { STF_BDF_HIGHEST = 5, STF_BDF_POINTS = STF_BDF_HIGHEST + 2 };

typedef struct stf_bdf {
  int p, k, last;   /* highest order; order of the trial; of the last step */
  int points, wait; /* valid past points; steps until the order is looked at */
  int refusals;
  bool halved;       /* the attempt is two steps of half its length */
  sunrealtype omega; /* frequency of the fastest part if that oscillates; 0: it does not */
  long seen, since;  /* Jacobians made, and the step of the last one */
  long omega_of;     /* Jacobians made when omega was found */
  sunrealtype noise; /* of algebraic unknowns, in tolerances */
  long noise_of;     /* Jacobians made when it was found */
  N_Vector y[STF_BDF_POINTS + 1];
  sunrealtype t[STF_BDF_POINTS + 1];
  sunrealtype alpha[STF_BDF_HIGHEST + 1];
  sunrealtype wanted[STF_BDF_HIGHEST + 1],
    allowed[STF_BDF_HIGHEST + 1]; /* of the error of order k */
  stf_carried carried;
  N_Vector base, offset, Z, other;
} stf_bdf;

/* Weights of the extrapolation to time t through the first `count` past points. */
void stf_bdf_extrapolate(const stf_bdf *e, int count, sunrealtype t, sunrealtype *weight);
/* Is this step made as two of half its length? */
bool stf_bdf_halves(const stf_step *s);
extern const stf_carrier stf_bdf_carrier;

#endif
