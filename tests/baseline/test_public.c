/* test_public.c: the baselines through the public interface, as a user calls them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const char *const all[] = {"cvode", "ida", "arkode:order=5,newton=1e-3"};

/* van der Pol, mu = 9: y1' = y2, y2' = 9 (1 - y1^2) y2 - y1 */
static int vdpol(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  const sunrealtype *x = NV_DATA_S(y);
  NV_Ith_S(ydot, 0) = x[1];
  NV_Ith_S(ydot, 1) = 9 * (1 - x[0] * x[0]) * x[1] - x[0];
  return 0;
}

static int vdpol_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  const sunrealtype *x = NV_DATA_S(y);
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -18 * x[0] * x[1] - 1;
  SM_ELEMENT_D(J, 1, 1) = 9 * (1 - x[0] * x[0]);
  return 0;
}

static const sunrealtype y0[] = {2.1, -0.3};
static const steif_problem problem = {
  .name = "vdpol9", .n = 2, .t1 = 21, .y0 = y0, .f = vdpol, .jac = vdpol_jac};

/* Solve to t and return the first component. */
static sunrealtype solve(const char *method, sunrealtype rtol, sunrealtype t)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *s = steif_solver_new(ctx, &problem, method, &o);
  const int code = s ? steif_solve_to(s, t) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  const sunrealtype value = s ? NV_Ith_S(steif_solution(s), 0) : NAN;
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return value;
}

static void all_agree_with_radau(void)
{
  const sunrealtype reference = solve("radau:s=3", 1e-10, 20.7);
  for (int e = 0; e < 3; e++) CLOSE(solve(all[e], 1e-9, 20.7), reference, 1e-5);
}

static void output_between_the_steps(void)
{
  for (int e = 0; e < 3; e++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = 1e-8;
    steif_solver *s = steif_solver_new(ctx, &problem, all[e], &o);
    for (int i = 1; i <= 5; i++) {
      CHECK(steif_solve_to(s, 1.3 * i) == STEIF_OK);
      CHECK(steif_time(s) == 1.3 * i);
      CLOSE(NV_Ith_S(steif_solution(s), 0), solve("radau:s=3", 1e-10, 1.3 * i), 1e-4);
    }
    const steif_stats *n = steif_statistics(s);
    CHECK(n->steps > 20 && n->nfe > n->steps && n->nje > 0 && n->nlu > 0 && n->cpu_s > 0);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

static void failures_reach_the_context(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  CHECK(steif_solver_new(ctx, &problem, "cvode:order=7", &o) == NULL);
  CHECK(steif_status(ctx) == STEIF_BAD_INPUT && strstr(steif_message(ctx), "order=7"));
  o.h = 0.01;
  CHECK(steif_solver_new(ctx, &problem, "ida", &o) == NULL);
  CHECK(steif_status(ctx) == STEIF_UNSUPPORTED && strstr(steif_message(ctx), "IDA chooses"));
  o.h = 0, o.max_steps = 30;
  steif_solver *s = steif_solver_new(ctx, &problem, "cvode", &o);
  CHECK(steif_solve_to(s, 20) == STEIF_STEP_LIMIT);
  CHECK(strstr(steif_message(ctx), "made 30 steps") != NULL);
  CHECK(steif_statistics(s)->steps == 30 && steif_time(s) > 0);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void equal_steps_of_arkode_are_those_of_our_engine(void)
{
  static const char *const tables[] = {"alexander2", "alexander3", "trbdf2", "esdirk43"};
  for (int k = 0; k < 4; k++) {
    sunrealtype end[2][2];
    for (int ours = 0; ours < 2; ours++) {
      char spec[64];
      snprintf(spec, sizeof spec, ours ? "dirk:%s" : "arkode:table=%s", tables[k]);
      steif_context *ctx = steif_context_new(NULL);
      steif_options o = steif_defaults();
      o.h = 0.013;
      steif_solver *s = steif_solver_new(ctx, &problem, spec, &o);
      CHECK(s && steif_solve_to(s, 21) == STEIF_OK);
      if (steif_status(ctx)) printf("\n  %s: %s", spec, steif_message(ctx));
      CHECK(steif_statistics(s)->steps == 1616); /* 21 / 0.013 rounded up */
      for (int i = 0; i < 2; i++) end[ours][i] = NV_Ith_S(steif_solution(s), i);
      steif_solver_free(&s);
      steif_context_free(&ctx);
    }
    CLOSE(end[1][0], end[0][0], 1e-9);
    CLOSE(end[1][1], end[0][1], 1e-8);
  }
}

/* Open, run and free; the number of requests. */
static long starve(const steif_problem *p, const char *method, long fatal)
{
  failing memory = {.refuse_at = fatal};
  const steif_setup setup = failing_setup(&memory);
  steif_context *ctx = steif_context_new(&setup);
  if (!ctx) return memory.served;
  steif_solver *s = steif_solver_new(ctx, p, method, NULL);
  if (fatal && memory.served >= fatal) CHECK(!s && steif_status(ctx) == STEIF_NO_MEMORY);
  const long opened = memory.served;
  if (s) CHECK(steif_solve_to(s, 0.4) == STEIF_OK && memory.served == opened);
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return memory.served;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 0) = 1;
  SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

static void memory_may_end_anywhere(void)
{
  steif_problem p[2] = {problem, problem};
  p[1].E = mass;
  for (int e = 0; e < 3; e++)
    for (int form = e == 0 ? 1 : 0; form < 2; form++) {
      const steif_problem *which = e == 0 ? &p[0] : &p[form];
      const long total = starve(which, all[e], 0);
      CHECK(total > 8);
      for (long k = 1; k <= total; k++) starve(which, all[e], k);
    }
}

static int look(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)t, (void)y;
  ++*(long *)user;
  return 0;
}

/* Where nobody looks at steps, the package makes many in one call: they are the same steps, between
 * outputs, through a break and under limits. Two problems: one with a break, at t = 1.1. */
static void steps_are_the_same_whoever_looks(void)
{
  static const char *const names[] = {"vdpol", "bruss2d:n=4"};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 6; k++) {
    steif_problem p;
    volatile int stop = 0;
    long seen = 0, steps[3] = {0};
    sunrealtype end[3][2];
    CU_ASSERT_FATAL(!steif_problem_find(ctx, names[k % 2], &p));
    for (int way = 0; way < 3; way++) { /* alone, alone with limits, observed */
      steif_options o = steif_defaults();
      o.rtol = 1e-5;
      if (way == 1) o.stop = &stop, o.max_seconds = 1000;
      if (way == 2) o.observe = look, o.observer = &seen;
      steif_solver *s = steif_solver_new(ctx, &p, all[k / 2], &o);
      for (int part = 1; part <= 2; part++) {
        CHECK(s && steif_solve_to(s, part < 2 ? 0.37 * p.t1 : p.t1) == STEIF_OK);
        end[way][part - 1] = NV_Ith_S(steif_solution(s), 0);
      }
      CHECK(steif_time(s) == p.t1);
      steps[way] = steif_statistics(s)->steps;
      steif_solver_free(&s);
    }
    CHECK(seen == steps[2] && steps[0] == seen && steps[1] == seen);
    CHECK(!memcmp(end[0], end[2], sizeof *end) && !memcmp(end[1], end[2], sizeof *end));
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* Limits hold inside of long calls, too. */
static void limits_hold(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int e = 0; e < 3; e++) {
    steif_options o = steif_defaults();
    volatile int stop = 0;
    o.max_steps = 40;
    steif_solver *s = steif_solver_new(ctx, &problem, all[e], &o);
    CHECK(s && steif_solve_to(s, 21) == STEIF_STEP_LIMIT);
    CHECK(steif_statistics(s)->steps == 40 && steif_time(s) > 0 && steif_time(s) < 21);
    steif_solver_free(&s);
    o.max_steps = 100000, o.stop = &stop;
    s = steif_solver_new(ctx, &problem, all[e], &o);
    CHECK(s && steif_solve_to(s, 1) == STEIF_OK);
    stop = 1;
    CHECK(steif_solve_to(s, 21) == STEIF_STOPPED);
    stop = 0;
    CHECK(steif_solve_to(s, 21) == STEIF_OK);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_public[] = {
  {"steps are the same whoever looks", steps_are_the_same_whoever_looks},
  {"limits hold in long calls", limits_hold},
  {"all agree with radau", all_agree_with_radau},
  {"output between the steps", output_between_the_steps},
  {"failures reach the context", failures_reach_the_context},
  {"equal steps of ARKODE are those of our engine",
   equal_steps_of_arkode_are_those_of_our_engine},
  {"memory may end anywhere, and none is asked for while stepping", memory_may_end_anywhere},
  CU_TEST_INFO_NULL};
