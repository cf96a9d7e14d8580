/* net.h: a problem on 5 x 5 points known by its products, its matrices, or both.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef NET_H
#define NET_H

#include "subjects.h"

enum { NET_SIDE = 5, NET_CELLS = NET_SIDE * NET_SIDE, NET_N = 2 * NET_CELLS };
enum net_call { NET_NONE, NET_AV, NET_ATV, NET_ETV, NET_SETUP, NET_SOLVE, NET_TURNED };

/* Brusselator with diffusion alpha and a stream that carries u, p = (A, B, alpha); walls u = 1, v = 3. */
struct net {
  struct subject s; /* first: the callbacks take it for their user */
  sunrealtype block[NET_CELLS][4];
  enum net_call stop; /* its call number `at`, counted from 1, returns `returned` */
  long at, calls;
  int returned;
};

/* .f, dFdp, Av and Atv; storage Krylov. */
void net_products(struct net *w);
/* P = c - J of one point at a time: precsetup, precsolve and precsolve_transposed. */
void net_precondition(struct net *w);
/* jac and a pattern, in place of Av and Atv; storage sparse. */
void net_matrices(struct net *w);
/* E = I + 0.3 of the next unknown to the right, in products or in matrices as the problem has; `grows`: times 1 + t/2. */
void net_mass(struct net *w, int grows);

#endif
