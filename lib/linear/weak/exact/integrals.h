/* integrals.h: the m-fold integrals of a run in many digits, for norms: sums whose terms of size h^-(k-1) cancel.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INTEGRALS_H
#define STF_INTEGRALS_H

#include "pairing.h"
#include "real.h"

/* z_j = I^j of the run from 0 on, j = 1 .. most, of components first .. first + count - 1 of n. */
typedef struct stf_integrals {
  int limbs, n, first, count, most;
  long double unit;   /* of times of events */
  stf_events *events; /* is told of each density and mass, and of z behind it */
  stf_real *z;        /* count x (most + 1); allocated, with what follows */
  stf_real *over;     /* 1/j, j = 1 .. most */
  stf_real *power;    /* (t - at)^j / j! */
  stf_real at;        /* time of z */
} stf_integrals;

int stf_integrals_open(steif_context *ctx, stf_integrals *integrals);
void stf_integrals_close(steif_context *ctx, stf_integrals *integrals);
/* With density x (n values) up to t. */
void stf_integrals_density(stf_integrals *integrals, const stf_real *t, const stf_real *x);
/* With the mass weight x at t. */
void stf_integrals_mass(stf_integrals *integrals, const stf_real *t, const stf_real *weight,
                        const stf_real *x);

#endif
