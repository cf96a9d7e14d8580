/* steif/weak.h: weak convergence of methods on E x' + F x = f, Campbell's systems.
 *
 * For N x' + x = f with N the k x k nilpotent Jordan block (ones above the diagonal) and any x(0-),
 *   x(t) = sum_{i<k} (-1)^i N^i f^(i)(t)  +  sum_{i<k-1} c_i delta^(i)(t),
 *   c_i = (-1)^i N^{i+1} (x(0-) - x_s(0+)),   x_s the smooth part.
 * A discretisation x_h converges weakly when <x_h, g> tends to <x, g> for smooth g, the impulses
 * included: <delta^(i), g> = (-1)^i g^(i)(0). A sequence x_i is read as a function in one of four
 * conventions, which differ by O(h):
 *   P      x_i on [ih, (i+1)h), i >= 0            (Campbell's)
 *   R      x_i on ((i-1)h, ih], i >= 1            (the step that produced x_i)
 *   C      h sum_i x_i delta(t - ih), i >= 1; i >= 0 where the run has solved for x_0, as convolution
 *          quadrature (start=cq) does            (comb)
 *   stage  h sum_n sum_j b_j X_{n,j} delta(t - t_n - c_j h)   (Runge-Kutta stages)
 * Usual are stage for Runge-Kutta methods of any number of stages (backward Euler apart), C for
 * convolution quadrature, R for the others.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_WEAK_H
#define STEIF_WEAK_H

#include <steif/impulse.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The test function g(t) = (1 - t)_+^8; derivative of order q. */
STEIF_EXPORT sunrealtype steif_test_function(sunrealtype t, int q);

/* Smooth part and impulse coefficients of one Jordan block. forcing NULL: 0. x0: k values x(0-).
 * x (k) receives the smooth part at t; c ((k-1) * k, by rows) the c_i; either may be NULL. */
STEIF_EXPORT int steif_jordan_exact(steif_context *ctx, int k, steif_forcing forcing,
                                    void *user, const sunrealtype *x0, sunrealtype t,
                                    sunrealtype *x, sunrealtype *c);

enum steif_convention { STEIF_P, STEIF_R, STEIF_C, STEIF_STAGE };

/* One run. Its rounding level is the difference to the same run in long double (recurrences of their
 * own, with entries exactly those of the run in double), added to what random changes of f and t by
 * parts of eps make of that, to four times the largest difference between such runs with the unknowns in
 * other orders, where the run has coordinates of its own, and to the accuracy of the exact value.
 * For general linear methods with one real shift the coefficients are the doubles of the family in both
 * runs. Methods that have no such second run (Rosenbrock, auto, general linear ones with other C; more than
 * 400 stage values): 16 times the largest difference between runs on multiples of the data, which decides no
 * verdict. */
typedef struct steif_weak_row {
  sunrealtype h, value, error,
    order; /* log2 of successive errors, NaN in the first row and where a break of f lies inside a step */
  sunrealtype rounding; /* level of `error` */
  int usable;           /* rounding <= 0.1 |error|, and h resolves the system, f and g */
} steif_weak_row;

typedef struct steif_weak_result {
  sunrealtype exact; /* <x, g> of the distributional solution; NaN: not known */
  sunrealtype first; /* closed first-order constant of backward Euler (P, R), else NaN */
  /* "converges weakly, order 1.00", "does not converge weakly: ...", "undecided: ...", of one row "none: ...".
   * Only usable rows have a say: at least three in a row, whose errors have one sign and whose last two
   * orders agree within 0.25 and do not move away from a whole number. "exact to rounding" takes three rows with errors below 4 times and
   * rounding below 1e-9 of the value. A test function with g^(q)(0) = 0 for a q below the index that
   * matters sees nothing of those impulses. A run is linear in x(0-) and f: where a second run tells
   * rounding, impulses of every order are measured by themselves, on Jordan blocks in many digits, and
   * the smooth part from x(0+), where need be with (1 - t/t1)^n, with other steps, and all components
   * together. Impulses above rounding that do not converge by themselves are the verdict, even if these
   * rows do not show it; where all parts converge, these decide what the rows leave open, and the lowest
   * order is that of the whole. Where it is not known, `order` is NAN. */
  char verdict[256];
  int converges; /* 1, 0, or -1: undecided */
  sunrealtype
    order; /* where it converges and shows one for this g (for all: a ball), else NAN */
  sunrealtype accuracy; /* of exact, as far as seen; 0: closed formulas */
  char source[160];     /* how exact was found */
  int index;            /* of the system */
  char note[160]; /* on the test function, where it does not end smoothly at t1; else empty */
  char mesh[160]; /* the first row's steps, where runs restart at breaks of f; else empty */
} steif_weak_result;

/* The convention of the program, of a method from a starting procedure (NULL: its own). */
STEIF_EXPORT int steif_convention_usual(steif_context *ctx, const char *method,
                                        const char *start, enum steif_convention *convention);

enum { STEIF_ALL = -1 }; /* components */

/* A test function g on [0, t1], 0 beyond: c_j = g^(j)(t) / j!, j = 0 .. order, from the right; nonzero
 * where it has none. For weak convergence at index k g takes k derivatives, k - 1 of which are 0
 * at t1. */
typedef struct steif_weight {
  int (*taylor)(long double t, int order, long double *c, void *user);
  void *user;
  sunrealtype t1;
  sunrealtype rounding; /* of its values, relative; 0: that of long double */
} steif_weight;

/* Pair component `component` (0-based) of runs with steps h, h/2, ... on [0, t1]: of a Jordan block,
 * where everything is known in closed form, of another descriptor problem of the collection, or of
 * a system of one's own. For these the impulses come from the pencil and the smooth part from its
 * closed solution, where there is one, or from radau:s=5 on the slow part and the derivatives of f
 * on the rest. Dense and small systems of index k > 1 are run in coordinates in which N is strictly
 * triangular: the same sequence, with rounding of eps h^-(k-1) where that of E and F as they are
 * given would be eps h^(-2 (k-1)). */
typedef struct steif_weak_query {
  const char
    *method; /* "be", "bdf:p=3", "radau:s=2", ...; "cobb": (E + h F) x' + F x = f itself */
  const char *problem; /* "jordan:k=3,case=H-inc", "ut5" */
  enum steif_convention convention;
  const char *start; /* starting procedure, NULL: the method's */
  sunrealtype
    h; /* first step; the runs make as many as reach t1. 0: t1 / 64, or a step near it that puts
                    all breaks on the meshes, or steps that end at the breaks */
  size_t rows;         /* at least 3 for a verdict */
  int component;       /* STEIF_ALL: values and errors are 2-norms over the components */
  sunrealtype *values; /* rows x n and n: of all of them by themselves; NULL: not wanted */
  sunrealtype *exacts;
  const steif_linear *linear; /* instead of problem, */
  const sunrealtype *x0;      /* from x(0-) = x0 */
  const steif_weight *g;      /* test function; NULL: (1 - t)_+^8 */
  int
    exact; /* 1: the runs are made and paired (for norms: integrated) in many-digit arithmetic, f alone in double, so that
                rounding decides nothing; for be, bdf and Runge-Kutta methods with regular A */
  size_t break_count; /* where f or a derivative of it jumps, ascending, of `linear` only: */
  const sunrealtype *breaks; /* impulses there are part of the exact distribution */
  int cells; /* norms only: B-splines on so many equal cells beside them; 0: none */
  /* 1: runs restart at every break of f, with a constant step near h of its own in each part between breaks
   * (rows show the longest). One-step methods change nothing but the step; convolution quadrature has the
   * source E x(t-) / h there, Gregory's weights of f from the right, and the same weights at the end of its
   * comb before a break. 0: where h = 0 and no constant step fits all breaks; convolution quadrature always,
   * if breaks are on its mesh. */
  int restart;
  /* Called when row[i] is as it will stay, i = 0, 1, ..., before the verdict: `exact`, `index`, `mesh` and `values` are
   * known then, too. Not 0 ends the measure with STEIF_STOPPED. NULL: not wanted. */
  int (*tell)(size_t i, void *told);
  void *told;
} steif_weak_query;
STEIF_EXPORT int steif_weak_measure(steif_context *ctx, const steif_weak_query *query,
                                    steif_weak_row *row, steif_weak_result *result);

/* The worst case over all test functions: with |g|_m = t1^(m - 1/2) ||g^(m)||_L2(0, t1) for g that vanish
 * with m - 1 derivatives at t1,
 *   sup |<x_h - x, g>| / |g|_m = t1^(1/2 - m) ||I^m (x_h - x)||_L2(0, t1),
 * I^m the m-fold integral from 0-; over several components 2-norms. H^-m holds the impulses of index k from
 * m = k - 1 on, where the order is 1/2 at best; it is p from m = k + p - 1 on. Convergence for every smooth
 * g is convergence in some H^-m.
 *
 * The supremum over the B-splines of degree m on N equal cells that vanish so at t1,
 *   t1^(1/2 - m) (sum over cells N / t1 (int I^m (x_h - x))^2)^(1/2),
 * rises to the norm as N doubles. Cells longer than h do not see the steps. */
typedef struct steif_ball_row {
  sunrealtype h, norm, rounding, order; /* order: NaN where a break of f lies inside a step */
  int usable;                           /* rounding <= 0.1 norm */
  sunrealtype splines;                  /* the supremum over B-splines; NaN: not asked for */
} steif_ball_row;
typedef struct steif_ball_space {
  int m;
  sunrealtype norm, order; /* of the smallest usable step */
  int converges;           /* 1, 0, or -1: undecided */
} steif_ball_space;
enum { STEIF_SPACES = 20 };
typedef struct steif_weak_ball {
  int index, m, count;
  steif_ball_space space[STEIF_SPACES]; /* m = k - 1 .. k + p + 1, p the order of the method */
  char verdict[256];
  int converges;  /* for every smooth g: 1, 0, or -1: undecided */
  char mesh[160]; /* as in steif_weak_result */
} steif_weak_ball;
/* Rows of H^-m (m = 0: k + p - 1) as the query asks for, and orders in all spaces. Of its g only t1
 * counts. For be, bdf, Runge-Kutta methods with regular A and general linear ones with one real shift. */
STEIF_EXPORT int steif_weak_measure_ball(steif_context *ctx, const steif_weak_query *query,
                                         int m, steif_ball_row *row, steif_weak_ball *result);

/* <x_h, g> of one component of a sequence x_0 .. x_m at times t_0 < ... < t_m (x by values of that
 * component) in convention P, R or C; box averages by Gauss quadrature of degree 15. */
STEIF_EXPORT sunrealtype steif_pair(enum steif_convention convention, size_t m,
                                    const sunrealtype *t, const sunrealtype *x);

/* The layer of a run on a Jordan block or another descriptor problem, step by step: steps + 1 rows
 * of t, of the n values x and the smooth part, and of the largest error. */
typedef struct steif_layer_result {
  int layer_steps; /* last step whose error against the smooth part exceeds `threshold` */
  sunrealtype threshold;
  int index; /* of the system */
} steif_layer_result;
STEIF_EXPORT int steif_layer_measure(steif_context *ctx, const char *method,
                                     const char *problem, const char *start, sunrealtype h,
                                     size_t steps, sunrealtype *t, sunrealtype *x,
                                     sunrealtype *exact, sunrealtype *error,
                                     steif_layer_result *result);

/* The same for a system of one's own from x(0-) = x0 at t = 0. */
STEIF_EXPORT int steif_layer_linear(steif_context *ctx, const char *method,
                                    const steif_linear *linear, const sunrealtype *x0,
                                    const char *start, sunrealtype h, size_t steps,
                                    sunrealtype *t, sunrealtype *x, sunrealtype *exact,
                                    sunrealtype *error, steif_layer_result *result);

/* Impulse coefficients from a homogeneous backward Euler run x_1 .. x_{k-1} with step h, exact for
 * every h: c_q = (-1)^q h^{q+1} sum_i C(i-1, q) x_i. x by rows (k-1) x k, c likewise. */
STEIF_EXPORT int steif_binomial_moments(steif_context *ctx, int k, sunrealtype h,
                                        const sunrealtype *x, sunrealtype *c);

#ifdef __cplusplus
}
#endif
#endif
