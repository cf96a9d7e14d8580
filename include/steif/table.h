/* steif/table.h: coefficients of Runge-Kutta and general linear methods, given or built, and
 * what can be computed of them: nodes, order conditions, stability function, splits.
 *
 * A table holds A (s x s, by rows), b, c of the method
 *   Y_i = y_n + h sum_j a_ij Y_j',   y_{n+1} = y_n + h sum_j b_j Y_j',   Y_j at t_n + c_j h.
 * Tables of kind STEIF_GLM hold U, V, C, D, xi of glm.h instead. Entries of the shelf are
 * constant data; families with any number of stages build theirs.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_TABLE_H
#define STEIF_TABLE_H

#include <steif/base.h>
#include <steif/glm.h>

#ifdef __cplusplus
extern "C" {
#endif

enum steif_table_kind {
  STEIF_EXPLICIT,    /* strictly lower triangular A */
  STEIF_DIRK,        /* lower triangular A; a_11 = 0 allowed (explicit first stage) */
  STEIF_COLLOCATION, /* full A */
  STEIF_GLM          /* general linear: .general, no A and b */
};

enum steif_claim {
  STEIF_A_STABLE = 1,
  STEIF_L_STABLE = 2,         /* A-stable and R(inf) = 0 */
  STEIF_STIFFLY_ACCURATE = 4, /* b is the last row of A, c_s = 1 */
  STEIF_SYMPLECTIC = 8,       /* b_i a_ij + b_j a_ji = b_i b_j */
  STEIF_SYMMETRIC = 16        /* its own adjoint */
};

typedef struct steif_table steif_table;
struct steif_table {
  const char *name;  /* "radau", set by the look-up */
  const char *about; /* one sentence and a citation */
  enum steif_table_kind kind;
  int s, order;             /* stages, classical order */
  int stage_order;          /* q of C(q); 0: not claimed */
  const sunrealtype *A, *b; /* NULL when built */
  const sunrealtype *A_low; /* A + A_low has more digits than A; NULL: A is exact */
  const sunrealtype *c;     /* NULL: row sums of A */
  const sunrealtype *bhat;  /* embedded weights, NULL if none */
  int order_hat;            /* order of the embedded method */
  unsigned claims;          /* enum steif_claim */
  /* Families: read the parameters; fill A (room for 2 STEIF_STAGES^2: the table, then its low
   * parts), b and c (room for STEIF_STAGES), and set s, order, stage_order, A, A_low, b, c and
   * what else depends on s. */
  int (*build)(steif_context *ctx, const steif_spec *spec, steif_table *self, sunrealtype *A,
               sunrealtype *b, sunrealtype *c);
  /* STEIF_GLM: name, k, r, U, V, C, D, xi (and order with W), completed by the look-up ... */
  const steif_glm *general;
  /* ... or filled in from the parameters, with the claims. */
  int (*fill)(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm);
};

/* Table i of the shelf (families unbuilt), NULL past the end. */
STEIF_EXPORT const steif_table *steif_table_at(size_t i);

/* A complete table from a spec: "gauss:s=3", "alexander2". NULL with the message set; free it.
 * */
STEIF_EXPORT steif_table *steif_table_new(steif_context *ctx, const char *spec);
STEIF_EXPORT void steif_table_free(steif_context *ctx, steif_table **table);

/* Largest violation of the order conditions of order p (all rooted trees with p vertices),
 * p = 1 .. 8; with `hat`, of the embedded weights. */
STEIF_EXPORT int steif_table_defect(steif_context *ctx, const steif_table *table, int p,
                                    int hat, sunrealtype *defect);

/* R(z) = 1 + z b^T (I - z A)^{-1} 1, and R(inf) for z = infinity (either part infinite). */
STEIF_EXPORT int steif_table_stability(steif_context *ctx, const steif_table *table,
                                       const sunrealtype z[2], sunrealtype R[2]);

#ifdef __cplusplus
}
#endif
#endif
