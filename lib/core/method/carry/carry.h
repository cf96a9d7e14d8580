/* carry.h: S = dy/dp carried through the steps of y: the derivative of the numbers that a step computes, its
 * length, order and coefficients held.
 *
 * A step solves F(t_j, Y_j, Y_j') = 0 with Y_j = base_j + Z_j, Y_j' = offset_j + (1/h) sum_m B_jm Z_m.
 * Column k of S, all matrices at the stages as they have come out (E = F_y', A = -F_y):
 *   sum_m (B_jm/h E_j - delta_jm A_j) dZ_m = A_j dbase_j - E_j doffset_j - F_p,j.
 * It is solved by dZ <- dZ + M^{-1} (right side - left side), M what Newton's iteration has in factors: all
 * columns at once, until what is left is below Newton's tolerance for columns whose entries are weighted by
 * 1 / (rtol |S_ik| + atol_i / scale_k). Where that is slow, M is made anew at the last stage. Systems of few
 * unknowns are factored as they stand.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CARRY_H
#define STF_CARRY_H

#include "stage_polynomial.h"
#include "step_error.h"

enum { STF_CARRY_MISSES = 2 };

typedef struct stf_carry {
  stf_step *step;
  const stf_carrier *carrier;
  stf_carrier_size size;
  int count;                /* columns */
  const int *parameter;     /* of each, from 0 */
  const sunrealtype *scale; /* of each */
  N_Vector *S, *next, *before;
  N_Vector
    *from; /* BDF: where its steps begin; collocation: errors that are filtered once more */
  N_Vector *error, *weights; /* of each column */
  sunrealtype *tolerance;    /* of the norm of each error */
  N_Vector **kept, **trial;  /* what the method keeps of each column, and of the attempt */
  N_Vector **r, **other;     /* right-hand sides of the sweeps */
  N_Vector **slope;          /* dF/dp, by points and columns */
  N_Vector work, product, Y, Yp;
  N_Vector last, last_slope; /* the last stage */
  stf_matrices_at at;
  stf_slopes *slopes;
  sunrealtype relative; /* the largest error of a column, in tolerances */
  sunrealtype *K, *rhs; /* carry_direct.c; NULL: sweeps */
  int *pivot;
  int live, *column;  /* columns still swept, by their numbers ... */
  sunrealtype *moved; /* ... and the weighted norm of what the last sweep has moved of each */
  sunrealtype eta;    /* rate / (1 - rate) of the sweeps, when last seen; 0: not yet */
  int history;        /* steps committed since a restart, at most 1 + STF_CARRY_MISSES */
  sunrealtype h_before[STF_CARRY_MISSES]; /* lengths of the steps before the last */
  /* Collocation: stages less the polynomial ahead, of the last step, the one before, and the attempt. */
  N_Vector **missed[STF_CARRY_MISSES], **misses;
  int degree;        /* how many of them predictions take */
  sunrealtype noise; /* the largest of differences by p, in tolerances of a column */
  long sweeps;
  struct stf_slope_probe *probe; /* of derivatives of F, in the midst of the run; NULL: none */
} stf_carry;

/* Equations of m stages, at points first .. first + m - 1. */
typedef struct stf_carry_stages {
  int first, m;
  sunrealtype t, h;            /* for M, should it be made anew ... */
  N_Vector Y, Yp;              /* ... at t with these */
  const sunrealtype *B_over_h; /* m x m */
  N_Vector *base, *offset;     /* of each column, for all stages; NULL: zero */
  bool predicted;              /* dZ hold a start of the iteration, else 0 */
  int to;                      /* dZ are trial[k][to] .. trial[k][to + m - 1] */
} stf_carry_stages;

/* Columns that start from S, filled in by the caller. */
int stf_carry_open(stf_step *s, int count, const int *parameter, const sunrealtype *scale,
                   stf_carry *T);
/* Matrices and dF/dp at (t, y, yp). */
int stf_carry_point(stf_carry *T, int point, sunrealtype t, N_Vector y, N_Vector yp);
/* STEIF_RETRY where the sweeps do not converge. */
int stf_carry_solve(stf_carry *T, const stf_carry_stages *g);
/* r[j] = right side - left side at stage j, at the dZ of column k. */
int stf_carry_stage_residuals(stf_carry *T, const stf_carry_stages *g, int k, N_Vector *r);
/* carry_direct.c: the matrix of the stages itself, of few unknowns. STEIF_RETRY: it is singular. */
int stf_carry_direct_open(stf_carry *T);
int stf_carry_direct(stf_carry *T, const stf_carry_stages *g);
/* out = A S - E S' - F_p of column k at a point; S' NULL: 0. */
int stf_carry_residual(stf_carry *T, int point, int k, N_Vector S, N_Vector slope,
                       N_Vector out);

/* After an attempt that has succeeded: columns at its end in T->next, and T->relative. */
int stf_carry_carry(stf_carry *T, sunrealtype h);
/* After the commit of the method. */
void stf_carry_commit(stf_carry *T);

/* Errors of the steps of y add up to less than a tolerance. Errors of S add up in the same way, but those of one step
 * may be thirty times as large: of methods of order p so many times the estimate of order q. They stay far below
 * what others allow in one step, the whole tolerance. Of index 2 and 3, whose errors do not add up: 1. */
sunrealtype stf_carry_slack(const stf_step *s, int q, int p);
/* `allowed` of y, where errors are of the order of the method. */
sunrealtype stf_carry_allowed(const stf_step *s, sunrealtype allowed, int q, int p);

/* What collocation methods share (carry_collocation.c): a step as it has been solved. */
typedef struct stf_collocation_stages {
  const stf_stage_polynomial *u;
  stf_stage_polynomial *ahead; /* the same */
  const sunrealtype *B_over_h;
  const stf_estimate *estimate;
  bool oscillates;
  N_Vector *Z; /* stages relative to y */
  /* Each v := (lambda/h E - A)^{-1} v as in the estimate of y. */
  int (*filter)(stf_step *s, sunrealtype h, int count, N_Vector *v);
} stf_collocation_stages;
int stf_carry_collocation(stf_carry *T, sunrealtype h, const stf_collocation_stages *c);
/* carry_predict.c: the start of the sweeps in T->trial, false: none; and what it has missed, when they have ended. */
bool stf_carry_predict(stf_carry *T, sunrealtype h, const stf_collocation_stages *c);
void stf_carry_look_back(stf_carry *T, sunrealtype h, const stf_collocation_stages *c);

/* A step of BDF from t to y at t + h with coefficients alpha of past values y_n, y_{n-1}, ... of y, and of S in
 * T->kept; then T->next is the derivative. The sweeps begin at the sum of predict_j kept_j, j < count; NULL: at 0. */
enum { STF_CARRY_PAST = 8 };
int stf_carry_bdf(stf_carry *T, int point, sunrealtype t, sunrealtype h, int order,
                  const sunrealtype *alpha, N_Vector *past, N_Vector y, int count,
                  const sunrealtype *predict);
void stf_carry_bdf_commit(stf_carry *T);

#endif
