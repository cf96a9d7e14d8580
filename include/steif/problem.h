/* steif/problem.h: what is integrated, in one of four forms, with callbacks users already own.
 *
 *   ode          y' = f(t, y)                          .f
 *   mass         M y' = f(t, y), M(t), M(t, y)         .f, .E   (M may be singular)
 *   implicit     F(t, y, y') = 0                       .F
 *   descriptor   E x' = A x + g(t), E and A constant   .E, .A, .g   (A = -F in E x' + F x = g)
 *
 * M is filled at the start, at two other times and two other states; where it is the same, it is taken for constant
 * and made once. Where it varies, the problem is F = M(t, y) y' - f(t, y) = 0, whose df/dy holds d(M y')/dy, made
 * by differences, to collocation, BDF, DIRK and IDA, with the orders of a constant M. Rosenbrock methods take
 * y' = z, 0 = F(t, y, z), with their orders too, where M is regular but for rows and columns of zeros (Hairer and
 * Wanner, Solving ODEs II, IV.7). ARKODE takes M(t) regular, not M(t, y). What cannot take it, and E or A of the
 * descriptor form that vary: STEIF_UNSUPPORTED, with the entry, the method and those that can.
 *
 * The form is deduced from the members that are set. All lower to one residual F(t, y, y') and one
 * matrix pencil s E - A with E = dF/dy' and A = -dF/dy; nothing else is asked of a problem.
 *
 * Callbacks have the SUNDIALS signatures and return 0, > 0 (cannot be evaluated here: try a smaller
 * step) or < 0 (stop). CVRhsFn, IDAResFn, CVLsJacFn and IDALsJacFn written for CVODE and IDA fit
 * unchanged; the three scratch vectors of a Jacobian callback are given.
 *
 * A problem is a value: the library copies nothing from it and frees nothing in it; every pointer
 * must outlive the solver. Members left 0 have the default stated, also those of later versions.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_PROBLEM_H
#define STEIF_PROBLEM_H

#include <steif/base.h>
#include <sundials/sundials_matrix.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_problem steif_problem;
typedef struct steif_parameters steif_parameters; /* parameters.h */
typedef struct steif_quadrature steif_quadrature; /* quadrature.h */

typedef int (*steif_rhs)(sunrealtype t, N_Vector y, N_Vector ydot, void *user);
typedef int (*steif_residual)(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user);
typedef int (*steif_jacobian)(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                              N_Vector tmp1, N_Vector tmp2, N_Vector tmp3);
typedef int (*steif_ida_jacobian)(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp,
                                  N_Vector r, SUNMatrix J, void *user, N_Vector tmp1,
                                  N_Vector tmp2, N_Vector tmp3);
/* Fill E = dF/dy' or A = -dF/dy at (t, y, yp). Dense and band matrices arrive zeroed; a sparse
 * (CSC) matrix is filled whole, pointers and indices included, with the same pattern each time. */
typedef int (*steif_matrix_fill)(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E,
                                 void *user);
/* g or its derivative of the given order at t; orders above 0 are asked for by the exact solution
 * of descriptor systems only: return > 0 when that order is not known, or set to NaN those components
 * of which it is not; what the solution depends on is asked of the pattern of E and F. */
typedef int (*steif_forcing)(sunrealtype t, int derivative, N_Vector g, void *user);
/* y = out of E x or A x, for the Krylov back end. */
typedef int (*steif_product)(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out,
                             void *user);
/* A preconditioner for it: z = out of P^{-1} b with P near dF/dy + c dF/dy' = c E - A, at the (t, y, yp)
 * and c of the last setup, which does the expensive part and may be NULL; it is not repeated while P serves other
 * points and steps (krylov.h). IDALsPrecSetupFn and IDALsPrecSolveFn fit; delta is 0. */
typedef int (*steif_precsetup)(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r,
                               sunrealtype c, void *user);
typedef int (*steif_precsolve)(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b,
                               N_Vector z, sunrealtype c, sunrealtype delta, void *user);
/* The same for the complex systems of collocation methods: z[0] + i z[1] = P^{-1} (b[0] + i b[1]) with P near
 * dF/dy + (c_re + i c_im) dF/dy' = c E - A. c is that of the system at hand and changes with the step size;
 * the last precsetup was for a real c within a factor of 2 of |c| with the sign of c_re. P may be that real one
 * (then one message or one pass over its factors serves both halves), or complex, made here at the first
 * call after a setup. Linear over the complex numbers: P^{-1} (i b) = i P^{-1} b. */
typedef int (*steif_precsolve_pair)(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r,
                                    N_Vector *b, N_Vector *z, sunrealtype c_re,
                                    sunrealtype c_im, sunrealtype delta, void *user);
/* y(t) (or y and yp at the start; yp may be NULL). */
typedef int (*steif_state)(sunrealtype t, N_Vector y, N_Vector yp, void *user);
/* Several numbers that depend on (t, y): invariants, or event functions; a CVRootFn fits. */
typedef int (*steif_values)(sunrealtype t, N_Vector y, sunrealtype *value, void *user);
/* What is to be done at an event at time t, fired[i] = 1 (g_i was rising), -1 (falling), 0 (not this
 * one). y may be changed, and anything that the callbacks read. Returns an enum steif_event_action, or
 * < 0: the run fails. */
typedef int (*steif_event_handler)(sunrealtype t, N_Vector y, const int *fired, void *user);
/* Called at the start of every run, before any other callback: callbacks that remember something, such as
 * a switch that an event has flipped, forget it here. Returns 0, or < 0: the run fails. */
typedef int (*steif_begin)(sunrealtype t, void *user);
/* What begin resets, as bytes for a checkpoint (checkpoint.h). save fills in `bytes`, or where that is NULL
 * nothing, and returns how many there are, which stays the same during a run; < 0: it cannot be done. restore
 * takes them back, after begin; returns 0, or < 0: these are not its bytes. */
typedef long (*steif_save_state)(void *bytes, void *user);
typedef int (*steif_restore_state)(const void *bytes, size_t count, void *user);
enum steif_event_action {
  STEIF_CONTINUE, /* neither y nor f has changed */
  STEIF_RESTART,  /* go on from the y left here, without history */
  STEIF_FINISH    /* the run ends here */
};

enum steif_form { STEIF_ODE = 1, STEIF_MASS = 2, STEIF_IMPLICIT = 4, STEIF_DESCRIPTOR = 8 };

/* Storage of E and A. Sparse matrices are compressed by columns. Krylov: none; systems are solved by
 * GMRES (krylov.h), in units of the error test where y' = f or a preconditioner is given. Forced on a
 * sparse problem without precsolve it keeps E and A, for products and for their ILU(0). */
enum steif_storage { STEIF_DENSE, STEIF_BAND, STEIF_SPARSE, STEIF_KRYLOV };

/* A sparsity pattern by columns: rows row[column[j]] .. row[column[j+1]-1], ascending. */
typedef struct steif_pattern {
  const sunindextype *column, *row; /* n + 1 and column[n] entries */
} steif_pattern;

/* Names of equations and unknowns, as many as there are of them, for sentences and tables; a list that
 * is NULL: equation 1, 2, ..., x1, x2, ... */
typedef struct steif_names {
  const char *const *equation, *const *unknown;
} steif_names;

/* A published or computed end value with the digits that are right. */
typedef struct steif_reference {
  sunrealtype t;
  sunindextype count;            /* 0: all n components */
  const sunindextype *component; /* 0-based; NULL: 0 .. count-1 */
  const sunrealtype *value;
  int digits; /* significant digits that are right; 0: not stated */
  const char *source;
} steif_reference;

typedef struct steif_event {
  const char *name; /* NULL: g1, g2, ... */
  int direction;    /* 1: when g rises, -1: when it falls, 0: both */
  int terminal;     /* 1: the run ends at the first of them */
} steif_event;

struct steif_problem {
  const char *name, *about; /* NULL: a run calls it "unnamed"; one sentence and a citation */
  sunindextype n;
  const steif_names *names; /* of its components and equations; NULL: none */
  sunrealtype t0, t1;       /* interval of a run; t1 = t0: options.t1 ends it */
  const sunrealtype *y0;    /* n start values (host memory) ... */
  const sunrealtype *yp0;   /* ... and slopes; NULL: computed where the form allows, else 0 */
  steif_state start;        /* instead of y0, for vectors without a host array */

  steif_rhs f;
  steif_residual F;
  steif_forcing g;
  steif_jacobian jac;        /* df/dy */
  steif_ida_jacobian idajac; /* dF/dy + c dF/dy', affine in c: E and A come from two calls */
  steif_matrix_fill E, A;    /* direct fills; E also marks the mass and descriptor forms */
  steif_product Ev, Av;      /* E x and A x without matrices (STEIF_KRYLOV); Av may be left to
                                differences of f or F, Ev NULL means E = I */
  steif_precsetup precsetup; /* Krylov: the preconditioner */
  steif_precsolve precsolve;
  /* Semilinear problems y' = L y + N(t, y): the constant linear part, for exponential methods of
   * Runge-Kutta type; f stays the whole right-hand side. L fills a matrix like A, Lv is x -> L x
   * for Krylov storage. Both NULL: L = df/dy at the start. */
  steif_matrix_fill L;
  steif_product Lv;
  void *user; /* handed to every callback */

  enum steif_storage storage;
  sunindextype lower, upper; /* bandwidths for STEIF_BAND */
  sunindextype nnz;          /* room in a sparse A (and E: nnz_E) that a callback fills */
  sunindextype nnz_E;
  /* Of dF/dy (+ dF/dy'): differences by groups of columns. The 1st, 2nd, 4th ... Jacobian of a run, of
   * baselines too, and those after failures of Newton's iteration are probed: entries that the pattern misses
   * join a copy of it. NULL: with STEIF_SPARSE, no Jacobian, nnz = 0 and n <= 20000 a solver finds it, by
   * steif_pattern_find, and says so in steif_method_used. */
  const steif_pattern *pattern;

  const int *index;      /* n entries 1, 2, 3: index of each component as in RADAU5; norms
                                scale component i by h^(index-1); NULL: all 1 */
  const int *constraint; /* n entries as for CVodeSetConstraints: 1: y_i >= 0, 2: > 0, -1: <= 0,
                                -2: < 0, 0: none; kept at the ends of steps; over ranks of own
                                rows, kept by all ranks alike; NULL: none */
  int dae_index;         /* differentiation index; 0: the highest of .index; -1: not stated */
  int autonomous;        /* 1: f does not depend on t */
  sunrealtype period;    /* of f in t where it is known, else 0 */
  int linear;            /* 1: F is affine in (y, y') with constant coefficients */

  steif_state exact; /* closed solution, if there is one */
  const steif_reference *reference;
  int invariants;                   /* number of conserved quantities ... */
  steif_values invariant;           /* ... all of them */
  int events;                       /* number of event functions g_i(t, y) ... */
  steif_values event;               /* ... all of them; see solver.h */
  const steif_event *event_list;    /* of each; NULL: both directions, none ends the run */
  steif_event_handler handle_event; /* NULL: events are noted only */
  steif_begin begin;                /* NULL: nothing is remembered */
  steif_save_state save;            /* both or none; NULL: with begin, runs cannot be saved */
  steif_restore_state restore;
  const sunrealtype *event_times; /* of the first events where they are known, ascending */
  int event_time_count;
  const sunrealtype *breaks; /* declared discontinuities of f after t0, ascending */
  int break_count;
  /* A separable problem: the first `positions` components are q, the others p; q' depends on (t, p)
   * only and p' on (t, q) only, as for H = T(p) + V(q). 0: not separable. The halves of f alone, for
   * splitting methods: kick writes the components p' of ydot, drift the components q', neither
   * touches the others; NULL: through f. */
  sunindextype positions;
  steif_rhs kick, drift;
  int unit_mass;          /* 1: q' = p, component by component; drift is not called for serial
                                vectors */
  sunrealtype rtol_scale; /* atol = rtol_scale * rtol by default; 0: 1 */

  /* Problems with parameters: fill the rest of *self from the spec; `destroy` undoes it. Members
   * that build does not touch keep the values of the shelf entry. */
  int (*build)(steif_context *ctx, const steif_spec *spec, steif_problem *self);
  void (*destroy)(steif_context *ctx, steif_problem *self);
  const steif_parameters *parameters;  /* numbers that it depends on; NULL: none */
  const steif_quadrature *quadrature;  /* integrals beside the solution; NULL: none */
  steif_precsolve_pair precsolve_pair; /* Krylov; NULL: precsolve for each half */
  /* Called before handle_event, for handlers that must know which way the solution goes: y' of the step at the
   * event, of algebraic unknowns too, by a difference of its dense output. NULL: not needed. */
  steif_state event_slope;
  /* Krylov: E^T x and A^T x, for gradients (gradient.h) without matrices; Etv NULL: E = I. Symmetric matrices: the
   * callbacks of Ev and Av. precsolve_transposed: z = P^{-T} b, with the P of precsolve. */
  steif_product Etv, Atv;
  steif_precsolve precsolve_transposed;
  /* Event functions that change in t alone, such as the nodes of a table of mod(t, 24), have one sign, and f is smooth, for
   * so long before and after a change: before a step g is evaluated so often ahead, at the present y, and the step
   * ends at the first of these times that shows a change. Not of prescribed steps. 0: not known. */
  sunrealtype event_spacing;
  /* Over ranks (steif/mpi.h): vectors like those that the callbacks take, options.like where that is NULL; another one
   * that is not spread over ranks is STEIF_BAD_INPUT. NULL: any vectors. */
  N_Vector like;
  /* Of vectors spread over ranks, whose unknowns without a derivative of their own are found nowhere else: y in place
   * becomes the state at t that keeps what the equations keep of it; yp is NULL. Called by all ranks, own rows. With it
   * adaptive steps of our own methods restart after each break of the problem, at the first time after it
   * (options.reinitialise does so elsewhere). Where index or dae_index is above 1, what else steps over breaks is
   * STEIF_UNSUPPORTED, errors are measured as in one process, and y is projected where steif_solve_to, steif_solve_step
   * and options.observe show it; by steif_dense not. NULL: y stays as steps leave it. */
  steif_state project;
  void *reserved[7]; /* 0; members to come take their place, and later ones stand after them */
};

/* The form, or 0 with the message set: complete, consistent, finite start values. */
STEIF_EXPORT int steif_problem_form(steif_context *ctx, const steif_problem *problem);
STEIF_EXPORT const char *steif_form_name(int form);

/* The pattern of df/dy, or of dF/dy and dF/dy', with the diagonal: rows that change when one unknown
 * moves, at three points by up to 1 %, 10 % and 50 % from the start at t0 (nearer where f has no value). 3 n
 * evaluations (6 n of F). What is 0 at all of them is missed; a run with the pattern goes on looking.
 * STEIF_NOT_FINITE: no values near the start. Free it after its last use. */
STEIF_EXPORT int steif_pattern_find(steif_context *ctx, const steif_problem *problem,
                                    steif_pattern **pattern);
STEIF_EXPORT void steif_pattern_free(steif_context *ctx, steif_pattern **pattern);

/* For callbacks that fill E, A or a Jacobian: M in whatever storage it comes, dense, band or sparse (which
 * is given room). The diagonal d, n entries, NULL: all 1; or entries (row[k], column[k]) in any order, equal
 * places are summed. 0, which the callback may return, or STEIF_BAD_INPUT: an entry outside of the matrix or
 * of its band.
 *
 *   static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
 *   {
 *     return steif_fill_diagonal(M, user);
 *   }
 */
STEIF_EXPORT int steif_fill_diagonal(SUNMatrix M, const sunrealtype *d);
STEIF_EXPORT int steif_fill_triplets(SUNMatrix M, sunindextype count, const sunindextype *row,
                                     const sunindextype *column, const sunrealtype *value);

#ifdef __cplusplus
}
#endif
#endif
