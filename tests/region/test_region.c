/* test_region.c: angles, limits and limits at infinity of stability regions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "suite.h"
#include <string.h>

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

/* Angles from the root locus: min over theta of arg(-sum (1 - e^{-i theta})^j / j), 15 digits. */
static void angles_of_bdf(void)
{
  static const double alpha[] = {90,           90, 86.0323668602, 73.3516704746, 51.8397558360,
                                 17.8397777922};
  for (int p = 1; p <= 6; p++) {
    char method[16];
    snprintf(method, sizeof method, "bdf:p=%d", p);
    const steif_region r = find(method);
    CLOSE(r.alpha_deg, alpha[p - 1], 1.2e-11); /* 1e-9 degrees at 86 */
    CHECK(r.a_stable == (p <= 2) && r.l_stable == (p <= 2));
    CHECK(r.zero_stable && r.r_inf < 1e-12 && isinf(r.real_limit));
  }
}

/* R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24: |R(iy)|^2 = 1 - y^6/72 + y^8/576, so y = 2 sqrt 2; the
 * real limit is the root of 1 + z/2 + z^2/6 + z^3/24. */
static void limits_of_explicit_methods(void)
{
  const steif_region rk4 = find("rk4"), euler = find("euler");
  CLOSE(rk4.real_limit, 2.785293563405282, 1e-13);
  CLOSE(rk4.imag_limit, sqrt(8), 1e-12);
  CHECK(rk4.alpha_deg == 0 && !rk4.a_stable && isinf(rk4.r_inf));
  CLOSE(euler.real_limit, 2.0, 1e-14);
  CHECK(euler.imag_limit == 0 && euler.zero_stable);
}

/* R(inf) = 1 - b^T A^-1 1: -1 and 1 for Gauss, 1 - sqrt 3 for Crouzeix, 0 for Radau. */
static void limits_at_infinity(void)
{
  const steif_region gauss = find("gauss:s=3"), crouzeix = find("dirk:crouzeix23"),
                     radau = find("radau:s=3");
  CLOSE(gauss.r_inf, 1.0, 1e-13);
  CLOSE(crouzeix.r_inf, sqrt(3) - 1, 1e-14);
  CHECK(gauss.a_stable && !gauss.l_stable && crouzeix.a_stable && !crouzeix.l_stable);
  CHECK(radau.a_stable && radau.l_stable && radau.r_inf < 1e-12);
  CHECK(isinf(radau.imag_limit) && isinf(gauss.imag_limit));
}

/* rho at one point: |1/(1-z)| for backward Euler; BDF2's larger root of
 * (3/2 - z) w^2 - 2 w + 1/2 at z = -0.7: (2 + sqrt(4 - 4.4))/4.4, modulus sqrt(0.5/2.2). */
static void radius_at_a_point(void)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype rho;
  CHECK(steif_spectral_radius(ctx, "be", (const sunrealtype[]){-0.37, 1.91}, &rho) == STEIF_OK);
  CLOSE(rho, 1 / hypot(1.37, 1.91), 1e-15);
  CHECK(steif_spectral_radius(ctx, "bdf:p=2", (const sunrealtype[]){-0.7, 0}, &rho) ==
        STEIF_OK);
  CLOSE(rho, sqrt(0.5 / 2.2), 1e-14);
  CHECK(steif_spectral_radius(ctx, "bdf:p=2", (const sunrealtype[]){1.5, 0}, &rho) == STEIF_OK);
  CHECK(isinf(rho)); /* the pole */
  steif_context_free(&ctx);
}

/* Parasitic roots at z = 0: the largest modulus after the principal 1. */
static void parasitic_roots(void)
{
  static const double modulus[] = {1. / 3, 0.42640143271, 0.56086151609, 0.70871081627,
                                   0.86338026787};
  steif_context *ctx = steif_context_new(NULL);
  for (int p = 2; p <= 6; p++) {
    char method[16];
    stf_scan scan;
    double second = 0;
    snprintf(method, sizeof method, "bdf:p=%d", p);
    CU_ASSERT_FATAL(stf_scan_open(&scan, ctx, method) == STEIF_OK);
    CHECK(stf_scan_eigenvalues(&scan, 0, 0) == STEIF_OK);
    for (int i = 0; i < p; i++) {
      const double re = scan.work[2 * i], im = scan.work[2 * i + 1];
      if (hypot(re - 1, im) > 1e-8) second = fmax(second, hypot(re, im));
    }
    CLOSE(second, modulus[p - 2], 1e-10);
    stf_scan_close(&scan);
  }
  steif_context_free(&ctx);
}

static void unknown_methods_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_region region;
  CHECK(steif_region_find(ctx, "badau:s=3", &region) == STEIF_UNKNOWN_NAME);
  CHECK(strstr(steif_message(ctx), "radau") != NULL);
  CHECK(steif_region_find(ctx, "bdf:p=7", &region) == STEIF_BAD_INPUT);
  CHECK(steif_region_find(ctx, NULL, &region) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_region[] = {
  {"BDF has the angles of its root locus to 1e-9 degrees", angles_of_bdf},
  {"explicit methods have their real and imaginary limits", limits_of_explicit_methods},
  {"limits at infinity and L-stability", limits_at_infinity},
  {"the spectral radius at a point", radius_at_a_point},
  {"parasitic roots of BDF at z = 0", parasitic_roots},
  {"unknown methods are rejected with the nearest name", unknown_methods_are_rejected},
  CU_TEST_INFO_NULL};
