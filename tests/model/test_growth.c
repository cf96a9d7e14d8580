/* test_growth.c: errors that a problem forgets and then makes larger again, and other units of time.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* In each wave errors grow by exp(k/pi - k/8) = 48 and shrink by 48 exp(k/4) = 7,000; the end is where they are
 * largest. y = sin x is exact. */
static const char waves[] = "param u = 1, k = 20\n"
                            "state y = 0\n"
                            "let x = t/u\n"
                            "let a = -k/4 + k*cos(2*pi*x)\n"
                            "y' = (a*(y - sin(x)) + cos(x))/u\n"
                            "time 0 to 10.25*u\n";

static void run(fixture *s, const char *method, double rtol)
{
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  CU_ASSERT_FATAL(solver != NULL);
  CHECK(steif_solve_to(solver, s->p.t1) == STEIF_OK);
  const double y = NV_Ith_S(steif_solution(solver), 0), exact = sin(10.25);
  const double off = fabs(y - exact) / (rtol * (1 + fabs(exact)));
  if (off > 10) printf("\n  %s at %g, t1 = %g: %g tolerances\n", method, rtol, s->p.t1, off);
  CHECK(off <= 10);
  steif_solver_free(&solver);
}

static void errors_grow_again(void)
{
  static const char *const methods[] = {"radau:s=3",     "radau:s=5", "rodas5p",
                                        "rodas4p",       "dirk:hw43", "dirk:trbdf2",
                                        "dirk:esdirk43", "bdf",       "auto"};
  static const double rtols[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  static const char *const units[] = {"", ":u=1e-6", ":u=1e6"};
  for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_text(&s, waves, units[k]) == STEIF_OK);
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
      for (size_t r = 0; r < sizeof rtols / sizeof *rtols; r++) run(&s, methods[m], rtols[r]);
    fixture_close(&s);
  }
}

/* e^500 = 1.4e217, whose square is no number. */
static void squares_that_overflow(void)
{
  static const char *const methods[] = {"auto",      "radau:s=3", "radau:s=5", "gauss:s=3",
                                        "dirk:hw43", "rodas4",    "bdf",       "dopri87"};
  fixture s;
  double y[1];
  CU_ASSERT_FATAL(fixture_text(&s, "state x = 1\nx' = x\ntime 0 to 500\n", "") == STEIF_OK);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
    CHECK(fixture_run(&s, methods[k], 1e-8, y) == STEIF_OK);
    CLOSE(y[0], exp(500), 1e-4);
  }
  fixture_close(&s);
}

CU_TestInfo tests_of_growth[] = {
  {"errors that grow again", errors_grow_again},
  {"squares that overflow", squares_that_overflow},
  CU_TEST_INFO_NULL,
};
