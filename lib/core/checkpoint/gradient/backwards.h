/* backwards.h: a run gone through backwards: records of its steps, their transposes, and the schedule by
 * which steps are made again.
 *
 * A record is a row of doubles: head, then Y_j and Y'_j of each point, then the error estimate; last, where second
 * derivatives are wanted, what Y_j and Y'_j are along the line.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BACKWARDS_H
#define STF_BACKWARDS_H

#include "direction_inside.h"
#include "integrator.h"
#include "stage_polynomial.h"
#include "transition.h"
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
enum { STF_BASIS = 24 };
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
  bool direct, forward; /* the stages' own matrix is factored; K x = r is being solved */
  bool by_rows;         /* K^T is factored by rows */
  N_Vector *residual, *omega, product, total;
  long solves, forward_solves, factors;
  bool lanes; /* operator_stages.c: those of the shifts, by GMRES, precondition it */
  steif_pencil *incomplete; /* of those, by matrices; NULL: by callbacks or by nothing */
  N_Vector turned;          /* scratch of transposed products */
  bool krylov;              /* stage_krylov.c, with factors of one real shift ... */
  sunrealtype held, gamma;  /* ... which is this, 0: none yet; of m > 1 stages 1/(gamma h) */
  sunrealtype tolerance;
  const steif_table *table;
  N_Vector *basis[STF_BASIS + 1], *extra, *nothing;
  N_Vector *behind;      /* w of the step behind, by channels; NULL: none */
  sunrealtype h_behind;  /* 0: not yet */
  int channel, channels; /* to be solved for; of right-hand sides at once */
  long sweeps;           /* of the last solve; `slow`: with these factors too many */
  bool slow, fresh;
} stf_adjoint;
int stf_adjoint_open(stf_pool *pool, stf_system *system, int m, const steif_table *table,
                     int channels, stf_adjoint *a);
/* Large sparse stages: what may be left of residuals, relative; smooth: w of one
 * stage is like that of the step behind; then a solve, 1: it does not converge. */
int stf_stage_krylov_open(stf_adjoint *a, const steif_table *table, sunrealtype tolerance,
                          int channels, bool smooth);
int stf_stage_krylov(stf_adjoint *a, N_Vector *r, N_Vector *w);
/* x := M^{-T} x, or M^{-1} x, by one solve for each shift of the middle stage. */
int stf_adjoint_precondition(stf_adjoint *a, N_Vector *x);
/* operator_stages.c, storage Krylov: the pencil of the middle stage; part of a residual that GMRES of all stages, whose
 * preconditioner is not quite linear, takes at a time; where all stages have one matrix, sweeps, 1: they do not converge; a
 * sentence for that. */
#define STF_LANES_GAIN 1e-2
int stf_lanes_open(stf_adjoint *a);
int stf_lanes_refine(stf_adjoint *a, N_Vector *r, N_Vector *w);
int stf_lanes_short(const stf_adjoint *a);
/* a->residual := r - K^T w, or r - K w. */
int stf_adjoint_residuals(stf_adjoint *a, N_Vector *r, N_Vector *w);
/* Factors after the matrices at the points are filled: B/h of the method, m x m by rows. */
int stf_adjoint_factor(stf_adjoint *a, sunrealtype t, sunrealtype h, const sunrealtype *B);
int stf_adjoint_solve(stf_adjoint *a, N_Vector *r, N_Vector *w);
/* The same of all channels, m vectors each. */
int stf_adjoint_solve_all(stf_adjoint *a, N_Vector *r, N_Vector *w);
/* K x = r, with the same factors. */
int stf_adjoint_solve_forward(stf_adjoint *a, N_Vector *r, N_Vector *x);
/* out += c M^T x, which 'E' or 'A' at a point. */
int stf_adjoint_add(const stf_adjoint *a, int point, char which, sunrealtype c, N_Vector x,
                    N_Vector out);
/* matrix_columns.c: out += c M^T x; entries of c M added to a dense matrix, rows `step` and columns ld apart. M NULL: identity. */
void stf_add_transposed(SUNMatrix M, sunindextype n, sunrealtype c, const sunrealtype *x,
                        sunrealtype *out);
void stf_add_dense(SUNMatrix M, sunindextype n, sunrealtype c, double *to, sunindextype step,
                   sunindextype ld);

/* A run along a line of parameters and start values: dots are derivatives by theta, at 0. */
typedef struct stf_pushed {
  steif_direction *line;
  stf_slopes *slopes;    /* dF/dtheta */
  N_Vector *Y, *Yp;      /* of the points of a step */
  N_Vector y, kappa;     /* of y and, in chains, of the last slope, before the next step */
  N_Vector *past;        /* BDF: y at 0, and values before */
  N_Vector *x, *r;       /* of the stages */
  bool has_E;            /* it is not the identity */
  SUNMatrix E, A;        /* at points of differences; A NULL: of products */
  stf_matrices_at moved; /* operators there */
  N_Vector at, slope_at;
  N_Vector *bend_E, *bend_A; /* of the stages: derivatives of E^T w and A^T w, w held */
  N_Vector *gy;              /* of the slopes of functionals */
  sunrealtype *gp;
} stf_pushed;

/* What has happened at the end of a step, or with step = -1 at the start. Of a step that was cut y is taken at the part
 * x of its length, and integrals are those of dense output up to there, by Gauss' formula: at x_i in `inside`, the last
 * of which is x. weight: BDF, of past values in y. */
enum { STF_INSIDE = 6 };
typedef struct stf_passed {
  long step;
  bool cut;
  sunrealtype x[STF_INSIDE + 1], c[STF_INSIDE], weight[STF_INSIDE + 1][STF_PAST];
  sunrealtype *inside; /* y at x_i, rows of n; NULL: no integrals */
  stf_transition change;
} stf_passed;

typedef struct stf_backwards {
  steif_context *ctx;
  const steif_problem *problem;
  const steif_functional *functional;
  stf_pool *pool;
  steif_solver *home; /* its system of equations gives matrices */
  stf_space space;
  sunindextype n;
  int count, P; /* functionals, parameters */
  int
    channels; /* count, or with a tangent twice that: channel count + i is the derivative of channel i */
  stf_pushed *tangent; /* NULL: first derivatives only */
  enum stf_trace_kind kind;
  int points;
  bool adaptive;
  size_t width, own;        /* doubles of a record; but for the tangents */
  const steif_table *table; /* collocation and chains */
  stf_stage_polynomial u;
  stf_adjoint adjoint;
  stf_slopes *slopes;
  struct stf_slope_probe *probe;
  N_Vector *Y, *Yp, *r, before, work, error;
  N_Vector *w, *right;      /* m of each channel; right: of r, in the order of w */
  N_Vector *lambda, *kappa; /* of y and, in chains, of the last slope; by channels */
  N_Vector *past[STF_PAST]; /* BDF: of values before */
  N_Vector *gy;
  sunrealtype *Fp, *gp, *g, *other, *nu; /* nu: BDF, weights of past values of the integral */
  sunrealtype *value, *mu, *estimate;
  sunrealtype end[STEIF_STAGES]; /* weights of the stages in y where the step counts up to */
  const stf_passed *cut;         /* NULL: to its end */
  /* integral_along.c: integrals of g(t, y + shift[0]), room, and what they come to by the method; NULL: not wanted. */
  N_Vector *shift;
  sunrealtype *shifted;
  N_Vector *
    extra; /* what integrals up to there add to stages or past values, then to y_n; NULL: none */
} stf_backwards;

/* operator_stages.c: what gives transposed products, and where they are wanted second derivatives: the system of the run, or
 * one with matrices. */
int stf_matrices_for(stf_backwards *B, bool second, stf_system **system);

/* functional.c: B->g, B->gy and B->gp of the integrand, or of what is said of the end, at (t, y). */
int stf_functional_at(stf_backwards *B, int at_end, sunrealtype t, N_Vector y);
/* end_unknowns.c: has the step what B->gy asks for, inside and at its end? */
int stf_check_inside_unknowns(stf_backwards *B, const steif_solver *s);
int stf_check_end_unknowns(stf_backwards *B, const steif_solver *s);
/* to += c g of the integrands; and B->g := derivatives by t of what is said of the end. */
int stf_functional_add(stf_backwards *B, sunrealtype c, sunrealtype t, N_Vector y,
                       sunrealtype *to);
int stf_functional_by_time(stf_backwards *B, sunrealtype t, N_Vector y);
/* to_i += c_i g_i(t, y + shift), where that is wanted and can be had. */
int stf_functional_shifted(stf_backwards *B, const sunrealtype *c, sunrealtype t, N_Vector y,
                           sunrealtype *to);
/* out_k = w . dF/dp_k; and mu of a channel less that. */
int stf_parameters_times(stf_backwards *B, sunrealtype t, N_Vector Y, N_Vector Yp, N_Vector w,
                         sunrealtype *out);
int stf_pull_parameters(stf_backwards *B, int i, sunrealtype t, N_Vector Y, N_Vector Yp,
                        N_Vector w);

/* probe_functional.c: STEIF_BAD_INPUT where slopes of the integrand, or of what is said of the end, are not those of the
 * values at (t, y), or dFdp_transposed those of dFdp. */
int stf_probe_functional(stf_backwards *B, int at_end, sunrealtype t, N_Vector y);
int stf_probe_pull(stf_backwards *B, sunrealtype t, N_Vector y, N_Vector yp);

/* pull.c: lambda and mu through the step of a record, as far as B->cut says; through what has come to the slope that a
 * chain began with at (t, y, yp). */
int stf_pull(stf_backwards *B, const sunrealtype *record);
int stf_pull_start(stf_backwards *B, sunrealtype t0, N_Vector y0, N_Vector yp0);
/* dense_weights.c: B->end, and what B->cut asks of B->extra and of past values. */
int stf_see_cut(stf_backwards *B, const stf_head *head);
/* event_passages.c: through an event or a break. */
int stf_pull_passage(stf_backwards *B, const stf_transition *change);
/* The matrix of the stages of collocation at the points read. */
int stf_factor_collocation(stf_backwards *B, const stf_head *head);

/* push.c: the step of a record along the line, into the record. */
int stf_push_open(stf_backwards *B, steif_direction *line);
int stf_push_start(stf_backwards *B, sunrealtype t0, N_Vector y0, N_Vector yp0);
int stf_push(stf_backwards *B, sunrealtype *record);
void stf_push_read(stf_backwards *B, const sunrealtype *record);
/* All that the next step is pushed from, `size` doubles of it, into or from a row. */
size_t stf_push_size(const stf_backwards *B);
void stf_push_keep(stf_backwards *B, sunrealtype *to);
void stf_push_back(stf_backwards *B, const sunrealtype *from);

/* curvature.c: derivatives of products along the line, by differences of two lengths extrapolated. Of w held at a
 * point (Y, Yp) that moves with (dY, dYp): bend_E = (E^T w)', bend_A = (A^T w)', and mu of channel count + i less
 * (F_p^T w)'. */
int stf_bend(stf_backwards *B, int i, sunrealtype t, const N_Vector point[4], N_Vector w,
             N_Vector bend_E, N_Vector bend_A);
/* tangent->gy, gp: of the slopes of the integrand, or of what is said of the end. */
int stf_bend_functional(stf_backwards *B, int at_end, sunrealtype t, N_Vector y, N_Vector dy);
/* out = (dy0/dp_k)'. */
int stf_bend_start(stf_backwards *B, int k, N_Vector out);

/* step_record.c: the step just made by s, from `before`, into a record. */
int stf_record_open(stf_backwards *B);
void stf_record_read(stf_backwards *B, const sunrealtype *record); /* into Y, Yp and error */
int stf_record_step(stf_backwards *B, steif_solver *s, N_Vector before, sunrealtype *record);

/* revolve.c: how far to go from the first of l > 1 steps until the next image, with c images left, that at the
 * first step not counted. */
long stf_revolve_advance(long l, int c);

#endif
