/* test_tables.c: diagonally implicit tables of this library run by ARKODE.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ride.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/table.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const char *const tables[] = {"alexander2", "alexander3", "crouzeix23", "trbdf2",
                                     "esdirk43"};
enum { TABLES = 5 };

/* y' = [a b; -b a] y with a = -1.9, b = 3.1 */
static int spiral(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  const sunrealtype *x = NV_DATA_S(y);
  NV_Ith_S(ydot, 0) = -1.9 * x[0] + 3.1 * x[1];
  NV_Ith_S(ydot, 1) = -3.1 * x[0] - 1.9 * x[1];
  return 0;
}

static int spiral_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                      N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = SM_ELEMENT_D(J, 1, 1) = -1.9;
  SM_ELEMENT_D(J, 0, 1) = 3.1, SM_ELEMENT_D(J, 1, 0) = -3.1;
  return 0;
}

/* out := R(h (a - i b))^n out, real and imaginary part */
static void power(const char *name, sunrealtype h, int n, sunrealtype out[2])
{
  steif_context *ctx = steif_context_new(NULL);
  steif_table *table = steif_table_new(ctx, name);
  const sunrealtype z[2] = {-1.9 * h, -3.1 * h};
  sunrealtype R[2] = {0, 0};
  CHECK(table && steif_table_stability(ctx, table, z, R) == STEIF_OK);
  for (int i = 0; i < n; i++) {
    const sunrealtype re = out[0] * R[0] - out[1] * R[1];
    out[1] = out[0] * R[1] + out[1] * R[0], out[0] = re;
  }
  steif_table_free(ctx, &table);
  steif_context_free(&ctx);
}

/* 17 steps of 0.1, or 16 of 0.101 and a last one of 0.084: its matrices are its own. */
static void constant_steps_give_powers_of_R(void)
{
  const sunrealtype y0[] = {1, 0};
  for (int k = 0; k < 4 * TABLES; k++) {
    const int linear = k % 2, fits = k / 2 % 2;
    const char *name = tables[k / 4];
    const steif_problem p = {.name = "spiral",
                             .n = 2,
                             .t1 = 1.7,
                             .y0 = y0,
                             .f = spiral,
                             .jac = spiral_jac,
                             .linear = linear};
    steif_options o = ride_defaults();
    o.h = fits ? 0.1 : 0.101;
    char spec[64];
    snprintf(spec, sizeof spec, "arkode:table=%s", name);
    ride r;
    CHECK(ride_whole(&r, &p, spec, &o) == STEIF_OK);
    if (r.code) printf("\n  %s: %s", spec, ride_says(&r));
    sunrealtype exact[2] = {1, 0};
    power(name, o.h, 16, exact);
    power(name, fits ? o.h : 1.7 - 16 * 0.101, 1, exact);
    CHECK(r.run.stats.steps == 17);
    CLOSE_FLOOR(ride_y(&r, 0), exact[0], 1e-11, 1e-2);
    CLOSE_FLOOR(ride_y(&r, 1), exact[1], 1e-11, 1e-2);
    ride_close(&r);
  }
}

static void default_table_with_equal_steps(void)
{
  const sunrealtype y0[] = {1, 0};
  const steif_problem p = {.name = "spiral", .n = 2, .t1 = 1.6, .y0 = y0, .f = spiral};
  const sunrealtype exact = exp(-1.9 * 1.6) * cos(3.1 * 1.6);
  for (int order = 2; order <= 5; order++) {
    sunrealtype error[2];
    for (int k = 0; k < 2; k++) {
      steif_options o = ride_defaults();
      o.h = k ? 0.05 : 0.1;
      char spec[32];
      snprintf(spec, sizeof spec, "arkode:order=%d", order);
      ride r;
      CHECK(ride_whole(&r, &p, spec, &o) == STEIF_OK);
      CHECK(r.run.stats.steps == (k ? 32 : 16));
      error[k] = fabs(ride_y(&r, 0) - exact);
      ride_close(&r);
    }
    CHECK(log2(error[0] / error[1]) > order - 0.4);
  }
}

static void embedded_table_chooses_steps(void)
{
  const sunrealtype y0[] = {1, 0};
  const steif_problem p = {.name = "spiral", .n = 2, .t1 = 1.7, .y0 = y0, .f = spiral};
  ride r;
  CHECK(ride_whole(&r, &p, "arkode:table=esdirk43,newton=1e-4", NULL) == STEIF_OK);
  if (r.code) printf("\n  %s", ride_says(&r));
  CLOSE_FLOOR(ride_y(&r, 0), exp(-1.9 * 1.7) * cos(3.1 * 1.7), 1e-4, 1e-1);
  CHECK(r.run.stats.steps > 10 && r.run.stats.steps < 500);
  ride_close(&r);
}

CU_TestInfo tests_of_tables[] = {
  {"constant steps give powers of R(z)", constant_steps_give_powers_of_R},
  {"default tables with equal steps have their order", default_table_with_equal_steps},
  {"an embedded table chooses its steps", embedded_table_chooses_steps},
  CU_TEST_INFO_NULL};
