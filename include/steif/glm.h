/* steif/glm.h: general linear methods, and every table and linear multistep formula as one.
 *
 * A step of a method with k external values X and r internal stages G, in the notation of
 * Steyer and Van Vleck (arXiv 1709.02059):
 *   G_i = sum_j U_ij X_j + h sum_l C_il F_l,   F_l = f(t_n + xi_l h, G_l),
 *   X_j <- sum_m V_jm X_m + h sum_l D_jl F_l.
 * Burrage and Butcher write A, U, B, V and c for C, U, D, V and xi. t_n is the time of the
 * newest value in X. On y' = lambda y a step is M(z) = V + z D (I - z C)^{-1} U, z = h lambda.
 *
 * X stands for W (y, h y', .., h^p y^(p)): the method has order p and stage order q >= p when
 *   C e^{xi z} z + U W Z = e^{xi z},   D e^{xi z} z + V W Z = W Z e^z,   Z = (1, z, .., z^p)^T,
 * up to O(z^{p+1}), and order q + 1 when the second holds one power further (J. C. Butcher:
 * Numerical Methods for Ordinary Differential Equations, 2016, 53; Z. Jackiewicz: General
 * Linear Methods, 2009). W is unique; its first column u is the preconsistency vector: V u = u,
 * U u = 1. The method is strictly stable when 1 is a simple eigenvalue of V and the others lie
 * within the circle. Then ell V = ell, ell u = 1 defines the coordinate w = sum_j ell_j X_j
 * that the parasitic modes leave alone.
 *
 *   steif_glm *g = steif_glm_new(ctx, "bdf:p=3");       any method with a recurrence
 *   g->second is 0.4264, the modulus of the parasitic roots;  steif_glm_free(ctx, &g);
 *
 * A tableau in a text file is the table file=PATH (glm:file=PATH as a method): a name, the
 * matrices row by row, numbers or quotients, # begins a comment:
 *     name my22          # optional; else the path
 *     xi   1/2 1
 *     C    1/2 0
 *          1/2 1/2
 *     U    1 0 -1/8
 *          1 0 -1/4
 *     D    1/2 1/2
 *          0 1
 *          -2 2
 *     V    1 0 -1/4
 *          0 0 0
 *          0 0 0
 * A, B and c may be written for C, D and xi; without U and V it is a Runge-Kutta method; rows
 * alpha and beta (oldest first) alone give the multistep formula sum alpha_j x_j = h sum beta_j
 * f_j.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_GLM_H
#define STEIF_GLM_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Largest numbers of stages and of external values; one enum, for C++20 multiplies no two. */
enum { STEIF_STAGES = 32, STEIF_PAST = 16 };

/* Matrices by rows without gaps. */
typedef struct steif_glm {
  char name[STEIF_SPEC_VALUE];
  int k, r; /* external values, stages */
  int order, stage_order;
  sunrealtype U[STEIF_STAGES * STEIF_PAST], V[STEIF_PAST * STEIF_PAST];     /* r x k, k x k */
  sunrealtype C[STEIF_STAGES * STEIF_STAGES], D[STEIF_PAST * STEIF_STAGES]; /* r x r, k x r */
  sunrealtype xi[STEIF_STAGES];
  sunrealtype W[STEIF_PAST * (STEIF_PAST + 1)]; /* k x (order + 1) */
  sunrealtype ell[STEIF_PAST];
  sunrealtype second; /* largest modulus of the other eigenvalues of V */
  /* X runs ahead of the exact solution by error h^{p+1} y^{(p+1)} u in a step, and lies off
   * W (y, h y', ..) by shift h^{p+1} y^{(p+1)} after many steps of constant size; 0 where
   * stage_order < order. */
  sunrealtype error, shift[STEIF_PAST];
} steif_glm;

struct steif_table;

/* The step of a method: "radau:s=3", "dirk:hw43", "bdf:p=4", "glm:nord22", "glm:file=PATH".
 * STEIF_UNSUPPORTED where it is no such recurrence (splitting, Rosenbrock, baselines). */
STEIF_EXPORT steif_glm *steif_glm_new(steif_context *ctx, const char *method);
STEIF_EXPORT void steif_glm_free(steif_context *ctx, steif_glm **glm);

/* Of any table: Runge-Kutta tables are k = 1, U = V = 1, C = A, D = b^T, xi = c. */
STEIF_EXPORT int steif_table_glm(steif_context *ctx, const struct steif_table *table,
                                 steif_glm *glm);

/* sum_{j=0}^steps alpha_j x_{n+j} = h sum_j beta_j f_{n+j}: X holds x and, where needed, h f of
 * the last `steps` times, oldest first. */
STEIF_EXPORT int steif_glm_multistep(steif_context *ctx, const char *name, int steps,
                                     const sunrealtype *alpha, const sunrealtype *beta,
                                     steif_glm *glm);

/* From name, k, r, U, V, C, D and xi: W, ell, orders, error and the rest. With order > 0 on
 * entry W is given and checked. STEIF_BAD_INPUT names a method that is inconsistent or not
 * strictly stable. */
STEIF_EXPORT int steif_glm_complete(steif_context *ctx, steif_glm *glm);

/* M(z), k x k pairs (re, im) by rows; z infinite gives the limit. */
STEIF_EXPORT int steif_glm_propagator(steif_context *ctx, const steif_glm *glm,
                                      const sunrealtype z[2], sunrealtype *M);

#ifdef __cplusplus
}
#endif
#endif
