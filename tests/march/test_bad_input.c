/* Bad input, one by one: the code, and a sentence with the values and what to do about it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <stdbool.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const char *const methods[] = {"auto",      "radau:s=3", "gauss:s=4",
                                      "dirk:hw43", "rodas4",    "bdf"};
enum { METHODS = sizeof methods / sizeof *methods };

/* What is wrong with the callbacks. */
enum fault {
  NONE,
  F_NAN,
  F_REFUSES,
  F_STOPS,
  F_RESIZES,
  JAC_NAN,
  JAC_STOPS,
  JAC_GROWS,
  JAC_OVERFLOWS
};

typedef struct wrong {
  enum fault fault;
  int calls; /* of the Jacobian */
} wrong;

/* y1' = -5 y1 + 3 t^2 y2^2, y2' = -y2. */
static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const wrong *w = user;
  const double a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  NV_Ith_S(out, 0) = w->fault == F_NAN ? NAN : -5 * a + 3 * t * t * b * b;
  NV_Ith_S(out, 1) = -b;
  if (w->fault == F_RESIZES) NV_LENGTH_S(out) = 1;
  return w->fault == F_REFUSES ? 1 : w->fault == F_STOPS ? -3 : 0;
}

static int dense(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                 N_Vector b, N_Vector c)
{
  const wrong *w = user;
  (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -5, SM_ELEMENT_D(J, 0, 1) = 6 * t * t * NV_Ith_S(y, 1);
  SM_ELEMENT_D(J, 1, 1) = w->fault == JAC_NAN ? NAN : -1;
  return w->fault == JAC_STOPS ? -2 : 0;
}

/* The entry (0, 1) is there behind the start only. */
static int sparse(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                  N_Vector b, N_Vector c)
{
  wrong *w = user;
  sunindextype *from = SM_INDEXPTRS_S(J), *row = SM_INDEXVALS_S(J);
  sunrealtype *value = SM_DATA_S(J);
  (void)fy, (void)a, (void)b, (void)c;
  from[0] = 0, from[1] = 1, row[0] = 0, value[0] = -5;
  if (w->calls++ == 0)
    from[2] = 2, row[1] = 1, value[1] = -1;
  else {
    from[2] = w->fault == JAC_OVERFLOWS ? 9 : 3;
    row[1] = 0, value[1] = 6 * t * t * NV_Ith_S(y, 1), row[2] = 1, value[2] = -1;
  }
  return 0;
}

static const sunrealtype start[] = {0.5, 1};

static steif_problem problem(wrong *w)
{
  const bool thin = w->fault >= JAC_GROWS;
  return (steif_problem){.name = "wrong",
                         .n = 2,
                         .t0 = 1,
                         .t1 = 2,
                         .y0 = start,
                         .f = f,
                         .jac = thin ? sparse : dense,
                         .storage = thin ? STEIF_SPARSE : STEIF_DENSE,
                         .nnz = thin ? 3 : 0,
                         .user = w};
}

/* Making the solver or the first run fails with this code and these words; nothing is lost (the tests
 * run under a leak checker). */
static void fails(enum fault fault, const char *method, int code, const char *words)
{
  wrong w = {.fault = fault};
  const steif_problem p = problem(&w);
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, &p, method, NULL);
  const int found = s ? steif_solve_to(s, 2) : steif_status(ctx);
  if (found != code || !strstr(steif_message(ctx), words))
    printf("\n  fault %d, %s: %d, %s", fault, method, found, steif_message(ctx));
  CHECK(found == code && strstr(steif_message(ctx), words));
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void callbacks_that_fail_are_named(void)
{
  for (int m = 0; m < METHODS; m++) {
    fails(F_NAN, methods[m], STEIF_NOT_FINITE,
          "component 1 of f of problem 'wrong' is not finite at the start, t = 1: correct");
    fails(F_REFUSES, methods[m], STEIF_CALLBACK, "f of problem 'wrong' could not be evaluated");
    fails(F_STOPS, methods[m], STEIF_CALLBACK, "(it returned -3)");
    fails(F_RESIZES, methods[m], STEIF_BAD_INPUT,
          "gave a vector back with 1 components, it had 2: callbacks fill vectors and never");
    fails(JAC_STOPS, methods[m], STEIF_CALLBACK,
          "jac of problem 'wrong' stopped the run at t = 1");
    if (m != 3) /* which keeps the Jacobian of the start */
      fails(JAC_OVERFLOWS, methods[m], STEIF_BAD_INPUT,
            "jac of problem 'wrong' filled 9 entries into room for 3: correct .nnz");
  }
}

static void jacobians_of_nan_are_not_called_singular(void)
{
  for (int m = 0; m < METHODS; m++) {
    const bool lanes = m < 3 || m == 4;
    fails(
      JAC_NAN, methods[m], STEIF_NOT_FINITE,
      lanes
        ? "the derivative of e2 with respect to y2 in the Jacobian of problem 'wrong' is nan"
        : "entry (2, 2) of A is nan: look at the function that fills it");
  }
}

/* Where there is room, entries may come and go. */
static void patterns_may_change(void)
{
  for (int m = 0; m < METHODS; m++) {
    wrong w = {.fault = JAC_GROWS}, none = {.fault = NONE};
    const steif_problem p = problem(&w), q = problem(&none);
    steif_context *ctx = steif_context_new(NULL);
    steif_solver *a = smooth_open(ctx, &p, methods[m], NULL),
                 *b = smooth_open(ctx, &q, methods[m], NULL);
    CHECK(!steif_solve_to(a, 2) && !steif_solve_to(b, 2));
    CLOSE(NV_Ith_S(steif_solution(a), 0), NV_Ith_S(steif_solution(b), 0), 1e-5);
    steif_solver_free(&a), steif_solver_free(&b);
    steif_context_free(&ctx);
  }
}

/* The start is shown at t0; nothing lies before it, and what lies before the last step is gone. */
static void times_before_are_refused(void)
{
  static const double bad[] = {0.5, 1 - 1e-9, -INFINITY, NAN, 2.5};
  for (int m = 0; m < METHODS; m++) {
    wrong w = {.fault = NONE};
    const steif_problem p = problem(&w);
    steif_context *ctx = steif_context_new(NULL);
    steif_solver *s = smooth_open(ctx, &p, methods[m], NULL);
    CHECK(!steif_solve_to(s, 1) && NV_Ith_S(steif_solution(s), 0) == start[0]);
    for (int i = 0; i < 5; i++) {
      CHECK(steif_solve_to(s, bad[i]) == STEIF_BAD_INPUT);
      CHECK(
        strstr(steif_message(ctx), "outside the interval [1, 2] of the run: set options.t1"));
    }
    CHECK(!steif_solve_to(s, 1.9));
    CHECK(steif_solve_to(s, 1) == STEIF_BAD_INPUT);
    CHECK(strstr(steif_message(ctx), "outside the last step"));
    CHECK(!steif_solve_to(s, 2)); /* nothing is lost */
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* Five rows of a chain, whose first equation hears the last unknown against its pattern. */
enum { N = 5 };
static int chain(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < N; i++) NV_Ith_S(out, i) = -NV_Ith_S(y, i);
  NV_Ith_S(out, 0) += 0.3 * NV_Ith_S(y, N - 1);
  return 0;
}

static const sunindextype diagonal_column[] = {0, 1, 2, 3, 4, 5},
                          diagonal_row[] = {0, 1, 2, 3, 4};
static const steif_pattern diagonal = {diagonal_column, diagonal_row};

/* y at t of the same problem stored dense and sparse agree, whatever the pattern misses. */
static void as_dense(const steif_problem *sparse, const char *method, sunrealtype t)
{
  steif_problem p[2] = {*sparse, *sparse};
  sunrealtype y[2][N];
  p[1].storage = STEIF_DENSE;
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = 1e-8;
    steif_solver *s = smooth_open(ctx, &p[k], method, &o);
    const int code = s ? steif_solve_to(s, t) : -1;
    if (code) printf("\n  %s: %s", method, steif_message(ctx));
    CU_ASSERT_FATAL(!code);
    memcpy(y[k], N_VGetArrayPointer(steif_solution(s)), sizeof y[k]);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
  for (int i = 0; i < N; i++) CLOSE_FLOOR(y[0][i], y[1][i], 1e-5, 1);
}

static void missing_entries_are_found(void)
{
  static const sunrealtype y0[] = {1, 2, 3, 4, 5};
  const steif_problem p = {.name = "chain",
                           .n = N,
                           .t1 = 1,
                           .y0 = y0,
                           .f = chain,
                           .storage = STEIF_SPARSE,
                           .pattern = &diagonal};
  static const char *const solvers[] = {"radau:s=3", "bdf", "rodas4", "cvode", "ida", "arkode"};
  for (int m = 0; m < 6; m++) as_dense(&p, solvers[m], 1);
}

/* The derivative by the last unknown is 0 at the start only: a later Jacobian finds it. */
static int awakes(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double last = NV_Ith_S(y, N - 1);
  chain(t, y, out, user);
  NV_Ith_S(out, 0) = -200 * (NV_Ith_S(y, 0) - last * last * last);
  NV_Ith_S(out, N - 1) = 2 * cos(t);
  return 0;
}

static void entries_that_come_later_are_found(void)
{
  static const sunrealtype y0[N] = {0};
  const steif_problem p = {.name = "late",
                           .n = N,
                           .t1 = 9,
                           .y0 = y0,
                           .f = awakes,
                           .storage = STEIF_SPARSE,
                           .pattern = &diagonal};
  static const char *const solvers[] = {"auto", "radau:s=5", "gauss:s=3", "rodas4",
                                        "bdf",  "cvode",     "ida",       "arkode"};
  for (int m = 0; m < 8; m++) as_dense(&p, solvers[m], 9);
}

/* Rounding is no missing entry where the terms of a row cancel along the probe, which would be looked for
 * column by column. */
enum { GRID = 400 };
static int spread(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *r = N_VGetArrayPointer(out);
  (void)t, ++*(int *)user;
  for (int i = 0; i < GRID; i++) {
    const double left = u[i ? i - 1 : 0], right = u[i < GRID - 1 ? i + 1 : i];
    const volatile double rounded = 1e8 + 9876.54 * (left - u[i] + (right - u[i]));
    r[i] = rounded - 1e8;
  }
  return 0;
}

static void probes_cost_a_few_evaluations(void)
{
  sunrealtype y0[GRID];
  int calls = 0;
  for (int i = 0; i < GRID; i++) y0[i] = 1;
  const steif_problem p = {.name = "spread",
                           .n = GRID,
                           .t1 = 1,
                           .y0 = y0,
                           .f = spread,
                           .storage = STEIF_BAND,
                           .lower = 1,
                           .upper = 1,
                           .user = &calls};
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
  CHECK(calls < 50);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* A method of order 2 would need errors of 1e-18 in a step. */
static void tolerances_beyond_a_method_are_refused(void)
{
  steif_options o = steif_defaults();
  o.rtol = 1e-10;
  smooth_refused(&smooth, "dirk:trbdf2", &o, STEIF_UNSUPPORTED,
                 "'trbdf2' of order 2 cannot keep rtol = 1e-10");
}

/* No solver: what a caller who did not look gets. */
static void no_solver_is_no_crash(void)
{
  int count = 3;
  const sunrealtype *c, *b;
  N_Vector *X;
  CHECK(steif_solution(NULL) == NULL && steif_method_used(NULL) == NULL);
  CHECK(isnan(steif_time(NULL)));
  CHECK(steif_statistics(NULL)->steps == 0);
  CHECK(steif_solve_to(NULL, 1) == STEIF_BAD_INPUT &&
        steif_solve_step(NULL) == STEIF_BAD_INPUT);
  CHECK(steif_dense(NULL, 0, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_drift_now(NULL, &count, NULL) == STEIF_OK && count == 0);
  count = 3;
  CHECK(steif_stages(NULL, &count, &c, &b, &X) == STEIF_OK && count == 0);
}

/* An interval of 1e-320 has no steps; one of 1e-270 has. */
static void intervals_may_be_short(void)
{
  static const double y0[] = {1, 1};
  wrong w = {NONE, 0};
  const steif_problem p = {
    .name = "short", .n = 2, .t1 = 1, .y0 = y0, .f = f, .jac = dense, .user = &w};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    steif_options o = steif_defaults();
    o.t1 = 1e-320;
    steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
    CHECK(!s && steif_status(ctx) == STEIF_BAD_INPUT &&
          strstr(steif_message(ctx), "unit of time"));
    o.t1 = 1e-270;
    s = steif_solver_new(ctx, &p, methods[m], &o);
    CHECK(s && steif_solve_to(s, o.t1) == STEIF_OK && steif_time(s) == o.t1);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_bad_input[] = {
  {"no solver is no crash", no_solver_is_no_crash},
  {"intervals may be short", intervals_may_be_short},
  {"callbacks that fail are named", callbacks_that_fail_are_named},
  {"Jacobians of NaN are not called singular", jacobians_of_nan_are_not_called_singular},
  {"patterns may change", patterns_may_change},
  {"times before are refused", times_before_are_refused},
  {"missing entries are found", missing_entries_are_found},
  {"entries that come later are found", entries_that_come_later_are_found},
  {"probes cost a few evaluations", probes_cost_a_few_evaluations},
  {"tolerances beyond a method are refused", tolerances_beyond_a_method_are_refused},
  CU_TEST_INFO_NULL};
