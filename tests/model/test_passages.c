/* test_passages.c: derivatives by parameters through events and breaks: of the index, of multipliers, of explicit methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <steif/gradient.h>
#include <steif/parameters.h>
#include <steif/quadrature.h>
#include <steif/sensitivity.h>

static int last(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, NV_LENGTH_S(y) - 1);
  return 0;
}

static const char rope[] =
  "param L = 1, g = 9.81\nstate x = 0.6, y = 0, u = 1, v = 0, T\ndiscrete taut = 0\n"
  "x' = u\ny' = v\nu' = -x*T\nv' = -y*T - g\n0 = if taut > 0.5 then x^2 + y^2 - L^2 else T\n"
  "when x^2 + y^2 > L^2: taut = 1\nwhen T < 0: taut = 0\ntime 0 to 1\n";

/* A mass falls until its rope is taut, which takes its velocity along the rope away: from index 1 to 3 at an event. Flight in
 * closed form, then L theta'' = -g sin theta with rtol 1e-13 (scipy, DOP853), and differences of that by L and g of the
 * sixth order. */
static void an_event_that_changes_the_index(void)
{
  static const struct {
    const char *method;
    enum steif_storage storage;
    double rtol;
  } runs[] = {{"radau:s=3", STEIF_DENSE, 1e-9},  {"radau:s=7", STEIF_DENSE, 1e-9},
              {"radau:s=5", STEIF_DENSE, 1e-10}, {"radau:s=5", STEIF_SPARSE, 1e-6},
              {"radau:s=7", STEIF_SPARSE, 1e-8}, {"bdf", STEIF_DENSE, 1e-10}};
  static const sunrealtype exact[] = {24.1364026726, -1.86416351976};
  for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
    fixture s;
    sunrealtype S[2] = {0};
    CU_ASSERT_FATAL(!fixture_text(&s, rope, ""));
    CHECK(fixture_derivatives(&s, runs[r].method, runs[r].storage, runs[r].rtol, 2, S));
    fixture_closely(runs[r].method, S, exact, 2, 1e-6);
    fixture_close(&s);
  }
}

/* Methods that do not find multipliers say so where an event asks for some. */
static void multipliers_that_appear_are_refused(void)
{
  static const char *const methods[] = {"gauss:s=3", "dirk:hw43", "rodas4p"};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, rope, ""));
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_options o = steif_defaults();
    o.rtol = 1e-6;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
    CHECK(solver && steif_solve_to(solver, 1) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(s.ctx), "whose multipliers it does not find") != NULL);
    steif_solver_free(&solver);
  }
  fixture_close(&s);
}

static int force_squared(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 4) * NV_Ith_S(y, 4);
  return 0;
}

/* A bead on a circle, turned back at height h: lam = -m w^2 up to t = asin(h/R)/w, then -m e^2 w^2. The derivatives of the
 * integral of lam^2 in closed form, by R, w, m, h and e; behind the event S is divided by the square of a step. */
static void multipliers_behind_an_event(void)
{
  static const char text[] =
    "param R=1.3, w=1, m=0.7, h=0.9, e=0.6\nstate x=R, y=0, u=0, v=R*w, lam\n"
    "x'=u\ny'=v\nm*u'=lam*x\nm*v'=lam*y\n0=x^2+y^2-R^2\n"
    "when y > h:\n u=-e*u\n v=-e*v\nend\ntime 0 to 2.987\n";
  static const char *const methods[] = {"auto", "radau:s=3", "radau:s=5", "bdf"};
  const double R = 1.3, w = 1, m = 0.7, h = 0.9, e = 0.6, t1 = 2.987, te = asin(h / R) / w;
  const double root = sqrt(R * R - h * h) * w, f = m * m * pow(w, 4), less = 1 - pow(e, 4);
  const double J = f * (te * less + pow(e, 4) * t1);
  const double exact[] = {-f * less * h / (R * root), 4 * J / w - f * less * te / w, 2 * J / m,
                          f * less / root, f * 4 * pow(e, 3) * (t1 - te)};
  const steif_quadrature squared = {.count = 1, .value = force_squared};
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    fixture s;
    CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
    s.p.quadrature = &squared;
    steif_options o = steif_defaults();
    o.rtol = 1e-7, o.sensitivities = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[k], &o);
    CU_ASSERT_FATAL(solver && !steif_solve_to(solver, t1));
    for (int i = 0; i < 5; i++) {
      sunrealtype d = NAN;
      CHECK(!steif_quadrature_sensitivity(solver, t1, i, &d));
      CLOSE_FLOOR(d, exact[i], 3e-5, 1);
    }
    steif_solver_free(&solver);
    fixture_close(&s);
  }
}

/* x' = 2 up to p; x' = -c until x < 0.3: S before, at and behind them, where dense output evaluates f anew. */
static void explicit_methods_do_not_look_ahead(void)
{
  fixture s;
  sunrealtype S[2] = {0};
  CU_ASSERT_FATAL(
    !fixture_text(&s, "param p=1.3\nstate x=0\nx'=if t<p then 2 else 0\ntime 0 to 3\n", ""));
  CHECK(fixture_derivatives(&s, "dopri87", STEIF_DENSE, 1e-6, 1, S));
  CLOSE(S[0], 2, 1e-9);
  fixture_close(&s);
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "param c=0.7, b=0.5\nstate x=1\ndiscrete s=0\n"
                                "x'=if s>0.5 then b else -c\nwhen x<0.3: s=1\ntime 0 to 2\n",
                                ""));
  steif_options o = steif_defaults();
  o.sensitivities = 1;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "dopri87", &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  N_Vector dy = N_VNew_Serial(1, steif_sundials(s.ctx));
  for (int i = 1; i < 16; i++) {
    const double t = i / 8.0;
    CHECK(!steif_solve_to(solver, t));
    for (int k = 0; k < 2; k++) {
      CHECK(!steif_sensitivity(solver, t, k, dy));
      CLOSE_FLOOR(NV_Ith_S(dy, 0), k ? t < 1 ? 0 : t - 1 : t < 1 ? -t : 0.5 / 0.7, 1e-9, 1);
    }
    if (i == 7) i++; /* at 1 itself: either side */
  }
  N_VDestroy(dy);
  steif_solver_free(&solver);
  fixture_close(&s);
}

/* The time of the third firing of a timer is 3 p, that of the only one p; their event functions have gone on behind them. */
static void timers_end_runs(void)
{
  static const struct {
    const char *text;
    double slope;
  } runs[] = {{"param p=0.4\nstate x=1\ndiscrete n=0\nx'=-x\nevery p: n=n+1\n"
               "when n>2.5: stop \"third\"\ntime 0 to 9\n",
               3},
              {"param p=1.2\nstate x=1\nx'=-x\nat p: stop \"once\"\ntime 0 to 3\n", 1}};
  for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
    fixture s;
    sunrealtype slope = NAN;
    CU_ASSERT_FATAL(!fixture_text(&s, runs[r].text, ""));
    steif_options o = steif_defaults();
    o.sensitivities = 1;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
    CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
    CHECK(steif_solve_to(solver, s.p.t1) == STEIF_EVENT);
    CHECK(!steif_sensitivity_event(solver, 0, &slope, NULL));
    CLOSE(slope, runs[r].slope, 1e-9);
    steif_solver_free(&solver);
    fixture_close(&s);
  }
}

/* d/dp of x = 2 p is not in steps that do not end at p. */
static void given_steps_pass_no_breaks(void)
{
  fixture s;
  CU_ASSERT_FATAL(
    !fixture_text(&s, "param p=1.3\nstate x=0\nx'=if t<p then 2 else 0\ntime 0 to 3\n", ""));
  steif_options o = steif_defaults();
  o.h = 0.01, o.sensitivities = 1;
  CHECK(!steif_solver_new(s.ctx, &s.p, "radau:s=3", &o));
  CHECK(steif_status(s.ctx) == STEIF_UNSUPPORTED);
  const steif_functional J = {.count = 1, .end = last};
  steif_gradient g = {0};
  o.sensitivities = 0;
  CHECK(steif_gradient_find(s.ctx, &s.p, "radau:s=3", &o, &J, &g) == STEIF_UNSUPPORTED);
  steif_gradient_free(s.ctx, &g);
  fixture_close(&s);
}

/* x jumps to -b x at t = 1, or where it is L = 0.4, and z = x with it: conditions on z are others from then on. q(2) and its
 * derivatives in closed form. */
static void conditions_of_what_jumps(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "bdf", "dirk:hw43"};
  const double e = exp(-1), exact[] = {e * (1 - e), 2 / 0.4};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    fixture s;
    sunrealtype S[2] = {0};
    CU_ASSERT_FATAL(!fixture_text(&s,
                                  "param b=2\nstate x=1, z, q=0\nx'=-x\n0=z-x\nq'=abs(z)\n"
                                  "at 1: x=-b*x\ntime 0 to 2\n",
                                  ""));
    CHECK(fixture_derivatives(&s, methods[m], STEIF_DENSE, 1e-7, 1, S));
    fixture_closely(methods[m], S, exact, 1, 1e-5);
    fixture_close(&s);
    CU_ASSERT_FATAL(!fixture_text(&s,
                                  "param L=0.4, b=2\nstate x=1, z, q=0\nx'=-x\n0=z-x\n"
                                  "q'=if z > 0 then 1 else 3\nwhen x < L and x > 0: x=-b*x\n"
                                  "time 0 to 2\n",
                                  ""));
    CHECK(fixture_derivatives(&s, methods[m], STEIF_DENSE, 1e-7, 1, S));
    fixture_closely(methods[m], S, exact + 1, 1, 1e-4);
    fixture_close(&s);
  }
}

CU_TestInfo tests_of_passages[] = {
  {"conditions of what jumps", conditions_of_what_jumps},
  {"multipliers behind an event", multipliers_behind_an_event},
  {"explicit methods do not look ahead", explicit_methods_do_not_look_ahead},
  {"timers that end runs", timers_end_runs},
  {"given steps pass no breaks", given_steps_pass_no_breaks},
  {"an event that changes the index", an_event_that_changes_the_index},
  {"multipliers that appear", multipliers_that_appear_are_refused},
  CU_TEST_INFO_NULL};
