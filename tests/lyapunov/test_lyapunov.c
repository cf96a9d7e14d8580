/* test_lyapunov.c: exponents of numerical solutions against Floquet multipliers and closed
 * forms.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "region.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <steif/lyapunov.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;

static int exponents(const char *problem, const char *method, const steif_lyapunov_options *o,
                     double *exponent, double *interval, steif_lyapunov_facts *facts)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  int code = steif_problem_find(ctx, problem, &p);
  if (code == STEIF_OK) {
    code = steif_lyapunov(ctx, &p, method, o, exponent, interval, facts);
    if (code != STEIF_OK) printf("\n  %s, %s: %s", problem, method, steif_message(ctx));
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
  return code;
}

/* Floquet exponents of the recurrence with h = 2 pi / 64: logarithms of the eigenvalues of the
 * product of 64 step matrices, in double, and QR over 30 periods after 30, which agree to
 * 1e-10. */
static const char triangular[] = "steyer:a=1.2,b1=-0.3,b2=-0.8,beta=1,omega=0",
                  rotating[] = "steyer:a=1.2,b1=-0.3,b2=-0.8,beta=1,omega=1";
static const struct row {
  const char *problem, *method;
  double exponent[2];
} rows[] = {
  {triangular, "be", {-0.262152483633, -0.739618021804}},
  {triangular, "dirk:cranknicolson", {-0.300543742034, -0.801807468570}},
  {triangular, "bdf:p=2", {-0.302307969824, -0.808253881601}},
  {triangular, "bdf:p=3", {-0.299888728930, -0.799114929222}},
  {triangular, "dirk:alexander2", {-0.300267617268, -0.800889120572}},
  {triangular, "radau:s=2", {-0.300005868239, -0.800041113971}},
  {triangular, "gauss:s=2", {-0.299999963610, -0.799999452007}},
  {triangular, "glm:dimsim2", {-0.300263968237, -0.800883493517}},
  {triangular, "glm:nord22", {-0.301408273175, -0.804870774541}},
  {triangular, "glm:nordsieck,of=bdf,p=2", {-0.302307969824, -0.808253881601}},
  {rotating, "glm:dimsim2", {-0.298792280715, -0.802338956317}},
  {rotating, "glm:nord22", {-0.293395884403, -0.812617418769}},
  {rotating, "glm:bdf,p=3", {-0.301347592018, -0.798498083517}},
  {rotating, "be", {-0.437349935320, -0.564420570116}},
  {rotating, "dirk:cranknicolson", {-0.297542254914, -0.804808955690}},
  {rotating, "bdf:p=2", {-0.289103668164, -0.820567437567}},
  {rotating, "bdf:p=3", {-0.301347592018, -0.798498083517}},
  {rotating, "dirk:alexander2", {-0.298777302234, -0.802379435607}},
  {rotating, "radau:s=2", {-0.299914324739, -0.800101906246}},
  {rotating, "gauss:s=2", {-0.299999392710, -0.800000914302}},
};

static void floquet_exponents_are_found(void)
{
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const steif_lyapunov_options o = {.h = 2 * pi / 64, .t1 = 120 * pi, .transient = 60 * pi};
    steif_lyapunov_facts facts = {0};
    double exponent[2] = {NAN, NAN};
    CHECK(exponents(rows[i].problem, rows[i].method, &o, exponent, NULL, &facts) == STEIF_OK);
    CHECK(facts.linear && facts.steps == 64 * 30);
    for (int j = 0; j < 2; j++) CLOSE_FLOOR(exponent[j], rows[i].exponent[j], 1e-9, 1);
    CLOSE(facts.sum, exponent[0] + exponent[1], 1e-14);
    CLOSE(facts.trace, -1.1, 1e-12); /* the mean of 2 a cos t + b1 + b2 over whole periods */
  }
}

/* The same for equation (3) with a = 1.2, b = -0.14, -0.15, beta = 10 and h = 2 pi / m: BDF2
 * grows up to m = 87 although the problem decays. */
static void stability_is_lost_between_87_and_88_steps(void)
{
  static const struct {
    int m;
    double exponent[2], tolerance;
  } row[] = {{32, {0.349463, -0.663896}, 1e-6},   {64, {0.0589754, -0.397519}, 1e-6},
             {84, {0.00719513, -0.320288}, 1e-6}, {87, {0.001694, NAN}, 1e-6},
             {88, {-0.000049, NAN}, 1e-6},        {128, {-0.0463027, -0.252154}, 1e-6}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const steif_lyapunov_options o = {
      .h = 2 * pi / row[i].m, .t1 = 120 * pi, .transient = 60 * pi};
    double exponent[2] = {NAN, NAN};
    CHECK(exponents("steyer", "bdf:p=2", &o, exponent, NULL, NULL) == STEIF_OK);
    CLOSE_FLOOR(exponent[0], row[i].exponent[0], row[i].tolerance, 1);
    if (!isnan(row[i].exponent[1]))
      CLOSE_FLOOR(exponent[1], row[i].exponent[1], row[i].tolerance, 1);
  }
  /* a complex pair of multipliers: only the mean converges; -.1448892452 twice */
  const steif_lyapunov_options o = {.h = 2 * pi / 64, .t1 = 120 * pi, .transient = 60 * pi};
  steif_lyapunov_facts facts = {0};
  double exponent[2];
  CHECK(exponents("steyer", "rk4", &o, exponent, NULL, &facts) == STEIF_OK);
  CLOSE(facts.sum / 2, -0.1448892452, 1e-9);
}

/* Smallest and largest averages of BDF2 with h = 2 pi / 256 over 60 periods. */
static void windows_give_the_spectral_intervals(void)
{
  static const struct {
    double window, low, high;
  } row[] = {{0.5, -1.379779, 0.780958}, {2, -0.299359, -0.299359}, {5, -0.452138, -0.146579}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const steif_lyapunov_options o = {
      .h = 2 * pi / 256, .t1 = 120 * pi, .transient = 40 * pi, .window = row[i].window * pi};
    double exponent[2], interval[4] = {NAN, NAN, NAN, NAN};
    CHECK(exponents(rotating, "bdf:p=2", &o, exponent, interval, NULL) == STEIF_OK);
    CLOSE_FLOOR(interval[0], row[i].low, 1e-6, 1);
    CLOSE_FLOOR(interval[1], row[i].high, 1e-6, 1);
    CHECK(interval[0] <= exponent[0] && exponent[0] <= interval[1]);
  }
}

/* x' = [[-1, 2], [0, -3]] x. */
static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 0) + 2 * NV_Ith_S(y, 1);
  NV_Ith_S(r, 1) = -3 * NV_Ith_S(y, 1);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -1;
  SM_ELEMENT_D(J, 0, 1) = 2;
  SM_ELEMENT_D(J, 1, 1) = -3;
  return 0;
}

static const sunrealtype y0[] = {0.7, -0.3};
static const steif_problem constant = {
  .name = "constant", .n = 2, .t1 = 80, .y0 = y0, .f = f, .jac = jac};

/* ln |R(h lambda)| / h, for BDF2 zeta = (2 + sqrt(1 + 2 z)) / (3 - 2 z). */
static double closed(steif_context *ctx, const char *method, double h, double lambda)
{
  const double z[2] = {h * lambda, 0};
  if (!strcmp(method, "bdf:p=2")) return log((2 + sqrt(1 + 2 * z[0])) / (3 - 2 * z[0])) / h;
  double radius = NAN;
  CHECK(steif_spectral_radius(ctx, method, z, &radius) == STEIF_OK);
  return log(radius) / h;
}

static void constant_systems_give_the_logarithms_of_R(void)
{
  static const char *const methods[] = {
    "be",          "dirk:cranknicolson", "bdf:p=2",
    "rk4",         "dirk:alexander2",    "gauss:s=3",
    "bdf:p=4",     "radau:s=3",          "lobatto3c:s=2",
    "euler",       "dirk:trbdf2",        "bdf:p=3",
    "glm:ab,p=2",  "glm:am,p=3",         "glm:dimsim1",
    "glm:dimsim2", "glm:nord22",         "glm:nordsieck,of=am,p=4"};
  steif_context *ctx = steif_context_new(NULL);
  for (int linear = -1; linear <= 1; linear += 2) /* along a trajectory, and without one */
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
      const steif_lyapunov_options o = {.h = 0.1, .transient = 40, .linear = linear};
      double exponent[2] = {NAN, NAN};
      const int code = steif_lyapunov(ctx, &constant, methods[i], &o, exponent, NULL, NULL);
      if (code != STEIF_OK) printf("\n  %s: %s", methods[i], steif_message(ctx));
      CHECK(code == STEIF_OK);
      CLOSE(exponent[0], closed(ctx, methods[i], 0.1, -1), 1e-12);
      CLOSE(exponent[1], closed(ctx, methods[i], 0.1, -3), 1e-12);
    }
  steif_context_free(&ctx);
}

/* The same systems in figures: logarithms of principal roots over h, computed by the
 * characteristic polynomials in double. */
static void constant_systems_have_known_exponents(void)
{
  static const struct {
    const char *method;
    double exponent[2];
  } row[] = {{"glm:ab,p=2", {-0.9956145409, -2.8768207245}},
             {"glm:am,p=3", {-0.9999567758, -2.9962416069}},
             {"glm:dimsim1", {-0.9982033528, -2.9437106060}},
             {"glm:nord22", {-1.0021913509, -3.0682606132}},
             {"bdf:p=2", {-1.0036357984, -3.1301677249}},
             {"rk4", {-0.9999990942, -2.9997397598}}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    for (int j = 0; j < 2; j++)
      CLOSE(closed(ctx, row[i].method, 0.1, j ? -3 : -1), row[i].exponent[j], 2e-10);
  steif_context_free(&ctx);
}

static void an_oscillator_has_the_exponents_zero(void)
{
  static const char *const methods[] = {"gauss:s=2", "gauss:s=1", "dirk:cranknicolson"};
  const steif_lyapunov_options o = {.h = 0.083, .t1 = 400};
  for (size_t i = 0; i < 3; i++) {
    double exponent[2] = {NAN, NAN};
    CHECK(exponents("harmonic", methods[i], &o, exponent, NULL, NULL) == STEIF_OK);
    for (int j = 0; j < 2; j++) CLOSE_FLOOR(exponent[j], 0, 1e-13, 1);
  }
}

/* (0.906, 0, -14.572): J. C. Sprott, Lyapunov exponent and dimension of the Lorenz attractor.
 * The sum is the trace -41/3; by rk4 with h = 0.01 it is -13.666564. */
static void lorenz_has_its_exponents(void)
{
  static const char *const methods[] = {"rk4", "gauss:s=2"};
  for (int i = 0; i < 2; i++) {
    const steif_lyapunov_options o = {.h = 0.01, .t1 = i == 0 ? 2020 : 520, .transient = 20};
    steif_lyapunov_facts facts = {0};
    double exponent[3] = {NAN, NAN, NAN};
    CHECK(exponents("lorenz", methods[i], &o, exponent, NULL, &facts) == STEIF_OK);
    CHECK(!facts.linear);
    CLOSE_FLOOR(exponent[0], 0.906, i == 0 ? 0.02 : 0.04, 1);
    CLOSE_FLOOR(exponent[1], 0, 0.01, 1);
    CLOSE_FLOOR(exponent[2], -14.572, i == 0 ? 0.02 : 0.04, 1);
    CLOSE_FLOOR(facts.trace, -41.0 / 3, 1e-12, 1);
    if (i == 0) CLOSE_FLOOR(facts.sum, -13.666564, 1e-4, 1);
    CLOSE_FLOOR(facts.sum, facts.trace, 2e-4, 1);
  }
}

/* BDF2 along its own solution, h = 0.01: the sum -13.8218 of a run 20 times longer. */
static void multistep_exponents_follow_the_computed_solution(void)
{
  const steif_lyapunov_options o = {.h = 0.01, .t1 = 1100, .transient = 100};
  steif_lyapunov_facts facts = {0};
  double exponent[3] = {NAN, NAN, NAN};
  CHECK(exponents("lorenz", "bdf:p=2", &o, exponent, NULL, &facts) == STEIF_OK);
  CLOSE_FLOOR(exponent[0], 0.9026, 0.02, 1);
  CLOSE_FLOOR(exponent[1], 0, 0.005, 1);
  CLOSE_FLOOR(exponent[2], -14.724, 0.02, 1);
  CLOSE_FLOOR(facts.sum, -13.8218, 2e-3, 1);
}

static void the_first_exponents_are_those_of_all(void)
{
  const steif_lyapunov_options o = {.h = 0.01, .t1 = 31.7, .transient = 3.1};
  steif_lyapunov_options less = o;
  double all[3], some[3];
  less.count = 2;
  CHECK(exponents("lorenz", "radau:s=2", &o, all, NULL, NULL) == STEIF_OK);
  CHECK(exponents("lorenz", "radau:s=2", &less, some, NULL, NULL) == STEIF_OK);
  for (int i = 0; i < 2; i++) CLOSE_FLOOR(some[i], all[i], 1e-9, 1);
}

static int rejected(const steif_problem *p, const char *method, steif_lyapunov_options o,
                    const char *word)
{
  steif_context *ctx = steif_context_new(NULL);
  double exponent[8], interval[16];
  const int code = steif_lyapunov(ctx, p, method, &o, exponent, interval, NULL);
  if (!strstr(steif_message(ctx), word)) printf("\n  no '%s': %s", word, steif_message(ctx));
  CHECK(strstr(steif_message(ctx), word) != NULL);
  CHECK(steif_status(ctx) == code);
  steif_context_free(&ctx);
  return code;
}

static int burst(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

static int burst_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = 2 * NV_Ith_S(y, 0);
  return 0;
}

static void bad_questions_are_rejected(void)
{
  const steif_lyapunov_options good = {.h = 0.1, .t1 = 7};
  steif_lyapunov_options o = good;
  steif_problem p = constant;
  p.jac = NULL;
  CHECK(rejected(&p, "rk4", good, ".jac") == STEIF_UNSUPPORTED);
  o.window = 7.3;
  CHECK(rejected(&constant, "rk4", o, "window of 7.3") == STEIF_BAD_INPUT);
  o = good, o.transient = 7;
  CHECK(rejected(&constant, "rk4", o, "transient") == STEIF_BAD_INPUT);
  o = good, o.count = 3;
  CHECK(rejected(&constant, "rk4", o, "3 exponents") == STEIF_BAD_INPUT);
  o = good, o.h = -0.3;
  CHECK(rejected(&constant, "rk4", o, "h = -0.3") == STEIF_BAD_INPUT);
  CHECK(rejected(&constant, "rk5", good, "rk5") == STEIF_UNKNOWN_NAME);
  CHECK(rejected(&constant, "cvode", good, "cvode") == STEIF_UNSUPPORTED);
  CHECK(rejected(&constant, "rodas4", good, "rodas4") == STEIF_UNSUPPORTED);
  CHECK(rejected(NULL, "rk4", good, "problem") == STEIF_BAD_INPUT);
  p = constant, p.f = burst, p.jac = burst_jac, p.n = 1;
  CHECK(rejected(&p, "rk4", good, "overflows") == STEIF_NOT_FINITE);
  CHECK(rejected(&p, "gauss:s=2", good, "t =") < 0);
}

/* lambda(t) = L + D cos(2 pi m t / h) has the mean -1 and decays; with h = 0.1 the numbers grow
 * or decay by where the stages see it. Rates by M(h lambda(t_n + c h)); 1/h ln R of the
 * constant lambda = 1 where all stages see 1. For m = 1 the claim of theorem 3.4 fails for
 * nodes c that are not whole. */
static void sampled_at_its_crests_a_decay_grows(void)
{
  static const struct {
    const char *method;
    double D;
    int m;
    double exponent, tolerance;
  } row[] = {
    {"be", 2, 1, 1.053605, 1e-6},
    {"dirk:cranknicolson", 2, 1, 1.000835, 1e-6},
    {"bdf:p=2", 2, 1, 1.003123, 1e-6},
    {"bdf:p=6", 2, 1, 1.000000, 1e-6},
    {"gauss:s=1", 2, 1, -3.0228, 1e-4},
    {"gauss:s=1", 2, 2, 1.000835, 1e-6},
    {"rk4", 2, 1, -1.7451, 1e-4},
    {"rk4", 2, 2, 0.999999, 1e-6},
    {"gauss:s=2", 2, 1, -0.5188, 1e-4},
    {"gauss:s=2", 8.311912, 1, 1.000000, 1e-6},
    {"radau:s=2", 2, 1, -1.2253, 1e-4},
    {"radau:s=2", 2, 3, 0.999986, 1e-6},
    {"dirk:alexander2", 2, 1, -0.7976, 1e-4},
    {"dirk:alexander2", 2, 17, 0.9885, 1e-4},
    {"dirk:alexander2", 2, 41, 0.9983, 1e-4},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const steif_lyapunov_options o = {.h = 0.1, .t1 = 60, .transient = 30};
    char name[80];
    double exponent = NAN;
    snprintf(name, sizeof name, "aliased:D=%.17g,period=%.17g", row[i].D, 0.1 / row[i].m);
    CHECK(exponents(name, row[i].method, &o, &exponent, NULL, NULL) == STEIF_OK);
    CLOSE_FLOOR(exponent, row[i].exponent, row[i].tolerance, 1);
  }
}

static void failed_allocations_are_reported(void)
{
  const steif_lyapunov_options o = {.h = 0.1, .t1 = 1.3, .linear = -1};
  steif_growth_facts g;
  double exponent[2];
  int code = STEIF_NO_MEMORY;
  long k = 0, failures = 0;
  while (code != STEIF_OK && k < 1000) {
    failing memory = {0};
    steif_setup setup = failing_setup(&memory);
    setup.threads = 1;
    steif_context *ctx = steif_context_new(&setup);
    memory.refuse_at = memory.served + ++k;
    code = steif_lyapunov(ctx, &constant, "radau:s=2", &o, exponent, NULL, NULL);
    const steif_lyapunov_options linear = {.h = 0.1, .t1 = 1.3};
    if (code == STEIF_OK) code = steif_growth_measure(ctx, &constant, "bdf:p=2", &linear, &g);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    CHECK(code == STEIF_OK || strlen(steif_message(ctx)) > 10);
    failures += code == STEIF_NO_MEMORY;
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
  }
  CHECK(code == STEIF_OK && failures > 20);
}

CU_TestInfo tests_of_lyapunov[] = {
  {"the exponents of periodic problems are Floquet's", floquet_exponents_are_found},
  {"constant systems have known exponents", constant_systems_have_known_exponents},
  {"BDF2 loses stability between 88 and 87 steps a period",
   stability_is_lost_between_87_and_88_steps},
  {"averages over windows fill the spectral intervals", windows_give_the_spectral_intervals},
  {"constant systems have ln |R(h lambda)| / h", constant_systems_give_the_logarithms_of_R},
  {"an oscillator has the exponents 0 and 0", an_oscillator_has_the_exponents_zero},
  {"the Lorenz attractor has its published exponents", lorenz_has_its_exponents},
  {"a multistep method has exponents along its own solution",
   multistep_exponents_follow_the_computed_solution},
  {"the first exponents alone are those of all", the_first_exponents_are_those_of_all},
  {"a decay sampled at its crests grows", sampled_at_its_crests_a_decay_grows},
  {"bad questions are rejected with a sentence", bad_questions_are_rejected},
  {"a failing allocation is reported and leaves nothing", failed_allocations_are_reported},
  CU_TEST_INFO_NULL};
