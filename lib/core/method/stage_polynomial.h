/* stage_polynomial.h: the polynomial of degree s with y_n at 0 and slopes Y_i' = (1/h) sum_m B_im Z_m at c_i,
 *   u(t_n + x h) = y_n + sum_j w_j(x) Z_j,   w(x)^T = (int_0^x l_i)_i^T B,  B = A^{-1}.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_STAGE_POLYNOMIAL_H
#define STF_STAGE_POLYNOMIAL_H

#include "space.h"
#include "table.h"

typedef struct stf_stage_polynomial {
  const steif_table *table;
  int s;
  bool accurate;         /* the end is a stage */
  sunrealtype *w;        /* w_j(x) = sum_k w[j s + k - 1] x^k, k = 1 .. s */
  sunrealtype *end;      /* w(1) = b^T B */
  sunrealtype *slope;    /* c_1 > 0: weights in Z of h u', where F is looked at for the error */
  sunrealtype *P, ratio; /* the last P asked for, and its step ratio */
} stf_stage_polynomial;

int stf_stage_polynomial_open(stf_pool *pool, const steif_table *table, const sunrealtype *B,
                              stf_stage_polynomial *u);
/* w_j(x). */
sunrealtype stf_stage_polynomial_weight(const stf_stage_polynomial *u, int j, sunrealtype x);
/* out = from + sum_j w_j(x) Z_j. */
int stf_stage_polynomial_at(const stf_stage_polynomial *u, const stf_space *space,
                            sunrealtype x, N_Vector from, N_Vector *Z, N_Vector out);
/* P, s x s, with next Z = P Z for a step `ratio` times as long. */
const sunrealtype *stf_stage_polynomial_ahead(stf_stage_polynomial *u, sunrealtype ratio);

#endif
