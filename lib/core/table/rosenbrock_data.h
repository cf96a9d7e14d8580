/* rosenbrock_data.h: Rosenbrock methods as data.
 *
 *   (M/(gamma h) - J) u_i = f(t + alpha_i h, Y_i) + M sum_{j<i} (c_ij/h) u_j + gamma_i h f_t,
 *   Y_i = y_n + sum_{j<i} a_ij u_j for i <= rows,  Y_i = Y_{i-1} + u_{i-1} beyond,
 *   y_{n+1} = Y_s + u_s,  error estimate u_s,
 *   y(t_n + x h) = (1 - x) y_n + x y_{n+1} + x (1 - x) sum (d_i + x d_{s+i}) u_i.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RODAS_H
#define STF_RODAS_H

#include "base.h"

enum { STF_RODAS_STAGES = 8 };

typedef struct stf_rodas {
  const char *name, *about;
  int s, rows, order;
  sunrealtype g;                    /* gamma */
  const sunrealtype *alpha, *gamma; /* s */
  const sunrealtype *a, *c;         /* strict lower triangles by rows, of `rows` and s stages */
  const sunrealtype *d;             /* 2 s: inside the step, order 3 */
} stf_rodas;
extern const stf_rodas stf_rodas_tables[];
extern const size_t stf_rodas_count;
/* NULL: there is none of that name. */
const stf_rodas *stf_rodas_find(const char *name);

#endif
