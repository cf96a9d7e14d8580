/* law_claims.c: A- and L-stability of every listed method are what the region computed from its
 * propagator says, claimed or not; symmetric methods satisfy M(z) M(-z) = 1.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <complex.h>

static void stability_is_as_claimed(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  int seen = 0;
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++) {
    if (info.order == 0 || !strcmp(info.family, "sympl")) continue; /* without a propagator */
    const int a = (info.claims & STEIF_A_STABLE) != 0, l = (info.claims & STEIF_L_STABLE) != 0;
    steif_region region = {0};
    CHECK(steif_region_find(ctx, info.name, &region) == STEIF_OK);
    if (region.a_stable != a || region.l_stable != l)
      printf("\n  %s: A %d, claimed %d; L %d, claimed %d; alpha %.10f, R(inf) %g", info.name,
             region.a_stable, a, region.l_stable, l, region.alpha_deg, region.r_inf);
    CHECK(region.a_stable == a && region.l_stable == l && region.zero_stable);
    seen++;
  }
  CHECK(seen > 40);
  steif_context_free(&ctx);
}

static double complex step(steif_context *ctx, const char *method, double complex z)
{
  const sunrealtype at[2] = {creal(z), cimag(z)};
  sunrealtype M[2] = {NAN, NAN};
  int r = 0;
  CHECK(steif_method_propagator(ctx, method, at, &r, NULL) == STEIF_OK && r == 1);
  CHECK(steif_method_propagator(ctx, method, at, &r, M) == STEIF_OK);
  return M[0] + I * M[1];
}

static void symmetric_methods_undo_themselves(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  int seen = 0;
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++) {
    if (info.order == 0 || info.stages == 0 || !strncmp(info.name, "b", 1)) continue;
    if (!strcmp(info.family, "sympl") || law_exponential(&info)) continue;
    if (!strcmp(info.family, "glm")) continue;
    const double complex z = 0.37 - 1.19 * I;
    const double off = cabs(step(ctx, info.name, z) * step(ctx, info.name, -z) - 1);
    CHECK((off < 1e-13) == ((info.claims & STEIF_SYMMETRIC) != 0));
    seen += (info.claims & STEIF_SYMMETRIC) != 0;
  }
  CHECK(seen > 3);
  steif_context_free(&ctx);
}

/* And the region asks no further. */
static void methods_without_a_propagator_say_so(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const sunrealtype z[2] = {-0.41, 2.63};
  steif_method_info info;
  steif_region region;
  int seen = 0, r;
  for (size_t i = 0; steif_method_at(ctx, i, &info) == STEIF_OK; i++) {
    if (strcmp(info.family, "sympl")) continue;
    CHECK(steif_method_propagator(ctx, info.name, z, &r, NULL) == STEIF_UNSUPPORTED);
    CHECK(steif_region_find(ctx, info.name, &region) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(ctx), "treats q and p differently") != NULL);
    seen++;
  }
  CHECK(seen > 12);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_claims[] = {
  {"A- and L-stability are as claimed, no more and no less", stability_is_as_claimed},
  {"M(z) M(-z) = 1 for symmetric methods and no others", symmetric_methods_undo_themselves},
  {"methods without a propagator say so", methods_without_a_propagator_say_so},
  CU_TEST_INFO_NULL};
