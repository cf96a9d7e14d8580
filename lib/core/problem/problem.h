/* problem.h: the problem room inside: every form lowered to one residual and one pencil.
 *
 *   F(t, y, y') with E = dF/dy', A = -dF/dy:
 *   ode          y' - f(t, y)             E = I,  A = df/dy
 *   mass         M y' - f(t, y)           E = M,  A = df/dy
 *   implicit     F(t, y, y')              E = F_y', A = -F_y
 *   descriptor   E y' - A y - g(t)
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PROBLEM_H
#define STF_PROBLEM_H

#include "agree.h"
#include "image.h"
#include "lu.h"
#include "space.h"
#include <steif/pencil.h>
#include <steif/problem.h>

typedef struct stf_groups stf_groups;

/* Where operators are applied. f: the residual there, for differences without .Av and for preconditioners. */
typedef struct stf_operator_point {
  sunrealtype t;
  N_Vector y, yp, f;
  sunrealtype size; /* of y, for differences along vectors; < 0: not known */
} stf_operator_point;

typedef struct stf_system {
  steif_context *ctx;
  const steif_problem *problem;
  stf_space space;
  int form;
  bool linear;                /* constant E and A: linearised once */
  enum steif_storage storage; /* of E and A */
  bool krylov;                /* the pencil is an operator */
  steif_pencil *pencil;
  steif_pencil *near;        /* operators: ILU(0) of E and A; NULL: there are no matrices */
  SUNMatrix E, A;            /* owned; E NULL: identity */
  sunrealtype scale;         /* floor of |y_j| in difference increments: atol / rtol ... */
  const sunrealtype *floors; /* ... or that of each component; NULL: scale for all */
  stf_groups *groups;        /* columns that may be moved together */
  N_Vector work[6];
  stf_operator_point at,
    made; /* operators only: of the last linearisation, of the last setup of the preconditioner */
  bool filled;
  bool central; /* differences on both sides, for matrices that are more than preconditioners */
  bool doubted; /* Newton's iteration has failed: the next Jacobian is probed */
  sunrealtype weight; /* of g in the residual of the descriptor form, 1 */
  long nfe, nje;
  long sums; /* see stf_space */
} stf_system;

/* The floor of component j. */
static inline sunrealtype stf_floor(const stf_system *s, sunindextype j)
{
  return s->floors ? s->floors[j] : s->scale;
}

/* Everything is claimed from the pool. The first linearisation is made at (t0, y, yp), the
 * start values that stf_system_start has filled in. */
int stf_system_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem, int form,
                    enum steif_storage storage, sunrealtype scale, const sunrealtype *floors,
                    N_Vector y, N_Vector yp, stf_system *system);

/* r = F(t, y, yp). r must differ from y and yp. */
int stf_system_residual(stf_system *system, sunrealtype t, N_Vector y, N_Vector yp, N_Vector r);
/* out = f(t, y) of the ode and mass forms. */
int stf_system_rhs(stf_system *system, sunrealtype t, N_Vector y, N_Vector out);
/* E and A at (t, y, yp) into the pencil; nothing for a linear system already filled. */
int stf_system_linearise(stf_system *system, sunrealtype t, N_Vector y, N_Vector yp);
/* The same into system->E and system->A only, for families with factors of their own. */
int stf_system_matrices(stf_system *system, sunrealtype t, N_Vector y, N_Vector yp);
/* own_factors.c, for those who do not see matrices. E of a dense system by rows, from the pool; NULL for
 * the identity. */
int stf_system_mass(stf_pool *pool, const stf_system *system, sunrealtype **M);
/* Factors of lambda/h E - A or 1/(gamma h) E - A by lu.h, dense systems only; STEIF_RETRY where they cannot
 * be made in the step from t. */
int stf_system_interleave(const stf_system *system, stf_interleaved *L, sunrealtype t,
                          sunrealtype h);
void stf_system_rosenbrock_open(const stf_system *system, stf_rosenbrock *R);
int stf_system_rosenbrock(const stf_system *system, stf_rosenbrock *R, sunrealtype gamma,
                          sunrealtype t, sunrealtype h);
/* Sparse: entries of A and of its factors, and their flops; negative: not known. */
double stf_system_fill(const stf_system *system, double *entries, double *fill);
/* out_i += weight() a_ij x_j over all entries stored of A, column by column; needs host arrays. */
void stf_system_add_entries(const stf_system *system, sunrealtype (*weight)(void *data),
                            void *data, const sunrealtype *x, sunrealtype *out);

/* Start values into y and yp: y' is given, or f for the ode form, else left as it is; *known
 * tells whether yp can be relied on. */
int stf_system_start(steif_context *ctx, const steif_problem *problem, int form,
                     const stf_space *space, N_Vector y, N_Vector yp, bool *known);
/* Without a call of f, F or g, and unchecked; yp stays where it is not given. */
int stf_start_values(steif_context *ctx, const steif_problem *problem, N_Vector y, N_Vector yp);

/* system_image.c: E and A; these, the point they were made at, factors and counts. */
void stf_matrices_keep(stf_system *system, stf_image *m);
void stf_system_keep(stf_system *system, stf_image *m);

/* STEIF_BAD_INPUT where problem.index declares less than E and A at the start show. */
int stf_index_check(stf_system *system);

/* Is the problem complete for this kind of storage? */
int stf_storage_check(steif_context *ctx, const steif_problem *problem,
                      enum steif_storage storage);

/* "'lambda'", or "y3" without names; `room` has STEIF_SPEC_WORD characters. */
const char *stf_unknown(const steif_problem *problem, sunindextype i, char *room);
const char *stf_equation(const steif_problem *problem, sunindextype i, char *room);

/* steif_problem_form where this rank has so many rows of start values, index and constraint. */
int stf_problem_form(steif_context *ctx, const steif_problem *problem, sunindextype rows);

/* The problem, or where it has no name a copy in `room` with one for messages. STF_NAMED(p): p from here on, for a
 * call that keeps no pointer to it. */
const steif_problem *stf_with_name(const steif_problem *problem, steif_problem *room);
#define STF_NAMED(p)                                                                           \
  steif_problem p##_room;                                                                      \
  p = stf_with_name(p, &p##_room)

/* The 0-based component that is not finite, or -1. Needs a host array (else -1). */
sunindextype stf_not_finite(N_Vector v);
/* For a sentence, of a vector that is known not to be finite: its number from 1, over ranks the rank too; asked for on
 * all of them. */
const char *stf_number_not_finite(N_Vector v, char room[STEIF_SPEC_WORD]);

/* operator.c: pencils known by products. Operators are applied at a point: remember it. */
int stf_operator_point_open(stf_pool *pool, const stf_system *system,
                            stf_operator_point *point);
int stf_operator_point_set(stf_system *system, stf_operator_point *point, sunrealtype t,
                           N_Vector y, N_Vector yp);
/* out = E x or A x there; what a callback returned. */
int stf_operator_product(stf_system *system, stf_operator_point *point, char which, N_Vector x,
                         N_Vector out);
/* The same with the transpose, where its products are known. */
bool stf_operator_transposes(const stf_system *system);
int stf_operator_transposed(stf_system *system, stf_operator_point *point, char which,
                            N_Vector x, N_Vector out);
int stf_operator_remember(stf_system *system, sunrealtype t, N_Vector y, N_Vector yp);
/* Of the callbacks; or of the matrices filled in, with their ILU(0) as preconditioner. */
int stf_operator_open(stf_pool *pool, stf_system *system);
int stf_operator_open_near(stf_pool *pool, stf_system *system);
/* Does Krylov storage keep the sparse matrices of this problem? */
bool stf_operator_has_near(const stf_system *system);
void stf_system_destroy_pencil(void *pencil);
/* Callbacks fail on some ranks only: solves tell the others (agree.h). */
void stf_operator_defer(stf_system *system, stf_deferred *deferred);
/* The same for several products: what fails between the two on any rank is the answer of the second. */
void stf_operator_hold(stf_system *system);
int stf_operator_release(stf_system *system);

/* Differences: dF/dy or dF/dy' of `which` ('A': f or -F by y; 'E': F by y') into M. */
int stf_groups_open(stf_pool *pool, stf_system *system);
int stf_differ(stf_system *system, char which, sunrealtype t, N_Vector y, N_Vector yp,
               SUNMatrix M);
/* Are E or A made by differences? */
bool stf_groups_differ(const stf_system *system);

/* missing_entries.c: one random direction through M, filled by differences, against a difference along it:
 * entries that a pattern misses join it, *grown tells so, and M is to be filled again; a band that misses one
 * is STEIF_BAD_INPUT. Two evaluations, and a few for each row that deviates. */
int stf_probe(stf_system *system, char which, sunrealtype t, N_Vector y, N_Vector yp,
              SUNMatrix M, bool *grown);

/* parameter_names.c: there are parameters, and k is one of them. */
int stf_parameter_check(steif_context *ctx, const steif_problem *problem, int k);

/* parameters.c: dF/dp_k without memory of its own, for those who step. */
typedef struct stf_slopes stf_slopes;
int stf_slopes_open(stf_pool *pool, steif_context *ctx, const steif_problem *problem, int form,
                    N_Vector like, stf_slopes **slopes);
int stf_slopes_at(stf_slopes *slopes, int k, sunrealtype t, N_Vector y, N_Vector yp,
                  N_Vector out);
/* STEIF_NOT_FINITE with the parameter, the equation and t. */
int stf_slopes_not_finite(const stf_slopes *slopes, int k, sunrealtype t, N_Vector slope);

/* Whatever callbacks there are, by one difference, p_k from `low` to `high` increments off. */
int stf_slopes_between(stf_slopes *slopes, int k, sunrealtype t, N_Vector y, N_Vector yp,
                       int low, int high, N_Vector out);
sunrealtype stf_slopes_increment(const steif_parameters *q, int k);
/* How many times the size of the terms of F the rounding of a difference is, 0 where a callback gives dF/dp. */
sunrealtype stf_slopes_noise(const stf_slopes *slopes, int k);

/* matrices_at.c: E and A at several points, beside those of the pencil; a linear system has one pair. Operators have
 * products only. */
typedef struct stf_nonzeros {
  sunindextype *column, *row;
  sunrealtype *value;
  bool known;
} stf_nonzeros;
typedef struct stf_matrices_at {
  stf_system *system;
  int count;
  SUNMatrix *E, *A;          /* of each point; E NULL: identity; operators: A NULL */
  stf_operator_point *point; /* operators */
  stf_nonzeros *entries;     /* of dense ones: A and E of each point */
  long made;
} stf_matrices_at;
int stf_matrices_at_open(stf_pool *pool, stf_system *system, int count, stf_matrices_at *m);
/* block += factor E or A of a point, by rows of the given width; of dense and sparse matrices. */
void stf_matrices_at_add(const stf_matrices_at *m, int j, char which, sunrealtype factor,
                         sunrealtype *block, size_t width);
bool stf_matrices_at_adds(const stf_matrices_at *m);
int stf_matrices_at_fill(stf_matrices_at *m, int point, sunrealtype t, N_Vector y, N_Vector yp);
/* out += c M^T x, which 'E' or 'A' at a point of operators; scratch: another vector. */
int stf_matrices_at_transposed(const stf_matrices_at *m, int point, char which, sunrealtype c,
                               N_Vector x, N_Vector out, N_Vector scratch);
/* out = E x or A x at a point. */
int stf_matrices_at_product(const stf_matrices_at *m, int point, char which, N_Vector x,
                            N_Vector out);
#endif
