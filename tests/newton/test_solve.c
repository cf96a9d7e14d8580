/* Stage equations solved by a split against the same equations solved whole in long double.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ring.h"

static void stages_are_solved(void)
{
  static const char *const specs[] = {NULL,        "radau:s=2", "radau:s=3",     "gauss:s=4",
                                      "gauss:s=5", "radau:s=7", "lobatto3c:s=4", "gauss:s=11"};
  for (int k = 0; k < 8; k++) {
    stage_room s;
    room_open(&s, &ring_nonlinear, specs[k], 0, 0.073);
    CHECK(!s.newton.transform.coupling);
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    CLOSE_FLOOR(room_error(&s), 0, 5e-12, 1);
    CHECK(s.newton.count > 2 && s.newton.count < 25);
    CHECK(s.newton.sweeps == s.newton.count);
    CHECK(s.newton.theta > 0 && s.newton.theta < 0.5);
    room_close(&s);
  }
}

/* Above 11 stages the transformation is a real Schur form whose shifts are coupled. */
static void coupled_shifts_solve_the_same(void)
{
  static const char *const specs[] = {"gauss:s=12", "radau:s=12", "radau:s=13",
                                      "lobatto3c:s=15"};
  for (int k = 0; k < 4; k++) {
    stage_room s;
    room_open(&s, &ring_nonlinear, specs[k], 0, 0.21);
    CHECK(s.newton.transform.coupling != NULL);
    s.newton.tolerance = 1e-11;
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    CLOSE_FLOOR(room_error(&s), 0, 2e-11, 1);
    room_close(&s);
    room_open(&s, &ring_linear, specs[k], 1, 0.21);
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    CLOSE_FLOOR(room_error(&s), 0, 1e-12, 1);
    CHECK(s.newton.sweeps == 1);
    room_close(&s);
  }
}

/* For a triangular B (2 and 5 with 3 above) the transformation is known: T = 1, two real shifts and the
 * coupling 3, which makes the sweep a substitution from the last stage up. */
static void triangular_coupling_is_substitution(void)
{
  static const double B[] = {2, 3, 0, 5}, one[] = {1, 0, 0, 1}, S[] = {0, 3, 0, 0},
                      c[] = {0.4, 1};
  stage_room s;
  room_open(&s, &ring_nonlinear, "radau:s=2", 0, 0.05);
  stf_transform transform = {.s = 2,
                             .shifts = 2,
                             .re = {2, 5},
                             .row = {0, 1},
                             .B = B,
                             .T = one,
                             .Tinv = one,
                             .coupling = S};
  s.newton = (stf_newton){0};
  CU_ASSERT_FATAL(!stf_newton_open(s.pool, &s.system, &transform, s.weights, &s.newton));
  s.newton.tolerance = 1e-13, s.newton.iterations = 60, s.stages.c = c;
  CHECK(!stf_newton_prepare(&s.newton, 0.2, s.h, s.y, s.yp, false));
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CLOSE_FLOOR(room_error(&s), 0, 1e-13, 1);
  CHECK(s.newton.count < 12);
  room_close(&s);
}

static void linear_systems_take_one_sweep(void)
{
  static const char *const specs[] = {NULL, "radau:s=3", "gauss:s=6"};
  for (int k = 0; k < 3; k++) {
    stage_room s;
    room_open(&s, &ring_linear, specs[k], 1, 0.19);
    for (int j = 0; j < s.newton.transform.s; j++) N_VConst(7.7e5, s.Z[j]); /* needs no start */
    for (int m = 1; m <= 3; m++) {
      CHECK(!stf_newton_prepare(&s.newton, 0.2, s.h, s.y, s.yp, true));
      s.r.calls = 0;
      CHECK(!stf_newton_solve(&s.newton, &s.stages));
      CHECK(s.newton.sweeps == m && s.newton.count == 1);
      CHECK(s.r.calls == s.newton.transform.s);
    }
    CLOSE_FLOOR(room_error(&s), 0, 2e-14, 1);
    const steif_pencil_stats *n = steif_pencil_statistics(s.system.pencil);
    CHECK(s.system.nje == 1 && n->factors + n->refactors == s.newton.transform.shifts);
    room_close(&s);
  }
}

/* base NULL and an offset: stages are solved for Y = y + Z themselves. */
static void stages_may_be_absolute(void)
{
  for (int linear = 0; linear < 2; linear++) {
    stage_room s;
    room_open(&s, linear ? &ring_linear : &ring_nonlinear, "radau:s=3", linear, 0.073);
    long double Z[6];
    room_reference(&s, Z);
    N_Vector *offset = stf_pool_vectors(s.pool, 3, s.y);
    for (int j = 0; j < 3; j++) {
      double row = 0;
      for (int m = 0; m < 3; m++) row += s.newton.transform.B[3 * j + m];
      N_VScale(-row / s.h, s.y, offset[j]);
      N_VScale(1, s.y, s.Z[j]);
    }
    s.stages.base = NULL, s.stages.offset = offset;
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    for (int j = 0; j < 3; j++)
      for (int i = 0; i < 2; i++)
        CLOSE_FLOOR(NV_Ith_S(s.Z[j], i), (double)Z[2 * j + i] + NV_Ith_S(s.y, i), 3e-12, 1);
    room_close(&s);
  }
}

static void the_tolerance_is_kept(void)
{
  static const double tolerances[] = {1e-2, 1e-4, 1e-6, 1e-9, 1e-13};
  int before = 0, first = 0;
  for (int k = 0; k < 5; k++) {
    stage_room s;
    room_open(&s, &ring_nonlinear, "radau:s=3", 0, 0.3);
    s.newton.tolerance = tolerances[k];
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    CHECK(room_error(&s) <= sqrt(6) * tolerances[k]); /* the norm is a mean over 6 values */
    CHECK(s.newton.count >= before);
    if (k == 4) CHECK(s.newton.count > first + 3);
    if (k == 0) first = s.newton.count;
    before = s.newton.count;
    room_close(&s);
  }
}

/* The error of the stages is measured in the weights, not absolutely. */
static void the_tolerance_is_weighted(void)
{
  stage_room s;
  room_open(&s, &ring_nonlinear, "radau:s=3", 0, 0.3);
  s.newton.tolerance = 1e-3;
  N_VConst(1e7, s.weights);
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CHECK(room_error(&s) <= sqrt(6) * 1e-10);
  room_close(&s);
}

CU_TestInfo tests_of_solve[] = {
  {"stages are solved through their shifts", stages_are_solved},
  {"coupled shifts solve the same equations", coupled_shifts_solve_the_same},
  {"a triangular coupling is substitution", triangular_coupling_is_substitution},
  {"linear systems take one sweep", linear_systems_take_one_sweep},
  {"stages may be absolute", stages_may_be_absolute},
  {"the tolerance is kept", the_tolerance_is_kept},
  {"the tolerance is weighted", the_tolerance_is_weighted},
  CU_TEST_INFO_NULL};
