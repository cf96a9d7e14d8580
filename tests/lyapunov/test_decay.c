/* test_decay.c: what is said of a step: the equation, the numbers, h*. Exponents of the numbers are those of
 * recurrences written down here or, of methods with several stages, of products of their maps over a
 * period made by another program in 50 digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;

static steif_decay searched(const char *problem, const char *method, double h, double t1,
                            int search)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_decay d = {.verdict = -2};
  const steif_lyapunov_options o = {.h = h, .t1 = t1};
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem, &p) == STEIF_OK);
  const int code = steif_decay_find(ctx, &p, method, &o, 0, search, &d);
  if (code) printf("\n  %s %s: %s", problem, method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return d;
}

static steif_decay judged(const char *problem, const char *method, double h, double t1)
{
  return searched(problem, method, h, t1, 0);
}

/* lambda(t) = -1 + 2 cos(20 pi t) at t = j h, h = 0.1/q. */
static double lambda(int q, double j) { return -1 + 2 * cos(2 * pi * j / q); }

static double of_euler(int q)
{
  double sum = 0;
  for (int j = 1; j <= q; j++) sum -= log(fabs(1 - 0.1 / q * lambda(q, j)));
  return sum / 0.1;
}

static double of_rk4(int q)
{
  double sum = 0;
  const double h = 0.1 / q;
  for (int j = 0; j < q; j++) {
    const double k1 = lambda(q, j), k2 = lambda(q, j + 0.5) * (1 + h / 2 * k1),
                 k3 = lambda(q, j + 0.5) * (1 + h / 2 * k2),
                 k4 = lambda(q, j + 1) * (1 + h * k3);
    sum += log(fabs(1 + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)));
  }
  return sum / 0.1;
}

/* Powers of the map of (x_j, x_{j+1}) over a period. */
static double of_bdf2(int q)
{
  enum { PERIODS = 400, LATE = 200 };
  double a = 1, b = 1, sum = 0;
  for (int j = 2; j < PERIODS * q + 2; j++) {
    const double next = (4 * b - a) / 3 / (1 - 2.0 / 3 * 0.1 / q * lambda(q, j));
    const double size = fabs(next);
    if (j >= LATE * q + 2) sum += log(size / fabs(b));
    a = b / size, b = next / size;
  }
  return sum / (0.1 * (PERIODS - LATE));
}

static void exponents_of_the_numbers(void)
{
  static const int parts[] = {1, 2, 3, 4, 8};
  static const struct {
    const char *method;
    double (*mu)(int q);
  } rows[] = {{"be", of_euler}, {"bdf:p=2", of_bdf2}, {"rk4", of_rk4}};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 5; k++) {
      const steif_decay d = judged("aliased", rows[i].method, 0.1 / parts[k], 4);
      CLOSE(d.mu, rows[i].mu(parts[k]), 1e-9);
      CLOSE(d.lambda, -1, 1e-10);
      CHECK(d.lambda_error < 1e-9 && d.mu_error < 1e-9 && d.periodic);
      CHECK(d.turns == (parts[k] <= 4) && (parts[k] > 4 || d.parts == parts[k]));
    }
  CLOSE(of_euler(1), 1.053605157, 1e-9); /* -ln(0.9)/0.1 */
}

static void exponents_of_several_stages(void)
{
  static const struct {
    const char *method;
    double h, mu;
  } rows[] = {{"radau:s=2", 0.1, -1.225336384}, {"radau:s=2", 0.05, -.986548935},
              {"radau:s=3", 0.1, -.969895942},  {"radau:s=3", 0.2, -1.302496},
              {"gauss:s=2", 0.1, -.518762966},  {"gauss:s=2", 0.025, -1.000019980},
              {"gauss:s=3", 0.2, .060363},      {"gauss:s=3", 0.1, -1.047310483},
              {"bdf:p=2", 0.2, 1.011903},       {"rk4", 0.2, .999989}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const steif_decay d = judged("aliased", rows[i].method, rows[i].h, 4);
    CLOSE(d.mu, rows[i].mu, 1e-5);
    CHECK(d.turns == (rows[i].h > 0.15 ? 2 : 1) &&
          (d.mu > 0) == (strstr(d.sentence, "grow") != NULL));
  }
}

/* The trace at the points of the steps equals the sum of the wrong exponents: only what does not depend on
 * the steps sees that they are too long. */
static void a_step_of_one_period_is_too_long(void)
{
  static const char *const methods[] = {"be", "bdf:p=2"};
  for (int i = 0; i < 2; i++) {
    const steif_decay d = judged("aliased", methods[i], 0.1, 200);
    CHECK(d.verdict == STEIF_DECAY_LOST && d.turns == 1 && d.parts == 1);
    CHECK(d.h_good < 0.098 && d.h_good > 0.0977 && d.h_bad > d.h_good && d.h_bad < 0.0981);
    CHECK(d.least == 2 && d.most >= 8 && d.tail);
    CHECK(strstr(d.sentence, "the numbers grow at +1.0") != NULL);
    CHECK(strstr(d.sentence, "h is 1 time(s) the period 0.1 of A") != NULL);
  }
  const steif_decay good = judged("aliased", "be", 0.02, 200);
  CHECK(good.verdict == STEIF_DECAY_KEPT && strstr(good.sentence, "keeps the decay"));
}

/* Beats: a step near the period decays in the end. K of backward Euler at 0.1001 is 7.5e9. */
static void growth_on_the_way_is_seen(void)
{
  const steif_decay d = judged("aliased", "be", 0.1001, 200);
  CHECK(d.verdict == STEIF_DECAY_LOST && d.mu < -0.8 && d.turns == 1);
  CLOSE(d.rise_numbers, log(7.5e9), 1e-2);
  CLOSE_FLOOR(d.rise, 0.0218, 1e-3, 1); /* ln 1.022, between steps of the flow */
  CHECK(strstr(d.sentence, "grow on the way by 7.5e+09") != NULL);
}

/* a = 1.2, b = -0.14, -0.15, beta = 10: with 2 pi/m the numbers grow at m - 1 and decay at m = `least`; any
 * h between the two brackets the border. */
static void the_longest_good_step(void)
{
  static const struct {
    const char *method;
    long least;
    double grows, decays, low, high;
  } rows[] = {{"bdf:p=2", 88, .0016939, -.0000491, .0713, .07148},
              {"radau:s=2", 13, .0130579, -.0081725, .4985, .5},
              {"radau:s=3", 6, .0843496, -.0650682, 1.218, 1.222},
              {"gauss:s=2", 10, .0109166, -.0225205, .6755, .6775},
              {"rk4", 13, .0191069, -.0177402, .5, .51}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const double m = (double)rows[i].least;
    const steif_decay d = judged("steyer", rows[i].method, 2 * pi / (m - 1), 200);
    CHECK(d.verdict == STEIF_DECAY_LOST && d.least == rows[i].least && d.most >= 4 * d.least);
    CLOSE(d.lambda, -0.14, 1e-7);
    CLOSE_FLOOR(d.mu, rows[i].grows, 1e-6, 1);
    CHECK(d.h_good > rows[i].low && d.h_bad < rows[i].high && d.h_bad < d.h_good * 1.002);
    CLOSE_FLOOR(judged("steyer", rows[i].method, 2 * pi / m, 20).mu, rows[i].decays, 1e-6, 1);
    if (i != 2) continue;
    const steif_decay far = searched("steyer", rows[i].method, 2 * pi / 84, 400, 1);
    CHECK(far.verdict == STEIF_DECAY_KEPT && far.least == rows[i].least);
    CHECK(far.h_good > rows[i].low && far.h_bad < rows[i].high);
  }
}

/* ---- no period ---- */

typedef struct constant {
  double a, b, c;
} constant; /* x' = [a b; 0 c] x */

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const constant *s = user;
  const double *x = NV_DATA_S(y);
  (void)t;
  NV_Ith_S(r, 0) = s->a * x[0] + s->b * x[1];
  NV_Ith_S(r, 1) = s->c * x[1];
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector u,
               N_Vector v, N_Vector w)
{
  const constant *s = user;
  (void)t, (void)y, (void)fy, (void)u, (void)v, (void)w;
  SM_ELEMENT_D(J, 0, 0) = s->a, SM_ELEMENT_D(J, 0, 1) = s->b, SM_ELEMENT_D(J, 1, 1) = s->c;
  return 0;
}

/* RK4 is stable on (-2.785293563, 0): h* = 2.785293563/3. */
static void constant_coefficients(void)
{
  static const double y0[] = {1, 1};
  static const struct {
    const char *method;
    constant A;
    double h;
    int verdict;
  } rows[] = {{"rk4", {-1, 2, -3}, 1, STEIF_DECAY_LOST},
              {"rk4", {-1, 2, -3}, 0.2, STEIF_DECAY_KEPT},
              {"be", {-1, 2, -3}, 0.1, STEIF_DECAY_KEPT},
              {"be", {-1, 2, -3}, 1, STEIF_DECAY_LOST}, /* ln 2 instead of 1 */
              {"be", {1, 2, -3}, 4, STEIF_DECAY_LOST},  /* false damping, 1/(1 - h) = -1/3 */
              {"gauss:s=2", {1, 2, -3}, 0.1, STEIF_DECAY_KEPT},
              {"rk4", {0, 1, -1}, 0.1, STEIF_DECAY_UNDECIDED}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    constant A = rows[i].A;
    const steif_problem p = {
      .name = "constant", .n = 2, .t1 = 400, .y0 = y0, .f = f, .jac = jac, .user = &A};
    const steif_lyapunov_options o = {.h = rows[i].h, .transient = 40};
    steif_decay d;
    CHECK(steif_decay_find(ctx, &p, rows[i].method, &o, 0, 0, &d) == STEIF_OK);
    if (d.verdict != rows[i].verdict) printf("\n  %zu: %s", i, d.sentence);
    CHECK(d.verdict == rows[i].verdict && !d.periodic && d.least == 0);
    CLOSE_FLOOR(d.lambda, A.a, 1e-6, 1);
    if (i == 0) CHECK(d.h_good <= 2.785293563 / 3 && d.h_bad >= 2.785293563 / 3);
    if (i == 4) CHECK(strstr(d.sentence, "false damping") != NULL);
  }
  steif_context_free(&ctx);
}

/* What decays a million times as fast as the solution hardly does so in Gauss's method, |R(infinity)| = 1: the
 * exponent of the equation is right within its error, or not known. */
static void fast_components_do_not_lead(void)
{
  static const double y0[] = {1, 1}, rate[] = {1e6, 1e9}, h[] = {0.1, 0.01};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4; i++) {
    constant A = {-1, 1, -rate[i / 2]};
    const steif_problem p = {
      .name = "stiff", .n = 2, .t1 = 20, .y0 = y0, .f = f, .jac = jac, .user = &A};
    const steif_lyapunov_options o = {.h = h[i % 2], .transient = 2};
    steif_decay d;
    CHECK(steif_decay_find(ctx, &p, "radau:s=3", &o, 0, 0, &d) == STEIF_OK);
    CHECK(!isfinite(d.lambda_error) || fabs(d.lambda + 1) <= d.lambda_error + 1e-3);
    CHECK(i > 1 || d.verdict == STEIF_DECAY_KEPT);
    CHECK(d.verdict == STEIF_DECAY_KEPT || d.verdict == STEIF_DECAY_UNDECIDED);
  }
  steif_context_free(&ctx);
}

/* Backward Euler with h = 0.1 of the time 1e9: 5 % off, in any unit of time. */
static void laws_do_not_depend_on_the_unit_of_time(void)
{
  static const double y0[] = {1, 1};
  steif_context *ctx = steif_context_new(NULL);
  for (double unit = 1e-9; unit < 1e10; unit *= 1e9) {
    constant A = {-unit, 2 * unit, -3 * unit};
    double exponent[2], error[2];
    steif_lyapunov_facts facts;
    steif_lyapunov_check check[4];
    int count;
    const steif_problem p = {
      .name = "unit", .n = 2, .t1 = 100 / unit, .y0 = y0, .f = f, .jac = jac, .user = &A};
    const steif_lyapunov_options o = {.h = 0.1 / unit, .error = error};
    CHECK(!steif_lyapunov(ctx, &p, "be", &o, exponent, NULL, &facts));
    CHECK(!steif_lyapunov_verify(ctx, &p, "be", &o, 0, 0, exponent, &facts, check, &count));
    CHECK(count >= 1 && check[0].law == STEIF_SUM_LAW && !check[0].holds);
    CLOSE(check[0].expected, -4 * unit, 1e-9);
  }
  steif_context_free(&ctx);
}

/* Neighbours of x' = A x: -1 and -3 differ by 2 in every window; a complex pair, -0.2 +- 3 i, turns and has no
 * gap; two equal exponents of a diagonal neither. */
static int turning(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector u,
                   N_Vector v, N_Vector w)
{
  (void)t, (void)y, (void)fy, (void)user, (void)u, (void)v, (void)w;
  SM_ELEMENT_D(J, 0, 0) = SM_ELEMENT_D(J, 1, 1) = -0.2;
  SM_ELEMENT_D(J, 0, 1) = 1, SM_ELEMENT_D(J, 1, 0) = -9;
  return 0;
}

static void separation_is_seen(void)
{
  static const double y0[] = {1, 1};
  static const struct {
    constant A;
    steif_jacobian jac;
    int separated;
    double gap;
  } rows[] = {{{-1, 2, -3}, jac, 1, 2}, {{-1, 0, -1}, jac, 0, 0}, {{0, 0, 0}, turning, 0, 0}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) {
    constant A = rows[i].A;
    const steif_problem p = {
      .name = "pair", .n = 2, .t1 = 200, .y0 = y0, .f = f, .jac = rows[i].jac, .user = &A};
    steif_separation pair = {.separated = -1};
    const steif_lyapunov_options o = {
      .h = 0.02, .transient = 30, .linear = 1, .separation = &pair};
    double x[2];
    CHECK(steif_lyapunov(ctx, &p, "gauss:s=3", &o, x, NULL, NULL) == STEIF_OK);
    CHECK(pair.separated == rows[i].separated && pair.low <= pair.high + 1e-12);
    CHECK(pair.low < rows[i].gap + 1e-6 && pair.high > rows[i].gap - 1e-6);
    CHECK(pair.window > (i == 0 ? 2 : 42) && pair.window < (i == 0 ? 3 : 43));
  }
  steif_context_free(&ctx);
}

/* The same, and the period is not told. */
static void a_period_need_not_be_known(void)
{
  static const struct {
    const char *method;
    double h;
    int verdict;
  } rows[] = {{"be", 0.1, STEIF_DECAY_LOST},
              {"be", 0.1001, STEIF_DECAY_LOST},
              {"be", 0.02, STEIF_DECAY_KEPT},
              {"gauss:s=3", 0.2, STEIF_DECAY_LOST},
              {"radau:s=3", 0.1, STEIF_DECAY_KEPT}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "aliased", &p) == STEIF_OK);
  p.period = 0;
  for (int i = 0; i < 5; i++) {
    const steif_lyapunov_options o = {.h = rows[i].h, .t1 = 200};
    steif_decay d;
    CHECK(steif_decay_find(ctx, &p, rows[i].method, &o, 0, 0, &d) == STEIF_OK);
    if (d.verdict != rows[i].verdict) printf("\n  %s: %s", rows[i].method, d.sentence);
    CHECK(d.verdict == rows[i].verdict && d.periodic && d.found);
    CLOSE(d.period, 0.1, 1e-12);
    CHECK(fabs(d.lambda + 1) <= d.lambda_error + 1e-12 && d.lambda_error < 1e-9);
    CLOSE_FLOOR(d.rise, 0.0218, 5e-3, 1);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void what_cannot_be_judged_is_said(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_decay d;
  CHECK(!steif_problem_find(ctx, "aliased", &p));
  steif_lyapunov_options o = {.h = 0.1};
  CHECK(steif_decay_find(ctx, &p, "be", &o, -1, 0, &d) == STEIF_BAD_INPUT);
  CHECK(steif_decay_find(ctx, &p, "be", &o, 0, 0, NULL) == STEIF_BAD_INPUT);
  o.h = 6;
  CHECK(steif_decay_find(ctx, &p, "be", &o, 0, 0, &d) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "take h = 5 or less") != NULL);
  p.n = 65;
  o.h = 0.1;
  CHECK(steif_decay_find(ctx, &p, "be", &o, 0, 0, &d) == STEIF_UNSUPPORTED);
  p.n = 1;
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_decay[] = {
  {"exponents of the numbers are those of the recurrences", exponents_of_the_numbers},
  {"exponents of methods with several stages", exponents_of_several_stages},
  {"a step of one period is too long", a_step_of_one_period_is_too_long},
  {"growth on the way is seen", growth_on_the_way_is_seen},
  {"the longest good step", the_longest_good_step},
  {"constant coefficients", constant_coefficients},
  {"fast components do not lead", fast_components_do_not_lead},
  {"laws do not depend on the unit of time", laws_do_not_depend_on_the_unit_of_time},
  {"integral separation", separation_is_seen},
  {"a period need not be known", a_period_need_not_be_known},
  {"what cannot be judged is said", what_cannot_be_judged_is_said},
  CU_TEST_INFO_NULL};
