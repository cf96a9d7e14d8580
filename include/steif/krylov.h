/* steif/krylov.h: systems solved by GMRES (storage STEIF_KRYLOV), what they cost and how they are solved.
 *
 * A step of an implicit method solves (s E - A) x = b for one or several shifts s. With a preconditioner P near
 * s E - A (precsetup, precsolve of problem.h) GMRES minimises the norm of P^{-1} (b - (s E - A) x) in the units of
 * the error test. What decides how often P is applied:
 *
 *   complex shifts      of Radau, Gauss and Lobatto methods: GMRES for complex vectors, kept as pairs (re, im),
 *                       with one real P near |s| E - A for both parts; then P^{-1} (s E - A) has its
 *                       spectrum on the chord from s / |s| to 1 where E^{-1} A has eigenvalues <= 0, and 2 or 3
 *                       iterations take nine tenths of the residual.
 *   forcing terms       a sweep of Newton's iteration takes nine tenths, or ends at half of Newton's tolerance;
 *                       the next sweep goes on from there (S. C. Eisenstat & H. F. Walker, SIAM J. Sci. Comput.
 *                       17, 1996). The last residual, which GMRES knows, is used once more.
 *   starts              linear problems too start from the extrapolated stages.
 *   setups              P is made again where s has left the range from half to twice its own, and for a new
 *                       Jacobian only once solves take twice the iterations, or have failed.
 *   reductions          all inner products of an iteration are made at once (classical Gram-Schmidt), and with the
 *                       norm of the right-hand side in the first: vectors over MPI make one sum over the
 *                       ranks for an iteration.
 *
 * Gradients go back with transposed products and preconditioners, .Etv, .Atv and .precsolve_transposed of the problem
 * (gradient.h).
 *
 * Newton's tolerance (options.newton) means the same as with factors, except that the default of bdf is ten
 * times as large: what GMRES leaves is as small as that.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_KRYLOV_H
#define STEIF_KRYLOV_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Since the solver was made. */
typedef struct steif_krylov_stats {
  long setups;                 /* preconditioners made */
  long applications;           /* vectors preconditioned: a pair is two */
  long products;               /* vectors multiplied by s E - A */
  long solves, complex_solves; /* right-hand sides; those of complex shifts among them */
  long iterations, complex_iterations; /* of GMRES */
  long
    reductions; /* sums over all ranks that steps and solves have made, or would with vectors that are spread;
                      not what callbacks make */
  long reserved[8];
} steif_krylov_stats;

/* Never NULL; zeros for baselines and where nothing is solved by GMRES. */
STEIF_EXPORT const steif_krylov_stats *steif_krylov_statistics(steif_solver *s);

#ifdef __cplusplus
}
#endif
#endif
