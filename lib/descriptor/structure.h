/* structure.h: what the analyses of descriptor systems share inside the room.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STRUCTURE_H
#define STF_STRUCTURE_H

#include "base.h"
#include <steif/impulse.h>

/* Right-hand sides of the Laurent formulas: columns E x0, f, f', ..., f^(derivatives). */
typedef struct stf_sources {
  sunindextype n;
  int derivatives;        /* highest order of f that is there */
  const sunrealtype *Ex0; /* n */
  const sunrealtype *f;   /* (derivatives + 1) x n by rows; NULL: f = 0 */
} stf_sources;

/* y += E x. */
void stf_sources_product(SUNMatrix E, const sunrealtype *x, sunrealtype *y);
/* f and its derivatives up to the order given at t, by rows of n; g: room for one. A missing one is
 * STEIF_BAD_INPUT, in the words of the forcing where it has any. */
int stf_sources_force(steif_context *ctx, steif_forcing f, void *user, sunrealtype t,
                      int derivatives, N_Vector g, sunrealtype *rows);

/* A system of index 1 with the smooth solutions of a given one, E x' + F x = sum_j G_j f^(j): the
 * first rows of E are 0, the others have full rank. n x n by columns each. */
typedef struct stf_reduction {
  int terms;              /* of the sum: the index, or 0 */
  int algebraic;          /* out: how many rows of E are 0 */
  sunrealtype *E, *F, *G; /* G: terms of them */
} stf_reduction;

/* The system in coordinates z in which its infinite and finite part are apart, diag(N, E_f) z' +
 * diag(I, F_f) z = G f with N strictly upper triangular: z = to x, x = back z. All n x n. */
typedef struct stf_decoupling {
  sunrealtype *E, *F, *G, *to, *back;
} stf_decoupling;

/* What else a staircase leaves; what is NULL is not wanted. */
typedef struct stf_pieces {
  sunrealtype *slow; /* projector, n x n */
  stf_reduction *reduction;
  const stf_decoupling *decoupling;
} stf_pieces;

/* Dense algorithms (staircase.c, qz.c): E and F column-major n x n. Each fills what it knows of
 * *structure (zeroed by the caller), and of *impulse when sources are given (index known). */
int stf_staircase(steif_context *ctx, sunindextype n, const sunrealtype *E,
                  const sunrealtype *F, const steif_analysis *analysis, const sunrealtype *x0,
                  const stf_sources *sources, steif_structure *structure,
                  steif_impulse *impulse, const stf_pieces *parts);
int stf_qz(steif_context *ctx, sunindextype n, const sunrealtype *E, const sunrealtype *F,
           const steif_analysis *analysis, sunindextype infinite, const sunrealtype *x0,
           const stf_sources *sources, steif_structure *structure, steif_impulse *impulse);

/* Sparse algorithms (contour.c, drazin.c): E and F sparse CSC. */
int stf_contour(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                steif_structure *structure);
int stf_contour_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                        const steif_analysis *analysis, const sunrealtype *x0,
                        const stf_sources *sources, steif_structure *structure,
                        steif_impulse *impulse);
int stf_drazin_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                       const steif_analysis *analysis, const sunrealtype *x0,
                       const stf_sources *sources, steif_structure *structure,
                       steif_impulse *impulse);

/* By sparse QR (array.c); STEIF_UNSUPPORTED where it is not built in. */
int stf_array_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                      const steif_analysis *analysis, const sunrealtype *x0,
                      const stf_sources *sources, steif_structure *structure,
                      steif_impulse *impulse);

/* Combinatorics of the pattern (matching.c): structural rank, degree (maximum-weight perfect
 * matching, weight 1 on entries of E), and by the Dulmage-Mendelsohn decomposition the equations
 * and unknowns of the over- and under-determined parts when there is no perfect matching. */
int stf_matching(steif_context *ctx, SUNMatrix E, SUNMatrix F, sunindextype *rank,
                 steif_structure *structure);

/* Square, of one order, dense or CSC, finite; or a sentence. */
int stf_structure_check(steif_context *ctx, SUNMatrix E, SUNMatrix F);
/* Claim lists in a structure (one that is there is released) and an impulse. Behind x_plus stand
 * 2 n values for the residuals: nothing else may claim it. */
int stf_structure_list(steif_context *ctx, sunindextype count, sunindextype **list);
int stf_impulse_claim(steif_context *ctx, sunindextype n, int index, steif_impulse *impulse);
/* The three residuals of steif_impulse from its x_plus and c. */
void stf_impulse_residuals(SUNMatrix E, SUNMatrix F, const sunrealtype *x0,
                           const sunrealtype *f, steif_impulse *impulse);

/* Index of each unknown up to 3 from the Laurent coefficients at infinity (stf_release it); NULL
 * where all are 1. */
int stf_linear_grade(steif_context *ctx, const steif_linear *linear,
                     const steif_analysis *analysis, const steif_structure *structure,
                     int **index);

#endif
