/* test_growth.c: BDF2 on the problem of Steyer and Van Vleck: growth, defects, residuals.
 *
 * Reference values: the recurrence in double with the closed fundamental matrix, and a second
 * time in 40 digits with LU solves and Gauss quadrature; x_1 by the classical Runge-Kutta
 * method. mu_last of h = 0.00075: the recurrence in 30 digits.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <string.h>

static int measure(const char *problem, const char *method, double h, double t1,
                   steif_growth_facts *facts, char *message)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_lyapunov_options o = {.h = h, .t1 = t1};
  steif_problem p;
  int code = steif_problem_find(ctx, problem, &p);
  if (code == STEIF_OK) {
    code = steif_growth_measure(ctx, &p, method, &o, facts);
    steif_problem_clear(ctx, &p);
  }
  snprintf(message, 400, "%s", steif_message(ctx));
  steif_context_free(&ctx);
  return code;
}

static const struct row {
  const char *problem;
  double h;
  int steps;
  double mean, max, mu, mu_last, residual, residual_max, tau, norm, end;
} rows[] = {
  {"steyer", 0.75, 53, 4.128571e5, 3.812720e6, .4829992, .3638650, 9.582e-2, .8402, 62.1,
   1.2491e6, 1.06237e6},
  {"steyer", 0.075, 533, 4.700390e-4, 2.088722e-3, .01433958, .002206331, 1.2549e-4, 1.1567e-3,
   1.1511, 2.6578, 1.1242},
  {"steyer", 0.0075, 5333, 1.901443e-7, 1.741899e-6, -.07961949, -.1143704, 1.2600e-7,
   1.1607e-6, 1.0104, 2.6862, 1.0356e-2},
  {"steyer", 0.00075, 53333, 1.890493e-10, 1.738487e-9, -.08115292, -.1176177838691, 1.2602e-10,
   1.1607e-9, 1.0010, 2.6866, 9.05678e-3},
  {"steyer:a=1.15,b1=-0.05,b2=-0.055,beta=1", 0.05, 2000, 6.589222e-5, 5.383358e-4, -.01409366,
   -.03629600, 3.5397e-5, 3.6100e-4, 1.0685, 2.9095, .0259481},
  {"steyer:a=1.45,b1=-0.05,b2=-0.055,beta=1", 0.05, 2000, 1.428557e-4, 8.841968e-4, .004440235,
   -.02421237, 5.4225e-5, 5.9022e-4, 1.0857, 3.9270, .0862852},
  {"steyer:a=1.75,b1=-0.05,b2=-0.055,beta=1", 0.05, 2000, 3.450986e-4, 1.420003e-3, .02232313,
   -.01336907, 8.1448e-5, 9.4420e-4, 1.1057, 5.3027, .253506},
  {"steyer:a=2.05,b1=-0.05,b2=-0.055,beta=1", 0.05, 2000, 9.333316e-4, 4.570511e-3, .03981980,
   -.003074688, 1.2072e-4, 1.4860e-3, 1.1261, 14.606, .705120},
};

static void published_tables(void)
{
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const struct row *r = &rows[i];
    steif_growth_facts g = {0};
    char message[400];
    CHECK(measure(r->problem, "bdf:p=2", r->h, r->steps * r->h, &g, message) == STEIF_OK);
    CHECK(g.steps == r->steps);
    CLOSE(g.lte_mean, r->mean, 1e-6);
    CLOSE(g.lte_max, r->max, 1e-6);
    CLOSE(g.mu, r->mu, 1e-6);
    CLOSE(g.mu_last, r->mu_last, 1e-6);
    CLOSE(g.residual_mean, r->residual, 1e-4);
    CLOSE(g.residual_max, r->residual_max, 1e-4);
    CLOSE(g.tau_max, r->tau, 1e-3);
    CLOSE(g.norm_max, r->norm, 1e-4);
    CLOSE(g.norm_end, r->end, 1e-4);
  }
}

/* Both columns of the closed fundamental matrix: what is left of a method of order 6 with small
 * steps, and one-step defects of Gauss (s = 3) that shrink like h^7. */
static void accurate_steps_follow_the_fundamental_matrix(void)
{
  for (int column = 1; column <= 2; column++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_growth_facts fine = {0}, coarse = {0};
    steif_problem p;
    char message[400], name[80];
    snprintf(name, sizeof name, "steyer:a=0.7,b1=-0.31,b2=-0.57,beta=3,omega=1.3,column=%d",
             column);
    CHECK(measure(name, "gauss:s=3", 0.02, 6.4, &fine, message) == STEIF_OK);
    CHECK(measure(name, "gauss:s=3", 0.1, 6.4, &coarse, message) == STEIF_OK);
    CHECK(steif_problem_find(ctx, name, &p) == STEIF_OK);
    N_Vector y = N_VNew_Serial(2, steif_sundials(ctx));
    CHECK(p.exact(6.4, y, NULL, p.user) == 0);
    CLOSE(fine.norm_end, hypot(NV_Ith_S(y, 0), NV_Ith_S(y, 1)), 1e-10);
    CLOSE(log(coarse.lte_max / fine.lte_max) / log(5), 7, 0.03);
    CHECK(isnan(fine.residual_max));
    N_VDestroy(y);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* beta -> 0 leaves two scalar equations: |x| = e^{a sin t + b1 t}, growth per time from closed
 * form. */
static void growth_of_a_scalar_equation_is_the_closed_one(void)
{
  steif_growth_facts g = {0};
  char message[400];
  const double a = 0.83, b = -0.27, t = 11.7, half = 5.85;
  CHECK(measure("steyer:a=0.83,b1=-0.27,b2=-0.9,beta=0,omega=0", "gauss:s=4", 0.05, t, &g,
                message) == STEIF_OK);
  CLOSE(g.mu_last, (a * sin(t) + b * t) / t, 1e-10);
  CLOSE(g.mu_window, (a * sin(t) - a * sin(half)) / (t - half) + b, 1e-10);
}

/* |x| = e^{a sin t + b t} and the local error fall below the smallest double on the way; growth per time does
 * not. Radau's and BDF's own growth by the same formula: their errors at this step. */
static void solutions_below_the_smallest_double(void)
{
  static const char *const method[] = {"gauss:s=4", "radau:s=3", "bdf:p=3"};
  const double a = 0.83, b = -0.37, t = 6000, off[] = {1e-10, 1e-8, 1e-3};
  for (size_t i = 0; i < 3; i++) {
    steif_growth_facts g = {0};
    char message[400];
    CHECK(measure("steyer:a=0.83,b1=-0.37,b2=-0.9,beta=0,omega=0", method[i], 0.05, t, &g,
                  message) == STEIF_OK);
    CLOSE(g.mu_last, (a * sin(t) + b * t) / t, off[i]);
    CLOSE(g.mu_window, (a * sin(t) - a * sin(t / 2)) / (t / 2) + b, off[i]);
    CHECK(g.norm_end < 1e-300 && g.lte_mean > 0 && isfinite(g.tau_all) && g.tau_all < 1e6);
    CHECK(isfinite(g.residual_mean) == (i == 2) && isfinite(g.mu_running));
  }
}

static int at_ten(sunrealtype t, sunrealtype norm, sunrealtype lte, void *user)
{
  volatile int *stop = user;
  (void)norm, (void)lte;
  if (t > 0.999) *stop = 1;
  return 0;
}

/* Stopped after ten steps: their facts, as of a run that ends there. */
static void what_was_measured_is_kept(void)
{
  volatile int stop = 0;
  steif_growth_facts part = {0}, whole = {0};
  char message[400];
  steif_problem p;
  steif_context *ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "steyer", &p));
  const steif_lyapunov_options o = {
    .h = 0.1, .t1 = 40, .tell = at_ten, .user = (void *)(uintptr_t)&stop, .stop = &stop};
  CHECK(steif_growth_measure(ctx, &p, "radau:s=2", &o, &part) == STEIF_STOPPED);
  CHECK(measure("steyer", "radau:s=2", 0.1, 1, &whole, message) == STEIF_OK);
  CHECK(part.steps == 10 && whole.steps == 10);
  CLOSE(part.lte_mean, whole.lte_mean, 1e-12);
  CLOSE(part.norm_end, whole.norm_end, 1e-12);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void bad_questions_are_rejected(void)
{
  steif_growth_facts g = {0};
  char message[400];
  CHECK(measure("lorenz", "rk4", 0.1, 3, &g, message) == STEIF_UNSUPPORTED);
  CHECK(strstr(message, "depends on y") != NULL);
  CHECK(measure("steyer", "bdf:p=6", 10, 40, &g, message) == STEIF_BAD_INPUT);
  CHECK(strstr(message, "4 steps") != NULL);
  CHECK(measure("steyer", "rk4", 0.5, -3, &g, message) == STEIF_BAD_INPUT);
  CHECK(measure("steyer:b1=90", "rk4", 0.01, 40, &g, message) == STEIF_NOT_FINITE);
  CHECK(strstr(message, "overflows") != NULL);
  CHECK(measure("steyer:a=0,b1=10,b2=20,beta=0,omega=0", "be", 0.1, 4, &g, message) ==
        STEIF_SINGULAR);
  CHECK(strstr(message, "change h") != NULL);
}

/* Residuals of BDF2 on the exact solution through the last value, recurrence and flow as above.
 * */
static void local_residuals(void)
{
  static const struct {
    double h, t1, mean, max;
  } row[] = {{0.75, 39.75, 1.88e5, 3.19e6},
             {0.075, 39.975, 3.02e-4, 1.15e-3},
             {0.0075, 39.9975, 1.27e-7, 1.16e-6}};
  char message[400];
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_growth_facts g = {0};
    CHECK(measure("steyer", "bdf:p=2", row[i].h, row[i].t1, &g, message) == STEIF_OK);
    CLOSE(g.local_mean, row[i].mean, 3e-3);
    CLOSE(g.local_max, row[i].max, 5e-3);
  }
}

/* One-step defects of general linear methods: the error constant times h^{p+1} x^(p+1), x =
 * exp(-0.9 t): mean over [0, 4] of 0.9^{p+1} e^{-0.9 t} is 0.9^p (1 - e^{-3.6}) / 4. */
static void defects_of_general_methods(void)
{
  static const struct {
    const char *method;
    int p;
    double error;
  } row[] = {{"glm:nord22", 2, 5 / 24.}, {"glm:dimsim1", 2, -1 / 6.},
             {"glm:ab,p=3", 3, -3 / 8.}, {"glm:am,p=3", 3, 1 / 24.},
             {"glm:bdf,p=2", 2, 1 / 3.}, {"glm:nordsieck,of=bdf,p=3", 3, 1 / 4.}};
  const double h = 0.01;
  char message[400];
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_growth_facts g = {0};
    const int code = measure("dahlquist:re=-0.9,im=0", row[i].method, h, 4, &g, message);
    if (code) printf("\n  %s: %s", row[i].method, message);
    CHECK(code == STEIF_OK && isnan(g.residual_mean) && isnan(g.local_max));
    const double mean =
      fabs(row[i].error) * pow(h, row[i].p + 1) * pow(0.9, row[i].p) * (1 - exp(-3.6)) / 4;
    CLOSE(g.lte_mean, mean, 0.05);
    CLOSE(g.mu, -0.9, 0.01);
  }
}

CU_TestInfo tests_of_growth[] = {
  {"the tables of Steyer and Van Vleck, computed with a correct start", published_tables},
  {"accurate steps follow the closed fundamental matrix",
   accurate_steps_follow_the_fundamental_matrix},
  {"the growth of a scalar equation is the closed one",
   growth_of_a_scalar_equation_is_the_closed_one},
  {"solutions below the smallest double", solutions_below_the_smallest_double},
  {"what was measured until a stop is kept", what_was_measured_is_kept},
  {"bad questions are rejected with a sentence", bad_questions_are_rejected},
  {"residuals on local solutions", local_residuals},
  {"defects of general linear methods", defects_of_general_methods},
  CU_TEST_INFO_NULL};
