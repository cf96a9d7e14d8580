/* contour.h: the structure of a sparse pencil by circles, and the algorithm that they make.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CONTOUR_H
#define STF_CONTOUR_H

#include "analysis_steps.h"
#include "prime_field.h"

extern const stf_algorithm stf_contour_algorithm;

/* The circle that the structure is from. */
typedef struct stf_contour_circle {
  sunrealtype radius;
  bool given;    /* by the caller */
  bool complete; /* it holds as many eigenvalues as the pattern, or ranks, allow */
  int ranked;    /* index by ranks, -1: not computed */
  int moments;   /* index by the moments; -1: they decide nothing */
  /* Rows whose diagonal is a rounded sum, to which eigenvalues beyond the circle are due, or which are
   * taken for exact; the first of them. */
  sunindextype rounded, rounded_row;
  stf_field field; /* the pencil as given, E, F and snap by the caller */
} stf_contour_circle;

/* E and F: CSC. Everything of *structure but the certificate and the sentence of a regular pencil. */
int stf_contour_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                     const steif_analysis *analysis, steif_structure *structure,
                     stf_contour_circle *circle);
void stf_contour_say(const stf_contour_circle *circle, steif_structure *structure);
/* The sentence of a start whose circles of R and 2 R differ by gap. */
void stf_contour_say_start(const steif_structure *structure, sunrealtype gap,
                           steif_impulse *out);

#endif
