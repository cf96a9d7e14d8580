/* steif/eigenvalues.h: the finite eigenvalues of a pencil, det(s E + F) = 0: the solutions v e^{st} of
 * E x' + F x = 0.
 *
 * Dense and small pencils: all of them, by the QZ algorithm on the finite part that the staircase
 * separates (C. B. Moler, G. W. Stewart, SIAM J. Numer. Anal. 10, 1973). Sparse ones: those nearest to a
 * point S by Arnoldi's method for (S E + F)^{-1} E, whose eigenvalues are 1 / (S - s), and 0 for infinite
 * ones, from a start without a fast part (K. Meerbergen, A. Spence, SIAM J. Matrix Anal. Appl. 18, 1997).
 * Each eigenvalue comes with its residual; that Arnoldi's method has missed none, or none of several
 * equal ones, is not certain.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_EIGENVALUES_H
#define STEIF_EIGENVALUES_H

#include <steif/impulse.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_eigenvalue {
  sunrealtype re, im; /* s, 1 / time */
  sunrealtype
    damping; /* -Re s / |s|: 1 aperiodic, 0 undamped, negative unstable; 0 for s = 0 */
  sunrealtype frequency; /* |Im s| / (2 pi) */
  sunrealtype
    residual; /* max_i |((s E + F) v)_i| / ((|s| ||E_i|| + ||F_i||) max |v|), 1-norms of rows:
                            relative changes of the entries that make s exact are as small. Of a
                            dense pencil in units in which entries are of one size, and where |s| is
                            below 1e-13 of the largest one with that instead: 0 to rounding */
} steif_eigenvalue;

typedef struct steif_eigenvalue_request {
  long count; /* the nearest ones; a pair is not parted. 0: all, dense and small pencils only */
  sunrealtype re, im; /* of S */
} steif_eigenvalue_request;

typedef struct steif_eigenvalues {
  long count;
  steif_eigenvalue *value; /* by their distance from S */
  int all;                 /* these are all finite ones, as many as the structure has */
  int certified; /* all residuals are below 1e-8, and as many as asked for were found */
  char message[256];
} steif_eigenvalues;

/* structure: of steif_structure_find, with a decided index. STEIF_SINGULAR for a singular pencil,
 * STEIF_UNSUPPORTED where all eigenvalues of a large sparse one are asked for. */
STEIF_EXPORT int steif_eigenvalues_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                                        const steif_analysis *analysis,
                                        const steif_structure *structure,
                                        const steif_eigenvalue_request *request,
                                        steif_eigenvalues *eigenvalues);
STEIF_EXPORT void steif_eigenvalues_clear(steif_context *ctx, steif_eigenvalues *eigenvalues);

#ifdef __cplusplus
}
#endif
#endif
