/* test_stepmap.c: which maps of one step are symplectic: the two-form decides, not the
 * determinant. Figures by hand unless a source is named.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <complex.h>
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static steif_step_map map_of(const steif_problem *p, const char *method, double h,
                             const double *Omega, double *J)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_step_map map = {.determinant = NAN, .symplectic = NAN, .reversal = NAN};
  const int code = steif_step_map_find(ctx, p, method, h, Omega, J, &map);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_context_free(&ctx);
  return map;
}

/* Kick, then drift: [1 h; 0 1] [1 0; -h 1] = [1 - h^2, h; -h, 1]; the other order of the
 * factors is the other method. */
static void factors_stand_in_the_order_of_the_flows(void)
{
  static const struct {
    const char *method;
    double J[4];
  } rows[] = {{"symeuler:first=p", {0.99, 0.1, -0.1, 1}},
              {"symeuler:first=q", {1, 0.1, -0.1, 0.99}},
              {"verlet:first=kick", {0.995, 0.1, -0.09975, 0.995}},
              {"verlet:first=drift", {0.995, 0.09975, -0.1, 0.995}}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double J[4];
    const steif_step_map m = map_of(&p, rows[i].method, 0.1, NULL, J);
    for (int k = 0; k < 4; k++) CLOSE(J[k], rows[i].J[k], 2e-15);
    CLOSE(m.determinant, 1, 4e-16);
    CHECK(m.symplectic < 4e-16);
    /* R Phi R Phi of Euler p-first: q comes back short by h^2 q - h p, at (1, 0). */
    CLOSE_FLOOR(m.reversal, i < 2 ? 0.01 : 0, 0.02, 1e-14);
  }
  steif_context_free(&ctx);
}

/* Two multipliers at -1. Verlet's at h = 2 share a vector: (2n)^2 + 1 times the energy after n steps from the other
 * start (verdicts on energies see one start). Those of gauss:s=2 at h = 12^(1/2), where R(i h) = -1, do not, and
 * no start grows. Beyond 2 verlet's radius is (h^2 - 2 + h (h^2 - 4)^(1/2)) / 2. */
static void borders_of_stability(void)
{
  static const struct {
    const char *method;
    double h;
    int border;
    double radius;
  } rows[] = {{"verlet", 2, 1, 1},
              {"verlet:first=drift", 2, 1, 1},
              {"verlet", 1.9, 0, 1},
              {"verlet", 2.1, 0, 1.87732804493},
              {"gauss:s=2", 3.4641016151377544, 0, 1},
              {"gauss:s=1", 2, 0, 1}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double J[4];
    const steif_step_map m = map_of(&p, rows[i].method, rows[i].h, NULL, J);
    CHECK(m.border == rows[i].border);
    CLOSE(m.radius, rows[i].radius, 1e-7); /* of a double root: the root of rounding */
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* -- linear systems q' = m p, p' = -S q ---------------------------------------------------------- */

typedef struct pair {
  double m, S[4];
} pair;

static int pair_f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const pair *s = user;
  const sunrealtype *x = NV_DATA_S(y);
  sunrealtype *d = NV_DATA_S(r);
  (void)t;
  for (int i = 0; i < 2; i++) {
    d[i] = s->m * x[2 + i];
    d[2 + i] = -s->S[2 * i] * x[0] - s->S[2 * i + 1] * x[1];
  }
  return 0;
}

static const sunrealtype four[] = {0.71, -0.33, 0.18, 0.94};

static steif_problem pair_problem(pair *s)
{
  return (steif_problem){.name = "pair",
                         .n = 4,
                         .t1 = 1,
                         .y0 = four,
                         .f = pair_f,
                         .user = s,
                         .linear = 1,
                         .positions = 2};
}

/* A kick alone with a force that has no potential. */
static void determinant_one_is_not_symplectic(void)
{
  pair s = {0, {2, 1, 0, 1}};
  const steif_problem p = pair_problem(&s);
  const steif_step_map m = map_of(&p, "symeuler:first=p", 0.1, NULL, NULL);
  CLOSE(m.determinant, 1, 1e-15);
  CLOSE(m.symplectic, 0.1, 1e-14); /* h |S - S^T| */
  s.S[2] = 1;
  CHECK(map_of(&p, "symeuler:first=p", 0.1, NULL, NULL).symplectic < 1e-15);
}

/* A circulatory force: S = 1 + 0.1 [0 1; -1 0] has the eigenvalue s = 1 + 0.1 i with (1, i),
 * and the step has mu with mu^2 - (2 - h^2 s) mu + 1 = 0: the orbit leaves though the
 * determinant is 1. */
static void circulatory_forces_blow_up(void)
{
  pair s = {1, {1, 0.1, -0.1, 1}};
  const steif_problem p = pair_problem(&s);
  const double h = 0.1;
  double J[16];
  const steif_step_map m = map_of(&p, "symeuler:first=p", h, NULL, J);
  CLOSE(m.determinant, 1, 1e-14);
  CLOSE(m.symplectic, 0.02, 1e-13);
  const double complex half = 1 - h * h * (1 + 0.1 * I) / 2;
  double complex mu = half + csqrt(half * half - 1);
  if (cabs(mu) < 1) mu = 1 / mu;
  CLOSE(cabs(mu), 1.005012563, 1e-9);
  const double complex k = (mu - 1) / (h * mu), v[] = {1, I, k, k * I};
  for (int i = 0; i < 4; i++) {
    double complex sum = 0;
    for (int j = 0; j < 4; j++) sum += J[4 * i + j] * v[j];
    CLOSE_FLOOR(cabs(sum - mu * v[i]), 0, 1e-14, 1);
  }
}

/* -- y' = Omega S y with any symmetric S --------------------------------------------------------- */

static int any_f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double *S = user;
  (void)t;
  for (int i = 0; i < 4; i++) {
    const int row = (i + 2) % 4;
    double sum = 0;
    for (int j = 0; j < 4; j++) sum += S[4 * row + j] * NV_Ith_S(y, j);
    NV_Ith_S(r, i) = i < 2 ? sum : -sum;
  }
  return 0;
}

static int any_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                   N_Vector b, N_Vector c)
{
  const double *S = user;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)c;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      SM_ELEMENT_D(J, i, j) = (i < 2 ? 1 : -1) * S[4 * ((i + 2) % 4) + j];
  return 0;
}

static void random_symmetric(unsigned *seed, double *S)
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j <= i; j++) {
      *seed = *seed * 1664525u + 1013904223u;
      S[4 * i + j] = S[4 * j + i] = (double)*seed / 2147483648.0 - 1;
    }
}

static void cayley_is_symplectic_for_every_linear_system(void)
{
  static const char *const methods[] = {"gauss:s=1", "dirk:cranknicolson", "gauss:s=2",
                                        "gauss:s=4"};
  unsigned seed = 20240607;
  double S[16];
  const steif_problem p = {.name = "any",
                           .n = 4,
                           .t1 = 1,
                           .y0 = four,
                           .f = any_f,
                           .jac = any_jac,
                           .user = S,
                           .linear = 1,
                           .positions = 2};
  for (int k = 0; k < 20; k++) {
    random_symmetric(&seed, S);
    for (int i = 0; i < 4; i++) {
      const steif_step_map m = map_of(&p, methods[i], 0.37, NULL, NULL);
      CHECK(m.symplectic < 2e-14);
      CLOSE(m.determinant, 1, 2e-14);
    }
    CHECK(map_of(&p, "radau:s=2", 0.37, NULL, NULL).symplectic > 1e-6);
  }
}

/* -- nonlinear --------------------------------------------------------------------------------- */

/* Recomputation of the book chapter's experiment: det J - 1 = 7.51e-03. */
static void the_trapezoidal_rule_is_not_symplectic(void)
{
  static const double at[] = {1, 0.5};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "pendulum", &p) == STEIF_OK);
  p.y0 = at;
  const steif_step_map rule = map_of(&p, "dirk:cranknicolson", 0.5, NULL, NULL),
                       midpoint = map_of(&p, "gauss:s=1", 0.5, NULL, NULL);
  CLOSE(rule.determinant - 1, 7.51e-03, 1e-3);
  CLOSE(rule.symplectic, 7.51e-03, 1e-3);
  CHECK(rule.reversal < 1e-12);
  CHECK(fabs(midpoint.determinant - 1) < 1e-11 && midpoint.symplectic < 1e-11);
  steif_context_free(&ctx);
}

/* The momenta of the Pleiades are masses times the velocities that are its unknowns. */
static void other_forms_may_be_given(void)
{
  enum { N = 28 };
  static double Omega[N * N];
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "plei", &p) == STEIF_OK);
  for (int i = 0; i < N / 2; i++) {
    Omega[i * N + N / 2 + i] = i % 7 + 1;
    Omega[(N / 2 + i) * N + i] = -(i % 7 + 1);
  }
  CHECK(map_of(&p, "verlet", 0.05, Omega, NULL).symplectic < 1e-9);
  CHECK(map_of(&p, "verlet", 0.05, NULL, NULL).symplectic > 1e-4);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void bad_questions_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p, lorenz;
  steif_step_map m;
  steif_drift drift[2];
  steif_energy e = {.drift = drift};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  CU_ASSERT_FATAL(steif_problem_find(ctx, "lorenz", &lorenz) == STEIF_OK);
  CHECK(steif_step_map_find(ctx, &p, "rk4", -0.1, NULL, NULL, &m) == STEIF_BAD_INPUT);
  CHECK(steif_step_map_find(ctx, &p, "rk5", 0.1, NULL, NULL, &m) == STEIF_UNKNOWN_NAME);
  CHECK(steif_step_map_find(ctx, &p, "rk4", 0.1, NULL, NULL, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_step_map_find(ctx, &lorenz, "rk4", 0.01, NULL, NULL, &m) == STEIF_OK);
  CHECK(isnan(m.symplectic) && isnan(m.reversal));
  /* Liouville: exp(h trace), trace -41/3. */
  CLOSE(m.determinant, exp(-0.41 / 3), 1e-5);
  CHECK(steif_energy_measure(ctx, &lorenz, "rk4", NULL, &e) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "no invariant") != NULL);
  e.period = NAN;
  CHECK(steif_energy_measure(ctx, &p, "rk4", NULL, &e) == STEIF_BAD_INPUT);
  CHECK(steif_energy_measure(ctx, &p, "rk4", NULL, NULL) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_stepmap[] = {
  {"borders of stability", borders_of_stability},
  {"factors stand in the order of the flows", factors_stand_in_the_order_of_the_flows},
  {"determinant one is not symplectic", determinant_one_is_not_symplectic},
  {"circulatory forces blow up", circulatory_forces_blow_up},
  {"Cayley's map is symplectic for every linear system",
   cayley_is_symplectic_for_every_linear_system},
  {"the trapezoidal rule is not symplectic", the_trapezoidal_rule_is_not_symplectic},
  {"other two-forms may be given", other_forms_may_be_given},
  {"bad questions are rejected", bad_questions_are_rejected},
  CU_TEST_INFO_NULL};
