/* variation.h: one step of a method on E W' = J(t, y) W as a general linear method (glm.h).
 *
 *   E K_i = h J_i (sum_j U_ij X_j + sum_l C_il K_l),  X+ = V X + D K,  J_i at t_n + xi_i h,
 * t_n the time of the newest block of X. E is the identity, or constant of a DAE of index 1.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_VARIATION_H
#define STF_VARIATION_H

#include "base.h"
#include "general.h"
#include "integrator.h"
#include "jacobian.h"
#include <steif/lyapunov.h>
#include <steif/method.h>
#include <steif/solver.h>

/* Room for dense systems of order n and blocks of d x m, which LAPACK is given. */
typedef struct stf_algebra {
  int *pivot, length; /* of work */
  sunrealtype *work;
  const struct stf_rows *rows;
} stf_algebra;
int stf_algebra_open(stf_pool *pool, int n, int d, int m, stf_algebra *room);

/* The systems of stages, E - h c J or all of them at once: a dense matrix by rows, or the pencil of
 * the sparse diag(E) and of the blocks c_il J_i at the shift 1/h. */
typedef struct stf_stage_system {
  int order;
  sunrealtype c;       /* of the stage whose factors are kept; NaN: none */
  sunrealtype *matrix; /* NULL: sparse */
  SUNMatrix E, S;
  struct steif_pencil *pencil;
  N_Vector *column; /* STF_AT_ONCE right-hand sides, neighbours in memory */
} stf_stage_system;

/* Largest order of a dense J and of E, most columns. */
enum { STF_DENSE_MOST = 1000 };

/* Blocks are d x m by rows; X holds k of them. */
typedef struct stf_variation {
  steif_context *ctx;
  const steif_problem *problem;
  const char *method;
  steif_glm *g;
  enum steif_table_kind shape;
  sunrealtype weight[STEIF_STAGES]; /* ell D */
  sunrealtype finish[STF_LEAST];    /* the solution in (X+; K; X) */
  int d, m;
  int finite,
    index; /* degrees of freedom of a DAE: the rank of E at index 1; n of an ode, index 0 */
  bool linear, filled;
  sunrealtype h, t, t0; /* t = t0 + count h */
  long count;
  sunrealtype *X, *next, *K, *base;
  SUNMatrix *J; /* of the stages, two at least */
  SUNMatrix E;  /* NULL: the identity */
  stf_stage_system system;
  stf_algebra algebra;
  N_Vector y, fy, slope[3]; /* y: state of an explicit trajectory, else the start */
  N_Vector stage, *f;       /* explicit trajectories: f_i */
  N_Vector yp;              /* 0: an affine F has the same matrices everywhere in y' */
  steif_solver *solver;     /* implicit trajectories */
  const volatile int *stop; /* set by who opened it; nonzero: no step, STEIF_STOPPED */
} stf_variation;

/* m columns; 0: as many as degrees of freedom. linear as in the options. Everything is owned by the pool. */
int stf_variation_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                       const char *method, sunrealtype h, sunrealtype t1, int m, int linear,
                       stf_variation *v);
/* A problem of descriptor form as one with a mass matrix, owned by the pool. */
int stf_mass_form(stf_pool *pool, steif_context *ctx, const steif_problem *of,
                  const steif_problem **form);
/* X becomes u times n x m random numbers, whose columns do not depend on m. */
void stf_variation_scatter(stf_variation *v);
/* X and t after one step. */
int stf_variation_step(stf_variation *v);
/* J at (t, y) into v->J[at]; fy = f(t, y) where it is known already, else NULL. */
int stf_variation_matrix(stf_variation *v, int at, sunrealtype t, N_Vector y, N_Vector fy);
/* E at the start, and its rank. */
int stf_variation_leading(stf_variation *v);
/* stage_system.c: K := (E - h c J)^{-1} K of stage i, or of all at once where C is full. */
int stf_stage_system_open(stf_pool *pool, stf_variation *v);
int stf_stage_system_solve(stf_variation *v, int i);
/* w = sum_j ell_j X_j, d x m. */
void stf_variation_principal(const stf_variation *v, sunrealtype *w);
/* The solution at t after a step, d x m. */
void stf_variation_solution(const stf_variation *v, sunrealtype *x);
/* x (d x m) at t, carried over h by `count` steps of a Runge-Kutta method. */
int stf_variation_carry(stf_variation *v, sunrealtype t, sunrealtype h, int count,
                        sunrealtype *x);
/* y where the trajectory of a nonlinear problem is. */
N_Vector stf_variation_state(const stf_variation *v);
/* The map over `steps` steps of a linear problem, d x d by rows in the principal coordinate, after
 * as many as take the parasitic modes below rounding. */
int stf_period_map(stf_pool *pool, steif_context *ctx, const steif_problem *problem,
                   const char *method, sunrealtype h, long steps, sunrealtype *Phi);
/* Steps that take the parasitic modes below rounding. */
long stf_burn_in(const steif_glm *g);
/* |J| of the last step by row sums, and the steps of Gauss's method of order 12 over h in which
 * h |J| is below 1/2, as long as 64 do: its error is then that of rounding. */
sunrealtype stf_variation_size(const stf_variation *v);
int stf_variation_substeps(const stf_variation *v, sunrealtype h);

/* mean_trace.c: (1/(t1 - t0)) int trace J dt of an ode, along the solution where J depends on y. error: how far
 * two quadratures are apart. known = false: they disagree, or cost too much. */
typedef struct stf_mean_trace {
  sunrealtype value, error;
  bool known;
} stf_mean_trace;
int stf_mean_trace_find(steif_context *ctx, const steif_problem *problem, sunrealtype t0,
                        sunrealtype t1, bool linear, const volatile int *stop,
                        stf_mean_trace *trace);

/* LU of A (n x n by rows) in place, rows exchanged; false when a pivot is 0 or NaN. B := A^{-1} B by
 * rows, n x m. */
bool stf_factor(int n, sunrealtype *A, const stf_algebra *room);
void stf_substitute(int n, int m, const sunrealtype *A, sunrealtype *B,
                    const stf_algebra *room);
/* W = Q R: the upper triangle of R (m x m) with positive diagonal, W d x m; `spare` has its size and
 * may be W, which is lost then. False when a diagonal entry is 0 or not finite. */
bool stf_triangle(int d, int m, const sunrealtype *W, sunrealtype *spare, sunrealtype *R,
                  const stf_algebra *room);
/* X := X R^{-1}, X (rows x m). */
void stf_renormalise(int rows, int m, const sunrealtype *R, sunrealtype *X,
                     const stf_algebra *room);

#endif
