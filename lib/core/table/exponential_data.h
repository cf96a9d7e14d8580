/* exponential_data.h: exponential Runge-Kutta and Rosenbrock methods as data.
 *
 * y' = L y + N(t, y) = f(t, y). With F = f(t_n, y_n), D_j = N(t_n + c_j h, Y_j) - N(t_n, y_n),
 *   Y_i     = y_n + c_i h phi_1(c_i hL) F + h sum w phi_k(nu hL) D_j,   i = 1 .. s-1,
 *   y_{n+1} = y_n +     h phi_1(    hL) F + h sum w phi_k(nu hL) D_j;
 * Y_0 = y_n, and the sums run over the terms of the stage. In this form only differences of N
 * meet the functions, and no e^{hL} is needed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EXPONENTIAL_H
#define STF_EXPONENTIAL_H

#include "base.h"

/* Limits: s, different c_i, and k. */
enum { STF_EXP_STAGES = 5, STF_EXP_NODES = 2, STF_EXP_ORDER = 4 };

/* w phi_k(node hL) D_of in stage `stage`; stage s + 1: of stage s, the error of the embedded
 * method. */
typedef struct stf_exp_term {
  int stage, k, node, of; /* node: place in the list of nodes */
  sunrealtype w;
} stf_exp_term;

typedef struct stf_exponential {
  const char *name, *about;
  int order, embedded; /* embedded: order, 0: none */
  int s;
  bool history; /* D_1 is extrapolated from the last step: h/h_old (N_n - N_{n-1}), c_1 = 1 */
  int at[STF_EXP_STAGES]; /* c_i = node[at_i], i > 0 */
  int nodes;
  sunrealtype node[STF_EXP_NODES]; /* the first is 1 */
  int count;
  const stf_exp_term *term;
} stf_exponential;

/* Runge-Kutta type, with a constant L. */
extern const stf_exponential stf_exponential_rk[];
extern const size_t stf_exponential_rk_count;
/* Rosenbrock type: L = df/dy(t_n, y_n). */
extern const stf_exponential stf_exponential_rb[];
extern const size_t stf_exponential_rb_count;

/* NULL where `name` is none of them. */
const stf_exponential *stf_exponential_find(const stf_exponential *list, size_t count,
                                            const char *name);

#endif
