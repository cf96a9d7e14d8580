/* law_checkpoint.c: a run that was saved and loaded ends in the same bits, with the same statistics, as the
 * one that went on, for every method and every kind of storage.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <stdlib.h>
#include <unistd.h>

/* A number that is other in every call, the same in every run of the test. */
static unsigned any(unsigned below)
{
  static unsigned state = 2463534242u;
  state ^= state << 13, state ^= state >> 17, state ^= state << 5;
  return state % below;
}

static void name_file(char *path, size_t room)
{
  snprintf(path, room, "law_checkpoint.%ld.ck", (long)getpid());
}

static int same_state(steif_solver *a, steif_solver *b)
{
  const steif_stats *x = steif_statistics(a), *y = steif_statistics(b);
  N_Vector u = steif_solution(a), v = steif_solution(b);
  const size_t bytes = (size_t)N_VGetLength(u) * sizeof(sunrealtype);
  return steif_time(a) == steif_time(b) && x->steps == y->steps && x->rejected == y->rejected &&
         x->nfe == y->nfe && x->nje == y->nje && x->nlu == y->nlu && x->nsolve == y->nsolve &&
         x->newton == y->newton && x->newton_fails == y->newton_fails && x->nli == y->nli &&
         x->h_last == y->h_last && x->rounding == y->rounding &&
         !strcmp(steif_method_used(a), steif_method_used(b)) &&
         !memcmp(N_VGetArrayPointer(u), N_VGetArrayPointer(v), bytes);
}

/* Dense output in the last step. */
static int same_inside(steif_solver *a, steif_solver *b)
{
  N_Vector u = N_VClone(steif_solution(a)), v = N_VClone(u);
  const sunrealtype t = steif_time(a) - 0.3 * steif_statistics(a)->h_last;
  const size_t bytes = (size_t)N_VGetLength(u) * sizeof(sunrealtype);
  const int x = steif_dense(a, t, u), y = steif_dense(b, t, v);
  const int same =
    x == y && (x || !memcmp(N_VGetArrayPointer(u), N_VGetArrayPointer(v), bytes));
  N_VDestroy(u), N_VDestroy(v);
  return same;
}

static const char *where;

static void say(steif_context *ctx, const char *method, long step, const char *what)
{
  printf("\n  %s %s after step %ld: %s: %s", where, method, step, what, steif_message(ctx));
}

/* Both to the end, or so many steps. */
static int go_on_alike(steif_context *ctx, const char *method, steif_solver *a, steif_solver *b,
                       long from)
{
  for (int k = 0; k < 150; k++) {
    const int x = steif_solve_step(a), y = steif_solve_step(b);
    if (x != y || !same_state(a, b)) return say(ctx, method, from + k, "other bits"), 0;
    if (x) break;
  }
  return 1;
}

/* Save after `steps` steps, load, and compare the rest of both. */
static int continues(steif_context *ctx, const steif_problem *p, const char *method,
                     const steif_options *o, long steps)
{
  char path[64];
  name_file(path, sizeof path);
  steif_solver *a = steif_solver_new(ctx, p, method, o);
  int good = a != NULL, code = 0;
  for (long k = 0; a && k < steps && !code; k++) code = steif_solve_step(a);
  if (!a) say(ctx, method, 0, "not opened");
  if (a && (good = !steif_checkpoint_save(a, path, NULL, 0)) == 0)
    say(ctx, method, steps, "save");
  steif_solver *b = good ? steif_checkpoint_load(ctx, path, p, o) : NULL;
  if (good && !b) say(ctx, method, steps, "load");
  good = b && same_state(a, b) && same_inside(a, b);
  if (b && !good) say(ctx, method, steps, "other state");
  good = good && go_on_alike(ctx, method, a, b, steps);
  steif_solver_free(&a), steif_solver_free(&b);
  remove(path);
  return good;
}

static void at_several_steps(steif_context *ctx, const steif_problem *p, const char *method,
                             const steif_options *o)
{
  where = p->name;
  CHECK(continues(ctx, p, method, o, 1));
  for (int k = 0; k < 3; k++) CHECK(continues(ctx, p, method, o, 2 + (long)any(25)));
}

/* Constant steps, and chosen ones where the method has them. */
static void both_kinds(steif_context *ctx, const steif_problem *p, const char *method)
{
  steif_options o = steif_defaults();
  steif_method_info info;
  CU_ASSERT_FATAL(!steif_method_find(ctx, method, &info));
  o.h = 0.031;
  at_several_steps(ctx, p, method, &o);
  o.h = 0, o.rtol = 1e-5;
  if (info.adaptive) at_several_steps(ctx, p, method, &o);
}

static void every_method_goes_on(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_method_info info;
  steif_problem nonlinear = law_problem;
  nonlinear.linear = 0;
  for (int m = 0; m < law_method_count; m++) both_kinds(ctx, &nonlinear, law_methods[m]);
  for (size_t m = 0; steif_method_at(ctx, m, &info) == STEIF_OK; m++)
    if (strcmp(info.family, "sympl") && strcmp(info.family, "baseline") &&
        strcmp(info.family, "descriptor"))
      both_kinds(ctx, &nonlinear, info.name);
  steif_context_free(&ctx);
}

/* Matrices in every storage, with the factors of each; DAEs, events, two methods of auto. */
static void every_problem_goes_on(void)
{
  static const struct {
    const char *problem, *method;
    sunrealtype rtol;
  } row[] = {
    {"hires", "auto", 1e-8},
    {"rober", "auto", 1e-10},
    {"vdpol", "radau:s=5", 1e-8},
    {"hires", "bdf", 1e-6},
    {"hires", "dirk:hw43", 1e-6},
    {"pollu", "radau:s=3", 1e-6},
    {"pollu", "bdf", 1e-6},
    {"pollu", "rodas4", 1e-6},
    {"medakzo:n=40", "radau:s=3", 1e-5},
    {"medakzo:n=40", "bdf", 1e-5},
    {"transamp", "radau:s=3", 1e-6},
    {"transamp", "rodas4p2", 1e-5},
    {"caraxis", "radau:s=3", 1e-6},
    {"andrews", "auto", 1e-6},
    {"beam", "gauss:s=3", 1e-4},
    {"bruss2d", "radau:s=3", 1e-5},
    {"bruss2d", "bdf", 1e-4},
    {"heat:n=40", "radau:s=4", 1e-6},
    {"heat:n=300", "glm:irks,p=3", 1e-5},
    {"heat:n=300", "exprb43", 1e-5},
    {"bounce", "radau:s=3", 1e-6},
    {"rectifier", "bdf", 1e-5},
    {"rectifier", "auto", 1e-6},
    {"swing", "dirk:hw43", 1e-5},
    {"kepler", "dopri87", 1e-9},
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_problem p;
    steif_options o = steif_defaults();
    if (steif_problem_find(ctx, row[i].problem, &p)) {
      printf("\n  %s: %s", row[i].problem, steif_message(ctx));
      CU_FAIL("unknown problem");
      continue;
    }
    o.rtol = row[i].rtol;
    at_several_steps(ctx, &p, row[i].method, &o);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* Products instead of matrices; two methods of auto, of which the run takes both; splitting methods. */
static void other_kinds_go_on(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.force_storage = 1, o.storage = STEIF_KRYLOV, o.rtol = 1e-5;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "heat:n=40", &p));
  at_several_steps(ctx, &p, "radau:s=3", &o);
  at_several_steps(ctx, &p, "bdf", &o);
  at_several_steps(ctx, &p, "exprb32", &o);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bruss2d", &p));
  at_several_steps(ctx, &p, "dirk:hw43", &o);
  steif_problem_clear(ctx, &p);
  o = steif_defaults(), o.h = 0.05, o.t1 = 600;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "kepler", &p));
  at_several_steps(ctx, &p, "verlet", &o);
  at_several_steps(ctx, &p, "symeuler:first=q", &o);
  at_several_steps(ctx, &p, "kahanli8", &o);
  at_several_steps(ctx, &p, "gauss:s=2,compensated=1", &o);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Engines come to the same point by repeating their steps. */
static void engines_are_repeated(void)
{
  static const struct {
    const char *problem, *method;
  } row[] = {{"hires", "cvode"},   {"chemakzo", "ida"},   {"hires", "arkode"},
             {"bounce", "cvode"},  {"switchrlc", "auto"}, {"rectifier", "ida"},
             {"bus", "descriptor"}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_problem p;
    steif_options o = steif_defaults();
    CU_ASSERT_FATAL(!steif_problem_find(ctx, row[i].problem, &p));
    o.rtol = 1e-5;
    at_several_steps(ctx, &p, row[i].method, &o);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_checkpoint[] = {{"every method goes on", every_method_goes_on},
                                         {"every problem goes on", every_problem_goes_on},
                                         {"other kinds go on", other_kinds_go_on},
                                         {"engines are repeated", engines_are_repeated},
                                         CU_TEST_INFO_NULL};
