/* phi_step.h: w = sum_k phi_k(nu h L) b_k for the A = L of a system's pencil and given nodes nu: by
 * the matrices phi_k, kept while h and L stay, or by their action on vectors, matrix-free.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PHIS_H
#define STF_PHIS_H

#include "action.h"
#include "problem.h"

typedef struct stf_phis {
  stf_system *system;
  int p, nodes;
  const sunrealtype *node;
  steif_action *action; /* NULL: by matrices */
  int n;
  sunrealtype h;      /* of the matrices, 0: none */
  double *L, *scaled; /* n x n, by columns */
  double **phi;       /* of each node p + 1 matrices */
  void *core;
  N_Vector unit, image;
  long factors; /* evaluations of phi_0 .. phi_p */
} stf_phis;

/* Functions up to phi_p at `nodes` nodes. `steady`: L and h stay, so that matrices of some size
 * pay. */
int stf_phis_open(stf_pool *pool, stf_system *system, int p, int nodes, const sunrealtype *node,
                  bool steady, stf_phis *f);
/* The pencil has another A. */
int stf_phis_renew(stf_phis *f);
/* Errors of w, in the 2-norm, up to relative ||w|| + absolute are allowed. */
void stf_phis_aim(stf_phis *f, sunrealtype relative, sunrealtype absolute);
/* b_0 is not looked at; b_k NULL counts as zero. */
int stf_phis_apply(stf_phis *f, sunrealtype h, int node, N_Vector *b, N_Vector w);

/* L and the matrices, or for the action what is known of L. */
void stf_phis_keep(stf_phis *f, stf_image *m);

#endif
