/* When factors are kept, made anew, or used for another shift.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ring.h"

static long factors(const stage_room *s)
{
  const steif_pencil_stats *n = steif_pencil_statistics(s->system.pencil);
  return n->factors + n->refactors;
}

static int prepare(stage_room *s, double h, bool jacobian)
{
  return stf_newton_prepare(&s->newton, 0.2, h, s->y, s->yp, jacobian);
}

static void factors_live_as_long_as_the_step(void)
{
  stage_room s;
  room_open(&s, &ring_nonlinear, "radau:s=3", 0, 0.05);
  CHECK(factors(&s) == 2 && s.system.nje == 1);
  CHECK(!prepare(&s, 0.05, false) && factors(&s) == 2);
  CHECK(!prepare(&s, 0.06, false) && factors(&s) == 4 && s.system.nje == 1);
  CHECK(!prepare(&s, 0.06, true) && factors(&s) == 6 && s.system.nje == 2);
  CHECK(s.newton.jacobian_new && !s.newton.jacobian_wanted);
  room_close(&s);
}

static void linear_systems_factor_once(void)
{
  stage_room s;
  room_open(&s, &ring_linear, "radau:s=3", 1, 0.05);
  for (int i = 0; i < 5; i++) CHECK(!prepare(&s, 0.05, true));
  CHECK(factors(&s) == 2 && s.system.nje == 1);
  CHECK(!prepare(&s, 0.07, true) && factors(&s) == 4 && s.system.nje == 1);
  room_close(&s);
}

/* Within a window factors serve another shift, corrections scaled by 2/(1 + ratio) (Petzold,
 * DASSL); back at their own shift they serve unscaled. */
static void a_window_keeps_factors(void)
{
  stage_room s;
  room_open(&s, &ring_nonlinear, NULL, 0, 0.05);
  s.newton.shift_ratio_most = 1.67;
  CHECK(!prepare(&s, 0.04, false) && factors(&s) == 1);
  CLOSE(s.newton.relax, 2 / 2.25, 1e-15);
  s.stages.h = s.h = 0.04;
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CLOSE_FLOOR(room_error(&s), 0, 4e-12, 1);
  s.newton.jacobian_wanted = false;
  CHECK(!prepare(&s, 0.05, false) && factors(&s) == 1);
  CHECK(s.newton.relax == 1);
  CHECK(!prepare(&s, 0.02, false) && factors(&s) == 2 && s.newton.relax == 1);
  CHECK(!prepare(&s, 0.02 * 1.6, false) && factors(&s) == 2);
  s.newton.jacobian_wanted = true; /* a slow iteration: the window is shut */
  CHECK(!prepare(&s, 0.02 * 1.5, false) && factors(&s) == 3);
  room_close(&s);
}

static void another_coefficient_is_another_shift(void)
{
  stage_room s;
  room_open(&s, &ring_nonlinear, NULL, 0, 0.05);
  stf_newton_single(&s.newton, 1);
  CHECK(!prepare(&s, 0.05, false) && factors(&s) == 1);
  stf_newton_single(&s.newton, 1.5);
  CHECK(!prepare(&s, 0.05, false) && factors(&s) == 2);
  N_VConst(0, s.Z[0]);
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CLOSE_FLOOR(room_error(&s), 0, 4e-12, 1); /* the reference reads B too */
  room_close(&s);
}

static void a_rate_above_the_bound_asks_for_a_jacobian(void)
{
  stage_room s;
  room_open(&s, &ring_slow, NULL, 0, 1);
  s.newton.stale_rate = 0.69, s.newton.tolerance = 1e-4;
  CHECK(!stf_newton_solve(&s.newton, &s.stages) && stf_newton_stale(&s.newton));
  room_close(&s);
  room_open(&s, &ring_slow, NULL, 0, 1);
  s.newton.stale_rate = 0.71, s.newton.tolerance = 1e-4;
  CHECK(!stf_newton_solve(&s.newton, &s.stages) && !stf_newton_stale(&s.newton));
  room_close(&s);
}

static void singular_matrices_are_named(void)
{
  ring r = ring_linear;
  stage_room s;
  r.factor = 0;
  room_open(&s, &r, NULL, 0, 0.05);
  s.newton.transform.re[0] = 0; /* 0 I - 0 */
  CHECK(prepare(&s, 0.05, false) == STEIF_SINGULAR && !s.newton.factored);
  s.newton.transform.re[0] = 1;
  CHECK(!prepare(&s, 0.05, false) && s.newton.factored);
  room_close(&s);
}

CU_TestInfo tests_of_factors[] = {
  {"factors live as long as the step", factors_live_as_long_as_the_step},
  {"linear systems factor once", linear_systems_factor_once},
  {"a window keeps factors", a_window_keeps_factors},
  {"another coefficient is another shift", another_coefficient_is_another_shift},
  {"a rate above the bound asks for a Jacobian", a_rate_above_the_bound_asks_for_a_jacobian},
  {"singular matrices are named", singular_matrices_are_named},
  CU_TEST_INFO_NULL};
