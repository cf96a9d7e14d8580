/* test_general_regions.c: step matrices and regions of general linear methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <string.h>

static double radius(steif_context *ctx, const char *method, double re, double im)
{
  double rho = NAN;
  CHECK(steif_spectral_radius(ctx, method, (const double[]){re, im}, &rho) == STEIF_OK);
  return rho;
}

/* The first stable z > 0, by bisection between `low` and `high` where the step does not grow.
 * */
static double end_of_growth(steif_context *ctx, const char *method, double low, double high)
{
  for (int i = 0; i < 60; i++) {
    const double middle = (low + high) / 2;
    *(radius(ctx, method, middle, 0) > 1 ? &low : &high) = middle;
  }
  return (low + high) / 2;
}

/* BDF: sum_{j<=k} 2^j / j where the locus z = sum (1 - e^{-i theta})^j / j meets theta = pi.
 * SDIRK and the DIMSIM of the same lambda: |R| = 1 at 1 / lambda^2 = 6 + 4 sqrt 2. nord22: 4.
 * */
static void growth_ends_on_the_positive_axis(void)
{
  static const struct {
    const char *method;
    double low, high, end;
  } row[] = {{"glm:bdf,p=1", 1.5, 3, 2},
             {"glm:bdf,p=2", 2, 6, 4},
             {"glm:bdf,p=3", 3, 9, 20 / 3.},
             {"glm:bdf,p=4", 5, 15, 32 / 3.},
             {"glm:bdf,p=5", 8, 30, 256 / 15.},
             {"glm:bdf,p=6", 12, 50, 416 / 15.},
             {"radau:s=2", 4, 9, 6},
             {"dirk:alexander2", 6, 20, 11.656854249492381},
             {"glm:dimsim2", 6, 20, 11.656854249492381},
             {"glm:nord22", 3, 9, 4}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    CLOSE(end_of_growth(ctx, row[i].method, row[i].low, row[i].high), row[i].end, 1e-9);
  /* without end: |R| > 1 on the whole axis */
  static const char *const endless[] = {"glm:am,p=2", "gauss:s=2",  "rk4",        "glm:ab,p=2",
                                        "gauss:s=1",  "glm:am,p=3", "glm:dimsim1"};
  for (size_t i = 0; i < sizeof endless / sizeof *endless; i++)
    for (double z = 0.013; z < 1e4; z *= 1.37) CHECK(radius(ctx, endless[i], z, 0) > 1);
  steif_context_free(&ctx);
}

/* rho of BDF2 at -1 is the root of (3/2 + 1) x^2 - 2 x + 1/2: 1/sqrt 5; all forms of a formula
 * have the same rho; the DIMSIM of type 2 has that of the SDIRK method of its lambda. */
static void forms_have_the_same_radius(void)
{
  static const char *const pairs[][2] = {{"glm:bdf,p=3", "bdf:p=3"},
                                         {"glm:nordsieck,of=bdf,p=5", "bdf:p=5"},
                                         {"glm:nordsieck,of=am,p=3", "glm:am,p=3"},
                                         {"glm:am,p=2", "dirk:cranknicolson"},
                                         {"glm:ab,p=1", "euler"},
                                         {"glm:dimsim2", "dirk:alexander2"}};
  steif_context *ctx = steif_context_new(NULL);
  CLOSE(radius(ctx, "glm:bdf,p=2", -1, 0), 1 / sqrt(5), 1e-14);
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
    for (int j = 0; j < 20; j++) {
      const double re = -3.1 + 0.3 * j, im = 2.3 * sin(j);
      CLOSE(radius(ctx, pairs[i][0], re, im), radius(ctx, pairs[i][1], re, im), 1e-7);
    }
  steif_context_free(&ctx);
}

static steif_region find(const char *method)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_region region;
  const int code = steif_region_find(ctx, method, &region);
  if (code != STEIF_OK) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  steif_context_free(&ctx);
  return region;
}

/* Real limits of Adams formulas: -1 of AB2, -6/11 of AB3, -3/10 of AB4; -6 of AM3, -3 of AM4
 * (Hairer and Wanner, Solving ODEs II, V.1). */
static void limits_of_adams(void)
{
  static const struct {
    const char *method;
    double limit;
  } row[] = {{"glm:ab,p=2", 1}, {"glm:ab,p=3", 6 / 11.}, {"glm:ab,p=4", 3 / 10.},
             {"glm:am,p=3", 6}, {"glm:am,p=4", 3},       {"glm:nordsieck,of=am,p=3", 6}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const steif_region r = find(row[i].method);
    CLOSE(r.real_limit, row[i].limit, 1e-9);
    CHECK(!r.a_stable && r.alpha_deg == 0 && r.zero_stable);
  }
  CHECK(isinf(find("glm:ab,p=2").r_inf) && isinf(find("glm:dimsim1").r_inf));
}

/* Around the origin rho(M(z)) / |e^z| - 1 = |C| |z|^{p+1} cos(..): 2 (p + 1) changes of sign;
 * and the points of the curve lie on it. */
static void order_stars_have_their_sectors(void)
{
  static const struct {
    const char *method;
    int p;
  } row[] = {{"rk4", 4},        {"radau:s=2", 3},   {"gauss:s=2", 4},  {"glm:irks,p=3", 3},
             {"glm:nord22", 2}, {"glm:dimsim1", 2}, {"glm:ab,p=2", 2}, {"bdf:p=3", 3}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    stf_scan scan;
    double point[2 * 60];
    int changes = 0, on = 0;
    CU_ASSERT_FATAL(stf_scan_open(&scan, ctx, row[i].method) == STEIF_OK);
    scan.star = true;
    bool before = stf_scan_excess(&scan, 0.1, 0) > 0;
    for (int k = 1; k <= 720; k++) {
      const double angle = k * acos(-1.0) / 360;
      const bool here = stf_scan_excess(&scan, 0.1 * cos(angle), 0.1 * sin(angle)) > 0;
      changes += here != before, before = here;
    }
    if (changes != 2 * row[i].p + 2) printf("\n  %s: %d", row[i].method, changes);
    CHECK(changes == 2 * row[i].p + 2);
    CHECK(steif_region_boundary(ctx, row[i].method, 1, 60, point) == STEIF_OK);
    for (int k = 0; k < 60; k++) {
      if (isnan(point[2 * k])) continue;
      const double left = radius(ctx, row[i].method, point[2 * k], point[2 * k + 1]);
      on += isinf(left) || fabs(left / exp(point[2 * k]) - 1) < 1e-9;
      CHECK(fabs(point[2 * k]) < 8.3 && fabs(point[2 * k + 1]) < 8.3);
    }
    CHECK(on > 30);
    stf_scan_close(&scan);
  }
  steif_context_free(&ctx);
}

static void methods_that_choose_are_rejected(void)
{
  static const char *const names[] = {"cvode", "ida", "arkode", "auto"};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 4; i++) {
    steif_region region;
    CHECK(steif_region_find(ctx, names[i], &region) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(ctx), names[i]) && !strstr(steif_message(ctx), "did you mean"));
  }
  steif_region region;
  CHECK(steif_region_find(ctx, "glm:nord23", &region) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "nord22") != NULL);
  CHECK(steif_region_find(ctx, "glm", &region) == STEIF_BAD_INPUT);
  CHECK(steif_region_find(ctx, "glm:rk4", &region) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "'rk4'") != NULL);
  CHECK(steif_region_find(ctx, "dirk:nord22", &region) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "'glm:nord22'") != NULL);
  CHECK(steif_region_find(ctx, "nord22", &region) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "'glm:nord22'") != NULL);
  CHECK(steif_region_find(ctx, "glm:bdf,p=7", &region) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_general_regions[] = {
  {"growth ends on the positive axis", growth_ends_on_the_positive_axis},
  {"all forms of a formula have the same radius", forms_have_the_same_radius},
  {"real limits of Adams formulas", limits_of_adams},
  {"order stars have their sectors", order_stars_have_their_sectors},
  {"methods that choose themselves are rejected", methods_that_choose_are_rejected},
  CU_TEST_INFO_NULL};
