/* gmres.h: GMRES (Y. Saad & M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 1986) in real arithmetic, and in
 * complex arithmetic on pairs of real vectors.
 *
 * A pair (x_r, x_i) stands for x_r + i x_i, with the inner product of complex vectors
 *
 *   <u, v> = sum w^2 (u_r v_r + u_i v_i) + i sum w^2 (u_r v_i - u_i v_r),
 *
 * w weights. With real coefficients the same space would hold half as much: the spectrum of a real map on pairs
 * is that of the complex one and its mirror image.
 *
 * Classical Gram-Schmidt: all inner products of an iteration are of vectors known before, so that one sum over
 * the ranks serves them all, the norm of what remains coming from the theorem of Pythagoras. A second pass
 * is made where the basis may have lost more than half of the digits: eps / (product of what the
 * iterations have left of their vectors)^2 bounds the loss of orthogonality (L. Giraud, J. Langou,
 * M. Rozloznik & J. van den Eshof, Numer. Math. 101, 2005).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_GMRES_H
#define STF_GMRES_H

#include "agree.h"
#include "hessenberg.h"
#include "space.h"

typedef struct stf_pair {
  N_Vector re, im; /* im NULL: a real vector */
} stf_pair;

/* M x = b, with P near M. Both return 0, or what stops the solve; b and x are others than out. */
typedef struct stf_map {
  int (*product)(void *data, stf_pair x, stf_pair out);
  int (*precondition)(void *data, stf_pair r, stf_pair out); /* NULL: P = I */
  void *data;
  bool left;        /* minimise the norm of P^{-1} (b - M x), not that of b - M x */
  N_Vector squares; /* of the weights w of that norm; NULL: all 1 */
  stf_number
    start; /* x = start P^{-1} b is what is left of b where that is within the tolerance; 0: none */
  bool ahead; /* the first iteration is made before its need is known: one sum less */
  double tolerance, relative; /* of the norm, the larger: absolute, and to that at x = 0 */
} stf_map;

typedef struct stf_gmres {
  stf_space space;
  N_Vector *basis[2], weighed[2],
    work[2]; /* [1]: imaginary parts, NULL before stf_gmres_pairs */
  N_Vector *terms;
  double *factors, *sums;
  stf_hessenberg H;
  int dimension, restarts;
  stf_deferred *deferred;     /* failures that the sums carry along; NULL: none are deferred */
  const char *culprit;        /* the callback that failed so */
  double first, last;         /* norms of the residual of the last solve */
  long iterations, sums_made; /* since it was opened */
} stf_gmres;

enum { STF_GMRES_SOLVED = 0, STF_GMRES_SHORT = 1, STF_GMRES_NAN = 2, STF_GMRES_STOPPED = 3 };

/* A basis of dimension + 1 vectors like that one; and its imaginary parts. */
int stf_gmres_open(stf_pool *pool, N_Vector like, int dimension, int restarts, stf_gmres *g);
int stf_gmres_pairs(stf_pool *pool, stf_gmres *g);

/* x from 0: SOLVED; SHORT of the tolerance after all restarts; NAN, the norm at x = 0 is not finite; STOPPED by
 * what *answer returned. x is defined after SOLVED only. */
int stf_gmres_solve(stf_gmres *g, const stf_map *map, stf_pair b, stf_pair x, int *answer);

#endif
