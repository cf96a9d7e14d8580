/* variation.h: one step of a method on W' = J(t, y) W as a general linear method.
 *
 *   K_i = h J_i (sum_j U_ij X_j + sum_l C_il K_l),  X+ = V X + D K,  J_i at t_n + xi_i h,
 * t_n the time of the newest block of X. Runge-Kutta: k = 1, U = V = 1, C = A, D = b^T. BDF: the
 * last k values, the oldest first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_VARIATION_H
#define STF_VARIATION_H

#include "base.h"
#include <steif/lyapunov.h>
#include <steif/method.h>
#include <steif/solver.h>
#include <steif/table.h>

enum { STF_PAST = 6 };

typedef struct stf_formula {
  int k, r;
  bool lower, explicit_; /* C lower triangular; strictly */
  sunrealtype U[STEIF_STAGES * STF_PAST], V[STF_PAST * STF_PAST], D[STF_PAST * STEIF_STAGES];
  sunrealtype C[STEIF_STAGES * STEIF_STAGES], xi[STEIF_STAGES];
  sunrealtype ell[STF_PAST], weight[STEIF_STAGES]; /* ell V = ell, weight = ell D */
} stf_formula;

int stf_formula_find(steif_context *ctx, const char *method, stf_formula *formula);

/* Blocks are d x m by rows; X holds k of them. */
typedef struct stf_variation {
  steif_context *ctx;
  const steif_problem *problem;
  const char *method;
  stf_formula formula;
  int d, m;
  bool linear, filled;
  sunrealtype h, t, t0; /* t = t0 + count h */
  long count;
  sunrealtype *X, *next, *K, *base, *J, *matrix;
  SUNMatrix M;
  N_Vector y, fy, slope[3]; /* y: state of an explicit trajectory, else the start */
  N_Vector stage, *f;       /* explicit trajectories: f_i */
  steif_solver *solver;     /* implicit trajectories */
} stf_variation;

/* m columns. linear as in the options. Everything is owned by the pool. */
int stf_variation_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                       const char *method, sunrealtype h, sunrealtype t1, int m, int linear,
                       stf_variation *v);
/* X and t after one step. */
int stf_variation_step(stf_variation *v);
/* J and h J of linear problems depend on t alone: the matrix at t into block `at` of v->J. */
int stf_variation_matrix(stf_variation *v, int at, sunrealtype t, N_Vector y);
/* w = sum_j ell_j X_j, d x m. */
void stf_variation_principal(const stf_variation *v, sunrealtype *w);

/* Number of equal steps of at most h in [t0, t1]; refuses nonsense. */
int stf_equal_steps(steif_context *ctx, sunrealtype h, sunrealtype span, long *steps);

/* B := A^{-1} B by rows, A (n x n) and B (n x m) overwritten; false when a pivot is 0 or NaN. */
bool stf_eliminate(int n, int m, sunrealtype *A, sunrealtype *B);
/* W = Q R, R (m x m) with positive diagonal into R, W (d x m) destroyed; false when a diagonal
 * entry is 0 or not finite. */
bool stf_triangle(int d, int m, sunrealtype *W, sunrealtype *R);
/* X := X R^{-1}, X (rows x m). */
void stf_renormalise(int rows, int m, const sunrealtype *R, sunrealtype *X);

#endif
