/* Steps whose systems are solved by GMRES: beside direct solves, by counts, and what stops them. The
 * problem is the Brusselator on a periodic square, J = reaction + 0.1 N^2 times the five-point star.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "smooth.h"
#include <stdbool.h>

static steif_context *ctx;
static steif_problem square;

static void begin(const char *name)
{
  ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &square));
}

static void end(void)
{
  steif_problem_clear(ctx, &square);
  steif_context_free(&ctx);
}

/* The callbacks below as they were called, and what they are to return. */
static struct {
  long setups, solves, refuse_at;
  int answer;
  double c, largest;
  bool rotates;
} seen;

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  (void)t, (void)y, (void)yp, (void)r, (void)user;
  seen.setups++, seen.c = c, seen.largest = fmax(seen.largest, c);
  return seen.refuse_at < 0 ? seen.answer : 0;
}

/* The diagonal of c - J without reactions; or the cyclic shift, on which GMRES stalls. */
static int solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  const sunindextype n = NV_LENGTH_S(b);
  const double side2 = (double)n / 2;
  (void)t, (void)y, (void)yp, (void)r, (void)delta, (void)user;
  CHECK(c > 0.3 * seen.c && c < 3 * seen.c); /* IDA tells its c of the moment */
  for (sunindextype i = 0; i < n; i++)
    NV_Ith_S(z, i) = NV_Ith_S(b, seen.rotates ? (i + 1) % n : i) / (c + 0.4 * side2);
  return ++seen.solves == seen.refuse_at ? seen.answer : 0;
}

/* The square without matrices. */
static steif_problem bare(void)
{
  steif_problem p = square;
  p.storage = STEIF_KRYLOV, p.jac = NULL, p.L = NULL, p.pattern = NULL, p.nnz = 0;
  p.precsetup = setup, p.precsolve = solve;
  memset(&seen, 0, sizeof seen);
  return p;
}

static double digits(steif_solver *s, const steif_problem *p)
{
  sunrealtype scd = -99, mescd;
  CHECK(!steif_solve_to(s, p->t1));
  if (steif_status(ctx)) printf("\n  %s", steif_message(ctx));
  CHECK(!steif_problem_digits(ctx, p, p->t1, steif_solution(s), 1, &scd, &mescd));
  return scd;
}

/* Without a step more for the digits that come out, which are more by bdf, of order 5 here, and with fewer iterations of
 * Newton, since products follow every shift. */
static void as_good_as_direct(void)
{
  static const char *const methods[] = {"bdf", "radau:s=3"};
  begin("bruss2d:n=16");
  for (int m = 0; m < 2; m++) {
    steif_options o = steif_defaults();
    o.rtol = 1e-5;
    steif_solver *direct = smooth_open(ctx, &square, methods[m], &o);
    o.storage = STEIF_KRYLOV, o.force_storage = 1;
    steif_solver *krylov = smooth_open(ctx, &square, methods[m], &o);
    const double wanted = digits(direct, &square), scd = digits(krylov, &square);
    CHECK(scd > wanted - 0.3 && scd > 4);
    const steif_stats *d = steif_statistics(direct), *k = steif_statistics(krylov);
    CHECK(d->nli == 0 && 2 * k->nli > k->nsolve && k->nli < 4 * k->nsolve);
    const double worth = m == 0 ? pow(10, (scd - wanted) / 5) : 1;
    CHECK((double)k->steps < 1.1 * worth * (double)d->steps);
    CHECK(k->nlu > 0 && 2 * k->nlu < 3 * d->nlu); /* made about as often as factors */
    if (m == 0) CHECK((double)k->nfe < 0.8 * worth * (double)d->nfe);
    steif_solver_free(&direct), steif_solver_free(&krylov);
  }
  end();
}

/* Equal steps: one aim, 1e-13 of y, so the same numbers. */
static void equal_steps_agree(void)
{
  static const char *const methods[] = {"bdf:p=3", "dirk:alexander2", "radau:s=3"};
  begin("bruss2d:n=8");
  for (int m = 0; m < 3; m++) {
    steif_options o = steif_defaults();
    o.h = 0.02, o.t1 = 0.2;
    steif_solver *direct = smooth_open(ctx, &square, methods[m], &o);
    o.storage = STEIF_KRYLOV, o.force_storage = 1;
    steif_solver *krylov = smooth_open(ctx, &square, methods[m], &o);
    CHECK(!steif_solve_to(direct, 0.2) && !steif_solve_to(krylov, 0.2));
    for (int i = 0; i < 128; i += 9)
      CLOSE_FLOOR(NV_Ith_S(steif_solution(krylov), i), NV_Ith_S(steif_solution(direct), i),
                  1e-11, 1);
    CHECK(steif_statistics(krylov)->nli > 0);
    steif_solver_free(&direct), steif_solver_free(&krylov);
  }
  end();
}

/* The largest difference to a run by factors a thousand times as exact, behind the break of f. */
static double off(steif_solver *s, sunrealtype t)
{
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  steif_solver *exact = smooth_open(ctx, &square, "radau:s=5", &o);
  CHECK(!steif_solve_to(s, t) && !steif_solve_to(exact, t));
  N_Vector d = N_VClone(steif_solution(s));
  N_VLinearSum(1, steif_solution(s), -1, steif_solution(exact), d);
  const double most = N_VMaxNorm(d);
  N_VDestroy(d);
  steif_solver_free(&exact);
  return most;
}

static void by_callbacks_and_differences(void)
{
  static const char *const methods[] = {"bdf", "cvode", "arkode", "ida"};
  begin("bruss2d:n=8");
  for (int m = 0; m < 4; m++) {
    steif_problem p = bare();
    steif_options o = steif_defaults();
    o.rtol = 1e-5;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(off(s, 2) < 1e-3);
    const steif_stats *n = steif_statistics(s);
    CHECK(seen.solves > n->nli && n->nli > 0);
    CHECK(seen.setups > 0 && seen.setups < n->steps);
    CHECK(seen.largest > 50);
    if (m == 0) CHECK(n->nlu == seen.setups && n->nfe > n->nli);
    steif_solver_free(&s);
  }
  end();
}

/* y' = f without a preconditioner; a callback that cannot once makes a step smaller. */
static void without_and_recovered(void)
{
  begin("bruss2d:n=8");
  for (int k = 0; k < 2; k++) {
    steif_problem p = bare();
    if (!k) p.precsolve = NULL;
    seen.refuse_at = 700, seen.answer = 1;
    steif_options o = steif_defaults();
    o.rtol = 1e-5;
    steif_solver *s = smooth_open(ctx, &p, "bdf", &o);
    CHECK(off(s, 2) < 1e-4);
    CHECK(k ? seen.solves > 700 : seen.solves == 0);
    steif_solver_free(&s);
  }
  end();
}

static void what_stops_it(void)
{
  static const struct {
    long refuse_at;
    int answer, code;
    bool rotates;
    const char *words;
  } rows[] = {
    {50, -3, STEIF_CALLBACK, false, "the preconditioner of the operator returned -3"},
    {-1, -2, STEIF_CALLBACK, false, "preparing the preconditioner"},
    {-1, 2, STEIF_CALLBACK, false, "preparing the preconditioner"},
    {0, 0, STEIF_NO_CONVERGENCE, true, "GMRES left a residual"},
  };
  begin("bruss2d:n=4");
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    steif_problem p = bare();
    seen.refuse_at = rows[k].refuse_at, seen.answer = rows[k].answer;
    seen.rotates = rows[k].rotates;
    steif_options o = steif_defaults();
    o.rtol = 1e-4;
    steif_solver *s = smooth_open(ctx, &p, "bdf", &o);
    CHECK(steif_solve_to(s, p.t1) == rows[k].code);
    if (!strstr(steif_message(ctx), rows[k].words)) printf("\n  %s", steif_message(ctx));
    CHECK(strstr(steif_message(ctx), rows[k].words) != NULL);
    steif_solver_free(&s);
  }
  end();
}

static int descend(steif_context *c)
{
  steif_problem p;
  if (steif_problem_find(c, "bruss2d:n=4", &p)) return steif_status(c);
  steif_options o = steif_defaults();
  o.rtol = 1e-3, o.storage = STEIF_KRYLOV, o.force_storage = 1, o.t1 = 0.01;
  steif_solver *s = steif_solver_new(c, &p, "bdf", &o);
  const int code = s ? steif_solve_to(s, o.t1) : steif_status(c);
  steif_solver_free(&s);
  steif_problem_clear(c, &p);
  return code;
}

static void short_memory(void)
{
  int code = STEIF_NO_MEMORY;
  long k = 0;
  while (code == STEIF_NO_MEMORY && k < 1000) {
    failing f = {.refuse_at = ++k};
    const steif_setup given = failing_setup(&f);
    steif_context *c = steif_context_new(&given);
    code = c ? descend(c) : STEIF_NO_MEMORY;
    steif_context_free(&c);
    CHECK(f.alive == 0);
  }
  CHECK(code == STEIF_OK && k > 40);
}

CU_TestInfo tests_of_krylov[] = {
  {"ILU(0) and GMRES are as good as factors", as_good_as_direct},
  {"equal steps give the numbers of factors", equal_steps_agree},
  {"preconditioners by callbacks, products by differences", by_callbacks_and_differences},
  {"no preconditioner; one that cannot once", without_and_recovered},
  {"what stops a run says so", what_stops_it},
  {"short memory", short_memory},
  CU_TEST_INFO_NULL,
};
