/* test_glm.c: runs of general linear methods: changing steps, chosen steps, forms, dense
 * output, and what they refuse.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

/* u' = -2 t u^2, u = 1 / (1 + t^2), with y2' = -2 t u^2 y2 / u too. */
static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype u = NV_Ith_S(y, 0);
  (void)user;
  NV_Ith_S(r, 0) = -2 * t * u * u;
  NV_Ith_S(r, 1) = 2 * t * u * NV_Ith_S(y, 1);
  return 0;
}
static const sunrealtype y0[] = {1 / 1.36, 1.36};
static const steif_problem rational = {
  .name = "rational", .n = 2, .t0 = -0.6, .t1 = 1.4, .y0 = y0, .f = f};

static double error(N_Vector y, double t)
{
  return fmax(fabs(NV_Ith_S(y, 0) - 1 / (1 + t * t)), fabs(NV_Ith_S(y, 1) - 1 - t * t));
}

/* Times from -0.6 to 1.4 whose steps change by factors 1.5, 1 and 2/3 in turn; each halving
 * splits every step. */
enum { COARSE = 24, MOST = COARSE << 5 };
static size_t mesh(int halvings, double *t)
{
  double length[COARSE], sum = 0;
  for (int i = 0; i < COARSE; i++)
    length[i] = (i % 4 == 1 || i % 4 == 2 ? 1.5 : 1) * (1 + 0.3 * sin(i)), sum += length[i];
  const int parts = 1 << halvings;
  t[0] = -0.6;
  for (int i = 0; i < COARSE * parts; i++)
    t[i + 1] = t[i] + 2 * length[i / parts] / sum / parts;
  return (size_t)(COARSE * parts) + 1;
}

static double end_error(steif_context *ctx, const char *method, int halvings)
{
  static double t[MOST + 1];
  steif_options o = steif_defaults();
  o.mesh_size = mesh(halvings, t), o.mesh = t, o.newton = 1e-6;
  o.t1 = t[o.mesh_size - 1];
  steif_solver *s = steif_solver_new(ctx, &rational, method, &o);
  if (!s) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(s != NULL);
  CHECK(steif_solve_to(s, o.t1) == STEIF_OK);
  const double off = error(steif_solution(s), o.t1);
  steif_solver_free(&s);
  return off;
}

static void changing_steps_keep_the_order(void)
{
  static const char *const methods[] = {"glm:ab,p=2",
                                        "glm:ab,p=3",
                                        "glm:ab,p=4",
                                        "glm:am,p=3",
                                        "glm:am,p=4",
                                        "glm:bdf,p=2",
                                        "glm:bdf,p=3",
                                        "glm:nord22",
                                        "glm:dimsim1",
                                        "glm:dimsim2",
                                        "glm:dimsim1,p=3",
                                        "glm:dimsim1,p=4",
                                        "glm:dimsim2,p=3",
                                        "glm:nordsieck,of=bdf,p=3",
                                        "glm:nordsieck,of=am,p=4",
                                        "glm:irks,p=1",
                                        "glm:irks,p=2",
                                        "glm:irks,p=3",
                                        "glm:irks,p=4"};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    steif_method_info info;
    CHECK(steif_method_find(ctx, methods[i], &info) == STEIF_OK);
    const int halvings = info.order > 3 ? 3 : 4;
    const double order =
      log2(end_error(ctx, methods[i], halvings) / end_error(ctx, methods[i], halvings + 1));
    if (fabs(order - info.order) > 0.3) printf("\n  %s: %.3f", methods[i], order);
    CHECK(fabs(order - info.order) <= 0.3);
  }
  steif_context_free(&ctx);
}

/* Adaptive steps: errors of at most ten tolerances on stiff problems with known ends, in the forms ode
 * (hires, rober, vdpol) and mass. */
static void chosen_steps_meet_tolerances(void)
{
  static const char *const methods[] = {"glm:nord22",   "glm:dimsim2",
                                        "glm:irks,p=2", "glm:irks,p=3",
                                        "glm:irks,p=4", "glm:nordsieck,of=bdf,p=4",
                                        "glm:bdf,p=2",  "glm:bdf,p=4"};
  static const char *const problems[] = {"hires", "rober", "vdpol", "transamp"};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
    for (size_t k = 0; k < sizeof problems / sizeof *problems; k++) {
      steif_problem p;
      sunrealtype scd, mescd[2] = {NAN, NAN};
      CU_ASSERT_FATAL(steif_problem_find(ctx, problems[k], &p) == STEIF_OK);
      for (int m = 0; m < 2; m++) {
        steif_options o = steif_defaults();
        o.rtol = m ? 1e-6 : 1e-4, o.atol = o.rtol * (p.rtol_scale > 0 ? p.rtol_scale : 1);
        steif_solver *s = steif_solver_new(ctx, &p, methods[i], &o);
        const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
        if (code) printf("\n  %s %s: %s", problems[k], methods[i], steif_message(ctx));
        const bool second = strchr(methods[i], '2') != NULL; /* of order 2: may doubt itself */
        CHECK(code == STEIF_OK || (code == STEIF_NOT_CERTIFIED && second));
        if (s)
          CHECK(steif_problem_digits(ctx, &p, p.t1, steif_solution(s),
                                     p.rtol_scale > 0 ? p.rtol_scale : 1, &scd,
                                     &mescd[m]) == STEIF_OK);
        steif_solver_free(&s);
      }
      const int good = mescd[0] > 3 && mescd[1] > 5;
      if (!good)
        printf("\n  %s %s: %.2f and %.2f digits", problems[k], methods[i], mescd[0], mescd[1]);
      CHECK(good);
      steif_problem_clear(ctx, &p);
    }
  steif_context_free(&ctx);
}

/* Methods for smooth problems choose steps as well, those whose estimate is a change of h^p y^(p)
 * among them: with the digits asked for, or a code where the order is too low. */
static void other_methods_choose_steps(void)
{
  static const char *const methods[] = {"glm:ab,p=3",      "glm:ab,p=6",      "glm:dimsim1",
                                        "glm:dimsim1,p=3", "glm:dimsim1,p=4", "glm:am,p=2",
                                        "glm:am,p=3",      "glm:am,p=4",      "glm:am,p=6",
                                        "glm:bdf,p=3",     "glm:bdf,p=6"};
  int succeeded = 0;
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    steif_options o = steif_defaults();
    o.rtol = o.atol = 1e-7;
    steif_solver *s = steif_solver_new(ctx, &rational, methods[i], &o);
    const int code = s ? steif_solve_to(s, 1.4) : steif_status(ctx);
    if (code != STEIF_UNSUPPORTED && code != STEIF_NOT_CERTIFIED) {
      if (code) printf("\n  %s: %s", methods[i], steif_message(ctx));
      CHECK(code == STEIF_OK && error(steif_solution(s), 1.4) < 10 * o.rtol);
      CHECK(steif_statistics(s)->steps > 20);
      succeeded++;
    }
    steif_solver_free(&s);
  }
  CHECK(succeeded >= 8);
  steif_context_free(&ctx);
}

/* Between steps the error is of the size of that at the ends, for order p with h^(p+1) at most.
 * */
static void dense_output_has_the_order(void)
{
  static const char *const methods[] = {"glm:ab,p=3",  "glm:am,p=3", "glm:bdf,p=3",
                                        "glm:dimsim2", "glm:nord22", "glm:irks,p=3"};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    steif_method_info info;
    double most[2] = {0, 0};
    CHECK(steif_method_find(ctx, methods[i], &info) == STEIF_OK);
    for (int m = 0; m < 2; m++) {
      steif_options o = steif_defaults();
      o.h = m ? 0.01 : 0.02, o.newton = 1e-6;
      steif_solver *s = steif_solver_new(ctx, &rational, methods[i], &o);
      N_Vector y = s ? N_VClone(steif_solution(s)) : NULL;
      CU_ASSERT_FATAL(y != NULL);
      for (double t = -0.6; t < 1.39;) {
        CHECK(steif_solve_step(s) == STEIF_OK);
        const double end = steif_time(s), at = t + 0.37 * (end - t);
        CHECK(steif_dense(s, at, y) == STEIF_OK);
        most[m] = fmax(most[m], error(y, at)), t = end;
      }
      N_VDestroy(y);
      steif_solver_free(&s);
    }
    const double order = log2(most[0] / most[1]);
    if (!(order > info.order - 0.3)) printf("\n  %s: %.3f", methods[i], order);
    CHECK(order > info.order - 0.3);
  }
  steif_context_free(&ctx);
}

/* Index 3: with equal steps the stiffly accurate methods of stage order p give index-1
 * components of N x' + x = f exactly at stages, and no component blows up. */
static void descriptor_systems_are_solved(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(steif_problem_find(ctx, "jordan:k=2", &p) == STEIF_OK);
  for (int m = 0; m < 2; m++) {
    steif_options o = steif_defaults();
    o.h = 0.01, o.t1 = p.t0 + 1;
    steif_solver *s = steif_solver_new(ctx, &p, m ? "glm:irks,p=3" : "glm:nord22", &o);
    N_Vector exact = s ? N_VClone(steif_solution(s)) : NULL;
    CU_ASSERT_FATAL(exact != NULL && p.exact != NULL);
    CHECK(steif_solve_to(s, o.t1) == STEIF_OK && p.exact(o.t1, exact, NULL, p.user) == 0);
    N_VLinearSum(1, exact, -1, steif_solution(s), exact);
    if (N_VMaxNorm(exact) > 1e-3) printf("\n  %d: %.3e", m, N_VMaxNorm(exact));
    CHECK(N_VMaxNorm(exact) < 1e-3);
    N_VDestroy(exact);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void refuse(const steif_problem *p, const char *method, double h, int code,
                   const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.h = h;
  CHECK(!steif_solver_new(ctx, p, method, &o) && steif_status(ctx) == code);
  if (!strstr(steif_message(ctx), words)) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(strstr(steif_message(ctx), words) != NULL);
  steif_context_free(&ctx);
}

static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const int code = f(t, y, r, user);
  N_VLinearSum(1, yp, -1, r, r);
  return code;
}

static void questions_without_sense_are_refused(void)
{
  steif_problem implicit = rational;
  implicit.f = NULL, implicit.F = residual, implicit.yp0 = y0;
  refuse(&implicit, "glm:ab,p=2", 0.1, STEIF_UNSUPPORTED, "has explicit stages");
  refuse(&rational, "rk4", 0, STEIF_UNSUPPORTED, "'rk4' has no error estimate");
  refuse(&rational, "glm:dimsim2,p=3", 0, STEIF_UNSUPPORTED, "'glm:dimsim2,p=3' has no");
  refuse(&rational, "glm:bdf,p=7", 0.1, STEIF_BAD_INPUT, "not strictly stable");
  refuse(&rational, "glm:nord22,p=3", 0.1, STEIF_UNKNOWN_NAME, "no parameter 'p'");
  refuse(&rational, "glm:file=missing.glm", 0.1, STEIF_IO, "missing.glm");
  refuse(&rational, "glm:p=3", 0.1, STEIF_BAD_INPUT, "needs the name of a table");
}

CU_TestInfo tests_of_glm[] = {
  {"changing steps keep the order", changing_steps_keep_the_order},
  {"chosen steps meet tolerances", chosen_steps_meet_tolerances},
  {"other methods choose steps", other_methods_choose_steps},
  {"dense output has the order", dense_output_has_the_order},
  {"descriptor systems are solved", descriptor_systems_are_solved},
  {"questions without sense are refused", questions_without_sense_are_refused},
  CU_TEST_INFO_NULL};
