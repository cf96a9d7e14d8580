/* test_slope_directions.c: directions of parameters, wrong ones, and short memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "slope_case.h"

/* ---- parameters --------------------------------------------------------------------------------------- */

static const char circuit[] =
  "model \"switch\"\nform descriptor\n"
  "param C1 = 2e-6, C2 = 3e-6, L = 1e-3, R = 10, R2 = 200, U = 6, v0 = 5, Rs = 0\n"
  "state v1 = v0, v2 = 1, iL = 0, e = 0, i = 0\n"
  "C1*v1' - iL + i = 0\nC2*v2' + v2/R2 - i = 0\nL*iL' + v1 - e = 0\ne + R*iL = U\n"
  "v1 - v2 = Rs*i\ntime 0 to 1e-3\n";

static void of_a_model(void)
{
  static const struct {
    const char *name;
    double v, i, c0;
  } known[] = {{"C1", 480000, 2520, 1.44},
               {"C2", -320000, -1680, 0.64},
               {"L", 0, 0, 0},
               {"R", 0, 0, 0},
               {"R2", 0, -2.6e-5, 0},
               {"U", 0, 0, 0},
               {"v0", 0.4, 0.0008, 1.2e-6}};
  bench b = {.ctx = steif_context_new(NULL)};
  CHECK(steif_model_parse(b.ctx, circuit, "switch", NULL, &b.problem) == STEIF_OK);
  CHECK(steif_linear_of(b.ctx, &b.problem, &b.system) == STEIF_OK);
  for (int k = 0; k < 8; k++) {
    const int number = steif_parameter_find(b.ctx, &b.problem, k < 7 ? known[k].name : "Rs");
    CHECK(steif_impulse_direction_of(b.ctx, &b.problem, number, &b.along) == STEIF_OK);
    CHECK(!steif_impulse_slope_find(b.ctx, &b.system, b.problem.y0, 0, NULL, NULL, &b.along,
                                    &b.slope));
    CHECK(b.slope.certified && b.slope.exists == (k < 7));
    if (k < 7) {
      /* The estimate is relative to the norms of both (slopes.h); x(0+) is of size 10. */
      const double size = fmax(fabs(known[k].v), 10 / b.slope.unit);
      CHECK(b.slope.estimate < 1e-9);
      CLOSE_FLOOR(b.slope.x_plus[0], known[k].v, b.slope.estimate, size);
      CLOSE_FLOOR(b.slope.x_plus[4], known[k].i, b.slope.estimate, size);
      CLOSE_FLOOR(b.slope.x_plus[3], k == 5, b.slope.estimate, size);
      CLOSE_FLOOR(b.slope.c[4], known[k].c0, 1e-9, 1e-6);
    }
    steif_impulse_slope_clear(b.ctx, &b.slope);
    steif_impulse_direction_clear(b.ctx, &b.along);
  }
  CHECK(b.problem.parameters->value[0] == 2e-6);
  SUNMatDestroy(b.system.E), SUNMatDestroy(b.system.F);
  steif_problem_clear(b.ctx, &b.problem);
  steif_context_free(&b.ctx);
}

/* (p - 1)^m x' + x = 1, y' + y + x = 0: x(0+) is x(0-) beside p = 1 and 1 there, whatever the first derivative of E is. By
 * q, which E does not hold, and by r, which moves E without its structure, the derivatives are 0. */
static void of_higher_order(void)
{
  static const char *const first[] = {"(p-1)^2", "(p-1)^3", "(p-1)^4", "abs(p-1)^3"};
  for (int m = 0; m < 4; m++) {
    char text[200];
    bench b = {.ctx = steif_context_new(NULL)};
    snprintf(text, sizeof text,
             "param p = 1, q = 1, r = 1\nstate x = 2, y = 3\n%s*x' + x = 1\n"
             "(1+(r-1)^2)*y' + y + q*x = 0\ntime 0 to 1\n",
             first[m]);
    CHECK(steif_model_parse(b.ctx, text, "jump", NULL, &b.problem) == STEIF_OK);
    CHECK(steif_linear_of(b.ctx, &b.problem, &b.system) == STEIF_OK);
    for (int k = 0; k < 3; k++) {
      CHECK(steif_impulse_direction_of(b.ctx, &b.problem, k, &b.along) == STEIF_OK);
      CHECK(!steif_impulse_slope_find(b.ctx, &b.system, b.problem.y0, 0, NULL, NULL, &b.along,
                                      &b.slope));
      CHECK(b.slope.certified && b.slope.exists == (k > 0));
      CHECK(k || (isnan(b.slope.x_plus[0]) && b.slope.finite_near == 2));
      for (int i = 0; k && i < 2; i++) CLOSE_FLOOR(b.slope.x_plus[i], 0, 1e-12, 3);
      steif_impulse_slope_clear(b.ctx, &b.slope);
      steif_impulse_direction_clear(b.ctx, &b.along);
    }
    SUNMatDestroy(b.system.E), SUNMatDestroy(b.system.F);
    steif_problem_clear(b.ctx, &b.problem);
    steif_context_free(&b.ctx);
  }
}

/* ---- bad input ----------------------------------------------------------------------------------------- */

static int of_another_order(sunrealtype by, SUNMatrix *E, SUNMatrix *F, void *user)
{
  const bench *b = user;
  (void)by;
  *E = SUNDenseMatrix(2, 2, steif_sundials(b->ctx));
  *F = SUNDenseMatrix(5, 5, steif_sundials(b->ctx));
  return STEIF_OK;
}

static void wrong_directions(void)
{
  static const sunrealtype nan[] = {0, NAN, 0, 0, 0};
  bench b;
  set_up(&b, "switchrlc");
  SM_ELEMENT_D(b.dE, 1, 2) = NAN;
  CHECK(find(&b) == STEIF_NOT_FINITE && !b.slope.x_plus);
  CHECK(strstr(steif_message(b.ctx), "dE/dp has nan in row 2, column 3"));
  SM_ELEMENT_D(b.dE, 1, 2) = 0;
  b.along.x0 = nan;
  CHECK(find(&b) == STEIF_NOT_FINITE && strstr(steif_message(b.ctx), "dx(0-)/dp"));
  b.along.x0 = NULL, b.along.nearby = of_another_order, b.along.user = &b;
  SM_ELEMENT_D(b.dE, 0, 0) = 1;
  CHECK(find(&b) == STEIF_BAD_INPUT && strstr(steif_message(b.ctx), "of the order 5"));
  SUNMatrix small = SUNDenseMatrix(3, 3, steif_sundials(b.ctx));
  const steif_impulse_direction d = {.F = small};
  CHECK(steif_impulse_slope_find(b.ctx, &b.system, b.problem.y0, 0, NULL, NULL, &d, &b.slope) ==
        STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(b.ctx), "dF/dp has 3 columns"));
  SUNMatDestroy(small);
  steif_impulse_direction of;
  CHECK(steif_impulse_direction_of(b.ctx, &b.problem, 0, &of) == STEIF_BAD_INPUT);
  tear_down(&b);
}

static void short_memory(void)
{
  long need = 1;
  for (long at = 0; at <= need; at += 1 + at / 24) {
    failing f = {.refuse_at = at};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    if (!ctx) continue;
    steif_problem p = {0};
    steif_linear l = {0};
    steif_impulse_direction d = {0};
    steif_impulse_slope s = {0};
    int code = steif_model_parse(ctx, circuit, "switch", NULL, &p);
    if (!code) code = steif_linear_of(ctx, &p, &l);
    if (!code) code = steif_impulse_direction_of(ctx, &p, 0, &d);
    if (!code) code = steif_impulse_slope_find(ctx, &l, p.y0, 0, NULL, NULL, &d, &s);
    CHECK(code == (at ? STEIF_NO_MEMORY : STEIF_OK) || (code == STEIF_OK && s.exists == 1));
    CHECK(!code || !s.x_plus);
    steif_impulse_slope_clear(ctx, &s);
    steif_impulse_direction_clear(ctx, &d);
    if (l.E) SUNMatDestroy(l.E);
    if (l.F) SUNMatDestroy(l.F);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
    if (!at) need = f.served;
  }
}

CU_TestInfo tests_of_slope_directions[] = {
  {"parameters of a model", of_a_model},
  {"matrices that move in higher order", of_higher_order},
  {"wrong directions", wrong_directions},
  {"short of memory", short_memory},
  CU_TEST_INFO_NULL};
