/* general.h: what is shared inside by the parts that make and use general linear methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_GENERAL_H
#define STF_GENERAL_H

#include "table.h"

#define STF_GLM_TOLERANCE                                                                      \
  1e-9 /* of conditions on coefficients, which may be given in decimals */

/* X (n x count) of smallest norm among the minimisers of |M X - B|, M (m x n) and B (m x
 * count), all by rows; *residual is the largest entry of M X - B. m, n <= STF_LEAST. */
enum { STF_LEAST = 2 * STEIF_PAST + STEIF_STAGES };
int stf_least_squares(steif_context *ctx, int m, int n, int count, const sunrealtype *M,
                      const sunrealtype *B, sunrealtype *X, sunrealtype *residual);

/* Right sides of (I - V) W_j = step and U W_j = stage for column j of W, `W` the columns before
 * it (by columns of k). */
void stf_glm_step_side(const steif_glm *g, int j, const sunrealtype *W, sunrealtype *step);
void stf_glm_stage_side(const steif_glm *g, int j, sunrealtype *stage);

/* Where an explicit, diagonally implicit or full C is all that matters. */
enum steif_table_kind stf_glm_shape(const steif_glm *glm);

/* The formulas for X = (y, h y', .., h^p y^(p)) that give order and stage order p to any C, D
 * and xi (r stages): U = Y - C Y K, V = exp(K) - D Y K, Y_ij = xi_i^j / j!, K the shift. W. M.
 * Wright, thesis, Auckland 2002. */
void stf_glm_nordsieck(steif_glm *glm, int p);

/* Weights d of (X_{n+1}; h F; X_n), 2k + r, with which they give sum_j target_j h^j
 * y^(j)(t_{n+1}), j = 0 .. order; `beyond`: the same to j = order + 1, as many equal steps
 * leave X, for estimates of `error`. *found is false when there are none. */
int stf_glm_combination(steif_context *ctx, const steif_glm *glm, const sunrealtype *target,
                        bool beyond, sunrealtype *d, bool *found);

/* Does X <- W z, the history for another step, damp stiff components, rho < 1, where steps do, that
 * is where rho(M(inf)) < 1? */
int stf_glm_rescales(steif_context *ctx, const steif_glm *glm, bool *damps);

/* The weights of the solution itself, with a sentence when there are none. */
int stf_glm_solution(steif_context *ctx, const steif_glm *glm, sunrealtype *d);

/* The highest power j of h whose column in W is not 0: X needs so many further values to begin
 * with. */
int stf_glm_powers(const steif_glm *glm);
/* X_0 from y(t_0 + i h / count), i = 0 .. count: weights k x (count + 1), stf_glm_powers <= count
 * <= order. */
void stf_glm_first(const steif_glm *glm, int count, sunrealtype *weights);

/* The DIMSIM of order and stage order p, p stages at i / (p - 1), U = 1, V = 1 v^T: W and D from
 * lambda, the diagonal of C, and x, the rows of C below it and v_1 .. v_{p-1}; the v_i sum to 1.
 * p <= 8. */
void stf_glm_dimsim(steif_glm *glm, int p, long double lambda, const long double *x);

/* Adams-Bashforth or Adams-Moulton of order p, X = (y_n, h f_n, h f_{n-1}, ..), with W. */
void stf_glm_adams(steif_glm *glm, int p, bool implicit);

#endif
