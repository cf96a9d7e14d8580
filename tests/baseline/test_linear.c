/* test_linear.c: linear systems of any index by `auto` and `descriptor`, from consistent and
 * other starts, against the distribution that solves them. SPDX-License-Identifier:
 * BSD-3-Clause */
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

enum { LARGEST = 8 };

typedef struct seen {
  int jumps, count;
  double t, c[LARGEST * LARGEST], plus[LARGEST];
} seen;

static int jump(sunrealtype t, const sunrealtype *before, const steif_impulse *i, void *user)
{
  seen *w = user;
  (void)before;
  w->jumps++, w->count = i->count, w->t = t;
  memcpy(w->plus, i->x_plus, (size_t)i->n * sizeof *w->plus);
  if (i->count) memcpy(w->c, i->c, (size_t)(i->count * i->n) * sizeof *w->c);
  return 0;
}

static int cosines(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)user;
  for (int m = 0; m < N_VGetLength(g); m++)
    NV_Ith_S(g, m) = cos(t + m + 1 + derivative * acos(0));
  return 0;
}

/* N x' + x = f, k = 1 .. 6: at times inside steps and at the end within ten tolerances, x(0+)
 * and the impulses to rounding. */
static void nilpotent_systems_are_right_from_any_start(void)
{
  static const char *const cases[] = {"N-cons", "N-inc"};
  static const double at[] = {.1237, .5, .91, 1};
  for (int k = 1; k <= 6; k++)
    for (int start = 0; start < 2; start++)
      for (double rtol = 1e-4; rtol > 1e-9; rtol /= 100) {
        char name[48];
        double c[LARGEST * LARGEST], x[LARGEST];
        seen w = {0};
        steif_problem p;
        steif_context *ctx = steif_context_new(NULL);
        snprintf(name, sizeof name, "jordan:k=%d,case=%s", k, cases[start]);
        CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
        steif_options o = steif_defaults();
        o.rtol = rtol, o.jump = jump, o.observer = &w;
        steif_solver *s = steif_solver_new(ctx, &p, k > 1 ? "auto" : "descriptor", &o);
        CU_ASSERT_FATAL(s != NULL);
        CHECK(w.jumps == 1 && w.t == 0 && w.count == k - 1);
        CHECK(!steif_jordan_exact(ctx, k, cosines, NULL, p.y0, 0, x, c));
        for (int i = 0; i < k; i++) CLOSE_FLOOR(w.plus[i], x[i], 1e-12, 1);
        for (int i = 0; i < (k - 1) * k; i++) CLOSE_FLOOR(w.c[i], c[i], 1e-12, 1);
        for (int i = 0; i < k; i++) CHECK(NV_Ith_S(steif_solution(s), i) == w.plus[i]);
        for (int q = 0; q < 4; q++) {
          CHECK(!steif_solve_to(s, at[q]));
          CHECK(!steif_jordan_exact(ctx, k, cosines, NULL, p.y0, at[q], x, NULL));
          for (int i = 0; i < k; i++)
            CLOSE_FLOOR(NV_Ith_S(steif_solution(s), i), x[i], 10 * rtol, 1);
        }
        const steif_stats *n = steif_statistics(s);
        CHECK(n->steps > 0 && n->nlu > 0 && n->nsolve >= n->steps && n->nfe > 0);
        steif_solver_free(&s);
        steif_problem_clear(ctx, &p);
        steif_context_free(&ctx);
      }
}

/* Every system of the collection from its own inconsistent start beside the exact smooth
 * solution. */
static void the_collection_is_right_from_its_starts(void)
{
  static const char *const names[] = {"impact",           "switchrlc",   "ut5",
                                      "springs:n=60,c=6", "ladder:n=20", "springs:n=450,c=4"};
  for (int k = 0; k < 6; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    steif_linear l;
    steif_linear_truth truth;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, names[k], &p));
    CU_ASSERT_FATAL(!steif_linear_of(ctx, &p, &l));
    const size_t n = (size_t)p.n;
    double *made = malloc(3 * n * sizeof *made), *x = malloc(3 * n * sizeof *x), t[3];
    steif_options o = steif_defaults();
    o.rtol = 1e-7;
    steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
    CU_ASSERT_FATAL(s && made && x);
    CHECK(!strncmp(steif_method_used(s), "descriptor", 10));
    for (int q = 0; q < 3; q++) {
      t[q] = p.t0 + (p.t1 - p.t0) * (q + 1) / 3;
      CHECK(!steif_solve_to(s, t[q]));
      memcpy(made + (size_t)q * n, N_VGetArrayPointer(steif_solution(s)), n * sizeof *made);
    }
    CHECK(!steif_linear_exact(ctx, &l, p.y0, p.t0, NULL, 0, NULL, 3, t, made, x, &truth));
    CHECK(truth.most < 10 * o.rtol);
    if (!(truth.most < 10 * o.rtol)) printf("\n  %s: off by %g", names[k], truth.most);
    steif_solver_free(&s);
    free(made), free(x);
    SUNMatDestroy(l.E), SUNMatDestroy(l.F);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* x1 = s, x2 = -x1': the source jumps by 2 at the declared break, x2 takes the impulse -2. */
static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 1, 0) = 1;
  return 0;
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(A, 0, 0) = SM_ELEMENT_D(A, 1, 1) = -1;
  return 0;
}

static int source(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)user;
  NV_Ith_S(g, 0) = sin(t + derivative * acos(0)) + (t >= .4 && !derivative ? 2 : 0);
  NV_Ith_S(g, 1) = 0;
  return 0;
}

static int crossing(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  *g = t - .7;
  return 0;
}

static int push(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired, (void)user;
  NV_Ith_S(y, 0) +=
    3; /* against its equation: taken back at once, with an impulse of 3 in x2 */
  return STEIF_RESTART;
}

static void breaks_and_events_jump(void)
{
  static const double y0[] = {0, -1}, at[] = {.4};
  const steif_problem p = {.name = "differentiator",
                           .n = 2,
                           .t1 = 1,
                           .y0 = y0,
                           .E = fill_E,
                           .A = fill_A,
                           .g = source,
                           .dae_index = 2,
                           .breaks = at,
                           .break_count = 1,
                           .events = 1,
                           .event = crossing,
                           .handle_event = push};
  steif_context *ctx = steif_context_new(NULL);
  seen w = {0};
  steif_options o = steif_defaults();
  o.jump = jump, o.observer = &w, o.rtol = o.atol = 1e-8;
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
  CU_ASSERT_FATAL(s != NULL);
  CHECK(!steif_solve_to(s, .39) && w.jumps == 1);
  CHECK(!steif_solve_to(s, .5) && w.jumps == 2 && w.t == .4);
  CLOSE(w.c[1], -2, 1e-12);
  CLOSE(NV_Ith_S(steif_solution(s), 0), 2 + sin(.5), 1e-7);
  CLOSE(NV_Ith_S(steif_solution(s), 1), -cos(.5), 1e-7);
  CHECK(!steif_solve_to(s, 1) && w.jumps == 3);
  CLOSE(w.t, .7, 1e-14);
  CLOSE(w.c[1], 3, 1e-7);
  CLOSE(NV_Ith_S(steif_solution(s), 0), 2 + sin(1), 1e-7);
  steif_solver_free(&s);
  o.h = .01;
  CHECK(!steif_solver_new(ctx, &p, "descriptor", &o));
  CHECK(steif_status(ctx) == STEIF_UNSUPPORTED);
  s = steif_solver_new(ctx, &p, "auto", &o); /* given steps are made on the system as it is */
  CHECK(s && !strncmp(steif_method_used(s), "radau", 5));
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Whichever allocation fails: the code says so, and nothing is kept. */
static void hunger_is_survived(void)
{
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code && k < 4000; k += 1 + k / 40) {
    failing memory = {.refuse_at = k};
    const steif_setup setup = failing_setup(&memory);
    steif_context *ctx = steif_context_new(&setup);
    if (!ctx) continue;
    steif_problem p;
    code = steif_problem_find(ctx, "ut5", &p);
    if (!code) {
      steif_solver *s = steif_solver_new(ctx, &p, "descriptor", NULL);
      code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
      steif_solver_free(&s);
      steif_problem_clear(ctx, &p);
    }
    CHECK(code == STEIF_NO_MEMORY || (!code && memory.served < k));
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
  }
  CHECK(!code);
}

CU_TestInfo tests_of_linear[] = {
  {"nilpotent systems are right from any start", nilpotent_systems_are_right_from_any_start},
  {"the collection is right from its starts", the_collection_is_right_from_its_starts},
  {"breaks and events jump", breaks_and_events_jump},
  {"hunger is survived", hunger_is_survived},
  CU_TEST_INFO_NULL};
