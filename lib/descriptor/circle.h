/* circle.h: (s E + F)^{-1} b around the circle |s| = R, equilibrated and refined.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CIRCLE_H
#define STF_CIRCLE_H

#include "structure.h"
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>

/* E and F scaled: rows and columns multiplied by powers of two that bring the largest entries of
 * size |E| + |F| near one, so that scaling rounds nothing. */
typedef struct stf_scaled {
  steif_context *ctx;
  stf_pool *pool;
  sunindextype n;
  SUNMatrix givenE, givenF;         /* as given, borrowed */
  SUNMatrix E, A;                   /* scaled, A = -F: the pencil s E - A = s E + F */
  sunrealtype *row, *column, *most; /* scales of rows and columns; scratch, 2 n */
  sunrealtype log_scale;            /* log det(scaled) - log det(given) */
  sunrealtype norm;                 /* largest column sum of size |E| + |F|, scaled */
  N_Vector like;
  steif_pencil *pencil;
} stf_scaled;

int stf_scaled_open(steif_context *ctx, SUNMatrix E, SUNMatrix F, stf_scaled *s);
void stf_scaled_close(stf_scaled *s);
/* Equilibrate size |E| + |F| and hand the values to the pencil. */
int stf_scaled_set(stf_scaled *s, sunrealtype size);
/* x <- (s E + F)^{-1} b with slot k, refined; in scaled coordinates. xi, bi NULL for a real shift.
 * r: scratch like x. */
int stf_scaled_solve(stf_scaled *s, int k, steif_shift at, int refinements, const N_Vector b[2],
                     N_Vector x[2], N_Vector r[2]);

/* A right-hand side at s in scaled coordinates; how often it is asked for does not matter. */
typedef void stf_circle_source(const stf_scaled *scaled, steif_shift s, void *user,
                               sunrealtype *re, sunrealtype *im);

/* The quadrature with `points` nodes R e^{2 pi i (j + 1/2) / points}, of which half are factored:
 * the data are real. `slots` at a time, so that factors of few points are alive. */
typedef struct stf_circle {
  stf_scaled scaled;
  int points, refinements, slots, lowest, count;
  N_Vector *sum; /* R^i times the coefficient of s^i, i = lowest .. lowest + count - 1 */
  N_Vector b[2], x[2], r[2];
  sunrealtype radius;
  sunrealtype log_det;   /* mean of log |det(s E + F)| over the circle */
  sunrealtype amplified; /* smallest ||(s E + F)^{-1} b|| / ||b|| met */
} stf_circle;

/* Room for coefficients lowest .. lowest + count - 1. Defaults of the analysis are filled in. */
int stf_circle_open(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, int lowest, int count, stf_circle *circle);
void stf_circle_close(stf_circle *circle);
/* Factor around the circle of radius R; source NULL: determinant only. */
int stf_circle_run(stf_circle *circle, sunrealtype R, stf_circle_source *source, void *user);

/* The analysis with its defaults. */
steif_analysis stf_analysis_filled(const steif_analysis *analysis);
/* The radius to use: given, found, or a guess from the largest entries. */
sunrealtype stf_radius(SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                       const steif_structure *structure);
/* max |M_ij|, 0 for an empty matrix. */
sunrealtype stf_largest(SUNMatrix M);

#endif
