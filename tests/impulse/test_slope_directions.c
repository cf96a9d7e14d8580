/* test_slope_directions.c: directions of parameters, wrong ones, and short memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "slope_case.h"
#include <steif/parameters.h>
#include <steif/sensitivity.h>

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

/* x(0+), then the impulses by all parameters of a problem of the collection. */
static void of_problem(const char *spec, int count, int vectors, const double *known)
{
  bench b;
  set_up(&b, spec);
  const int n = (int)b.problem.n;
  CHECK(b.problem.parameters && b.problem.parameters->count == count);
  for (int k = 0; k < count; k++, known += n * vectors) {
    double most = 1;
    CHECK(steif_impulse_direction_of(b.ctx, &b.problem, k, &b.along) == STEIF_OK);
    CHECK(!steif_impulse_slope_find(b.ctx, &b.system, b.problem.y0, 0, NULL, NULL, &b.along,
                                    &b.slope));
    CHECK(b.slope.certified && b.slope.exists == 1 && b.slope.count == vectors - 1);
    for (int i = 0; i < n * vectors; i++) most = fmax(most, fabs(known[i]));
    for (int i = 0; i < n * vectors; i++)
      CLOSE_FLOOR(i < n ? b.slope.x_plus[i] : b.slope.c[i - n], known[i], 1e-11, most);
    steif_impulse_slope_clear(b.ctx, &b.slope);
    steif_impulse_direction_clear(b.ctx, &b.along);
  }
  tear_down(&b);
}

/* Closed forms: see test_slopes.c; q N x' + x = f has x(0+) = sum (-q)^i N^i f^(i), f_m = cos(m + t); ut5 in rational
 * numbers, by beta, by rows and columns mixed. */
static const double impact[] = {0,
                                0,
                                0.433884297520661,
                                0.433884297520661,
                                -2.40871525169046,
                                0,
                                0,
                                0,
                                0,
                                -0.303719008264463,
                                0,
                                0,
                                0,
                                0,
                                0,
                                0,
                                0,
                                -0.929752066115702,
                                -0.929752066115702,
                                5.16153268219384,
                                0,
                                0,
                                0,
                                0,
                                -1.39462809917355,
                                0,
                                0,
                                0,
                                0,
                                0,
                                0.318181818181818,
                                0.318181818181818,
                                -0.0867768595041322,
                                -0.0867768595041322,
                                4.03302028549962,
                                0,
                                0,
                                0.318181818181818,
                                -0.681818181818182,
                                0.0607438016528926,
                                0,
                                0,
                                0,
                                0,
                                0.477272727272727};
static const double ut5[] = {-20, -20, 20,  1, 0,   2, 2,  -2, 5, 0, 10, 10, -10, 0, 0,
                             20,  20,  -20, 0, 0,   0, 0,  0,  0, 0, 0,  0,  0,   0, 0,
                             5,   12,  8,   0, -12, 7, -2, -9, 3, 1, -2, 3,  -8,  0, 5};
static const double rlc[] = {480000,  480000,  0, 0, 2520,    0, 0, 0, 0, 1.44, /* C1 */
                             -320000, -320000, 0, 0, -1680,   0, 0, 0, 0, 0.64, /* C2 */
                             0,       0,       0, 0, 0,       0, 0, 0, 0, 0,    /* L, R */
                             0,       0,       0, 0, 0,       0, 0, 0, 0, 0,
                             0,       0,       0, 0, -2.6e-5, 0, 0, 0, 0, 0, /* R2, V */
                             0,       0,       0, 1, 0,       0, 0, 0, 0, 0};

static void of_the_collection(void)
{
  const double jordan[] = {sin(2) - 2 * cos(3), sin(3), 0, 2.1339068204274, 3.9899924966004, 0,
                           -7.9799849932009,    0,      0};
  of_problem("impact", 3, 3, impact);
  of_problem("jordan:case=N-inc", 1, 3, jordan);
  of_problem("ut5", 3, 3, ut5);
  of_problem("switchrlc", 6, 2, rlc);
}

/* After the start: S of runs beside differences of the exact solution by p. */
static void of_runs(void)
{
  static const struct {
    const char *spec;
    double t, size;
  } runs[] = {
    {"switchrlc", 2e-4, 1}, {"impact", 1, 1}, {"impact:case=cons", 1, 1}, {"jordan", 1, 1}};
  for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
    bench b;
    set_up(&b, runs[r].spec);
    const steif_parameters *q = b.problem.parameters;
    N_Vector S = N_VNew_Serial(b.problem.n, steif_sundials(b.ctx)), low = N_VClone(S),
             high = N_VClone(S);
    steif_options o = steif_defaults();
    o.rtol = 1e-8, o.sensitivities = 1;
    steif_solver *s = steif_solver_new(b.ctx, &b.problem, "radau:s=3", &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, runs[r].t));
    for (int k = 0; k < q->count; k++) {
      const double p = q->value[k], h = 1e-4 * (p != 0 ? p : 1);
      CHECK(!steif_sensitivity_output(s, runs[r].t, k, S));
      CHECK(!steif_parameter_set(b.ctx, &b.problem, k, p + h));
      CHECK(!b.problem.exact(runs[r].t, high, NULL, b.problem.user));
      CHECK(!steif_parameter_set(b.ctx, &b.problem, k, p - h));
      CHECK(!b.problem.exact(runs[r].t, low, NULL, b.problem.user));
      CHECK(!steif_parameter_set(b.ctx, &b.problem, k, p));
      N_VLinearSum(0.5 / h, high, -0.5 / h, low, low);
      for (sunindextype i = 0; i < b.problem.n; i++)
        CLOSE_FLOOR(NV_Ith_S(S, i), NV_Ith_S(low, i), 1e-5, N_VMaxNorm(low));
    }
    steif_solver_free(&s);
    N_VDestroy(S), N_VDestroy(low), N_VDestroy(high);
    tear_down(&b);
  }
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
  CHECK(steif_impulse_direction_of(b.ctx, &b.problem, 6, &of) == STEIF_BAD_INPUT);
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
  {"parameters of the collection", of_the_collection},
  {"runs by these parameters", of_runs},
  {"matrices that move in higher order", of_higher_order},
  {"wrong directions", wrong_directions},
  {"short of memory", short_memory},
  CU_TEST_INFO_NULL};
