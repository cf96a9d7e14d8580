/* test_kepler.c: energy and angular momentum on Kepler's orbit of eccentricity 0.6, with
 * a constant step size and with steps that follow the distance; rows and periods of a run that is measured.
 * Figures: recomputation of the book chapter's experiments.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

#define TWO_PI 6.28318530717958647692

static void measure(const char *method, steif_options *o, steif_energy *e)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "kepler:e=0.6", &p) == STEIF_OK);
  o->max_steps = 100000000;
  const int code = steif_energy_measure(ctx, &p, method, o, e);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* 200 periods; the losses by a program of a few lines of its own. */
static void orbits_sink_under_rk4_and_not_under_verlet(void)
{
  static const struct {
    const char *method;
    double h, final, digits;
  } rows[] = {{"rk4", 0.05, -6.78203e-03, 1e-5}, {"rk4", 0.1, -2.54894e-01, 1e-5}};
  for (int i = 0; i < 2; i++) {
    steif_drift drift[2];
    steif_energy e = {.period = TWO_PI, .drift = drift};
    steif_options o = steif_defaults();
    o.h = rows[i].h, o.t1 = o.h * (double)lround(200 * TWO_PI / o.h);
    measure(rows[i].method, &o, &e);
    CLOSE(drift[0].final, rows[i].final, rows[i].digits);
    CHECK(drift[0].max <= 1e-15 && drift[0].drifts && drift[0].per_period < 0);
  }
  steif_drift drift[2];
  steif_energy e = {.drift = drift};
  steif_options o = steif_defaults();
  o.h = 0.05, o.t1 = 0.05 * (double)lround(200 * TWO_PI / 0.05);
  measure("verlet", &o, &e);
  CLOSE(drift[0].max, 9.3887e-03, 1e-5);
  CHECK(drift[0].min > -1e-4 && !drift[0].drifts);
  CHECK(drift[1].max < 3e-15 && drift[1].min > -3e-15); /* angular momentum */
  CHECK(e.period > TWO_PI && e.period < 1.05 * TWO_PI); /* precession, from the maxima */
}

/* h = 0.05 r^(3/2) of the position reached, from (q, p) = y at t[0]: a mesh for the same
 * method. */
static size_t mesh(size_t room, const double *y, double t1, double *t)
{
  double q[] = {y[0], y[1]}, p[] = {y[2], y[3]};
  size_t count = 1;
  for (; t[count - 1] < t1 && count < room; count++) {
    const double r = hypot(q[0], q[1]), h = 0.05 * r * sqrt(r);
    for (int i = 0; i < 2; i++) p[i] -= h / 2 * q[i] / (r * r * r);
    for (int i = 0; i < 2; i++) q[i] += h * p[i];
    const double s = hypot(q[0], q[1]);
    for (int i = 0; i < 2; i++) p[i] -= h / 2 * q[i] / (s * s * s);
    t[count] = t[count - 1] + h;
  }
  return count;
}

static int keep(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)t;
  memcpy(user, NV_DATA_S(y), 4 * sizeof(double));
  return 0;
}

/* The mesh is made again every eight periods: a fixed one amplifies the rounding of the run. */
static void steps_that_follow_the_orbit_lose_the_band(void)
{
  /* energy after 40, 80, 120, 160, 200 periods */
  static const double known[] = {-6.065e-04, -9.805e-04, -2.110e-03, -3.096e-03, -4.399e-03};
  enum { ROOM = 3000 };
  double t[ROOM] = {0}, y[] = {0.4, 0, 0, 2}, lost = 0;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "kepler:e=0.6", &p) == STEIF_OK);
  for (int k = 1; k <= 25; k++) {
    steif_drift drift[2];
    steif_energy e = {.period = TWO_PI, .drift = drift};
    steif_options o = steif_defaults();
    o.mesh = t, o.mesh_size = mesh(ROOM, y, 8 * k * TWO_PI, t);
    o.observe = keep, o.observer = y;
    p.t0 = t[0], p.t1 = 200 * TWO_PI, p.y0 = (const double[]){y[0], y[1], y[2], y[3]};
    CHECK(steif_energy_measure(ctx, &p, "verlet", &o, &e) == STEIF_OK);
    lost += drift[0].final;
    t[0] = t[o.mesh_size - 1];
    if (k % 5 == 0) CLOSE(lost, known[k / 5 - 1], 3e-4);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Eleven rows over ten units of time, with both invariants of the last one those of the
 * drifts; the period is that of the orbit, from the maxima of q_1 at the pericentre. */
static void rows_are_even_and_the_period_is_found(void)
{
  sunrealtype row[11 * 3];
  steif_drift drift[2];
  steif_energy e = {.drift = drift, .row = row, .rows = 11};
  steif_options o = steif_defaults();
  o.h = 0.03125, o.t1 = 20;
  measure("kahanli6", &o, &e);
  CU_ASSERT_EQUAL(e.rows, 11);
  CU_ASSERT_EQUAL(e.steps, 640);
  for (int i = 0; i < 11; i++) CLOSE_FLOOR(row[3 * i], 2 * i, 1e-12, 1);
  CHECK(row[1] == 0 && row[2] == 0);
  for (int k = 0; k < 2; k++) CHECK(row[30 + 1 + k] == drift[k].final);
  CLOSE(drift[0].start, -0.5, 1e-15);
  CLOSE(drift[1].start, 0.8, 1e-15);
  CLOSE(e.period, TWO_PI, 1e-3);
  CLOSE(drift[0].per_period, drift[0].slope * e.period, 1e-15);
}

CU_TestInfo tests_of_kepler[] = {
  {"rows are even and the period is found", rows_are_even_and_the_period_is_found},
  {"orbits sink under RK4 and not under Verlet", orbits_sink_under_rk4_and_not_under_verlet},
  {"steps that follow the orbit lose the band", steps_that_follow_the_orbit_lose_the_band},
  CU_TEST_INFO_NULL};
