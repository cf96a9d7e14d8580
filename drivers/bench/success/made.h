/* made.h: random problems whose solution is known in closed form.
 *
 *   relaxation   y' = g' + A (y - g) + N(y) - N(g),  N_i = c_i y_i y_{i+1}; N = 0: linear
 *   algebraic    the same, the last rows without y' and g': index 1
 *   constrained  the same with + G (z - g_z), 0 = phi(y) - phi(g), phi' G != 0: index 2
 *   mechanical   q'' = g'' - K (q - g) - D (q' - g') + phi'(q)^T (z - g_z), 0 = phi(q) - phi(g): index 3
 *   flow         x' = D x in blocks of order 1 and 2, y_i = x_i + c_i x_{i+1}^2; c = 0: linear
 *
 * g are constants plus two waves. A has eigenvalues in the left half plane, from slow ones to stiff ones.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MADE_H
#define MADE_H

#include "random.h"
#include <steif/problem.h>

enum { MADE_MOST = 8, MADE_WAVES = 2 };
enum made_kind {
  MADE_LINEAR,
  MADE_RELAXATION,
  MADE_ALGEBRAIC,
  MADE_CONSTRAINED,
  MADE_MECHANICAL,
  MADE_FLOW,
  MADE_BENT,
  MADE_KINDS
};

typedef struct made {
  steif_problem problem;
  char name[32];
  enum made_kind kind;
  int n, differential; /* rows with y' */
  sunrealtype A[MADE_MOST][MADE_MOST], c[MADE_MOST], G[MADE_MOST], H[MADE_MOST], bend;
  sunrealtype mean[MADE_MOST], size[MADE_MOST][MADE_WAVES], rate[MADE_MOST][MADE_WAVES],
    phase[MADE_MOST][MADE_WAVES];
  sunrealtype start[MADE_MOST]; /* x(0) of a flow */
  int index[MADE_MOST];
} made;

/* Problem number `seed` of a kind; it points into itself. */
void made_new(made *m, enum made_kind kind, long seed);
const char *made_kind_name(enum made_kind kind);

/* A = -T diag(lambda) T^{-1} of order n; rates of 10^0 to 10^decades. */
void made_matrix(made *m, stf_random *r, int n, sunrealtype decades);
/* Flows. */
void made_flow(made *m, stf_random *r);

#endif
