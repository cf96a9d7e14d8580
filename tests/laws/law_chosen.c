/* law_chosen.c: runs with chosen steps: attempts are pure, pauses change nothing, a run begun anew ends
 * in the same place, a mirrored run comes home, and the number of threads does not matter.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include "integrator.h"
#include <stdlib.h>

static const char *const chosen[] = {"auto",      "radau:s=3",     "radau:s=5",   "radau:s=7",
                                     "gauss:s=3", "gauss:s=4",     "bdf",         "bdf:p=2",
                                     "dirk:hw43", "dirk:esdirk43", "dirk:trbdf2", "rodas4",
                                     "rodas5p",   "exprb43",       "dopri87"};
enum { CHOSEN = sizeof chosen / sizeof *chosen, ACCEPTED = 7 };

/* With weights for a step of length h, after ACCEPTED steps. */
static steif_solver *part_way(steif_context *ctx, const char *method)
{
  const steif_options o = {.rtol = 1e-5};
  steif_solver *s = steif_solver_new(ctx, &law_problem, method, &o);
  CU_ASSERT_FATAL(s != NULL);
  for (int i = 0; i < ACCEPTED; i++) CHECK(!steif_solve_step(s));
  return s;
}

static void attempt(steif_solver *s, double h) { CHECK(!s->step.method->attempt(&s->step, h)); }

/* attempt(h), attempt(h/2) is what a fresh attempt(h/2) is, but for what Newton's iteration leaves, and
 * the accepted solution stays. */
static void a_second_attempt_is_a_first_one(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < CHOSEN; m++) {
    steif_solver *twice = part_way(ctx, chosen[m]), *once = part_way(ctx, chosen[m]);
    stf_step *a = &twice->step, *b = &once->step;
    CHECK(a->t == b->t && a->h == b->h);
    const double before[] = {NV_Ith_S(a->y, 0), NV_Ith_S(a->y, 1)}, h = a->h;
    attempt(twice, h), attempt(twice, h / 2), attempt(once, h / 2);
    for (int i = 0; i < 2; i++) {
      CLOSE_FLOOR(NV_Ith_S(a->next, i), NV_Ith_S(b->next, i), 2e-8, 1);
      CHECK(NV_Ith_S(a->y, i) == before[i]);
    }
    CLOSE(a->control.tolerance, b->control.tolerance, 1e-2);
    steif_solver_free(&twice), steif_solver_free(&once);
  }
  steif_context_free(&ctx);
}

static void same(N_Vector a, N_Vector b)
{
  for (sunindextype i = 0; i < N_VGetLength(a); i++) CHECK(NV_Ith_S(a, i) == NV_Ith_S(b, i));
}

/* Times asked for on the way, dense output and drift do not touch the run: bit for bit. */
static void pauses_change_nothing(void)
{
  const steif_options o = {.rtol = 1e-6};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < CHOSEN; m++) {
    N_Vector whole = law_run(ctx, &law_problem, chosen[m], &o);
    steif_solver *s = steif_solver_new(ctx, &law_problem, chosen[m], &o);
    CU_ASSERT_FATAL(whole && s);
    for (int i = 1; i <= 16; i++) CHECK(!steif_solve_to(s, 1.7 * i / 16));
    same(whole, steif_solution(s));
    N_VDestroy(whole);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* Stopped, stored, and begun anew from what was stored: to the tolerance. */
static void a_stored_point_goes_on(void)
{
  const double rtol = 1e-6;
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < CHOSEN; m++) {
    steif_options o = {.rtol = rtol};
    N_Vector whole = law_run(ctx, &law_problem, chosen[m], &o);
    o.t1 = 0.61;
    N_Vector part = law_run(ctx, &law_problem, chosen[m], &o);
    CU_ASSERT_FATAL(whole && part);
    steif_problem rest = law_problem;
    rest.t0 = 0.61, rest.y0 = N_VGetArrayPointer(part), o.t1 = 0;
    N_Vector end = law_run(ctx, &rest, chosen[m], &o);
    CU_ASSERT_FATAL(end != NULL);
    CLOSE_FLOOR(law_distance(whole, end), 0, 10 * rtol, 1);
    N_VDestroy(whole), N_VDestroy(part), N_VDestroy(end);
  }
  steif_context_free(&ctx);
}

/* Volterra's prey and predators, x' = x (1 - y) - x sin(t)/5, y' = y (x - 1); backwards: z(s) = y(T - s). */
enum { T = 5 };

static int hunt(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const int *mirrored = user;
  const double x = NV_Ith_S(y, 0), p = NV_Ith_S(y, 1), sign = mirrored ? -1 : 1;
  const double at = mirrored ? T - t : t;
  NV_Ith_S(out, 0) = sign * x * (1 - p - sin(at) / 5);
  NV_Ith_S(out, 1) = sign * p * (x - 1);
  return 0;
}

static void mirrored_runs_come_home(void)
{
  static const sunrealtype start[] = {1.7, 0.6};
  static int mirrored;
  const steif_options o = {.rtol = 1e-6};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < CHOSEN; m++) {
    steif_problem p = {.name = "hunt", .n = 2, .t1 = T, .y0 = start, .f = hunt};
    N_Vector away = law_run(ctx, &p, chosen[m], &o);
    CU_ASSERT_FATAL(away != NULL);
    p.y0 = N_VGetArrayPointer(away), p.user = &mirrored;
    N_Vector home = law_run(ctx, &p, chosen[m], &o);
    CU_ASSERT_FATAL(home != NULL);
    for (int i = 0; i < 2; i++) CLOSE_FLOOR(NV_Ith_S(home, i), start[i], 20 * o.rtol, 1);
    N_VDestroy(away), N_VDestroy(home);
  }
  steif_context_free(&ctx);
}

/* One call of f, or of the Jacobian, in mid-run fails recoverably, or gives NaN and says nothing. */
typedef struct stumble {
  int f, jac, f_at, jac_at; /* calls so far; the one that fails, 0: none */
  int silent;
} stumble;

static int stumbling(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  stumble *s = user;
  law_problem.f(t, y, r, NULL);
  if (++s->f != s->f_at) return 0;
  NV_Ith_S(r, 0) = NAN;
  return !s->silent;
}

static int stumbling_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                         N_Vector a, N_Vector b, N_Vector c)
{
  stumble *s = user;
  law_problem.jac(t, y, fy, J, NULL, a, b, c);
  return ++s->jac == s->jac_at;
}

static void one_failure_does_no_harm(void)
{
  const steif_options o = {.rtol = 1e-6};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = law_problem;
  p.f = stumbling, p.jac = stumbling_jac;
  for (int m = 0; m < CHOSEN; m++) {
    stumble free = {0};
    p.user = &free;
    N_Vector right = law_run(ctx, &p, chosen[m], &o);
    CU_ASSERT_FATAL(right != NULL);
    for (int k = 1; k <= 16; k++) {
      stumble s = {.f_at = k < 16 ? 2 + free.f * k / 16 : 0,
                   .jac_at = k == 16 && free.jac > 1 ? 2 : 0,
                   .silent = k % 2};
      p.user = &s;
      N_Vector end = law_run(ctx, &p, chosen[m], &o);
      if (!end) printf("\n  %s, %d: %s", chosen[m], k, steif_message(ctx));
      CU_ASSERT_FATAL(end != NULL);
      CHECK(s.f >= s.f_at && s.jac >= s.jac_at);
      CLOSE_FLOOR(law_distance(right, end), 0, 10 * o.rtol, 1);
      N_VDestroy(end);
    }
    N_VDestroy(right);
  }
  steif_context_free(&ctx);
}

/* Steps, evaluations of f, Jacobians, factorisations on the law problem at rtol 1e-6, as counted when they
 * were written down: a tenth more is too much, a tenth less asks for new ones. */
static void counts_are_kept(void)
{
  static const long known[CHOSEN][4] = {
    {8, 159, 4, 32},    {28, 240, 5, 56},   {12, 145, 3, 30},     {8, 159, 4, 32},
    {28, 262, 5, 46},   {18, 188, 4, 26},   {142, 285, 19, 24},   {2502, 3353, 229, 232},
    {153, 1732, 1, 41}, {51, 672, 1, 18},   {4193, 15401, 1, 51}, {89, 806, 89, 90},
    {39, 429, 39, 39},  {57, 342, 57, 114}, {34, 454, 0, 0}};
  const steif_options o = {.rtol = 1e-6};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < CHOSEN; m++) {
    steif_solver *s = steif_solver_new(ctx, &law_problem, chosen[m], &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, law_problem.t1));
    const steif_stats *n = steif_statistics(s);
    const long found[] = {n->steps, n->nfe, n->nje, n->nlu};
    for (int k = 0; k < 4; k++) {
      const long slack = 1 + known[m][k] / 10;
      if (labs(found[k] - known[m][k]) > slack)
        printf("\n  %s: %ld, %ld, %ld, %ld", chosen[m], found[0], found[1], found[2], found[3]);
      CHECK(labs(found[k] - known[m][k]) <= slack);
    }
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* The same bits again, with one thread and with two, whose factorisations run side by side. */
static void threads_do_not_matter(void)
{
  static const struct {
    const char *problem, *method;
    double h, t1;
  } runs[] = {{"bruss2d:n=32", "radau:s=5", 0.02, 0.1},
              {"bruss2d:n=32", "radau:s=5", 0, 0.1},
              {"heat2d:n=48", "gauss:s=4", 0.01, 0.05},
              {"bruss2d:n=32", "gauss:s=3", 0, 0.1},
              {"bruss2d:n=32", "bdf", 0, 0.1},
              {"bruss2d:n=32", "dirk:hw43", 0, 0.02},
              {"bruss2d:n=32", "rodas5p", 0, 0.02},
              {"bruss2d:n=32", "auto", 0, 0.1},
              {"lorenz96", "dopri87", 0, 2},
              {"beam", "radau:s=5", 0, 0.05},
              {"ringmod", "auto", 0, 1e-6}};
  for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
    steif_context *ctx[3];
    N_Vector end[3];
    for (int k = 0; k < 3; k++) {
      ctx[k] = steif_context_new(&(steif_setup){.threads = k < 2 ? 1 : 2});
      const steif_options o = {.rtol = 1e-5, .h = runs[i].h, .t1 = runs[i].t1};
      steif_problem p;
      CU_ASSERT_FATAL(!steif_problem_find(ctx[k], runs[i].problem, &p));
      end[k] = law_run(ctx[k], &p, runs[i].method, &o);
      CU_ASSERT_FATAL(end[k] != NULL);
      steif_problem_clear(ctx[k], &p);
    }
    same(end[0], end[1]), same(end[0], end[2]);
    for (int k = 0; k < 3; k++) N_VDestroy(end[k]), steif_context_free(&ctx[k]);
  }
}

CU_TestInfo tests_of_law_chosen[] = {
  {"a second attempt is a first one", a_second_attempt_is_a_first_one},
  {"pauses change nothing", pauses_change_nothing},
  {"a stored point goes on", a_stored_point_goes_on},
  {"mirrored runs come home", mirrored_runs_come_home},
  {"one failure does no harm", one_failure_does_no_harm},
  {"counts are kept", counts_are_kept},
  {"threads do not matter", threads_do_not_matter},
  CU_TEST_INFO_NULL};
