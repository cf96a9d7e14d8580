/* diagnose.h: what the diagnoses of nonlinear DAEs share: the problem seen in dense or
 * sparse matrices, Taylor coefficients along curves, and the three tests of the index.
 *
 * Derivatives are kept as Taylor coefficients in sigma = (t - t*)/tau: y(sigma) = sum z_k
 * sigma^k, z_k = tau^k y^(k)/k!, F(sigma) = sum F_k sigma^k along that curve.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DIAGNOSE_H
#define STF_DIAGNOSE_H

#include "base.h"
#include "problem.h"
#include <steif/diagnose.h>

enum { STF_DEEPEST = 4, STF_FIT_NODES = 16 }; /* differentiations of the array; nodes of a fit */

/* A problem to look at. Reals are host arrays of n values throughout. */
typedef struct stf_lens {
  steif_context *ctx;
  stf_pool *pool;
  steif_problem problem; /* a copy whose t0 is the point */
  const char *const *equation, *const *unknown;
  stf_system system;
  size_t n;
  bool analytic; /* E and A come from callbacks */
  N_Vector y, yp, r;
  sunrealtype t, *y0, *yp0;  /* the point */
  sunrealtype *floor, *size; /* size = |y0| + floor, or so */
  sunrealtype *scratch;      /* 6 n */
} stf_lens;

int stf_diagnose_open(steif_context *ctx, const steif_problem *problem,
                      const steif_inquiry *inquiry, stf_lens *lens);
void stf_diagnose_close(stf_lens *lens);
/* "e3" and "y2", or the user's; `room` has STEIF_SPEC_WORD characters. */
const char *stf_diagnose_equation(const stf_lens *lens, size_t i, char *room);
const char *stf_diagnose_unknown(const stf_lens *lens, size_t j, char *room);
/* Append to a sentence of STEIF_SENTENCE characters. */
void stf_diagnose_say(char *sentence, const char *format, ...) STEIF_PRINTF(2, 3);
/* " a, b, c (and 7 more)" of those with flag[i] >= least; with counts: "a (2), b (1)". */
void stf_diagnose_list(const stf_lens *lens, char *sentence, bool equations, const int *flag,
                       int least, bool counts);

/* r = F(t, y, y'), > 0 where it cannot be evaluated or is not finite. */
int stf_diagnose_residual(stf_lens *lens, sunrealtype t, const sunrealtype *y,
                          const sunrealtype *yp, sunrealtype *r);
/* E = F_y' and B = F_y, dense by columns; by differences of order 4 without callbacks. */
int stf_diagnose_matrices(stf_lens *lens, sunrealtype t, const sunrealtype *y,
                          const sunrealtype *yp, sunrealtype *E, sunrealtype *B);
/* The same by differences whatever callbacks there are, column j only. */
int stf_diagnose_column(stf_lens *lens, char which, sunrealtype t, const sunrealtype *y,
                        const sunrealtype *yp, size_t j, sunrealtype *column);

/* Reproducible numbers in (-1, 1). */
sunrealtype stf_diagnose_random(unsigned *state);

/* -- sparse view (any n) ----------------------------------------------------------------- */

/* E and B on the union of their patterns by columns; entries at rounding level are
 * dropped. Each call has the values of its point on the pattern of all points so far, for
 * one of them may be a zero of an entry. */
typedef struct stf_view {
  size_t n;
  sunindextype *column, *row; /* n + 1, column[n] */
  sunrealtype *e, *b;
  char *has; /* of each entry: 1 in E, 2 in B, at some point */
} stf_view;

int stf_view_take(stf_lens *lens, sunrealtype t, const sunrealtype *y, const sunrealtype *yp,
                  stf_view *view);
void stf_view_free(stf_lens *lens, stf_view *view);
/* Rates |B|/|E| of the rows that have both, columns weighted by size: the smallest and the
 * largest; 1 without any. */
void stf_view_rates(stf_lens *lens, const stf_view *view, sunrealtype *slowest,
                    sunrealtype *fastest);

/* LU of a sparse matrix on the pattern of a view, both directions, with refinement. */
typedef struct stf_factor stf_factor;
int stf_factor_open(stf_lens *lens, const stf_view *view, stf_factor **factor);
void stf_factor_free(stf_factor **factor);
/* P = s E + B, or with offsets c and d the system Jacobian, equilibrated. STEIF_SINGULAR
 * is usual. */
int stf_factor_shift(stf_factor *f, const stf_view *view, sunrealtype s);
int stf_factor_jacobian(stf_factor *f, const stf_view *view, const int *c, const int *d);
int stf_factor_solve(stf_factor *f, bool transposed, sunrealtype *x);
/* Reciprocal condition of the equilibrated matrix in the 1-norm (W. W. Hager 1984). */
int stf_factor_rcond(stf_factor *f, sunrealtype *rcond);

/* -- test S ------------------------------------------------------------------------------ */

typedef struct stf_structure {
  bool matched;
  int index;               /* by structure */
  int *c, *d, *number;     /* n each; number of unknown j by structure */
  sunindextype freedom;    /* sum d - sum c */
  sunindextype *match;     /* n: unknown of equation i, -1 */
  int *surplus, *unsolved; /* n: 1 for equations in too few unknowns, and these unknowns */
} stf_structure;
int stf_structure_find(stf_lens *lens, const stf_view *view, stf_structure *s);

/* -- test G ------------------------------------------------------------------------------ */

typedef struct stf_growth {
  bool found, singular;     /* singular: at three shifts */
  sunrealtype rcond;        /* the best of the three */
  int index, *row, *column; /* n each: degrees of rows and columns of (sE - A)^{-1} */
} stf_growth;
/* bound: numbers that the structure allows, where its Jacobian is regular; else NULL. */
int stf_growth_find(stf_lens *lens, const stf_view *view, stf_factor *f, const int *bound,
                    stf_growth *g);

/* -- Taylor coefficients and test D ------------------------------------------------------ */

/* Functionals of a fit through m nodes: weight[q * m + i] gives coefficient q <= order. */
typedef struct stf_fit {
  int m, order;
  sunrealtype node[STF_FIT_NODES]; /* in (-1, 1) */
  sunrealtype weight[(STF_DEEPEST + 3) * STF_FIT_NODES], tail[2 * STF_FIT_NODES];
} stf_fit;
void stf_fit_open(stf_fit *fit, int m, int order);

typedef struct stf_curve {
  sunrealtype t, tau;
  int count;      /* coefficients z_0 .. z_{count-1} */
  sunrealtype *z; /* count x n by rows */
} stf_curve;
void stf_curve_at(const stf_curve *curve, size_t n, sunrealtype sigma, sunrealtype *y,
                  sunrealtype *yp);
/* Coefficients F_0 .. F_order (rows of out) over nodes delta * node; tail (n, or NULL):
 * size of the last two Chebyshev coefficients. `values`: m n. */
int stf_curve_residual(stf_lens *lens, const stf_curve *curve, const stf_fit *fit,
                       sunrealtype delta, sunrealtype *values, sunrealtype *out,
                       sunrealtype *tail);
/* Coefficients of E and B, order + 1 matrices each, delta chosen by their variation. */
int stf_curve_matrices(stf_lens *lens, const stf_curve *curve, const stf_fit *fit,
                       sunrealtype *nodes, sunrealtype *E, sunrealtype *B, sunrealtype *delta);

typedef struct stf_array {
  bool closed; /* y' is determined by `index` differentiations */
  bool stalls; /* it never will be: constraints stop, the null space keeps growing */
  int index;
  sunindextype freedom;
  sunrealtype gap, tau;
  int *determined, *derivatives; /* n each */
  int *prescribe;                /* n */
} stf_array;
int stf_array_open(stf_lens *lens, stf_array *a);
/* At the curve's point and tau, up to `deepest` differentiations. */
int stf_array_find(stf_lens *lens, const stf_curve *curve, int deepest, stf_array *a);
/* Over several tau between the time scales of the view; the one with the largest gap is
 * kept. */
int stf_array_scan(stf_lens *lens, const stf_view *view, sunrealtype t, const sunrealtype *y,
                   const sunrealtype *yp, const sunrealtype *ypp, stf_array *a);
/* The whole array: rows (K+1) n, columns (K+2) n for z_0 .. z_{K+1}. */
void stf_array_fill(size_t n, int K, sunrealtype tau, const sunrealtype *E,
                    const sunrealtype *B, sunrealtype *D);

/* -- dense algebra ----------------------------------------------------------------------- */

/* A = U diag(s) VT, all of U (m x m) and VT (n x n); A is destroyed. Workspace from the
 * context. */
int stf_diagnose_svd(steif_context *ctx, size_t m, size_t n, sunrealtype *A, sunrealtype *s,
                     sunrealtype *U, sunrealtype *VT);
/* Rank by the widest gap of s_0 >= s_1 >= ..., with `top` above and rounding of it below. */
size_t stf_diagnose_rank(const sunrealtype *s, size_t count, sunrealtype top, sunrealtype *gap);

/* -- start ------------------------------------------------------------------------------- */

/* Least movement: minimise sum (weight_j (z_j - target_j))^2 subject to r(z) = 0 by Gauss-
 * Newton with damping; target NaN: stay near the current value. Rows need not be
 * independent. */
typedef struct stf_move {
  steif_context *ctx;
  size_t rows, columns;
  sunrealtype *z, *target, *weight, *unit; /* unit: sizes of z for the test of convergence */
  int (*residual)(void *data, const sunrealtype *z, sunrealtype *r);
  int (*jacobian)(void *data, const sunrealtype *z, sunrealtype *J);
  void (*prepare)(void *data, struct stf_move *move); /* fill z, target, weight, unit */
  int (*accept)(void *data, struct stf_move *move);   /* take the solution, or say why not */
  void *data;
  int most; /* iterations */
  int iterations;
  bool converged;
  size_t rank;
  sunrealtype rcond;                      /* smallest kept singular value over the largest */
  sunrealtype *r, *J, *U, *VT, *s, *left; /* at the end: r and J at z, U of the scaled J */
  sunrealtype *work;
} stf_move;
/* From memory to acceptance; a callback that asks for another point becomes a sentence. */
int stf_move_run(stf_lens *lens, stf_move *move);

/* F and its derivatives along a curve, each order with the node distance that serves it
 * best. */
typedef struct stf_ladder {
  stf_lens *lens;
  stf_fit fit;
  int order;
  sunrealtype delta[STF_DEEPEST + 2]; /* of orders 1 .. order, in sigma */
  sunrealtype fastest, slowest;
  sunrealtype *values, *rows, *tail;
} stf_ladder;
int stf_ladder_open(stf_pool *pool, stf_lens *lens, int order, stf_ladder *ladder);
/* Choose delta on this curve; scale: sizes of the terms of the equations; order[i] of
 * equation i, or NULL: all. */
int stf_ladder_choose(stf_ladder *ladder, const stf_curve *curve, const sunrealtype *scale,
                      const int *order);
/* out: (order + 1) x n Taylor coefficients by rows. */
int stf_ladder_climb(stf_ladder *ladder, const stf_curve *curve, sunrealtype *out);

typedef struct stf_task {
  stf_lens *lens;
  const steif_request *request;
  steif_start *start;
  const stf_view *view;
  sunrealtype *scale; /* n: size of the terms of each equation */
  int most;           /* iterations of a stage */
} stf_task;
int stf_start_scale(stf_task *task);
int stf_start_stages(stf_task *task, const stf_structure *s);
int stf_start_array(stf_task *task, const stf_array *a, const int *number);
enum steif_attribute stf_start_attribute(const stf_task *task, size_t j);
sunrealtype stf_start_weight(const stf_task *task, size_t j);

/* Claims the lists of *start from the pool in start->memory. */
int stf_start_claim(steif_context *ctx, size_t n, steif_start *start);

/* -- verdict ----------------------------------------------------------------------------- */

/* What the tests said at the points looked at; lists are of the lens. */
enum { STF_POINTS = 4 };
typedef struct stf_evidence {
  stf_lens *lens;
  stf_view view;
  stf_factor *factor;
  stf_structure structure;
  int points, arrays; /* points looked at, and those where test D ran */
  struct {
    sunrealtype t, *y, *yp, *ypp, rcond;
    stf_growth growth;
    stf_array array;
  } at[STF_POINTS];
} stf_evidence;
int stf_evidence_gather(stf_lens *lens, stf_evidence *evidence);
void stf_evidence_free(stf_evidence *evidence);
bool stf_evidence_certified(const stf_evidence *evidence);
int stf_verdict(const stf_evidence *evidence, steif_diagnosis *d);
/* The consistent start from the point of the lens, which may have moved since the evidence was
 * gathered. */
int stf_start_from(stf_evidence *evidence, const steif_request *request, steif_start *start);
int stf_diagnosis_claim(steif_context *ctx, size_t n, steif_diagnosis *d);

/* -- causes of a failure ----------------------------------------------------------------- */

typedef struct stf_case {
  stf_lens *lens;           /* at the last accepted point */
  const steif_scene *scene; /* NULL: the Jacobian alone is looked at */
  steif_cause *cause;
  sunrealtype *scale, *noise, *weight; /* n each: terms and noise of equations, error weights */
  stf_evidence evidence;               /* gathered when first needed */
  steif_diagnosis diagnosis;
  bool gathered;
} stf_case;
/* More unknowns than the dense tests serve. */
bool stf_case_large(const stf_case *c);
/* Each looks for one cause and fills *cause if it is there. */
int stf_case_blow_up(stf_case *c);
int stf_case_impasse(stf_case *c);
int stf_case_jump(stf_case *c);
int stf_case_jacobian(stf_case *c);
int stf_case_singular(stf_case *c);
int stf_case_differences(stf_case *c);
int stf_case_accuracy(stf_case *c);
int stf_case_stiff(stf_case *c);
int stf_case_start(stf_case *c);
int stf_case_ringing(stf_case *c);
int stf_case_index(stf_case *c);
/* The diagnosis at the last accepted point. */
int stf_case_diagnose(stf_case *c);
/* Noise of F around the point (J. J. More and S. M. Wild, SIAM J. Sci. Comput. 33, 2011);
 * 0 where none is seen. */
int stf_case_noise(stf_case *c);

#endif
