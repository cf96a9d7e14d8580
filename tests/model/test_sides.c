/* Events of DAEs by algebraic unknowns, which errors of a step may take through zero and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>
#include <string.h>

/* Behind an event z is put on its equation: it crosses once, whatever the step had made of it. */
static void an_algebraic_unknown_crosses_once(void)
{
  static const char *const methods[] = {"auto",      "bdf",     "radau:s=3", "radau:s=5",
                                        "gauss:s=3", "rodas5p", "rodas4p",   "dirk:esdirk43"};
  static const double rtols[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-8};
  fixture s;
  double y[3];
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "state x = 0, z, d = 0\nx' = 1\nd' = -0.1*d\n0 = z^3 + z - x\n"
                                "when z > 1: d = d + 1\ntime 0 to 4\n",
                                ""));
  for (int m = 0; m < 8; m++)
    for (int k = 0; k < 5; k++) {
      CHECK(fixture_run(&s, methods[m], rtols[k], y) == STEIF_OK);
      CLOSE_FLOOR(y[2], exp(-0.2), 1e-3, 1); /* once more: 0.8 */
    }
  fixture_close(&s);
}

/* Against f that takes z back at once the state slides along z = 0, which has to be told and not to become a cycle that
 * grows: x would be 0 to the end. */
static void slides_are_told(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "gauss:s=3", "bdf", "rodas5p"};
  static const double rtols[] = {1e-3, 1e-6};
  fixture s;
  CU_ASSERT_FATAL(
    !fixture_text(&s,
                  "state x = 1, z\nx' = if z > 0 then -1 else 1\n0 = z^3 + z - x\n"
                  "time 0 to 3\n",
                  ""));
  for (int m = 0; m < 5; m++)
    for (int k = 0; k < 2; k++) {
      steif_options o = steif_defaults();
      o.rtol = rtols[k];
      steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
      CHECK(solver && steif_solve_to(solver, 3) == STEIF_STEP_SIZE);
      CHECK(strstr(steif_message(s.ctx), "slides along the surface of the event"));
      if (solver) CLOSE_FLOOR(NV_Ith_S(steif_solution(solver), 0), 0, rtols[k], 1);
      steif_solver_free(&solver);
    }
  fixture_close(&s);
}

/* So does the force in the rod of a pendulum, of index 3: it swings from the side through the bottom, where T = 3 g, and T
 * passes 15 upwards once in each half of a period of 2.3686 s (4 K(1/2)/g^(1/2)): 4 times until 4.5 s. */
static void a_force_crosses_once(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "radau:s=5"};
  static const double rtols[] = {1e-3, 1e-4, 1e-6, 1e-8};
  fixture s;
  double y[6];
  CU_ASSERT_FATAL(
    !fixture_text(&s,
                  "param g = 9.81\nstate x = 1, y = 0, vx = 0, vy = 0, T, c = 0\n"
                  "x' = vx\ny' = vy\nvx' = -T*x\nvy' = -T*y - g\n0 = x^2 + y^2 - 1\n"
                  "c' = 0\nwhen T > 15: c = c + 1\ntime 0 to 4.5\n",
                  ""));
  for (int m = 0; m < 3; m++)
    for (int k = 0; k < 4; k++) {
      CHECK(fixture_run(&s, methods[m], rtols[k], y) == STEIF_OK);
      CLOSE_FLOOR(y[5], 4, 1e-6, 1);
    }
  fixture_close(&s);
}

/* A break of f and an event at the same time: steps that are evaluated anew for dense output end before it. */
static void a_break_and_an_event(void)
{
  static const char *const methods[] = {"dopri87", "exprb32", "exprb43", "auto", "bdf"};
  fixture s;
  double y[3];
  CU_ASSERT_FATAL(
    !fixture_text(&s,
                  "state s = 0, z = 0, y = 0\ns' = if t < 3 then 1 else 0\nz' = 1\n"
                  "y' = floor(t)\ntime 0 to 8\n",
                  ""));
  for (int m = 0; m < 5; m++) {
    CHECK(fixture_run(&s, methods[m], 1e-6, y) == STEIF_OK);
    CLOSE_FLOOR(y[0], 3, 1e-10, 1);
    CLOSE_FLOOR(y[2], 28, 1e-10, 1);
  }
  fixture_close(&s);
}

/* A tank whose outlet has a check valve, which is found closed and open 15 times. radau:s=5, radau:s=7, gauss:s=4 and
 * gauss:s=5 at 1e-12 agree in all digits. */
static int count_events(steif_solver *solver, sunrealtype t, N_Vector y, const int *fired,
                        void *user)
{
  (void)solver, (void)t, (void)y, (void)fired;
  ++*(int *)user;
  return 0;
}

static void valve_by(fixture *s, const char *method, double rtol)
{
  int count = 0;
  steif_options o = steif_defaults();
  o.rtol = rtol, o.on_event = count_events, o.observer = &count;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  CU_ASSERT_PTR_NOT_NULL_FATAL(solver);
  CHECK(steif_solve_to(solver, 10) == STEIF_OK);
  const sunrealtype *y = N_VGetArrayPointer(steif_solution(solver));
  CLOSE_FLOOR(y[0], 0.332529003414, 10 * rtol, 1);
  CLOSE_FLOOR(y[2], 0.201341576562, 10 * rtol, 1);
  CHECK(fabs(y[1]) < 10 * rtol);
  CHECK(count == 15);
  if (count != 15) printf("\n  %s, %g: %d events", method, rtol, count);
  steif_solver_free(&solver);
}

static void a_valve_opens_and_closes(void)
{
  static const char *const methods[] = {"auto",      "bdf",     "radau:s=3", "radau:s=7",
                                        "gauss:s=3", "rodas5p", "rodas4p",   "dirk:esdirk43"};
  static const double rtols[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s,
                                "state h = 1, q ~ 0, p ~ 1\nh' = -q\n"
                                "0 = p - h - 0.5*sin(5*t)\n"
                                "0 = q - (if p > 0.8 then 2*(p - 0.8) else 0)\ntime 0 to 10\n",
                                ""));
  for (int m = 0; m < 8; m++)
    for (int k = 0; k < 6; k++) valve_by(&s, methods[m], rtols[k]);
  fixture_close(&s);
}

/* A mass on a plate A sin(w t) leaves it where the force is 0, A w^2 sin(w t) = g, and falls; the condition of the contact rests
 * at zero until then, and hides nothing. The velocity at the end in closed form. */
static void contacts_that_end(void)
{
  static const char *const methods[] = {"auto", "radau:s=3"};
  const double g = 9.81, A = 0.3, w = 6, t = asin(g / (A * w * w)) / w, end = 0.25;
  for (int m = 0; m < 2; m++)
    for (double rtol = 1e-4; rtol > 1e-9; rtol /= 100) {
      fixture s;
      double y[3] = {0};
      CU_ASSERT_FATAL(
        !fixture_text(&s,
                      "param m=0.5,g=9.81,A=0.3,w=6\nstate y=0,v=A*w,lam\ndiscrete on=1\n"
                      "y'=v\nm*v'=-m*g+lam\n0=if on>0.5 then y-A*sin(w*t) else lam\n"
                      "when y < A*sin(w*t) and v < A*w*cos(w*t) - 1e-3 and on < 0.5: on=1\n"
                      "when lam < 0 and on > 0.5: on=0\ntime 0 to 0.25\n",
                      ""));
      CHECK(fixture_run(&s, methods[m], rtol, y) == STEIF_OK);
      CLOSE(y[1], A * w * cos(w * t) - g * (end - t), 100 * rtol);
      fixture_close(&s);
    }
}

CU_TestInfo tests_of_sides[] = {
  {"contacts that end", contacts_that_end},
  {"a valve", a_valve_opens_and_closes},
  {"an algebraic unknown crosses once", an_algebraic_unknown_crosses_once},
  {"a force crosses once", a_force_crosses_once},
  {"slides are told", slides_are_told},
  {"a break and an event", a_break_and_an_event},
  CU_TEST_INFO_NULL,
};
