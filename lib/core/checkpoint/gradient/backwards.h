/* backwards.h: a run gone through backwards: records of its steps, their transposes, and the schedule by
 * which steps are made again.
 *
 * A record is a row of doubles: head, then Y_j and Y'_j of each point, then the error estimate.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BACKWARDS_H
#define STF_BACKWARDS_H

#include "integrator.h"
#include "stage_polynomial.h"
#include <steif/gradient.h>

enum { STF_PAST = 7, STF_HEAD = 12 };

/* What is logged of every step. */
typedef struct stf_logged {
  sunrealtype t, h;
  unsigned long long hash; /* of y at the end */
} stf_logged;

typedef struct stf_head {
  sunrealtype t, h;
  int order, halved;
  sunrealtype alpha[STF_PAST];
} stf_head;

/* K^T w = r at m points of a step. */
typedef struct stf_adjoint {
  steif_context *ctx;
  stf_pool *pool;
  const stf_space *space;
  stf_transform transform; /* m > 1 */
  sunrealtype *in, *out;   /* T^T and T^{-T} */
  int m, middle;           /* middle: the point whose matrices are factored */
  sunindextype n;
  stf_matrices_at at;
  sunrealtype B[STEIF_STAGES * STEIF_STAGES], h; /* B/h in use */
  steif_pencil *pencil;
  double *side,
    *K; /* dense, of small systems or where sweeps do not converge; NULL: none yet */
  int *pivot;
  bool direct;
  N_Vector *residual, *omega, product, total;
  long solves, factors;
} stf_adjoint;
int stf_adjoint_open(stf_pool *pool, stf_system *system, int m, const steif_table *table,
                     stf_adjoint *a);
/* Factors after the matrices at the points are filled: B/h of the method, m x m by rows. */
int stf_adjoint_factor(stf_adjoint *a, sunrealtype t, sunrealtype h, const sunrealtype *B);
int stf_adjoint_solve(stf_adjoint *a, N_Vector *r, N_Vector *w);
/* out += c M^T x, which 'E' or 'A' at a point. */
void stf_adjoint_add(const stf_adjoint *a, int point, char which, sunrealtype c, N_Vector x,
                     N_Vector out);
/* matrix_columns.c: out += c M^T x; entries of c M added to a dense matrix, ld apart. M NULL: identity. */
void stf_add_transposed(SUNMatrix M, sunindextype n, sunrealtype c, const sunrealtype *x,
                        sunrealtype *out);
void stf_add_dense(SUNMatrix M, sunindextype n, sunrealtype c, double *to, sunindextype ld);

typedef struct stf_backwards {
  steif_context *ctx;
  const steif_problem *problem;
  const steif_functional *functional;
  stf_pool *pool;
  steif_solver *home; /* its system of equations gives matrices */
  stf_space space;
  sunindextype n;
  int count, P; /* functionals, parameters */
  enum stf_trace_kind kind;
  int points;
  bool adaptive;
  size_t width;             /* doubles of a record */
  const steif_table *table; /* collocation and chains */
  stf_stage_polynomial u;
  stf_adjoint adjoint;
  stf_slopes *slopes;
  N_Vector *Y, *Yp, *r, *w, before, work, error;
  N_Vector *lambda, *kappa; /* of y and, in chains, of the last slope; by functionals */
  N_Vector *past[STF_PAST]; /* BDF: of values before */
  N_Vector *gy;
  sunrealtype *gp, *g, *other, *nu; /* nu: BDF, weights of past values of the integral */
  sunrealtype *value, *mu, *estimate;
} stf_backwards;

/* functional.c: B->g, B->gy and B->gp of the integrand, or of what is said of the end, at (t, y). */
int stf_functional_at(stf_backwards *B, int at_end, sunrealtype t, N_Vector y);
/* mu_i += c dF/dp^T w at (t, Y, Yp), B->value += c g_i and mu_i += c g_p. */
int stf_pull_parameters(stf_backwards *B, int i, sunrealtype t, N_Vector Y, N_Vector Yp,
                        N_Vector w);

/* pull.c: lambda and mu through the step of a record. */
int stf_pull(stf_backwards *B, const sunrealtype *record);
int stf_pull_start(stf_backwards *B, sunrealtype t0, N_Vector y0, N_Vector yp0);

/* step_record.c: the step just made by s, from `before`, into a record. */
int stf_record_open(stf_backwards *B);
int stf_record_step(stf_backwards *B, steif_solver *s, N_Vector before, sunrealtype *record);

/* revolve.c: how far to go from the first of l > 1 steps until the next image, with c images left, that at the
 * first step not counted. */
long stf_revolve_advance(long l, int c);

#endif
