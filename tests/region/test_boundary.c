/* test_boundary.c: traced boundaries lie on rho = 1, in order, with the extremes that are known.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <stdlib.h>

enum { COUNT = 300 };
static sunrealtype points[2 * COUNT];

static size_t trace(const char *method)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_region_boundary(ctx, method, 0, COUNT, points) == STEIF_OK);
  size_t known = 0;
  for (int i = 0; i < COUNT; i++) {
    if (isnan(points[2 * i])) continue;
    sunrealtype rho;
    known++;
    CHECK(steif_spectral_radius(ctx, method, points + 2 * i, &rho) == STEIF_OK);
    CLOSE(rho, 1.0, 1e-10);
  }
  steif_context_free(&ctx);
  return known;
}

/* Neighbours are near: no jump within a piece longer than `most`. */
static double longest_jump(void)
{
  double most = 0;
  for (int i = 1; i < COUNT; i++) {
    const double *a = points + 2 * (i - 1), *b = points + 2 * i;
    if (!isnan(a[0]) && !isnan(b[0])) most = fmax(most, hypot(a[0] - b[0], a[1] - b[1]));
  }
  return most;
}

/* |1 - z| = 1 for backward Euler and |1 + z| = 1 for Euler: circles. */
static void circles_of_euler(void)
{
  for (int side = 0; side < 2; side++) {
    CHECK(trace(side ? "euler" : "be") >= COUNT - 2);
    for (int i = 0; i < COUNT; i++)
      if (!isnan(points[2 * i]))
        CLOSE(hypot(points[2 * i] + (side ? 1 : -1), points[2 * i + 1]), 1.0, 1e-10);
    CHECK(longest_jump() < 0.1);
    CHECK(points[0] == points[2 * (COUNT - 2)] && points[1] == points[2 * (COUNT - 2) + 1]);
  }
}

/* Leftmost points: min Re of the root locus of BDF, the real limit of RK4. */
static void extremes_are_reached(void)
{
  static const struct {
    const char *method;
    double left;
  } rows[] = {{"bdf:p=3", -0.0833333333},
              {"bdf:p=4", -0.6666666667},
              {"bdf:p=5", -2.3271187383},
              {"bdf:p=6", -6.0750000000},
              {"rk4", -2.785293563405282}};
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    double left = 0;
    CHECK(trace(rows[r].method) >= COUNT - 4);
    for (int i = 0; i < COUNT; i++) left = fmin(left, points[2 * i]); /* skips NaN */
    CLOSE(left, rows[r].left, 2e-3);
  }
}

/* The boundary of Gauss methods is the imaginary axis, met by no other ray. */
static void axis_of_gauss(void)
{
  CHECK(trace("gauss:s=2") >= COUNT / 3);
  double top = 0;
  for (int i = 0; i < COUNT; i++)
    if (!isnan(points[2 * i])) {
      CHECK(fabs(points[2 * i]) < 1e-10);
      top = fmax(top, points[2 * i + 1]);
    }
  CHECK(top > 5);
}

static void one_point_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_region_boundary(ctx, "be", 0, 1, points) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* Every allocation fails in turn: the code says so, nothing leaks (AddressSanitizer looks). */
static void *starving(size_t bytes, void *user)
{
  long *left = user;
  return (*left)-- > 0 ? malloc(bytes) : NULL;
}

static void feeding(void *block, void *user)
{
  (void)user;
  free(block);
}

static void memory_may_run_short_anywhere(void)
{
  int code = STEIF_NO_MEMORY, hungry = 0;
  for (long meals = 1; code != STEIF_OK && meals < 100; meals++) {
    long left = meals;
    const steif_setup setup = {.allocate = starving, .release = feeding, .user = &left};
    steif_context *ctx = steif_context_new(&setup);
    if (!ctx) continue;
    code = steif_region_boundary(ctx, "bdf:p=2", 0, COUNT, points);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    hungry += code == STEIF_NO_MEMORY;
    steif_context_free(&ctx);
  }
  CHECK(code == STEIF_OK && hungry >= 6);
}

CU_TestInfo tests_of_boundary[] = {
  {"the boundaries of both Euler methods are closed circles", circles_of_euler},
  {"leftmost points are the known extremes", extremes_are_reached},
  {"the boundary of Gauss methods is the imaginary axis", axis_of_gauss},
  {"a boundary of one point is rejected", one_point_is_rejected},
  {"memory may run short anywhere", memory_may_run_short_anywhere},
  CU_TEST_INFO_NULL};
