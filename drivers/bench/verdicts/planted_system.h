/* planted_system.h: random systems E x' + F x = f whose distributional solution is known by other means:
 *   E = S diag(I, N) T,  F = S diag(-J, I) T,  f = S f^
 * with S and T products of elementary matrices of small whole numbers, so that E, F and the inverses are
 * exact, N made of Jordan blocks and J of real and complex eigenvalues. In z = T x
 *   w' = J w,  N v' + v = f^:  w = exp(J t) w(0),  v = sum_i (-1)^i N^i f^^(i) + sum_i c_i delta^(i).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PLANTED_SYSTEM_H
#define PLANTED_SYSTEM_H

#include "pairing.h"
#include "random.h"
#include <steif/weak.h>

enum { SYSTEM_MOST = 10, SYSTEM_DEGREE = 3 };
enum system_forcing { SYSTEM_FREE, SYSTEM_POLYNOMIAL, SYSTEM_COSINE };

typedef struct planted_system {
  stf_random random;
  int n, finite, index;
  bool last[SYSTEM_MOST]; /* of its Jordan block, or not in one */
  sunrealtype rate,
    turning; /* eigenvalues: -rate where finite = 1, rate +- i turning where 2 */
  sunrealtype S[SYSTEM_MOST][SYSTEM_MOST], T[SYSTEM_MOST][SYSTEM_MOST],
    back[SYSTEM_MOST][SYSTEM_MOST]; /* T^{-1} */
  enum system_forcing forcing;
  sunrealtype f[SYSTEM_MOST]
               [SYSTEM_DEGREE + 1]; /* polynomials of f^; cosines: f[i][0] cos(t + i) */
  sunrealtype z0[SYSTEM_MOST], away[SYSTEM_MOST]; /* away: of v(0-) from the smooth part */
  sunrealtype x0[SYSTEM_MOST];
  steif_linear linear, plain; /* in x, and in z; matrices are freed by the next */
} planted_system;

/* System number `seed`. */
int planted_system_new(steif_context *ctx, long seed, planted_system *s);
void planted_system_free(planted_system *s);
/* For systems put together otherwise: the matrices, and a consistent start of v. */
int planted_system_matrices(steif_context *ctx, planted_system *s);
void planted_system_settle(planted_system *s);
/* <z_m, g> of the solution, by quadrature in long double, and c_i (index - 1 rows of n) in x. */
int planted_system_exact(planted_system *s, const stf_weight *g, long double *z,
                         long double *c);
/* x_m of z. */
long double planted_system_component(const planted_system *s, int m, const long double *z);

#endif
