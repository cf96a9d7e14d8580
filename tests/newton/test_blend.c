/* The blended iteration: one real factorisation for all stages.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ring.h"
#include <math.h>

static void blend_in(stage_room *s, double h)
{
  CU_ASSERT_FATAL(!stf_newton_blend(s->pool, s->table, &s->newton));
  s->newton.factored = false, s->newton.iterations = 90;
  CU_ASSERT_FATAL(!stf_newton_prepare(&s->newton, 0.2, h, s->y, s->yp, false));
  s->stages.h = s->h = h;
}

/* gamma = 1/|lambda*| for lambda* of largest argument among the eigenvalues of A^{-1}: those of Radau
 * IIA with 3 stages are the roots of x^3 - 9 x^2 + 36 x - 60 (denominator of the Pade approximation
 * (2, 3) of e^z), 2.68108287362775 +- 3.05043019924741 i; of Gauss with 2 of x^2 - 6 x + 12,
 * 3 +- i sqrt 3. */
static void gamma_centres_the_spectrum(void)
{
  static const char *const specs[] = {"radau:s=3", "gauss:s=2"};
  const double expected[] = {0.24623275752644, 1 / sqrt(12)};
  for (int k = 0; k < 2; k++) {
    stage_room s;
    room_open(&s, &ring_nonlinear, specs[k], 0, 0.073);
    blend_in(&s, 0.073);
    CLOSE(s.newton.gamma, expected[k], 1e-13);
    room_close(&s);
  }
}

static void it_solves_the_same_stages(void)
{
  static const char *const specs[] = {"radau:s=2", "radau:s=3", "gauss:s=4", "radau:s=7",
                                      "lobatto3c:s=4"};
  for (int k = 0; k < 5; k++) {
    stage_room s;
    room_open(&s, &ring_nonlinear, specs[k], 0, 0.073);
    const long before = steif_pencil_statistics(s.system.pencil)->factors;
    blend_in(&s, 0.073);
    CHECK(steif_pencil_statistics(s.system.pencil)->factors == before + 1);
    CHECK(!stf_newton_solve(&s.newton, &s.stages));
    CLOSE_FLOOR(room_error(&s), 0, 5e-12, 1);
    room_close(&s);
  }
}

/* Factors of a step twice as long serve as well: nothing is factored, the stages are those of h. */
static void factors_serve_other_steps(void)
{
  stage_room s;
  room_open(&s, &ring_nonlinear, "radau:s=3", 0, 0.073);
  blend_in(&s, 0.131);
  const long before = steif_pencil_statistics(s.system.pencil)->factors;
  s.newton.shift_ratio_most = 2;
  CHECK(!stf_newton_prepare(&s.newton, 0.2, 0.073, s.y, s.yp, false));
  s.stages.h = s.h = 0.073;
  CHECK(steif_pencil_statistics(s.system.pencil)->factors == before);
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CLOSE_FLOOR(room_error(&s), 0, 1e-11, 1);
  room_close(&s);
}

/* y'' = -y: the slowest of all q = h lambda in the left half plane is |gamma q| = 1 on the imaginary
 * axis, and there the iteration contracts by 1 - cos(arg lambda*), 0.33982957 for Radau with 3
 * stages. */
static void swing(long double t, const long double *y, long double *f)
{
  (void)t;
  f[0] = y[1], f[1] = -y[0];
}

static void swing_jac(long double t, const long double *y, long double J[2][2])
{
  (void)t, (void)y;
  J[0][0] = J[1][1] = 0, J[0][1] = 1, J[1][0] = -1;
}

static void the_rate_is_as_published(void)
{
  static const ring swinging = {swing, swing_jac, 1, 0, 0};
  stage_room s;
  room_open(&s, &swinging, "radau:s=3", 0, 4.0);
  blend_in(&s, 4.0);
  blend_in(&s, 1 / s.newton.gamma);
  CHECK(!stf_newton_solve(&s.newton, &s.stages));
  CLOSE_FLOOR(room_error(&s), 0, 1e-11, 1);
  CLOSE(s.newton.theta, 1 - cos(atan2(3.0504301992474105694, 2.6810828736277521339)), 0.02);
  CHECK(s.newton.count > 20);
  room_close(&s);
}

CU_TestInfo tests_of_blend[] = {
  {"gamma centres the spectrum", gamma_centres_the_spectrum},
  {"it solves the same stages", it_solves_the_same_stages},
  {"factors serve other steps", factors_serve_other_steps},
  {"the rate is as published", the_rate_is_as_published},
  CU_TEST_INFO_NULL,
};
