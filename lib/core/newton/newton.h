/* newton.h: simplified Newton for the stage equations of every implicit family.
 *
 * Unknown are s increments Z_j with
 *   F(t + c_j h, base_j + Z_j, offset_j + (1/h) sum_m B_jm Z_m) = 0,   j = 1 .. s.
 * Collocation: B = A^{-1}, base_j = y_n, offset 0. A stage of DIRK: s = 1, B = 1/gamma. BDF: s = 1,
 * B = alpha_0, offset = the history's share of y'. B is transformed into real and complex shifts
 * of the pencil: one with eigenvalue lambda solves (lambda/h E - A) d omega = -(Tinv F).
 *
 * Convergence (Hairer and Wanner, Solving ODEs II, IV.8): theta_m = ||dZ^m|| / ||dZ^(m-1)||,
 * eta = theta/(1 - theta), stop when eta ||dZ|| <= the tolerance. A first correction is judged by the eta of
 * the first two corrections of the last solve, or of its last two if larger, as many times larger as the
 * correction is: where F couples y in one direction later corrections vanish, and say nothing of the first.
 * theta >= 1 or too many iterations: the stage is refused; with an old Jacobian it is tried again with a new
 * one first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NEWTON_H
#define STF_NEWTON_H

#include "problem.h"
#include "table.h"

typedef struct stf_newton {
  stf_system *system;
  stf_transform transform;
  sunrealtype single;     /* B of stf_newton_single */
  int iterations;         /* most in one solve */
  sunrealtype tolerance;  /* on the weighted norm of the error of Z */
  sunrealtype rounding;   /* corrections below this may be rounding: accepted when they stall */
  sunrealtype stale_rate; /* a rate above this asks for a new Jacobian next time */
  N_Vector weights;       /* reciprocal weights; the caller keeps them current */
  N_Vector *residual, *omega, *dZ, *Zp, Y; /* s, s, s, s, 1 vectors */
  N_Vector zero;
  sunrealtype *B_over_h, *minus_T; /* B / h, -T */
  sunrealtype gamma;      /* > 0: blended iteration (blended.h) with shift 1/(gamma h) */
  sunrealtype *B_part[2]; /* of stf_parts, instead of B_over_h; NULL: not wanted */
  const sunrealtype *A;   /* of the table, and scratch: blended iteration only */
  sunrealtype *mix;
  sunrealtype
    shift_ratio_most;       /* > 1: factors serve shifts within this ratio (one real shift) */
  bool renew_with_factors;  /* a new factorisation takes a new Jacobian along */
  sunrealtype shift, relax; /* the first one in the factors; factor of the corrections */
  sunrealtype h;            /* of B_over_h */
  bool factored, jacobian_new; /* factors exist for (h, E, A); Jacobian made in this step */
  bool jacobian_wanted;        /* a new Jacobian is wanted */
  sunrealtype theta, eta;      /* of the last solve */
  sunrealtype eta_of;          /* correction that eta was seen at */
  sunrealtype eta_least;       /* floor of the eta that a first correction is judged by */
  int count;                   /* iterations of the last solve */
  long sweeps, fails;          /* iterations, refusals */
} stf_newton;

/* Where the stages are. */
typedef struct stf_stages {
  sunrealtype t, h;
  const sunrealtype *c; /* s */
  N_Vector *base;       /* s vectors (the same one repeated is fine); NULL: zero */
  N_Vector *offset;     /* s vectors; NULL: zero */
  N_Vector *Z;          /* in: start of the iteration; out: solution */
  bool predicted; /* Z is a start of linear systems too, for GMRES; else these start from 0 */
} stf_stages;

int stf_newton_open(stf_pool *pool, stf_system *system, const stf_transform *transform,
                    N_Vector weights, stf_newton *newton);

/* After open: one real shift for all stages, by the blended iteration, in place of those of B. */
int stf_newton_blend(stf_pool *pool, const steif_table *table, stf_newton *newton);

/* One shift, for the 1 x 1 matrix b. */
int stf_transform_single(stf_pool *pool, sunrealtype b, stf_transform *transform);

/* Another b in its place: the next prepare factors anew. */
void stf_newton_single(stf_newton *newton, sunrealtype b);

/* Factors for step h with the pencil as it is; `jacobian` first renews E and A at (t, y, yp). */
int stf_newton_prepare(stf_newton *newton, sunrealtype t, sunrealtype h, N_Vector y,
                       N_Vector yp, bool jacobian);

/* Solve; STEIF_RETRY when refused. */
int stf_newton_solve(stf_newton *newton, const stf_stages *stages);

/* The same with a new Jacobian in every iteration, made at the last stage: for steps that must not
 * be made smaller. */
int stf_newton_full(stf_newton *newton, const stf_stages *stages);

/* After either: sweeps until the corrections no longer shrink, so that what is left is the rounding of
 * the residuals and not that of the factors, which is the same in every step. */
int stf_newton_polish(stf_newton *newton, const stf_stages *stages);

/* dZ = M^{-1} residual, M the matrix that the iteration has in place of that of the stages. */
int stf_newton_correct(stf_newton *newton);
/* r_k := M^{-1} r_k for `count` columns of s vectors at once; `other` is lost. */
int stf_newton_apply(stf_newton *newton, int count, N_Vector *const *r, N_Vector *const *other);

/* Convergence was slow or refused: the next prepare should renew the Jacobian. */
bool stf_newton_stale(const stf_newton *newton);

/* Rates, ages and wishes; the system is kept by itself. */
void stf_newton_keep(stf_newton *newton, stf_image *m);

#endif
