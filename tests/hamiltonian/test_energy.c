/* test_energy.c: drift of the energy on the oscillator, the pendulum and Kepler's problem:
 * bands, lines, closed forms. Figures: recomputation of the book chapter's experiments
 * (numpy, mpmath), and the closed forms named with them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

#define TWO_PI 6.28318530717958647692

typedef struct run {
  steif_drift drift[4];
  steif_energy energy;
  double y[4]; /* at the end */
} run;

static int keep(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)t;
  memcpy(user, NV_DATA_S(y),
         (size_t)(NV_LENGTH_S(y) < 4 ? NV_LENGTH_S(y) : 4) * sizeof(double));
  return 0;
}

/* `steps` steps of length h. */
static run measured(steif_context *ctx, const steif_problem *p, const char *method, double h,
                    long steps)
{
  run r = {.energy = {.period = TWO_PI}};
  steif_options o = steif_defaults();
  o.h = h, o.t1 = h * (double)steps, o.observe = keep, o.observer = r.y;
  o.newton = 1e-6, o.max_steps = 1000000000;
  r.energy.drift = r.drift;
  const int code = steif_energy_measure(ctx, p, method, &o, &r.energy);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  CU_ASSERT_EQUAL(r.energy.steps, steps);
  return r;
}

static run named(const char *problem, const char *method, double h, long steps)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, problem, &p) == STEIF_OK);
  const run r = measured(ctx, &p, method, h, steps);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return r;
}

/* From q = 1, p = 0. Verlet from kick to kick has the map with trace 2 - h^2, so beyond h = 2 the energy
 * grows by powers of its root, 1.877328 at h = 2.1; at h = 2 the root -1 is double: from drift to drift
 * E_n / E_0 = 1 + (2 n)^2. RK4 at 3 i: |R|^2 = 1 - 3^6/72 + 3^8/576 = 145/64. */
static void steps_beyond_the_border_are_not_lowered(void)
{
  static const struct {
    const char *method;
    double h, t1;
    long steps;
    double ratio;
    int drifts;
  } rows[] = {{"verlet", 2.1, 20, 9, 23123.3131, 1},
              {"verlet", 2.1, 21.5, 10, 81493.7605, 1},
              {"verlet:first=drift", 2.1, 20, 9, 225584.542, 1},
              {"verlet:first=drift", 2.1, 21.5, 10, 795052.322, 1},
              {"verlet", 2, 20, 10, 1, 0},
              {"verlet:first=drift", 2, 20, 10, 401, 1},
              {"rk4", 3, 20, 6, 135.247165, 1},
              {"rk4", 20.0 / 7, 20, 7, 2.728648844, 1},
              {"rk4", 2.8, 20, 7, 0.3656976948, 1}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  for (int i = 0; i < 9; i++) {
    steif_drift drift;
    steif_energy e = {.drift = &drift};
    const steif_options o = {.h = rows[i].h, .t1 = rows[i].t1};
    CHECK(steif_energy_measure(ctx, &p, rows[i].method, &o, &e) == STEIF_OK);
    CHECK(e.h == rows[i].h && e.steps == rows[i].steps);
    CLOSE(e.end, (double)rows[i].steps * rows[i].h, 1e-15);
    CLOSE(1 + drift.final / drift.start, rows[i].ratio, 1e-8);
    CHECK(drift.drifts == rows[i].drifts);
  }
  const steif_options long_step = {.h = 2.1, .t1 = 2};
  steif_drift drift;
  CHECK(steif_energy_measure(ctx, &p, "verlet", &long_step, &(steif_energy){.drift = &drift}) ==
        STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "take h = 2 or less, or end at 2.1 or later") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Per period it is h^5: a factor of 32 for half the step. */
static void rk4_loses_less_by_32_for_half_the_step(void)
{
  static const double loss[] = {-4.3769e-04, -1.3893e-05, -4.3579e-07, -1.3631e-08};
  for (int i = 0; i < 4; i++) {
    const double h = ldexp(0.4, -i);
    const run r = named("harmonic", "rk4", h, lround(20 * TWO_PI / h));
    CLOSE(r.drift[0].per_period, loss[i], 1e-2);
    CHECK(fabs(r.drift[0].slope) > 1e3 * r.drift[0].slope_error);
  }
}

/* Backward Euler divides the energy by 1 + h^2 in every step: what is lost for good is a drift, though soon
 * nothing more is lost. */
static void what_is_lost_is_a_drift(void)
{
  static const double h[] = {0.02, 0.1, 0.1, 0.5};
  static const long steps[] = {1000, 1000, 10000, 4000};
  for (int i = 0; i < 4; i++) {
    const run r = named("harmonic", "be", h[i], steps[i]);
    const double left = pow(1 + h[i] * h[i], -(double)steps[i]);
    CHECK(fabs(r.drift[0].final / r.drift[0].start - (left - 1)) < 1e-6);
    CHECK(r.drift[0].drifts == 1);
  }
}

/* -- what is kept exactly ------------------------------------------------------------------------ */

/* user: coefficients of q^2, q p, p^2. */
static int quadratic(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype *x = NV_DATA_S(y), *c = user;
  (void)t;
  *value = c[0] * x[0] * x[0] + c[1] * x[0] * x[1] + c[2] * x[1] * x[1];
  return 0;
}

static void modified_energies_are_kept(void)
{
  static const double h = 0.3;
  static const struct {
    const char *method;
    double c[3];
  } rows[] = {{"verlet:first=kick", {1 - 0.09 / 4, 0, 1}},
              {"verlet:first=drift", {1, 0, 1 - 0.09 / 4}},
              {"symeuler:first=p", {1, -0.3, 1}},
              {"symeuler:first=q", {1, 0.3, 1}},
              {"gauss:s=1", {0.5, 0, 0.5}},
              {"gauss:s=2", {0.5, 0, 0.5}},
              {"dirk:cranknicolson", {0.5, 0, 0.5}}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  p.invariant = quadratic;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    p.user = (void *)rows[i].c;
    const steif_drift d = measured(ctx, &p, rows[i].method, h, 20944).drift[0];
    CHECK(d.max - d.min < 1e-12 * d.start);
    CHECK(fabs(d.start) > 0.49);
  }
  steif_context_free(&ctx);
}

/* From (1, 0): Verlet kick first in [-h^2/8, 0], drift first in [0, h^2/8/(1 - h^2/4)],
 * Euler in [0.5/(1 + h/2) - 0.5, 0.5/(1 - h/2) - 0.5]. */
static void bands_are_the_closed_ones(void)
{
  static const double steps[] = {0.05, 0.3};
  for (int i = 0; i < 2; i++) {
    const double h = steps[i], band = h * h / 8;
    const long count = i ? 20944 : 12566;
    const steif_drift kick = named("harmonic", "verlet", h, count).drift[0],
                      drift = named("harmonic", "verlet:first=drift", h, count).drift[0],
                      euler = named("harmonic", "symeuler", h, count).drift[0];
    CLOSE(kick.min, -band, 1e-7);
    CHECK(kick.min >= -band - 1e-14 && kick.max <= 1e-14);
    CLOSE(kick.mean, -band / 2, 1e-3);
    CLOSE(drift.max, band / (1 - h * h / 4), 1e-7);
    CHECK(drift.min >= -1e-14);
    CLOSE(euler.max, 0.5 / (1 - h / 2) - 0.5, 1e-6);
    CLOSE(euler.min, 0.5 / (1 + h / 2) - 0.5, 1e-6);
  }
}

/* Brouwer: rounding that is not biased grows like the root of the number of steps; with
 * coefficients rounded once and for all it grows along a line, to 2e-14 here. */
static void compensated_gauss_keeps_the_energy_to_rounding(void)
{
  static const char *const methods[] = {"gauss:s=1,compensated=1", "gauss:s=2,compensated=1",
                                        "gauss:s=4,compensated=1"};
  for (int i = 0; i < 3; i++) {
    const steif_drift d = named("harmonic", methods[i], 0.05, 12566).drift[0];
    CHECK(d.max < 2e-15 && d.min > -2e-15);
  }
  for (int i = 0; i < 2; i++) {
    const steif_drift d = named("harmonic", methods[i], 0.05, 125664).drift[0];
    CHECK(d.max < 6e-15 && d.min > -6e-15 && !d.drifts);
  }
}

/* Kahan and Li's method at a step where its own error is below rounding: root mean square
 * over an ensemble of starts. */
static double rounding(const char *method)
{
  enum { MEMBERS = 12 };
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  double sum = 0, y0[2] = {0, 0};
  CU_ASSERT_FATAL(steif_problem_find(ctx, "pendulum", &p) == STEIF_OK);
  p.y0 = y0;
  for (int i = 0; i < MEMBERS; i++) {
    y0[0] = 1 + 0.0137 * i;
    const double off = measured(ctx, &p, method, 0.05, 10000).drift[0].final;
    sum += off * off;
  }
  steif_context_free(&ctx);
  return sqrt(sum / MEMBERS);
}

static void compensated_sums_round_less(void)
{
  const double plain = rounding("kahanli8:compensated=0"),
               less = rounding("kahanli8:compensated=1");
  CHECK(plain < 1e-13 && less < 2e-14 && less < plain / 1.3);
}

/* -- pendulum ------------------------------------------------------------------------------------ */

static void verlet_keeps_a_band_on_the_pendulum(void)
{
  const steif_drift d = named("pendulum", "verlet", 0.05, 5000).drift[0];
  CLOSE(d.min, -2.65300181554e-04, 1e-8);
  CHECK(d.max <= 0 && !d.drifts);
}

/* Orbits shrink, the sooner the nearer to the separatrix; nothing escapes. */
static void rk4_sinks_on_the_pendulum(void)
{
  static const struct {
    double q0, h, final;
    int digits;
  } rows[] = {{1, 0.05, -9.0141499e-06, 8}, {1, 0.1, -2.8803505e-04, 8},
              {1, 0.3, -6.5282145e-02, 8},  {1, 0.6, -4.5864804e-01, 8},
              {3, 0.1, -4.857662e-04, 7},   {3, 0.2, -1.637801e-02, 7},
              {3, 0.3, -1.447830e-01, 7},   {3, 0.5, -1.495, 4}};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "pendulum", &p) == STEIF_OK);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const double y0[] = {rows[i].q0, 0};
    p.y0 = y0;
    const steif_drift d =
      measured(ctx, &p, "rk4", rows[i].h, lround(1000 * TWO_PI / rows[i].h)).drift[0];
    CLOSE(d.final, rows[i].final, 6 * pow(10, -rows[i].digits));
    CHECK(d.max < 1e-5 && d.slope < 0 && d.drifts);
  }
  steif_context_free(&ctx);
}

/* Not symplectic, but conjugate to what is: bounded. */
static void the_trapezoidal_rule_stays_in_a_band(void)
{
  const steif_drift d = named("pendulum", "dirk:cranknicolson", 0.1, 20000).drift[0];
  CLOSE(d.min, -1.757e-04, 3e-4);
  CHECK(d.max < 1e-9 && !d.drifts);
}

/* Maxima lie between the points of a run, on a parabola through three of them: cos has a period of 2 pi, whose
 * maxima the steps of 1/2 miss by up to 1/4. */
static void periods_are_those_between_points(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "harmonic", &p) == STEIF_OK);
  for (int more = 0; more < 4; more++) {
    steif_drift drift[4];
    steif_energy e = {.drift = drift};
    steif_options o = steif_defaults();
    o.h = 0.5 + 0.01 * more, o.t1 = o.h * 31;
    CHECK(!steif_energy_measure(ctx, &p, "gauss:s=4", &o, &e));
    if (!(fabs(e.period - TWO_PI) < 0.02)) printf("\n  h = %g: period %.6g", o.h, e.period);
    CHECK(fabs(e.period - TWO_PI) < 0.02);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_energy[] = {
  {"steps beyond the border are not lowered", steps_beyond_the_border_are_not_lowered},
  {"RK4 loses 32 times less per period for half the step",
   rk4_loses_less_by_32_for_half_the_step},
  {"what is lost is a drift", what_is_lost_is_a_drift},
  {"modified energies are kept to rounding", modified_energies_are_kept},
  {"bands are the closed ones", bands_are_the_closed_ones},
  {"compensated Gauss keeps the energy to rounding",
   compensated_gauss_keeps_the_energy_to_rounding},
  {"compensated sums round less", compensated_sums_round_less},
  {"Verlet keeps a band on the pendulum", verlet_keeps_a_band_on_the_pendulum},
  {"RK4 sinks on the pendulum", rk4_sinks_on_the_pendulum},
  {"the trapezoidal rule stays in a band", the_trapezoidal_rule_stays_in_a_band},
  {"periods are those between points", periods_are_those_between_points},
  CU_TEST_INFO_NULL};
