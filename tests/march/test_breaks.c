/* Declared breaks: steps end before them and begin behind them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <sunmatrix/sunmatrix_dense.h>

/* y' = -3.1 (y - s), s = 1, -2, 0.5 before, between and after two breaks. A call inside an
 * attempt that began on the other side of a break is counted; `late`: f has its old value at
 * the break. */
static const double breaks[] = {0.4137, 1.0625};
typedef struct jumps {
  steif_solver *s;
  int late, strange;
} jumps;

static int side(double t, int late)
{
  int n = 0;
  for (int i = 0; i < 2; i++) n += late ? t > breaks[i] : t >= breaks[i];
  return n;
}

static const double rest[] = {1, -2, 0.5};

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  jumps *j = user;
  NV_Ith_S(out, 0) = -3.1 * (NV_Ith_S(y, 0) - rest[side(t, j->late)]);
  if (!j->s) return 0;
  const double from = steif_time(j->s); /* a step from a break is behind it */
  int before = 0;
  for (int i = 0; i < 2; i++) before += from >= breaks[i];
  j->strange += side(t, j->late) != before;
  return 0;
}

static double exact(double t)
{
  double y = 0.2, from = 0;
  for (int k = 0; k < 3; k++) {
    const double to = k < 2 && breaks[k] < t ? breaks[k] : t;
    y = rest[k] + (y - rest[k]) * exp(-3.1 * (to - from));
    if (to == t) return y;
    from = to;
  }
  return y;
}

static const double start[] = {0.2};

static steif_problem kicked(jumps *j)
{
  return (steif_problem){.name = "kicked",
                         .n = 1,
                         .t1 = 2,
                         .y0 = start,
                         .f = f,
                         .user = j,
                         .breaks = breaks,
                         .break_count = 2};
}

static const char *const methods[] = {"radau:s=3",   "radau:s=2",  "gauss:s=3",
                                      "dirk:trbdf2", "dirk:hw43",  "bdf:p=5",
                                      "bdf:p=1",     "radau:s=12", "dirk:esdirk43"};
enum { METHODS = sizeof methods / sizeof *methods };

typedef struct seen {
  int hits;
  double last;
} seen;

static int look(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  seen *x = user;
  (void)s;
  for (int i = 0; i < 2; i++) {
    CHECK(!(x->last < breaks[i] && t > breaks[i])); /* no step across */
    if (t != breaks[i]) continue;
    x->hits++;
    CLOSE(NV_Ith_S(y, 0), exact(t), 1e-3);
  }
  CHECK(t > x->last);
  x->last = t;
  return 0;
}

static void breaks_are_hit_exactly(void)
{
  for (int m = 0; m < METHODS; m++)
    for (int late = 0; late < 2; late++)
      for (int storage = STEIF_DENSE; storage <= STEIF_BAND; storage++) {
        steif_context *ctx = steif_context_new(NULL);
        jumps j = {.late = late};
        seen x = {0};
        const steif_problem p = kicked(&j);
        steif_options o = steif_defaults();
        o.rtol = 1e-5; /* what order 1 keeps */
        o.observe = look, o.observer = &x;
        o.storage = (enum steif_storage)storage, o.force_storage = 1;
        steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
        CHECK(!steif_solve_to(s, 2));
        CHECK(x.hits == 2 && x.last == 2);
        CLOSE(NV_Ith_S(steif_solution(s), 0), exact(2), 1e-3);
        steif_solver_free(&s);
        steif_context_free(&ctx);
      }
}

/* No evaluation of a step lies on the other side of a break, whether f has its new value at the
 * break or only behind it. */
static void steps_see_one_side_only(void)
{
  for (int m = 0; m < METHODS; m++)
    for (int late = 0; late < 2; late++) {
      steif_context *ctx = steif_context_new(NULL);
      jumps j = {.late = late};
      const steif_problem p = kicked(&j);
      const steif_options o = {.rtol = 1e-5};
      steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
      j.s = s;
      CHECK(!steif_solve_to(s, 2));
      if (j.strange) printf("\n  %s, late = %d: %d", methods[m], late, j.strange);
      CHECK(j.strange == 0);
      steif_solver_free(&s);
      steif_context_free(&ctx);
    }
}

/* The error of the end without the breaks declared is larger, or the steps are more. */
static void breaks_pay(void)
{
  steif_context *ctx = steif_context_new(NULL);
  long steps[2], rejected[2];
  double error[2];
  for (int declared = 0; declared < 2; declared++) {
    jumps j = {0};
    steif_problem p = kicked(&j);
    if (!declared) p.break_count = 0;
    steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
    CHECK(!steif_solve_to(s, 2));
    steps[declared] = steif_statistics(s)->steps,
    rejected[declared] = steif_statistics(s)->rejected;
    error[declared] = fabs(NV_Ith_S(steif_solution(s), 0) - exact(2));
    steif_solver_free(&s);
  }
  CHECK(rejected[1] < rejected[0] && steps[1] < steps[0] && error[1] < 1e-6);
  CHECK(rejected[1] <= 2);
  steif_context_free(&ctx);
}

static void dense_output_beside_a_break(void)
{
  steif_context *ctx = steif_context_new(NULL);
  jumps j = {0};
  const steif_problem p = kicked(&j);
  steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
  CHECK(!steif_solve_to(s, breaks[0]) && steif_time(s) == breaks[0]);
  CLOSE(NV_Ith_S(steif_solution(s), 0), exact(breaks[0]), 1e-6);
  const double behind = nextafter(breaks[0], 1), on = breaks[0] + 1e-3;
  CHECK(!steif_solve_to(s, behind) && steif_time(s) == behind);
  CLOSE(NV_Ith_S(steif_solution(s), 0), exact(breaks[0]), 1e-6);
  CHECK(!steif_solve_to(s, on));
  CLOSE(NV_Ith_S(steif_solution(s), 0), exact(on), 1e-6);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Breaks at the ends, outside, and closer than the clock resolves. */
static void odd_breaks_do_no_harm(void)
{
  const double odd[] = {-1, 0, 1e-300, breaks[0], nextafter(breaks[0], 1), breaks[1], 2, 3};
  for (int m = 0; m < METHODS; m++) {
    steif_context *ctx = steif_context_new(NULL);
    jumps j = {0};
    steif_problem p = kicked(&j);
    p.breaks = odd, p.break_count = 8;
    const steif_options o = {.rtol = 1e-5};
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    const int code = steif_solve_to(s, 2);
    if (code) printf("\n  %s: %s", methods[m], steif_message(ctx));
    CHECK(!code && steif_time(s) == 2);
    CLOSE(NV_Ith_S(steif_solution(s), 0), exact(2), 1e-3);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* The run ends at a break, where f has its new value: no step sees it, adaptive steps and baselines alike. */
static void a_break_may_be_the_end(void)
{
  static const char *const solvers[] = {"auto",    "radau:s=3", "bdf",   "rodas4",
                                        "dopri87", "cvode",     "arkode"};
  for (int m = 0; m < 7; m++) {
    steif_context *ctx = steif_context_new(NULL);
    jumps j = {0};
    steif_problem p = kicked(&j);
    p.t1 = breaks[0];
    steif_options o = steif_defaults();
    o.rtol = 1e-8;
    steif_solver *s = smooth_open(ctx, &p, solvers[m], &o);
    j.s = s;
    j.strange = 0;
    CHECK(steif_solve_to(s, breaks[0]) == STEIF_OK && steif_time(s) == breaks[0]);
    CLOSE(NV_Ith_S(steif_solution(s), 0), exact(breaks[0]), 1e-6);
    if (j.strange) printf("\n  %s: %d", solvers[m], j.strange);
    CHECK(j.strange == 0);
    j.s = NULL;
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* x' + y' = -x, 0 = x - y - c, c = 0 and 1 after t = 0.5: neither row nor column tells that s = x + y alone is continuous.
 * s' = -(s + c)/2 from 1; x = (s + c)/2 and y = (s - c)/2 jump by -+ 1/2. */
static int sums_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 0, 1) = 1;
  return 0;
}

static int sums_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(A, 0, 0) = -1;
  SM_ELEMENT_D(A, 1, 0) = 1, SM_ELEMENT_D(A, 1, 1) = -1;
  return 0;
}

static int sums_g(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)user;
  NV_Ith_S(g, 0) = 0;
  NV_Ith_S(g, 1) = !derivative && t >= 0.5 ? -1 : 0;
  return 0;
}

static void sums_jump_at_breaks(void)
{
  static const char *const solvers[] = {"auto", "radau:s=3", "radau:s=5", "bdf", "descriptor"};
  static const double at[] = {0.5}, half[] = {0.5, 0.5};
  const steif_problem p = {.name = "sums",
                           .n = 2,
                           .t1 = 2,
                           .y0 = half,
                           .E = sums_E,
                           .A = sums_A,
                           .g = sums_g,
                           .breaks = at,
                           .break_count = 1};
  for (int m = 0; m < 5; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = 1e-7;
    steif_solver *s = steif_solver_new(ctx, &p, solvers[m], &o);
    CU_ASSERT_PTR_NOT_NULL_FATAL(s);
    const int code = steif_solve_to(s, 2);
    if (code) printf("\n  %s: %s", solvers[m], steif_message(ctx));
    CHECK(!code);
    const double sum = (exp(-0.25) + 1) * exp(-0.75) - 1;
    CLOSE(NV_Ith_S(steif_solution(s), 0), (sum + 1) / 2, 1e-6);
    CLOSE(NV_Ith_S(steif_solution(s), 1), (sum - 1) / 2, 1e-6);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_breaks[] = {
  {"breaks are hit exactly", breaks_are_hit_exactly},
  {"steps see one side of a break only", steps_see_one_side_only},
  {"declared breaks pay", breaks_pay},
  {"dense output beside a break", dense_output_beside_a_break},
  {"a break may be the end", a_break_may_be_the_end},
  {"odd breaks do no harm", odd_breaks_do_no_harm},
  {"sums jump at breaks", sums_jump_at_breaks},
  CU_TEST_INFO_NULL};
