/* What Newton's iteration must not accept, and what rescues it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ring.h"

static void a_wrong_sign_is_refused(void)
{
  static const char *const specs[] = {NULL, "radau:s=3"};
  for (int k = 0; k < 2; k++) {
    ring r = ring_nonlinear;
    r.factor = -1;
    stage_room s;
    room_open(&s, &r, specs[k], 0, 0.073);
    CHECK(stf_newton_solve(&s.newton, &s.stages) == STEIF_RETRY);
    CHECK(steif_status(s.ctx) == STEIF_NO_CONVERGENCE);
    CHECK(strstr(steif_message(s.ctx),
                 "not converge for problem 'ring' in the step from t = 0.2") &&
          strstr(steif_message(s.ctx), "h = 0.073") &&
          strstr(steif_message(s.ctx), "Jacobian"));
    CHECK(s.newton.theta >= 1 && s.newton.fails == 1);
    CHECK(stf_newton_stale(&s.newton));
    room_close(&s);
  }
}

static void too_many_iterations_are_refused(void)
{
  stage_room s;
  room_open(&s, &ring_slow, NULL, 0, 1);
  s.newton.iterations = 7;
  CHECK(stf_newton_solve(&s.newton, &s.stages) == STEIF_RETRY);
  CHECK(s.newton.count == 7);
  CHECK(strstr(steif_message(s.ctx), "after 7 iterations") &&
        strstr(steif_message(s.ctx), "rate 0.7"));
  room_close(&s);
}

/* The iteration contracts by 0.7 exactly. Accepted where the correction is below the tolerance,
 * the error is 0.7/(1 - 0.7) of it in the norm, a mean of two; taking slow convergence for
 * rounding would leave a hundred times that. */
static void slow_convergence_is_not_rounding(void)
{
  static const double tolerances[] = {1e-2, 1e-5};
  for (int k = 0; k < 2; k++) {
    stage_room s;
    room_open(&s, &ring_slow, NULL, 0, 1);
    s.newton.tolerance = tolerances[k];
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    CLOSE(s.newton.theta, 0.7, 1e-9);
    CHECK(room_error(&s) <= sqrt(2) * 7 / 3 * tolerances[k]);
    CHECK(stf_newton_stale(&s.newton)); /* a new Jacobian is wanted next time */
    room_close(&s);
  }
}

/* A tolerance below rounding: corrections of the size of rounding that no longer shrink are
 * accepted where the caller says how large that is. */
static void corrections_at_rounding_are_accepted(void)
{
  stage_room s;
  room_open(&s, &ring_slow, NULL, 0, 1);
  s.newton.tolerance = 1e-40, s.newton.rounding = 1e-15, s.newton.iterations = 500;
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CLOSE_FLOOR(room_error(&s), 0, 5e-15, 1);
  room_close(&s);
}

static void values_that_are_not_finite_are_named(void)
{
  for (int linear = 0; linear < 2; linear++) {
    ring r = linear ? ring_linear : ring_nonlinear;
    stage_room s;
    room_open(&s, &r, "radau:s=3", linear, 0.05);
    s.r.poison = linear ? INFINITY : NAN;
    CHECK(stf_newton_solve(&s.newton, &s.stages) == STEIF_RETRY);
    CHECK(steif_status(s.ctx) == STEIF_NOT_FINITE);
    CHECK(strstr(steif_message(s.ctx), "not finite (y") != NULL);
    room_close(&s);
  }
}

/* Only a later stage is not finite: its component is found all the same. */
static void poisoned(long double t, const long double *y, long double *f)
{
  f[0] = -y[0], f[1] = t > 0.24L ? NAN : -y[1];
}

static void later_stages_are_looked_at(void)
{
  static const double B[] = {2, 0, 0, 5}, one[] = {1, 0, 0, 1}, c[] = {0, 1};
  ring r = ring_slow;
  r.f = poisoned;
  stage_room s;
  room_open(&s, &r, "radau:s=2", 0, 0.05);
  stf_transform transform = {
    .s = 2, .shifts = 2, .re = {2, 5}, .row = {0, 1}, .B = B, .T = one, .Tinv = one};
  s.newton = (stf_newton){0};
  CU_ASSERT_FATAL(!stf_newton_open(s.pool, &s.system, &transform, s.weights, &s.newton));
  s.newton.iterations = 9, s.stages.c = c;
  CHECK(!stf_newton_prepare(&s.newton, 0.2, s.h, s.y, s.yp, false));
  CHECK(stf_newton_solve(&s.newton, &s.stages) == STEIF_RETRY);
  CHECK(strstr(steif_message(s.ctx), "(y2)"));
  room_close(&s);
}

static void a_full_iteration_rescues(void)
{
  static const char *const specs[] = {NULL, "radau:s=1"};
  for (int k = 0; k < 2; k++) {
    stage_room s;
    room_open(&s, &ring_cubic, specs[k], 0, 1);
    CHECK(stf_newton_solve(&s.newton, &s.stages) == STEIF_RETRY);
    N_VConst(0, s.Z[0]);
    CHECK(!stf_newton_full(&s.newton, &s.stages));
    CLOSE_FLOOR(room_error(&s), 0, 4e-12, 1);
    CHECK(s.newton.count > 4 && s.newton.count < 30);
    CHECK(stf_newton_stale(&s.newton)); /* its Jacobian is of another point */
    room_close(&s);
  }
}

/* A full iteration that does not converge says at what rate. */
static void nowhere(long double t, const long double *y, long double *f)
{
  (void)t;
  const long double x = y[0] - 0.8L;
  f[0] = x + x * x + 1, f[1] = -y[1]; /* Z = h f with h = 1 has no real root */
}

static void nowhere_jac(long double t, const long double *y, long double J[2][2])
{
  (void)t;
  J[0][0] = 1 + 2 * (y[0] - 0.8L), J[0][1] = J[1][0] = 0, J[1][1] = -1;
}

static void a_full_iteration_may_fail(void)
{
  ring r = ring_nonlinear;
  r.f = nowhere, r.jac = nowhere_jac;
  stage_room s;
  room_open(&s, &r, NULL, 0, 0.999);
  NV_Ith_S(s.Z[0], 0) = 0.41;
  s.newton.iterations = 12;
  CHECK(stf_newton_full(&s.newton, &s.stages) == STEIF_RETRY);
  CHECK(steif_status(s.ctx) == STEIF_NO_CONVERGENCE && s.newton.count == 12);
  CHECK(strstr(steif_message(s.ctx), "after 12 iterations"));
  CHECK(strstr(steif_message(s.ctx), "rate 1;") == NULL);
  room_close(&s);
}

CU_TestInfo tests_of_refusal[] = {
  {"a Jacobian of the wrong sign is refused", a_wrong_sign_is_refused},
  {"too many iterations are refused", too_many_iterations_are_refused},
  {"slow convergence is not taken for rounding", slow_convergence_is_not_rounding},
  {"corrections at rounding are accepted", corrections_at_rounding_are_accepted},
  {"values that are not finite are named", values_that_are_not_finite_are_named},
  {"later stages are looked at", later_stages_are_looked_at},
  {"a full iteration rescues", a_full_iteration_rescues},
  {"a full iteration may fail", a_full_iteration_may_fail},
  CU_TEST_INFO_NULL};
