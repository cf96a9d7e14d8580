/* stage_chain.h: stages one after another, the loop of diagonally implicit Runge-Kutta and general
 * linear methods.
 *
 *   Y_i = sum_j u_ij x_j + h sum_{l<i} a_il K_l + h a_ii K_i,   F(t_n + c_i h, Y_i, K_i) = 0.
 * The entries a_ii are gamma, one real shift 1/(gamma h), or 0: then K_i = f(t_n + c_i h, Y_i).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CHAIN_H
#define STF_CHAIN_H

#include "method.h"

typedef struct stf_chain {
  int s, k;
  const sunrealtype *A, *c, *U; /* s x s, s, s x k by rows; U NULL: k = 1, u = 1 */
  sunrealtype gamma;            /* 0: all stages are explicit */
  N_Vector *K, *X;              /* slopes and stage values of the attempt */
  N_Vector base, offset, Z, other;
  N_Vector guess; /* slope to begin the first stage from; NULL: zero */
} stf_chain;

/* gamma and vectors, and Newton's iteration where gamma > 0. `name` for sentences. */
int stf_chain_open(stf_step *s, const char *name, stf_chain *chain);
/* Stages first .. s - 1 of a step of length h from the vectors x; K and X before `first` are
 * there. */
int stf_chain_run(stf_step *s, stf_chain *chain, int first, N_Vector *x, sunrealtype h);
/* s->error := (E/(gamma h) - A)^{-1} E base with the factors of the stages: an estimate,
 * divided by gamma h in `base`, without what stiff components put into it. Explicit chains:
 * s->error := base. */
int stf_chain_filter(stf_step *s, stf_chain *chain);

#endif
