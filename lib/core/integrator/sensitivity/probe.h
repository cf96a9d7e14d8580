/* probe.h: derivatives as they are given, against differences of F at a point, where that can tell them apart.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PROBE_H
#define STF_PROBE_H

#include "integrator.h"
#include <math.h>

typedef struct stf_slope_probe {
  steif_solver *s;
  stf_slopes *slopes;   /* dF/dp; NULL: no parameters */
  stf_matrices_at at;   /* E and A at one point */
  const int *parameter; /* of each column, NULL: all */
  int count;
  sunrealtype t;
  N_Vector y, yp;             /* the point */
  N_Vector given, rounding;   /* a derivative, and how far F moves by rounding */
  N_Vector found, wide, half; /* differences over [-d, d], [-2d, 2d] and [0, d] */
  N_Vector F, along, moved;   /* F at the point; a direction; y or y' on it */
  N_Vector near;              /* y of the other point */
  bool far;                   /* F is a difference over half of p_k */
} stf_slope_probe;

/* probe_matrices.c: dF/dp, dF/dy and dF/dy' at the present point of a run with these equations, and at one near it;
 * STEIF_BAD_INPUT where one is wrong. */
int stf_probe_open(stf_pool *pool, stf_system *system, stf_slopes *slopes, const int *parameter,
                   int count, stf_slope_probe **probe);
int stf_probe_look(stf_slope_probe *q, steif_solver *s);
/* probe_slopes.c: dF/dp. */
int stf_probe_slopes(stf_slope_probe *q);
/* rounding_i = how far F_i moves with y and y' by some units of rounding. */
int stf_probe_rounding(stf_slope_probe *q);
/* The entry of `given` that is off by the most, in parts of what it may be off by; -1: none. `unknown` ones are not judged;
 * NULL: none. *bar: the error of its difference, of lengths d. */
sunindextype stf_probe_worst(const stf_slope_probe *q, sunrealtype d,
                             bool (*unknown)(const stf_slope_probe *q, sunindextype i),
                             sunrealtype *bar);

/* An entry that is given, beside differences over [-d, d], [-2d, 2d] or longer, and [0, d]: how far it is off, in parts of
 * ten times what they are apart, with what rounding makes of them, and of 1e-3 of itself; *error: the first of these. */
static inline sunrealtype stf_probe_excess(sunrealtype given, sunrealtype found,
                                           sunrealtype wide, sunrealtype half,
                                           sunrealtype rounding, sunrealtype *error)
{
  const sunrealtype sure = 10, relative = 1e-3;
  const sunrealtype spread = fmax(fabs(found - wide), fabs(found - half));
  *error = sure * (spread + rounding);
  return fabs(given - found) / fmax(*error, relative * fmax(fabs(given), fabs(found)));
}

#endif
