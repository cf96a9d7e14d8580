/* test_supervisor.c: supervised steps keep x' = A(t) x of Steyer and Van Vleck (arXiv 1709.02059,
 * equation (3)) decaying where error control does not, and leave easy problems alone.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <steif/supervisor.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;
/* The errors of BDF are kept below a tenth of these. */
static const double tolerance[] = {0.99, 1e-1, 1e-2, 5e-3, 3e-3, 2e-3, 1e-3, 1e-5};
enum { TOLERANCES = 8, HARD = 4 };

/* Exponents b1 and b2; the rate asserted is |b1| / 4. */
static const struct hard {
  const char *problem;
  double rate;
} hard[HARD] = {{"steyer:a=1.2,b1=-0.14,b2=-0.15,beta=10", 0.035},
                {"steyer:a=1.45,b1=-0.05,b2=-0.055,beta=1", 0.0125},
                {"steyer:a=1.75,b1=-0.05,b2=-0.055,beta=1", 0.0125},
                {"steyer:a=2.05,b1=-0.05,b2=-0.055,beta=1", 0.0125}};

static steif_supervised run(const char *problem, const char *method, double rtol, double t1,
                            steif_supervision how, double *y)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_supervised facts = {.mu = NAN};
  steif_problem p;
  const steif_options o = {.rtol = rtol, .t1 = t1, .h0 = 1e-3};
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem, &p) == STEIF_OK);
  how.window = 4 * pi; /* two periods */
  const int code = steif_supervise(ctx, &p, method, &o, &how, y, &facts);
  if (code) printf("\n  %s, %s: %s", problem, method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return facts;
}

/* The windows of a run: ln |w| at the end of one is that of the one before and mu times its length. */
typedef struct windows {
  long count;
  double t, log, off;
} windows;

static int add_up(const steif_supervised_window *w, void *user)
{
  windows *all = user;
  all->off = fmax(all->off, fabs(w->log - all->log - w->mu * (w->t - all->t)));
  all->t = w->t;
  all->log = w->log;
  all->count++;
  return 0;
}

static void growth_adds_up(void)
{
  windows all = {0};
  const steif_supervised kept =
    run(hard[0].problem, "bdf:p=2", 1e-1, 200,
        (steif_supervision){.rate = hard[0].rate, .tell = add_up, .user = &all}, NULL);
  CHECK(all.count == kept.windows && all.count > 10);
  CHECK(all.log < -0.9 * hard[0].rate * 200);
  CHECK(all.off <= 1e-12 * fabs(all.log));
}

static double attempts(const steif_supervised *f)
{
  return (double)(f->cost.steps + f->cost.rejected);
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Every one of the 32 runs decays; error control alone fails for large tolerances; the median cost is
 * at most 3 times the cheapest run of it that decays. */
static void hard_runs_decay(void)
{
  double ratio[HARD * TOLERANCES];
  int grown = 0;
  for (int k = 0; k < HARD; k++) {
    double cost[TOLERANCES], cheapest = INFINITY;
    for (int i = 0; i < TOLERANCES; i++) {
      const steif_supervised alone =
        run(hard[k].problem, "bdf:p=2", tolerance[i], 200,
            (steif_supervision){.rule = STEIF_SUPERVISE_NONE}, NULL);
      const steif_supervised kept = run(hard[k].problem, "bdf:p=2", tolerance[i], 200,
                                        (steif_supervision){.rate = hard[k].rate}, NULL);
      CHECK(kept.mu < 0 && kept.direct && kept.unresolved == 0);
      CHECK(alone.triggers == 0 && alone.redone == 0);
      if (alone.mu < 0) cheapest = fmin(cheapest, attempts(&alone));
      if (i == 0) CHECK(alone.mu > 0.05 && kept.triggers > 0 && kept.redone > 0);
      grown += alone.mu > 0;
      cost[i] = attempts(&kept);
    }
    for (int i = 0; i < TOLERANCES; i++) ratio[k * TOLERANCES + i] = cost[i] / cheapest;
  }
  CHECK(grown >= 2 * HARD);
  qsort(ratio, HARD * TOLERANCES, sizeof *ratio, ascending);
  CHECK(ratio[HARD * TOLERANCES / 2] <= 3);
}

static void long_runs_decay(void)
{
  for (int k = 0; k < HARD; k++)
    for (int i = 0; i < 3; i++) {
      const steif_supervised kept = run(hard[k].problem, "bdf:p=2", tolerance[i], 1000,
                                        (steif_supervision){.rate = hard[k].rate}, NULL);
      /* the second half cuts windows, which decay by the rate as a whole */
      CHECK(kept.mu < -0.9 * hard[k].rate && kept.windows == 80);
    }
}

static void other_methods_decay_too(void)
{
  static const char *const methods[] = {"be", "bdf", "dirk:hw43", "radau:s=3", "rodas4"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    CHECK(
      run(hard[0].problem, methods[m], 1e-1, 200, (steif_supervision){.rate = 0.035}, NULL).mu <
      0);
}

static void easy_problems_are_left_alone(void)
{
  for (int i = 0; i < TOLERANCES; i++) {
    const char *easy = "steyer:a=1.2,b1=-0.5,b2=-0.8,beta=1";
    double a[2], b[2];
    const steif_supervised alone = run(easy, "bdf:p=2", tolerance[i], 200,
                                       (steif_supervision){.rule = STEIF_SUPERVISE_NONE}, a);
    for (int rule = STEIF_SUPERVISE_WINDOWS; rule <= STEIF_SUPERVISE_SUM; rule++) {
      const steif_supervised kept =
        run(easy, "bdf:p=2", tolerance[i], 200,
            (steif_supervision){.rule = (enum steif_supervision_rule)rule, .rate = 0.125}, b);
      CHECK(kept.triggers == 0 && kept.redone == 0 && isinf(kept.cap));
      CHECK(kept.cost.steps == alone.cost.steps && kept.mu == alone.mu);
      CHECK(a[0] == b[0] && a[1] == b[1]);
    }
  }
}

/* x(t) = e^{a sin t + b1 t} (cos t, sin t): y, its growth over [100, 200] and the peak of it. */
static void the_solution_comes_with_it(void)
{
  double y[2];
  const steif_supervised f =
    run(hard[2].problem, "radau:s=3", 1e-10, 200, (steif_supervision){.rate = 0.0125}, y);
  const double size = exp(1.75 * sin(200) - 0.05 * 200);
  CLOSE(y[0], size * cos(200), 1e-7);
  CLOSE(y[1], size * sin(200), 1e-7);
  CLOSE_FLOOR(f.mu, (1.75 * (sin(200) - sin(100)) - 0.05 * 100) / 100, 1e-3, 1);
  CLOSE(f.peak, 1.75 * sin(pi / 2) - 0.05 * pi / 2, 2e-2); /* near t = pi/2 */
}

static void the_sum_bounds_the_growth_between(void)
{
  const steif_supervision how = {.rule = STEIF_SUPERVISE_SUM, .rate = 0.035};
  const steif_supervised kept = run(hard[0].problem, "bdf:p=2", tolerance[0], 200, how, NULL),
                         alone = run(hard[0].problem, "bdf:p=2", tolerance[0], 200,
                                     (steif_supervision){.rule = STEIF_SUPERVISE_NONE}, NULL);
  CHECK(kept.triggers >= 2 && kept.redone == 0 && isfinite(kept.cap));
  CHECK(kept.mu < 0 && alone.peak > 100 && kept.peak < 20);
}

/* -- beside a nonlinear problem: u' = A u - |u|^2 u + (1, 0), A = [[-1, 12], [0, -6]] -------- */

static const double start[] = {0.7, -0.3};

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), q = u * u + v * v;
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -u + 12 * v - q * u + 1;
  NV_Ith_S(r, 1) = -6 * v - q * v;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), q = u * u + v * v;
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -1 - q - 2 * u * u;
  SM_ELEMENT_D(J, 0, 1) = 12 - 2 * u * v;
  SM_ELEMENT_D(J, 1, 0) = -2 * u * v;
  SM_ELEMENT_D(J, 1, 1) = -6 - q - 2 * v * v;
  return 0;
}

static const steif_problem cubic = {
  .name = "cubic", .n = 2, .t1 = 40, .y0 = start, .f = f, .jac = jac};

/* At rest u + u^3 = 1: u = .6823278038280193; the slowest rate there is 1 + 3 u^2. */
static void nonlinear_problems_are_followed(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_options o = {.rtol = 1e-8};
  const steif_supervision how = {.rate = 0.25, .window = 2};
  static const char *const methods[] = {"bdf", "radau:s=3", "dirk:hw43", "gauss:s=9"};
  const double u = 0.6823278038280193;
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_supervised facts = {.mu = NAN};
    double y[2] = {NAN, NAN};
    CHECK(steif_supervise(ctx, &cubic, methods[m], &o, &how, y, &facts) == STEIF_OK);
    CHECK(!facts.direct && facts.redone == 0 && facts.windows == 20);
    CLOSE(y[0], u, 1e-6);
    CLOSE_FLOOR(y[1], 0, 1e-6, 1);
    CLOSE(facts.mu, -(1 + 3 * u * u), 1e-4);
  }
  static const char *const exact[] = {"rodas4", "exprb32", "auto"};
  for (int i = 0; i < 3; i++) {
    CHECK(steif_supervise(ctx, &cubic, exact[i], &o, &how, NULL, NULL) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(ctx), "second derivatives"));
  }
  steif_context_free(&ctx);
}

/* -- what is rejected --------------------------------------------------------------------- */

static void growth_of_the_problem_is_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  const steif_options o = {.rtol = 1e-4, .t1 = 20};
  const steif_supervision how = {.rate = 1, .window = 2, .redo = 3};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &p) == STEIF_OK);
  CHECK(steif_supervise(ctx, &p, "radau:s=3", &o, &how, NULL, NULL) == STEIF_NOT_CERTIFIED);
  CHECK(strstr(steif_message(ctx), "'lorenz' grows in 4 windows in a row"));
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static int stop(const steif_supervised_window *window, void *user)
{
  *(double *)user = window->t;
  return window->t > 5;
}

static void nonsense_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_options plain = {.rtol = 1e-4}, equal = {.h = 0.1};
  steif_problem none = cubic;
  none.jac = NULL;
  double t = 0;
  const struct {
    const steif_problem *p;
    const char *method, *words;
    const steif_options *o;
    steif_supervision how;
    int code;
  } row[] = {
    {&cubic, "bdf", "rate 0", &plain, {.window = 2}, STEIF_BAD_INPUT},
    {&cubic, "bdf", "window 0", &plain, {.rate = 1}, STEIF_BAD_INPUT},
    {&cubic, "bdf", "run of 40", &plain, {.rate = 1, .window = 41}, STEIF_BAD_INPUT},
    {&cubic,
     "bdf",
     "shrink = 2",
     &plain,
     {.rate = 1, .window = 2, .shrink = 2},
     STEIF_BAD_INPUT},
    {&cubic, "bdf", "leave out h", &equal, {.rate = 1, .window = 2}, STEIF_UNSUPPORTED},
    {&cubic, "bfd", "no method 'bfd'", &plain, {.rate = 1, .window = 2}, STEIF_UNKNOWN_NAME},
    {&cubic, "rk4", "no error estimate", &plain, {.rate = 1, .window = 2}, STEIF_UNSUPPORTED},
    {&none, "bdf", ".jac", &plain, {.rate = 1, .window = 2}, STEIF_UNSUPPORTED},
    {&cubic,
     "bdf",
     "t = 6",
     &plain,
     {.rate = 1, .window = 2, .tell = stop, .user = &t},
     STEIF_CALLBACK},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const int code =
      steif_supervise(ctx, row[i].p, row[i].method, row[i].o, &row[i].how, NULL, NULL);
    if (code != row[i].code || !strstr(steif_message(ctx), row[i].words))
      printf("\n  row %zu: %d, %s", i, code, steif_message(ctx));
    CHECK(code == row[i].code);
    CHECK(strstr(steif_message(ctx), row[i].words));
  }
  CLOSE(t, 6, 0.1); /* the first step that ends after it */
  steif_context_free(&ctx);
}

static void short_memory_is_told(void)
{
  const steif_options o = {.rtol = 1e-3};
  const steif_supervision how = {.rate = 0.25, .window = 20};
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code != STEIF_OK && k < 1000; k++) {
    failing f = {0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    f.refuse_at = f.served + k;
    code = steif_supervise(ctx, &cubic, "bdf", &o, &how, NULL, NULL);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
  CHECK(code == STEIF_OK);
}

CU_TestInfo tests_of_supervisor[] = {
  {"growth in windows adds up", growth_adds_up},
  {"hard runs decay", hard_runs_decay},
  {"long runs decay", long_runs_decay},
  {"other methods decay too", other_methods_decay_too},
  {"easy problems are left alone", easy_problems_are_left_alone},
  {"the solution comes with it", the_solution_comes_with_it},
  {"the sum bounds the growth between", the_sum_bounds_the_growth_between},
  {"nonlinear problems are followed", nonlinear_problems_are_followed},
  {"growth of the problem is told", growth_of_the_problem_is_told},
  {"nonsense is rejected", nonsense_is_rejected},
  {"short memory is told", short_memory_is_told},
  CU_TEST_INFO_NULL};
