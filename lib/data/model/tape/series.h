/* series.h: Taylor coefficients in t of nodes, along a curve of the unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MODEL_SERIES_H
#define STF_MODEL_SERIES_H

#include "input.h"
#include "tape.h"

/* y_i(t + s) = sum_k y[k n + i] s^k, k = 0 .. order + 1. */
typedef struct stf_curve {
  const double *y;
  int32_t n;
} stf_curve;

/* The coefficients 0 .. order of `root` at feed->t; without a curve it has no unknowns. STEIF_RETRY:
 * they are not known there, and *why (or NULL) says of which operation, if it was NULL before. */
int stf_taylor(const stf_formulas *g, int32_t root, const stf_feed *feed,
               const stf_curve *curve, const int32_t *counter, int order, stf_sweep *sweep,
               double *value, const char **why);

/* special_series.c: NULL, or why there is no series; w: 4 series of scratch. */
const char *stf_special_series(int kind, int n, const stf_series *a, stf_series *u,
                               stf_series *w);
const char *stf_angle_series(int n, const stf_series *a, const stf_series *b, stf_series *u,
                             stf_series *w);
/* sign: of a just to the right, less its value. */
const char *stf_lookup_series(const stf_lookup *l, int n, const stf_series *a, int sign,
                              stf_series *u, stf_series *w);

#endif
