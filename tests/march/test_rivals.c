/* "auto" changes its mind: a system that becomes stiff, one that ceases to be, the same run again with
 * pauses, events found on either side, and memory that ends while it opens its methods.
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

enum { N = 24, END = 30 };

/* y_i' = -k(t) (y_i - cos w_i t) - w_i sin w_i t, y_i(0) = 1: y_i = cos w_i t. k goes from one of two
 * rates to the other about t = 5. */
typedef struct relaxation {
  double early, late;
} relaxation;

static double frequency(int i) { return 0.5 + i / 48.0; }

static double rate(const relaxation *r, double t)
{
  return r->early + (r->late - r->early) * (1 + tanh(4 * (t - 5))) / 2;
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  for (int i = 0; i < N; i++) {
    const double w = frequency(i);
    NV_Ith_S(out, i) = -rate(user, t) * (NV_Ith_S(y, i) - cos(w * t)) - w * sin(w * t);
  }
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)y, (void)fy, (void)a, (void)b, (void)c;
  for (int i = 0; i < N; i++) SM_ELEMENT_D(J, i, i) = -rate(user, t);
  return 0;
}

/* y_0 = 0 at t = (2 k + 1) pi. */
static int zero(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  *value = NV_Ith_S(y, 0);
  return 0;
}

static const double ones[N] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                               1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
static relaxation hardening = {1, 1e4}, softening = {300, 0.1};

static steif_problem problem(relaxation *r)
{
  return (steif_problem){
    .name = "relaxation", .n = N, .t1 = END, .y0 = ones, .f = f, .jac = jac, .user = r};
}

/* To the end with so many pauses; what the method at each of them begins with goes into `used`. */
static void run(steif_context *ctx, const steif_problem *p, int pauses, char used[][16],
                double *y)
{
  const steif_options o = {.rtol = 1e-6};
  steif_solver *s = steif_solver_new(ctx, p, "auto", &o);
  CU_ASSERT_FATAL(s != NULL);
  for (int k = 1; k <= pauses; k++) {
    CHECK(!steif_solve_to(s, END * k / (double)pauses));
    if (used) snprintf(used[k - 1], sizeof used[k - 1], "%s", steif_method_used(s));
  }
  memcpy(y, N_VGetArrayPointer(steif_solution(s)), N * sizeof *y);
  for (int i = 0; i < N; i++) CLOSE_FLOOR(y[i], cos(frequency(i) * END), 1e-5, 1);
  steif_solver_free(&s);
}

static void it_turns_to_the_cheaper_method(void)
{
  steif_context *ctx = steif_context_new(NULL);
  char used[15][16];
  double y[N];
  steif_problem p = problem(&hardening);
  run(ctx, &p, 15, used, y);
  CHECK(!strncmp(used[1], "dopri87 ", 8) && !strncmp(used[14], "radau:s=7 ", 10));
  p = problem(&softening);
  run(ctx, &p, 15, used, y);
  CHECK(!strncmp(used[0], "radau:s=7 ", 10) && !strncmp(used[14], "dopri87 ", 8));
  steif_context_free(&ctx);
}

static void pauses_do_not_change_its_mind(void)
{
  steif_context *ctx = steif_context_new(NULL);
  relaxation *of[] = {&hardening, &softening};
  for (int k = 0; k < 2; k++) {
    const steif_problem p = problem(of[k]);
    double once[N], often[N];
    run(ctx, &p, 1, NULL, once);
    run(ctx, &p, 97, NULL, often);
    for (int i = 0; i < N; i++) CHECK(once[i] == often[i]);
  }
  steif_context_free(&ctx);
}

static int note(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user)
{
  int *count = user;
  (void)s, (void)y, (void)fired;
  CLOSE(t, (2 * *count + 1) * acos(-1), 1e-5);
  ++*count;
  return 0;
}

/* Steps of more than a period, which collocation makes, are known as well inside. */
static void events_are_found_on_both_sides(void)
{
  steif_context *ctx = steif_context_new(NULL);
  relaxation *of[] = {&hardening, &softening};
  for (int k = 0; k < 2; k++) {
    int count = 0;
    const steif_options o = {.rtol = 1e-6, .on_event = note, .observer = &count};
    steif_problem p = problem(of[k]);
    p.events = 1, p.event = zero;
    steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(!steif_solve_to(s, END));
    CHECK(count == 5);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* y_0' = -r (y_0 - c(t)^2 - 1e-9), c = max(0, cos 3 t), rests at 1e-9, and coarse steps carry it below zero; the
 * others are smooth. */
static int resting(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double c = fmax(0, cos(3 * t));
  (void)f(t, y, out, user);
  NV_Ith_S(out, 0) = -rate(user, t) * (NV_Ith_S(y, 0) - c * c - 1e-9);
  return 0;
}

static int lowest(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  double *low = user;
  (void)s, (void)t;
  *low = fmin(*low, NV_Ith_S(y, 0));
  return 0;
}

/* Steps made anew for a sign are short, and neither stiffness nor accuracy made them so: the run ends with the
 * method that it has without the constraint, where y_0 goes below zero, after no more changes. */
static void constraints_are_no_verdict(void)
{
  static const int positive[N] = {2};
  relaxation r = {40, 40};
  steif_context *ctx = steif_context_new(NULL);
  double low[2] = {1, 1};
  int changes[2] = {-1, -1};
  for (int kept = 0; kept < 2; kept++) {
    const steif_options o = {.rtol = 1e-4, .observe = lowest, .observer = &low[kept]};
    steif_problem p = problem(&r);
    p.f = resting, p.constraint = kept ? positive : NULL;
    steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(!steif_solve_to(s, END));
    CHECK(!strncmp(steif_method_used(s), "radau:s=7 ", 10));
    const char *change = strstr(steif_method_used(s), "change");
    changes[kept] = change ? atoi(change + strlen("change")) : 0;
    steif_solver_free(&s);
  }
  CHECK(changes[1] <= changes[0]);
  CHECK(low[0] < 0 && low[1] >= 0);
  steif_context_free(&ctx);
}

static void stepping_asks_for_no_memory(void)
{
  relaxation *of[] = {&hardening, &softening};
  for (int k = 0; k < 2; k++) {
    failing memory = {0};
    const steif_setup setup = failing_setup(&memory);
    steif_context *ctx = steif_context_new(&setup);
    const steif_options o = {.rtol = 1e-6};
    const steif_problem p = problem(of[k]);
    steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
    CU_ASSERT_FATAL(s != NULL);
    const long before = memory.served;
    CHECK(!steif_solve_to(s, END) && strstr(steif_method_used(s), "change 1"));
    CHECK(memory.served == before);
    steif_solver_free(&s), steif_context_free(&ctx);
    CHECK(memory.alive == 0);
  }
}

static void opening_may_fail_anywhere(void)
{
  const steif_options o = {.rtol = 1e-6};
  const steif_problem p = problem(&softening);
  for (long k = 1;; k++) {
    failing memory = {.refuse_at = k};
    const steif_setup setup = failing_setup(&memory);
    steif_context *ctx = steif_context_new(&setup);
    steif_solver *s = ctx ? steif_solver_new(ctx, &p, "auto", &o) : NULL;
    const int code = s ? steif_solve_step(s) : ctx ? steif_status(ctx) : STEIF_NO_MEMORY;
    steif_solver_free(&s), steif_context_free(&ctx);
    CHECK(memory.alive == 0);
    CHECK(code == (memory.served < k ? STEIF_OK : STEIF_NO_MEMORY));
    if (memory.served < k) break;
  }
}

CU_TestInfo tests_of_rivals[] = {
  {"it turns to the cheaper method", it_turns_to_the_cheaper_method},
  {"pauses do not change its mind", pauses_do_not_change_its_mind},
  {"events are found on both sides", events_are_found_on_both_sides},
  {"constraints are no verdict", constraints_are_no_verdict},
  {"stepping asks for no memory", stepping_asks_for_no_memory},
  {"opening may fail anywhere", opening_may_fail_anywhere},
  CU_TEST_INFO_NULL};
