/* steif/phi.h: exponentials and phi functions of matrices.
 *
 *   phi_0(z) = e^z,   phi_k(z) = int_0^1 e^{(1-s) z} s^{k-1} ds / (k-1)!,   phi_k(0) = 1/k!,
 *   phi_k(z) = z phi_{k+1}(z) + 1/k!
 *
 * They solve linear equations with polynomial input: y' = A y + b_1 + tau b_2 + tau^2/2 b_3 + ...,
 * y(0) = b_0, has y(t) = phi_0(tA) b_0 + t phi_1(tA) b_1 + t^2 phi_2(tA) b_2 + ... None of the
 * functions below forms the quotient (phi_k - 1/k!) / z, which loses u/|z| per step: scaling and
 * doubling need no difference of near-equal numbers.
 *
 * Dense matrices are n x n, by columns, entry (i, j) at i + n j; results may not overlap arguments.
 * Scaling and squaring follows A. H. Al-Mohy and N. J. Higham, SIAM J. Matrix Anal. Appl. 31
 * (2009): balancing, a scaling chosen from ||A^k||^{1/k} and not from ||A||, Pade degrees 3 to 13,
 * and, for (quasi-)triangular matrices, diagonal blocks and first superdiagonal recomputed after
 * every squaring. The relative error is about u times the condition number of steif_expm_condition,
 * and often far less. Entries that underflow become 0. A result beyond the range of double
 * precision, and NaN or infinity in an argument, are STEIF_NOT_FINITE.
 *
 *   double A[] = {0, -0.4, 0.1, -0.05}, X[4], phi[3 * 4];
 *   steif_expm(ctx, 2, A, X);                 e^A
 *   steif_phi_matrix(ctx, 2, 2, A, phi);      e^A, phi_1(A), phi_2(A) one after another
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_PHI_H
#define STEIF_PHI_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The highest k of phi_k. */
enum { STEIF_PHI_MOST = 8 };

/* re[k] + i im[k] = phi_k(x + i y), k = 0 .. p, to four units of round-off; im may be NULL when
 * y = 0. A value out of range is infinite or NaN, an argument that is not finite gives NaN. Returns
 * STEIF_BAD_INPUT for p outside 0 .. STEIF_PHI_MOST, without a message. */
STEIF_EXPORT int steif_phi_scalar(int p, double x, double y, double *re, double *im);

/* X = e^A. */
STEIF_EXPORT int steif_expm(steif_context *ctx, int n, const double *A, double *X);

/* phi_0(A) .. phi_p(A), one n x n matrix after another. */
STEIF_EXPORT int steif_phi_matrix(steif_context *ctx, int n, int p, const double *A,
                                  double *phi);

/* w = phi_0(A) b_0 + ... + phi_p(A) b_p for the columns b_0 .. b_p of the n x (p+1) array b, by one
 * exponential of size n + p. */
STEIF_EXPORT int steif_phi_combine(steif_context *ctx, int n, int p, const double *A,
                                   const double *b, double *w);

/* L = the derivative of e^A in the direction E, int_0^1 e^{(1-s)A} E e^{sA} ds; X = e^A as well
 * unless NULL (A. H. Al-Mohy and N. J. Higham, SIAM J. Matrix Anal. Appl. 30, 2009). */
STEIF_EXPORT int steif_expm_frechet(steif_context *ctx, int n, const double *A, const double *E,
                                    double *X, double *L);

/* The relative condition number of e^A in the Frobenius norm, ||L|| ||A|| / ||e^A||, by power
 * iteration on the derivative and its adjoint, to about three digits. */
STEIF_EXPORT int steif_expm_condition(steif_context *ctx, int n, const double *A, double *cond);

#ifdef __cplusplus
}
#endif
#endif
