/* test_index.c: IDA on N x' + x = f with one nilpotent block of size k, index k: where it
 * works and how it gives up (measured behaviour of IDA 6.4 at rtol = atol = 1e-6).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ride.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { MOST = 8 };

/* Row i: x_{i+1}' + x_i = f_i with f_i = 0 below the last, f_k = sin(1.3 t + 0.4); hence
 * x_{k-j} = (-d/dt)^j f_k. */
static sunrealtype x_of(int j, sunrealtype t)
{
  return pow(-1.3, j) * sin(1.3 * t + 0.4 + j * acos(-1.0) / 2);
}

static int N_fill(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (sunindextype i = 0; i + 1 < SM_ROWS_D(E); i++) SM_ELEMENT_D(E, i, i + 1) = 1;
  return 0;
}

static int minus_one(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (sunindextype i = 0; i < SM_ROWS_D(A); i++) SM_ELEMENT_D(A, i, i) = -1;
  return 0;
}

static int forcing(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)user;
  if (derivative) return 1;
  N_VConst(0, g);
  NV_Ith_S(g, NV_LENGTH_S(g) - 1) = x_of(0, t);
  return 0;
}

typedef struct chain {
  steif_problem problem;
  sunrealtype y0[MOST], yp0[MOST];
} chain;

/* A start off by 1 in every component if it is not consistent. */
static void build(chain *c, int k, bool consistent)
{
  c->problem = (steif_problem){.name = "chain",
                               .n = k,
                               .t1 = 2,
                               .y0 = c->y0,
                               .yp0 = c->yp0,
                               .E = N_fill,
                               .A = minus_one,
                               .g = forcing};
  for (int i = 0; i < k; i++) {
    const int j = k - 1 - i;
    c->y0[i] = x_of(j, 0) + (consistent ? 0 : 1);
    c->yp0[i] = -x_of(j + 1, 0);
  }
}

static void ride_chain(ride *r, int k, bool consistent, const steif_options *o)
{
  static chain c; /* outlives the ride */
  build(&c, k, consistent);
  ride_whole(r, &c.problem, "ida", o);
}

static sunrealtype error(const ride *r, int k)
{
  sunrealtype most = 0;
  for (int i = 0; i < k; i++) most = fmax(most, fabs(ride_y(r, i) - x_of(k - 1 - i, r->run.t)));
  return most;
}

static void index_one_from_a_consistent_start(void)
{
  ride r;
  ride_chain(&r, 1, true, NULL);
  CHECK(r.code == STEIF_OK && error(&r, 1) < 1e-5);
  ride_close(&r);
}

static void inconsistent_starts_fail_at_once(void)
{
  for (int k = 1; k <= 6; k++) {
    ride r;
    ride_chain(&r, k, false, NULL);
    CHECK(r.code == STEIF_BASELINE && r.run.t == 0);
    CHECK(strstr(ride_says(&r), "IDA stopped at t = 0 after 0 steps") != NULL);
    CHECK(strstr(ride_says(&r), "index above 1") != NULL);
    CHECK(strstr(ride_says(&r), "misses equation ") && strstr(ride_says(&r), "F = 1"));
    CHECK(strstr(ride_says(&r), k <= 3 ? "IDA_ERR_FAIL (-3)" : "IDA_CONV_FAIL (-4)") != NULL);
    ride_close(&r);
  }
}

static void index_one_is_repaired(void)
{
  for (int c = 1; c <= 2; c++) {
    steif_options o = ride_defaults();
    o.consistent = c;
    ride r;
    ride_chain(&r, 1, false, &o);
    CHECK(r.code == STEIF_OK && error(&r, 1) < 1e-5);
    ride_close(&r);
  }
}

static void index_two_is_not_repaired(void)
{
  steif_options o = ride_defaults();
  o.consistent = 1;
  ride r;
  ride_chain(&r, 2, false, &o);
  CHECK(r.code == STEIF_BASELINE);
  CHECK(strstr(ride_says(&r), "IDA stopped at t = 0") != NULL);
  ride_close(&r);
}

static void index_two_crawls_unless_suppressed(void)
{
  steif_options o = ride_defaults();
  o.max_steps = 20000;
  ride r;
  ride_chain(&r, 2, true, &o);
  CHECK(r.code == STEIF_STEP_LIMIT && r.run.t < 1.5);
  CHECK(strstr(ride_says(&r), "20000 steps") != NULL);
  ride_close(&r);
  o.suppress_algebraic = 1;
  ride_chain(&r, 2, true, &o);
  CHECK(r.code == STEIF_OK && r.run.stats.steps < 200 && error(&r, 2) < 1e-3);
  ride_close(&r);
}

static void index_three_and_above_fail_near_the_start(void)
{
  for (int k = 3; k <= 8; k++) {
    ride r;
    ride_chain(&r, k, true, NULL);
    CHECK(r.code == STEIF_BASELINE && r.run.t < 1e-3);
    CHECK(strstr(ride_says(&r), "IDA_ERR_FAIL") || strstr(ride_says(&r), "IDA_CONV_FAIL"));
    CHECK(strstr(ride_says(&r), "the index is suspect") != NULL || r.run.t > 0);
    CHECK(strstr(ride_says(&r), "stopped at t = ") != NULL);
    ride_close(&r);
  }
}

CU_TestInfo tests_of_index[] = {
  {"index 1 runs from a consistent start", index_one_from_a_consistent_start},
  {"inconsistent starts fail at t = 0 and name the equation", inconsistent_starts_fail_at_once},
  {"IDACalcIC repairs index 1", index_one_is_repaired},
  {"IDACalcIC does not repair index 2", index_two_is_not_repaired},
  {"index 2 crawls unless the algebraic part is suppressed",
   index_two_crawls_unless_suppressed},
  {"index 3 and above fail near the start", index_three_and_above_fail_near_the_start},
  CU_TEST_INFO_NULL};
