/* linear_system.h: what the analyses of descriptor systems share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LINEAR_SYSTEM_H
#define STF_LINEAR_SYSTEM_H

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

/* The 2-norm of n numbers; that of all entries of a matrix, dense or CSC. */
sunrealtype stf_sources_length(sunindextype n, const sunrealtype *x);
sunrealtype stf_sources_frobenius(SUNMatrix M);
/* What errors of an x(0+) of size `plus` are relative to: that, or a thousandth of what E x(0-), f, f',
 * ... stand for in units of the unknowns, where it is smaller: x(0+) = 0 is as good as any. E and F:
 * Frobenius norms. */
sunrealtype stf_sources_measure(const stf_sources *sources, sunrealtype plus, sunrealtype E,
                                sunrealtype F);

/* Square, of one order, dense or CSC, finite; or a sentence. */
int stf_structure_check(steif_context *ctx, SUNMatrix E, SUNMatrix F);
/* Allocate lists in a structure (one that is there is released) and an impulse, whose x_plus has 2 n
 * values more for the residuals: nothing else may allocate it. */
int stf_structure_list(steif_context *ctx, sunindextype count, sunindextype **list);
int stf_impulse_allocate(steif_context *ctx, sunindextype n, int index, steif_impulse *impulse);
/* The three residuals of steif_impulse from its x_plus and c. */
void stf_impulse_residuals(SUNMatrix E, SUNMatrix F, const sunrealtype *x0,
                           steif_impulse *impulse);

/* What a structure keeps for later solutions of the same matrices: the first member of whatever it is,
 * with the function that frees all of it. */
struct stf_kept {
  void (*free)(steif_context *ctx, struct stf_kept *kept);
};

#endif
