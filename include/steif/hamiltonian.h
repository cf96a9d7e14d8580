/* steif/hamiltonian.h: which linear systems x' = A x are Hamiltonian: four questions, not one.
 *
 *   definite     A^T P + P A = 0 for a P = P^T > 0: the orbits stay bounded forward and backward.
 *                So it is when A is diagonalisable with imaginary eigenvalues (0 among them).
 *   nonsingular  the same for a P = P^T of full rank, definite or not: the Jordan blocks of l and
 *                -l have the same sizes, and those of even size at 0 come in pairs.
 *   symplectic   A^T K + K A = 0 for a skew K of full rank: A = K^{-1} (K A), with K A symmetric
 *                the Hessian of H. As before, but the blocks of odd size at 0 come in pairs.
 *   invariant    some P = P^T, not 0: x^T P x is conserved. Two eigenvalues (or one and itself)
 *                have the sum 0.
 *
 * None of them implies all others: diag(1, -1) has H = q p and no definite P; H = p^2/2 has no P of
 * full rank; a skew A of odd order has P = 1 and no K. Where A is invertible, nonsingular and
 * symplectic are the same, K = P A^{-1}.
 *
 * Numbers. A is balanced and taken to a complex Schur form; eigenvalues are put into clusters
 * until each spectral projector Pi is small enough to tell its cluster from the others by
 * r = tolerance ||A|| ||Pi||, the uncertainty of the cluster's mean and of its block. What is
 * below r is 0, what is above STEIF_DOUBT r is not, and in between the answer is -1, undecided. So
 * "no" means: none with a condition number below 1/tolerance. Jordan blocks are told by the ranks
 * of a staircase with the same thresholds.
 *
 * V. I. Arnold, Mathematical Methods of Classical Mechanics, 2nd ed. (1989), appendix 6;
 * J. Williamson, Amer. J. Math. 58 (1936); C. A. Bavely and G. W. Stewart, SIAM J. Numer. Anal. 16
 * (1979), for the clusters. Matrices are n x n, by columns.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_HAMILTONIAN_H
#define STEIF_HAMILTONIAN_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { STEIF_DOUBT = 30 };

/* A solution P of A^T P + P A = 0. */
typedef struct steif_form_found {
  const double *P;  /* NULL: none, or not asked for */
  double residual;  /* ||A^T P + P A|| / (2 ||A|| ||P||), Frobenius */
  double condition; /* ||P|| ||P^{-1}||, 2-norm; infinite for a P of lower rank */
  double distance;  /* relative change of A after which P solves the equation exactly:
                       ||P^{-1} (A^T P + P A)|| / (2 ||A||); NaN for a P of lower rank */
} steif_form_found;

typedef struct steif_hamiltonian {
  int definite, nonsingular, symplectic, invariant; /* 1 yes, 0 no, -1 undecided */
  int dimension; /* of the space of symmetric P; -1: undecided */
  double tolerance;
  /* The best P there is: if definite, the sum of Pi^* Pi over the distinct eigenvalues, the mean of
   * e^{A^T t} e^{A t} over all times (1 for a skew A); else one of full rank; else one that is not
   * 0. Where there is none but a change of A below STEIF_NEAR makes it definite, the P of that
   * change, its `distance` away. */
  steif_form_found symmetric;
  steif_form_found skew; /* K, where symplectic */
  const double *re, *im; /* eigenvalues of A, those of one cluster together */
  char message[256];     /* the first question, in words */
  void *memory;
} steif_hamiltonian;
#define STEIF_NEAR 1e-6

/* tolerance: relative accuracy of the entries of A; 0: rounding, 10 n units of round-off.
 * P and K are left out where a Jordan structure of more than 20 eigenvalues stands in the way.
 * steif_hamiltonian_clear it. */
STEIF_EXPORT int steif_hamiltonian_find(steif_context *ctx, int n, const double *A,
                                        double tolerance, steif_hamiltonian *h);
STEIF_EXPORT void steif_hamiltonian_clear(steif_context *ctx, steif_hamiltonian *h);

/* Small systems with known answers, one after another; NULL past the end. */
typedef struct steif_hamiltonian_example {
  const char *name, *about;
  int n;
  const double *A; /* by columns */
  int definite, nonsingular, symplectic, invariant, dimension;
} steif_hamiltonian_example;
STEIF_EXPORT const steif_hamiltonian_example *steif_hamiltonian_example_at(size_t i);

#ifdef __cplusplus
}
#endif
#endif
