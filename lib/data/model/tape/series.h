/* series.h: Taylor coefficients in t of nodes, along a curve of the unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MODEL_SERIES_H
#define STF_MODEL_SERIES_H

#include "tape.h"

/* ---- Taylor arithmetic: c[k] = u^(k)(t) / k!, k = 0 .. n ------------------------------------- */

enum { STF_ORDER = 64 };
typedef struct stf_series {
  sunrealtype c[STF_ORDER + 1];
} stf_series;

void stf_series_constant(int n, sunrealtype value, stf_series *u);
void stf_series_times(int n, const stf_series *a, const stf_series *b, stf_series *u);
/* NULL, or why there is no series. u is neither a nor b nor w. */
const char *stf_series_over(int n, const stf_series *a, const stf_series *b, stf_series *u);
const char *stf_series_power(int n, const stf_series *a, sunrealtype exponent, stf_series *u);
/* a^exponent by squaring; w: two series of scratch. */
const char *stf_series_whole(int n, const stf_series *a, long exponent, stf_series *u,
                             stf_series w[2]);
const char *stf_series_log(int n, const stf_series *a, stf_series *u);
void stf_series_exp(int n, const stf_series *a, stf_series *u);
/* sign -1: sine and cosine, +1: sinh and cosh. */
void stf_series_waves(int n, const stf_series *a, int sign, stf_series *sine,
                      stf_series *cosine);
/* sign +1: tan, -1: tanh; w = 1 + sign u^2. */
const char *stf_series_tan(int n, const stf_series *a, int sign, stf_series *u, stf_series *w);
void stf_series_atan(int n, const stf_series *a, stf_series *u, stf_series *w);

/* ---- nodes ----------------------------------------------------------------------------------- */

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

/* The nodes of `list`, ascending, which hold all their operands, into `all`, which has room for count + 4 series;
 * place: an entry for each node of the graph. NULL, or why the first that has no series has none; *wrong is that
 * node. Those are NaN: a branch that is not taken may have none. */
const char *stf_series_run(const stf_formulas *g, const int32_t *list, size_t count,
                           const stf_feed *feed, const stf_curve *curve, const int32_t *counter,
                           int order, int32_t *place, stf_series *all, int32_t *wrong);

/* special_series.c: NULL, or why there is no series; w: 4 series of scratch. */
const char *stf_special_series(int kind, int n, const stf_series *a, stf_series *u,
                               stf_series *w);
const char *stf_angle_series(int n, const stf_series *a, const stf_series *b, stf_series *u,
                             stf_series *w);
/* sign: of a just to the right, less its value. */
const char *stf_lookup_series(const stf_lookup *l, int n, const stf_series *a, int sign,
                              stf_series *u, stf_series *w);

#endif
