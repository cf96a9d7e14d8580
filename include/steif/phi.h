/* steif/phi.h: exponentials and phi functions of matrices, and their action on vectors.
 *
 *   phi_0(z) = e^z,   phi_k(z) = int_0^1 e^{(1-s) z} s^{k-1} ds / (k-1)!,   phi_k(0) = 1/k!,
 *   phi_k(z) = z phi_{k+1}(z) + 1/k!
 *
 * They solve linear equations with polynomial input: y' = A y + b_1 + tau b_2 + tau^2/2 b_3 +
 * ..., y(0) = b_0, has y(t) = phi_0(tA) b_0 + t phi_1(tA) b_1 + t^2 phi_2(tA) b_2 + ... None of
 * the functions below forms the quotient (phi_k - 1/k!) / z, which loses u/|z| per step:
 * scaling and doubling need no difference of near-equal numbers.
 *
 * Dense matrices are n x n, by columns, entry (i, j) at i + n j; results may not overlap
 * arguments. Scaling and squaring follows A. H. Al-Mohy and N. J. Higham, SIAM J. Matrix Anal.
 * Appl. 31 (2009): balancing, a scaling chosen from ||A^k||^{1/k} and not from ||A||, Pade
 * degrees 3 to 13, and, for (quasi-)triangular matrices, diagonal blocks and first
 * superdiagonal recomputed after every squaring. The relative error is about u times the
 * condition number of steif_expm_condition, and often far less. Entries that underflow become
 * 0. A result beyond the range of double precision, and NaN or infinity in an argument, are
 * STEIF_NOT_FINITE.
 *
 *   double A[] = {0, -0.4, 0.1, -0.05}, X[4], phi[3 * 4];
 *   steif_expm(ctx, 2, A, X);                 e^A
 *   steif_phi_matrix(ctx, 2, 2, A, phi);      e^A, phi_1(A), phi_2(A) one after another
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_PHI_H
#define STEIF_PHI_H

#include <steif/base.h>
#include <steif/pencil.h>
#include <sundials/sundials_matrix.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The highest k of phi_k. */
enum { STEIF_PHI_MOST = 8 };

/* re[k] + i im[k] = phi_k(x + i y), k = 0 .. p, to four units of round-off; im may be NULL when
 * y = 0. A value out of range is infinite or NaN, an argument that is not finite gives NaN.
 * Returns STEIF_BAD_INPUT for p outside 0 .. STEIF_PHI_MOST, without a message. */
STEIF_EXPORT int steif_phi_scalar(int p, double x, double y, double *re, double *im);

/* X = e^A. */
STEIF_EXPORT int steif_expm(steif_context *ctx, int n, const double *A, double *X);

/* phi_0(A) .. phi_p(A), one n x n matrix after another. */
STEIF_EXPORT int steif_phi_matrix(steif_context *ctx, int n, int p, const double *A,
                                  double *phi);

/* w = phi_0(A) b_0 + ... + phi_p(A) b_p for the columns b_0 .. b_p of the n x (p+1) array b, by
 * one exponential of size n + p. */
STEIF_EXPORT int steif_phi_combine(steif_context *ctx, int n, int p, const double *A,
                                   const double *b, double *w);

/* L = the derivative of e^A in the direction E, int_0^1 e^{(1-s)A} E e^{sA} ds; X = e^A as well
 * unless NULL (A. H. Al-Mohy and N. J. Higham, SIAM J. Matrix Anal. Appl. 30, 2009). */
STEIF_EXPORT int steif_expm_frechet(steif_context *ctx, int n, const double *A, const double *E,
                                    double *X, double *L);

/* The relative condition number of e^A in the Frobenius norm, ||L|| ||A|| / ||e^A||, by power
 * iteration on the derivative and its adjoint, to about three digits. */
STEIF_EXPORT int steif_expm_condition(steif_context *ctx, int n, const double *A, double *cond);

/* w = sum_k phi_k(tA) b_k for large A, without forming a function of A. Three methods:
 *
 *   rational    Krylov space of (I - gamma A)^{-1}, gamma = t/10: one factorisation (KLU), kept
 *               while t stays within a factor of two, and one solve per dimension and b_k that
 *               is given. Their number does not depend on ||tA|| where the spectrum lies in a
 *               sector around the negative real axis (diffusion); useless for oscillations.
 *   polynomial  Arnoldi with sub-steps (R. B. Sidje, ACM TOMS 24, 1998); products grow like
 *               ||tA||.
 *   taylor      truncated Taylor series with shift and cost selection (A. H. Al-Mohy and
 *               N. J. Higham, SIAM J. Sci. Comput. 33, 2011); sparse matrices only.
 *
 * Automatic choice: up to ||tA||_1 = 8 Taylor, up to 100 polynomial, above polynomial for
 * oscillations and rational otherwise; where the rational space does not converge the polynomial
 * one is tried if ||tA||_1 is at most 1e5. An operator is rational when its spectrum is declared
 * to be sectorial, else polynomial. */
enum steif_action_method {
  STEIF_ACTION_AUTO = 0,
  STEIF_ACTION_RATIONAL,
  STEIF_ACTION_POLYNOMIAL,
  STEIF_ACTION_TAYLOR
};

enum steif_spectrum {
  STEIF_SPECTRUM_UNKNOWN = 0, /* a symmetric matrix is found to be sectorial, a skew one not */
  STEIF_SPECTRUM_SECTORIAL,   /* real negative, or in a sector around the negative real axis */
  STEIF_SPECTRUM_OSCILLATORY  /* near the imaginary axis */
};

/* Zero means the default. */
typedef struct steif_action_options {
  int method, spectrum;  /* of the enums above */
  sunrealtype tolerance; /* of ||w||, in the 2-norm; 1e-10 */
  int dimension;         /* of the Krylov space; 30 (polynomial), 60 (rational) */
  long products;         /* that one application may take; 100000 */
} steif_action_options;

/* What one application did. */
typedef struct steif_action_report {
  int method;          /* the one that gave the result */
  sunrealtype error;   /* estimate of ||error||, in the 2-norm */
  sunrealtype norm;    /* ||w|| */
  sunrealtype norm_tA; /* ||tA||_1; 0 for operators */
  long products, solves, factors;
  long steps;    /* sub-steps of the polynomial and the Taylor method */
  int dimension; /* largest Krylov space */
} steif_action_report;

typedef struct steif_action steif_action;

/* A sparse square matrix by columns (CSC), or an operator, whose E must be NULL: one of A and
 * op is NULL. Both are borrowed. `like` gives the kind of vector; with a matrix it has a host
 * array. */
STEIF_EXPORT steif_action *steif_action_new(steif_context *ctx, SUNMatrix A,
                                            const steif_operator *op, N_Vector like,
                                            const steif_action_options *options);

/* The values of A changed. */
STEIF_EXPORT int steif_action_update(steif_action *a);

/* w = sum_{k=0}^{p} phi_k(tA) b_k for any finite t; b_k NULL counts as zero, w differs from all
 * b_k. STEIF_NOT_CERTIFIED, with the estimate in sentence and report, when the estimated error
 * stays above tolerance ||w|| + 32 u sum ||b_k||/k!; w then holds the best there is. The
 * estimate covers the approximation, not the rounding of solves with I - gamma A, about u times
 * the condition of that matrix. Vectors are made as the first applications need them, none
 * later. */
STEIF_EXPORT int steif_action_apply(steif_action *a, sunrealtype t, int p, N_Vector *b,
                                    N_Vector w, steif_action_report *report);

STEIF_EXPORT void steif_action_free(steif_action **a);

#ifdef __cplusplus
}
#endif
#endif
