/* kick_drift.h: kicks and drifts of a separable problem, and sums that remember their rounding.
 *
 * Positions are components 0 .. m - 1, momenta the rest. A running sum y keeps the part of
 * the last increment that rounding took from it, in e: with d = increment + e,
 *   y' = y + d,   e' = d - (y' - y)      (Kahan; exact where |d| <= |y|).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_HALVES_H
#define STF_HALVES_H

#include "method.h"

typedef struct stf_kick_drift {
  stf_system *system;
  sunindextype m;
  bool unit;        /* serial, and q' = p */
  N_Vector speed;   /* q' in the positions; for vectors that are not serial 0 in the momenta */
  N_Vector mask[2]; /* 1 in the positions, in the momenta; NULL where kick and drift serve */
  N_Vector increment, moved; /* scratch of compensated sums of vectors that are not serial */
} stf_kick_drift;

/* Claims, and refusal of problems that are not separable: not declared, or found out by
 * moving the positions and the momenta at the start, where f is `slope`. `name`: of the
 * method. */
int stf_kick_drift_open(stf_pool *pool, stf_system *system, const char *name, N_Vector y,
                        N_Vector slope, stf_kick_drift *halves);

/* p'(t, q of y) into the momenta of `force`; 0 or untouched in its positions. */
int stf_kick_drift_force(stf_kick_drift *halves, sunrealtype t, N_Vector y, N_Vector force);

/* A point of the step: the state and what rounding took (NULL: not kept). */
typedef struct stf_point {
  N_Vector y, e;
} stf_point;

/* to = from after a kick a (force may be NULL when a = 0) and a drift b at time t; `to` may be
 * `from`. STEIF_RETRY when a component is not finite. */
int stf_kick_drift_pass(stf_kick_drift *halves, sunrealtype a, N_Vector force, sunrealtype b,
                        sunrealtype t, stf_point from, stf_point to);

/* to = from + increment, compensated; `increment` is overwritten. */
void stf_add_compensated(const stf_space *space, N_Vector increment, stf_point from,
                         stf_point to);

#endif
