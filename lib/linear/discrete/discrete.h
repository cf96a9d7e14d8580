/* discrete.h: the room of discretisation inside: one discretisation under construction.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DISCRETE_H
#define STF_DISCRETE_H

#include "lapack.h"
#include "matfun.h"
#include <steif/discrete.h>

#define STF_PI 3.14159265358979323846

/* What a scheme fills in. The weights and Bd have room for n x m, Cd for p x n, Dd for p x m. */
typedef struct stf_plan {
  steif_context *ctx;
  const steif_state_space *s;
  const steif_spec *spec;
  const struct stf_rule *rule;
  double dt;
  double *Ad, *Bd, *Cd, *Dd, *B0, *Bm, *B1, *re, *im;
} stf_plan;

/* Of an exponential scheme: weights of (phi_0, phi_1, phi_2, 1) at u_k, u_{k+1/2}, u_{k+1}; of
 * the others alpha. */
typedef struct stf_rule {
  steif_scheme scheme;
  int (*build)(const stf_plan *p);
  double weight[3][4], alpha;
  bool shifted; /* the state of the form is h - B1 u */
  const char *key[2];
} stf_rule;

int stf_exponential_build(const stf_plan *p);
int stf_bilinear_build(const stf_plan *p);
int stf_matched_build(const stf_plan *p);

/* Sizes, NULL, NaN and infinity. */
int stf_state_space_check(steif_context *ctx, const steif_state_space *s);
/* C = alpha op(A) B + beta C; A is rows x inner, B inner x columns; nothing for empty ones. */
void stf_product(int rows, int columns, int inner, double alpha, const double *A,
                 const double *B, double beta, double *C);
/* Eigenvalues of A, which is kept. */
int stf_eigenvalues(steif_context *ctx, int n, const double *A, double *re, double *im);

/* Finite zeros of C (s - A)^{-1} B + D for one input and one output; *count of them, at most n. */
int stf_zeros(steif_context *ctx, const steif_state_space *s, int *count, double *re,
              double *im);

#endif
