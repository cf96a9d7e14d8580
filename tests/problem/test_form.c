/* The form deduced from the members of a problem, and every sentence that refuses one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  N_VScale(-0.731, y, out);
  return 0;
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  (void)t, (void)user;
  N_VLinearSum(1, yp, 0.731, y, r);
  return 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)t, (void)derivative, (void)user;
  N_VConst(0.417, out);
  return 0;
}

static int fill(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(M, 0, 0) = SM_ELEMENT_D(M, 1, 1) = 1.93;
  return 0;
}

static int times(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  N_VScale(1.93, x, out);
  return 0;
}

static const double start[] = {0.83, -1.71};

static steif_problem bare(void)
{
  return (steif_problem){.name = "bare", .n = 2, .t1 = 1.37, .y0 = start};
}

static void forms_follow_from_the_members(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = bare();
  p.f = f;
  CHECK(steif_problem_form(ctx, &p) == STEIF_ODE);
  p.A = fill; /* the Jacobian by a direct fill */
  CHECK(steif_problem_form(ctx, &p) == STEIF_ODE);
  p.E = fill;
  CHECK(steif_problem_form(ctx, &p) == STEIF_MASS);
  p.E = NULL, p.Ev = times;
  CHECK(steif_problem_form(ctx, &p) == STEIF_MASS);
  p = bare(), p.F = F;
  CHECK(steif_problem_form(ctx, &p) == STEIF_IMPLICIT);
  p.E = p.A = fill;
  CHECK(steif_problem_form(ctx, &p) == STEIF_IMPLICIT);
  p.F = NULL;
  CHECK(steif_problem_form(ctx, &p) == STEIF_DESCRIPTOR);
  p.g = g;
  CHECK(steif_problem_form(ctx, &p) == STEIF_DESCRIPTOR);
  p.E = p.A = NULL, p.Ev = p.Av = times;
  CHECK(steif_problem_form(ctx, &p) == STEIF_DESCRIPTOR);
  CHECK(steif_status(ctx) == STEIF_OK);
  steif_context_free(&ctx);
}

static void forms_have_names(void)
{
  CHECK(!strcmp(steif_form_name(STEIF_ODE), "ode"));
  CHECK(!strcmp(steif_form_name(STEIF_MASS), "mass"));
  CHECK(!strcmp(steif_form_name(STEIF_IMPLICIT), "implicit"));
  CHECK(!strcmp(steif_form_name(STEIF_DESCRIPTOR), "descriptor"));
  CHECK(!strcmp(steif_form_name(3), "none"));
}

static void refused(const steif_problem *p, int code, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  const int form = steif_problem_form(ctx, p);
  const int good = !form && steif_status(ctx) == code && strstr(steif_message(ctx), words);
  if (!good) printf("\n  form %d, code %d: %s", form, steif_status(ctx), steif_message(ctx));
  CHECK(good);
  steif_context_free(&ctx);
}

static void missing_members_are_named(void)
{
  refused(NULL, STEIF_BAD_INPUT, "a problem is needed");
  steif_problem p = bare();
  p.name = NULL;
  refused(&p, STEIF_BAD_INPUT, "'unnamed' has no form");
  p = bare();
  refused(&p, STEIF_BAD_INPUT, "has no form: set .f");
  p.E = fill;
  refused(&p, STEIF_BAD_INPUT, "has no form");
  p.E = NULL, p.A = fill, p.g = g;
  refused(&p, STEIF_BAD_INPUT, "has no form");
  p = bare(), p.f = f, p.y0 = NULL;
  refused(&p, STEIF_BAD_INPUT, "no start values: set .y0 or .start");
  p = bare(), p.f = f, p.n = 0;
  refused(&p, STEIF_BAD_INPUT, "n = 0 components");
}

static void contradictory_members_are_refused(void)
{
  steif_problem p = bare();
  p.f = f, p.F = F;
  refused(&p, STEIF_BAD_INPUT, "and nothing besides");
  p.f = NULL, p.g = g;
  refused(&p, STEIF_BAD_INPUT, "and nothing besides");
  p.F = NULL, p.f = f;
  refused(&p, STEIF_BAD_INPUT, "and nothing besides");
}

static int give_start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)t, (void)yp, (void)user;
  N_VConst(0.29, y);
  return 0;
}

static void values_must_be_finite(void)
{
  const double bad[] = {0.83, NAN}, worse[] = {INFINITY, 0.2};
  steif_problem p = bare();
  p.f = f, p.y0 = bad;
  refused(&p, STEIF_NOT_FINITE, "y0[1] = nan");
  p.y0 = start, p.yp0 = worse;
  refused(&p, STEIF_NOT_FINITE, "yp0[0] = inf");
  p.y0 = NULL, p.start = give_start; /* slopes are looked at without y0 too */
  refused(&p, STEIF_NOT_FINITE, "yp0[0] = inf");
  p = bare(), p.f = f, p.t0 = -INFINITY;
  refused(&p, STEIF_BAD_INPUT, "interval [-inf, 1.37]");
  p.t0 = 2.5;
  refused(&p, STEIF_BAD_INPUT, "ascending");
}

static void indices_are_one_to_three(void)
{
  const int zero[] = {1, 0}, four[] = {4, 1}, good[] = {3, 1};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = bare();
  p.f = f, p.index = zero;
  refused(&p, STEIF_BAD_INPUT, "index[1] = 0");
  p.index = four;
  refused(&p, STEIF_BAD_INPUT, "index[0] = 4");
  p.y0 = NULL, p.start = give_start;
  refused(&p, STEIF_BAD_INPUT, "index[0] = 4");
  p.index = good;
  CHECK(steif_problem_form(ctx, &p) == STEIF_ODE);
  steif_context_free(&ctx);
}

static void breaks_ascend(void)
{
  const double falling[] = {0.31, 0.29}, infinite[] = {INFINITY};
  steif_problem p = bare();
  p.f = f, p.break_count = 2;
  refused(&p, STEIF_BAD_INPUT, "announces 2 breaks");
  p.breaks = falling, p.break_count = -1;
  refused(&p, STEIF_BAD_INPUT, "announces -1 breaks");
  p.break_count = 2;
  refused(&p, STEIF_BAD_INPUT, "breaks[1] = 0.28999");
  p.breaks = infinite, p.break_count = 1;
  refused(&p, STEIF_BAD_INPUT, "breaks[0] = inf");
}

static void storage_must_be_complete(void)
{
  steif_problem p = bare();
  p.f = f, p.storage = STEIF_BAND, p.lower = 2;
  refused(&p, STEIF_BAD_INPUT, "lower = 2, upper = 0");
  p.lower = 1, p.upper = -1;
  refused(&p, STEIF_BAD_INPUT, "upper = -1");
  p = bare(), p.f = f, p.storage = STEIF_SPARSE;
  refused(&p, STEIF_BAD_INPUT, "set .nnz");
  p.storage = (enum steif_storage)7;
  refused(&p, STEIF_BAD_INPUT, "storage 7");
}

static void forced_storage_must_be_complete_too(void)
{
  steif_problem p = bare();
  p.f = f;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "set .nnz");
  p.lower = 5;
  fixture_refused(&p, STEIF_BAND, STEIF_BAD_INPUT, "lower = 5");
}

/* Products serve Krylov storage only, and there a descriptor system needs both. */
static void products_do_not_make_matrices(void)
{
  steif_problem p = bare();
  p.f = f, p.Ev = times;
  fixture_refused(&p, STEIF_DENSE, STEIF_UNSUPPORTED, "fill .E, or take Krylov");
  p.f = NULL, p.Av = times;
  fixture_refused(&p, STEIF_DENSE, STEIF_UNSUPPORTED, "fill .E and .A");
  p.Av = NULL, p.A = fill;
  fixture_refused(&p, STEIF_KRYLOV, STEIF_UNSUPPORTED, ".Av for Krylov");
  p.Ev = NULL, p.E = fill;
  fixture_refused(&p, STEIF_KRYLOV, STEIF_UNSUPPORTED, ".Ev for Krylov");
}

CU_TestInfo tests_of_form[] = {
  {"forms follow from the members", forms_follow_from_the_members},
  {"forms have names", forms_have_names},
  {"missing members are named", missing_members_are_named},
  {"contradictory members are refused", contradictory_members_are_refused},
  {"values must be finite", values_must_be_finite},
  {"indices are 1 to 3", indices_are_one_to_three},
  {"breaks ascend", breaks_ascend},
  {"storage must be complete", storage_must_be_complete},
  {"forced storage must be complete too", forced_storage_must_be_complete_too},
  {"products do not make matrices", products_do_not_make_matrices},
  CU_TEST_INFO_NULL};
