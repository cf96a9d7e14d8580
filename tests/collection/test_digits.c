/* test_digits.c: scd and mescd against exact solutions and references.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static void errors_of_the_exact_solution_are_measured(void)
{
  fixture s;
  double scd, mescd;
  if (fixture_open(&s, "forced:k=3.7,c=0.2")) return;
  CHECK(s.p.exact(2.3, s.y, NULL, s.p.user) == 0);
  const double r0 = NV_Ith_S(s.y, 0), r1 = NV_Ith_S(s.y, 1);
  NV_Ith_S(s.y, 0) += 3e-7 * r0;
  NV_Ith_S(s.y, 1) -= 5e-8 * r1;
  CHECK(steif_problem_digits(s.ctx, &s.p, 2.3, s.y, 0.25, &scd, &mescd) == STEIF_OK);
  CLOSE(scd, -log10(3e-7), 1e-8);
  const double e0 = 3e-7 * fabs(r0) / (0.25 + fabs(r0)),
               e1 = 5e-8 * fabs(r1) / (0.25 + fabs(r1));
  CLOSE(mescd, -log10(fmax(e0, e1)), 1e-8);
  fixture_close(&s);
}

static void an_exact_hit_shows_the_digits_of_double(void)
{
  fixture s;
  double scd, mescd;
  if (fixture_open(&s, "kepler:e=0.3")) return;
  CHECK(s.p.exact(1.7, s.y, NULL, s.p.user) == 0);
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.7, s.y, 1, &scd, &mescd) == STEIF_OK);
  CLOSE(scd, 53 * log10(2), 1e-12); /* unit round-off 2^-53 */
  CLOSE(mescd, 53 * log10(2), 1e-12);
  fixture_close(&s);
}

static void what_is_not_finite_has_no_digits(void)
{
  fixture s;
  double scd, mescd;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  if (fixture_open(&s, "lorenz")) return;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) NV_Ith_S(s.y, j) = s.p.reference->value[j];
    NV_Ith_S(s.y, i) = bad[i];
    CHECK(steif_problem_digits(s.ctx, &s.p, 10, s.y, 1, &scd, &mescd) == STEIF_OK);
    CHECK(isinf(scd) && scd < 0 && isinf(mescd) && mescd < 0);
  }
  fixture_close(&s);
}

static void zero_references_count_in_mescd_only(void)
{
  fixture s;
  double scd, mescd;
  if (fixture_open(&s, "stiffpair")) return;
  NV_Ith_S(s.y, 0) = exp(-4) * (1 + 2e-5); /* exp(-4000) is zero in double */
  NV_Ith_S(s.y, 1) = 7e-3;
  CHECK(steif_problem_digits(s.ctx, &s.p, 4, s.y, 1, &scd, &mescd) == STEIF_OK);
  CLOSE(scd, -log10(2e-5), 1e-8);
  CLOSE(mescd, -log10(7e-3), 1e-12);
  fixture_close(&s);
  if (fixture_open(&s, "jordan:k=4,case=H-inc")) return;
  NV_Ith_S(s.y, 2) = 4e-6;
  CHECK(steif_problem_digits(s.ctx, &s.p, 0.7, s.y, 1, &scd, &mescd) == STEIF_OK);
  CHECK(isnan(scd));
  CLOSE(mescd, -log10(4e-6), 1e-12);
  fixture_close(&s);
}

/* A reference of chosen components, at the end of y' = -y written by hand. */
static int decay(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  N_VScale(-1, y, ydot);
  return 0;
}

static void chosen_components_are_compared_at_their_time(void)
{
  static const sunindextype component[] = {2, 0};
  static const sunrealtype value[] = {0.75, -1.25};
  static const steif_reference reference = {
    .t = 0.3, .count = 2, .component = component, .value = value, .source = "chosen"};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = {
    .name = "mine", .n = 3, .t1 = 1, .f = decay, .reference = &reference};
  N_Vector y = N_VNew_Serial(3, steif_sundials(ctx));
  double scd, mescd;
  NV_Ith_S(y, 0) = -1.25 * (1 + 4e-4), NV_Ith_S(y, 1) = 1e9, NV_Ith_S(y, 2) = 0.75;
  CHECK(steif_problem_digits(ctx, &p, 0.1 + 0.2, y, 0, &scd, &mescd) == STEIF_OK);
  CLOSE(scd, -log10(4e-4), 1e-9);
  CLOSE(mescd, scd, 1e-12);
  CHECK(steif_problem_digits(ctx, &p, 0.3000001, y, 0, &scd, &mescd) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "0.3") != NULL && isnan(scd) && isnan(mescd));
  N_VDestroy(y);
  steif_context_free(&ctx);
}

/* Closed solutions that end (> 0) or stop the run (< 0). */
static int ends(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)y, (void)yp, (void)user;
  return t > 1 ? 1 : -7;
}

static void an_exact_solution_may_decline(void)
{
  static const sunrealtype value[] = {2.5};
  static const steif_reference reference = {.t = 3, .value = value, .source = "chosen"};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = {
    .name = "mine", .n = 1, .t1 = 3, .f = decay, .exact = ends, .reference = &reference};
  N_Vector y = N_VNew_Serial(1, steif_sundials(ctx));
  double scd, mescd;
  NV_Ith_S(y, 0) = 2.5 * (1 - 6e-5);
  CHECK(steif_problem_digits(ctx, &p, 3, y, 1, &scd, &mescd) == STEIF_OK);
  CLOSE(scd, -log10(6e-5), 1e-9);
  CHECK(steif_problem_digits(ctx, &p, 2, y, 1, &scd, &mescd) == STEIF_UNSUPPORTED);
  CHECK(steif_problem_digits(ctx, &p, 0.5, y, 1, &scd, &mescd) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), "-7") != NULL);
  N_VDestroy(y);
  steif_context_free(&ctx);
}

static void wrong_arguments_are_rejected(void)
{
  fixture s;
  double scd, mescd;
  if (fixture_open(&s, "harmonic")) return;
  N_Vector longer = N_VNew_Serial(5, steif_sundials(s.ctx));
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.5, longer, 1, &scd, &mescd) == STEIF_BAD_INPUT);
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.5, NULL, 1, &scd, &mescd) == STEIF_BAD_INPUT);
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.5, s.y, 1, NULL, &mescd) == STEIF_BAD_INPUT);
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.5, s.y, 1, &scd, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_problem_digits(s.ctx, NULL, 1.5, s.y, 1, &scd, &mescd) == STEIF_BAD_INPUT);
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.5, s.y, -1, &scd, &mescd) == STEIF_BAD_INPUT);
  CHECK(steif_problem_digits(s.ctx, &s.p, 1.5, s.y, NAN, &scd, &mescd) == STEIF_BAD_INPUT);
  N_VDestroy(longer);
  fixture_close(&s);
}

CU_TestInfo tests_of_digits[] = {
  {"errors against the exact solution are measured", errors_of_the_exact_solution_are_measured},
  {"an exact hit shows the digits of double", an_exact_hit_shows_the_digits_of_double},
  {"what is not finite has minus infinity digits", what_is_not_finite_has_no_digits},
  {"zero references count in mescd only", zero_references_count_in_mescd_only},
  {"chosen components are compared at their time",
   chosen_components_are_compared_at_their_time},
  {"an exact solution may decline or stop", an_exact_solution_may_decline},
  {"wrong arguments are rejected", wrong_arguments_are_rejected},
  CU_TEST_INFO_NULL};
