/* test_exact.c: exact pairing and first-order constants of the Jordan block.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

/* <x_1, g> and E_1 in conventions P and R; E_1 from the limit of measured errors at 50 digits. */
static const struct row {
  int consistent, forced, k;
  double exact, first_P, first_R;
} rows[] = {
  {0, 0, 2, 2.0, -23.0, -8.0},
  {0, 0, 3, -22.0, 313.0, 160.0},
  {0, 0, 4, 202.0, -3047.0, -1856.0},
  {0, 0, 5, -1478.0, 22153.0, 14944.0},
  {0, 0, 6, 8602.0, -118967.0, -85856.0},
  {1, 1, 2, 0.145743485951604, 0.1051532301, -0.04930517795},
  {1, 1, 3, 0.2563052259126585, -0.3967750056, -0.5466120887},
  {1, 1, 4, 0.3468428095914897, 1.333746035, 1.247534426},
  {1, 1, 5, 0.3886505690311419, 16.26604651, 16.28229155},
  {1, 1, 6, 0.3684730183689024, -148.9353645, -148.8103163},
  {0, 1, 2, 2.561890322498746, -29.33820854, -9.713892524},
  {0, 1, 3, -29.38860791840363, 417.7424704, 213.7928604},
  {0, 1, 4, 224.5979088503104, -3397.73885, -2084.853864},
  {0, 1, 5, -1309.578251451839, 19625.03324, 13313.4989},
  {0, 1, 6, 7118.476571781406, -98494.74504, -71077.62923},
};

static void check_row(const struct row *r, steif_context *ctx)
{
  sunrealtype x0[MOST], exact, P, R;
  stf_block block;
  for (int m = 0; m < r->k; m++) x0[m] = counting[m];
  if (r->consistent)
    CHECK(steif_jordan_exact(ctx, r->k, cosines, NULL, counting, 0, x0, NULL) == STEIF_OK);
  CU_ASSERT_FATAL(stf_block_open(&block, ctx, r->k, r->forced ? cosines : NULL, NULL, x0) ==
                  STEIF_OK);
  CHECK(stf_block_pair(&block, 0, 0, &exact) == STEIF_OK);
  CHECK(stf_block_first(&block, 0, STEIF_P, &P) == STEIF_OK);
  CHECK(stf_block_first(&block, 0, STEIF_R, &R) == STEIF_OK);
  CLOSE(exact, r->exact, 4e-15);
  CLOSE(P, r->first_P, 5.1e-10);
  CLOSE(R, r->first_R, 5.1e-10);
  stf_block_close(&block);
}

static void pairing_is_exact(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) check_row(rows + i, ctx);
  steif_context_free(&ctx);
}

/* (1-t)^8 at t = 0.37 by hand: 0.63^8, -8 0.63^7, 8!/3! (-1)^5 0.63^3, 8!. */
static void test_function_and_derivatives(void)
{
  CLOSE(steif_test_function(0.37, 0), 0.0248155780267521, 1e-14);
  CLOSE(steif_test_function(0.37, 1), -0.31511845113336, 1e-13);
  CLOSE(steif_test_function(0.37, 5), -1680.31584, 1e-13);
  CLOSE(steif_test_function(0.37, 8), 40320.0, 1e-15);
  CHECK(steif_test_function(0.37, 9) == 0);
  CHECK(steif_test_function(1.25, 0) == 0 && steif_test_function(1.25, 8) == 0);
  CHECK(isnan(steif_test_function(0.37, -1)));
}

/* k = 3, f_m = cos(t+m): x_s1 = f1 - f2' + f3'' = cos(t+1) + sin(t+2) - cos(t+3), and so on; the
 * impulses are c_0 = N d, c_1 = -N^2 d with d = x(0-) - x_s(0). */
static void smooth_part_and_impulses(void)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype x[3], c[6];
  CHECK(steif_jordan_exact(ctx, 3, cosines, NULL, counting, 0.71, x, c) == STEIF_OK);
  CLOSE(x[0], cos(1.71) + sin(2.71) - cos(3.71), 1e-15);
  CLOSE(x[1], cos(2.71) + sin(3.71), 2e-15);
  CLOSE(x[2], cos(3.71), 1e-15);
  const double d2 = 2 - (cos(2) + sin(3)), d3 = 3 - cos(3);
  CLOSE(c[0], d2, 1e-15);
  CLOSE(c[1], d3, 1e-15);
  CHECK(c[2] == 0 && c[4] == 0 && c[5] == 0);
  CLOSE(c[3], -d3, 1e-15);
  steif_context_free(&ctx);
}

static int stubborn(sunrealtype t, int derivative, N_Vector g, void *user)
{
  return derivative > 1 ? 1 : cosines(t, derivative, g, user);
}

static void refuses_with_sentences(void)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype x[3];
  CHECK(steif_jordan_exact(ctx, 0, NULL, NULL, counting, 0, x, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_jordan_exact(ctx, 3, NULL, NULL, NULL, 0, x, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_jordan_exact(ctx, 3, stubborn, NULL, counting, 0, x, NULL) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "derivative 2") != NULL);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_exact[] = {
  {"the pairing and the first-order constants have their closed values", pairing_is_exact},
  {"the test function has the derivatives of (1-t)^8", test_function_and_derivatives},
  {"smooth part and impulses of an index-3 block are right", smooth_part_and_impulses},
  {"bad blocks are refused with a sentence", refuses_with_sentences},
  CU_TEST_INFO_NULL};
