/* Options that are refused, and what the others do.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

static void bad_options_are_named(void)
{
  static const double atols[] = {1e-6, 0};
  steif_options o;
#define REFUSED(member, value, words)                                                          \
  o = steif_defaults(), o.member = value;                                                      \
  smooth_refused(&smooth, "radau:s=2", &o, STEIF_BAD_INPUT, words)
  REFUSED(rtol, -1e-3, "rtol = -0.001");
  REFUSED(rtol, 1, "between 0 and 1");
  REFUSED(rtol, NAN, "between 0 and 1");
  REFUSED(rtol, INFINITY, "between 0 and 1");
  REFUSED(rtol, 1e-15, "more than double precision has");
  REFUSED(atol, -1, "atol = -1");
  REFUSED(atol, INFINITY, "atol = inf");
  REFUSED(atol, NAN, "atol = nan");
  REFUSED(atols, atols, "atols[1] = 0");
  REFUSED(h, -0.1, "h = -0.1");
  REFUSED(h, NAN, "h = nan");
  REFUSED(h0, -0.1, "h0 = -0.1");
  REFUSED(h_max, INFINITY, "h_max = inf");
  REFUSED(max_steps, -4, "max_steps = -4");
  REFUSED(iterations, -1, "iterations = -1");
  REFUSED(newton, NAN, "newton = nan");
  REFUSED(t1, 0.25, "t1 = 0.25 must lie after the start t0 = 0.25");
  REFUSED(t1, NAN, "t1 = nan");
  REFUSED(t1, -3, "t1 = -3 must lie after the start t0 = 0.25");
#undef REFUSED
}

static void bad_calls_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_solver_new(NULL, &smooth, "be", NULL) == NULL);
  CHECK(steif_solver_new(ctx, &smooth, NULL, NULL) == NULL);
  CHECK(steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(steif_solver_new(ctx, NULL, "be", NULL) == NULL);
  CHECK(steif_status(ctx) == STEIF_BAD_INPUT);
  N_Vector three = N_VNew_Serial(3, steif_sundials(ctx));
  steif_options o = steif_defaults();
  o.like = three;
  CHECK(steif_solver_new(ctx, &smooth, "radau:s=2", &o) == NULL);
  CHECK(strstr(steif_message(ctx), "options.like has 3 components, problem 'smooth' has 2"));
  N_VDestroy(three);
  steif_solver *none = NULL;
  steif_solver_free(&none);
  steif_solver_free(NULL);
  steif_context_free(&ctx);
}

static void options_of_zeros_are_defaults(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_options zero = {0};
  steif_solver *a = smooth_open(ctx, &smooth, "radau:s=3", &zero),
               *b = smooth_open(ctx, &smooth, "radau:s=3", NULL);
  CHECK(!steif_solve_to(a, 2) && !steif_solve_to(b, 2));
  CHECK(steif_statistics(a)->steps == steif_statistics(b)->steps);
  CHECK(NV_Ith_S(steif_solution(a), 1) == NV_Ith_S(steif_solution(b), 1));
  steif_solver_free(&a), steif_solver_free(&b);
  steif_context_free(&ctx);
}

typedef struct longest {
  double first, most, before;
} longest;

static int measure(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)y;
  longest *l = user;
  const double h = t - l->before;
  if (!(l->first > 0)) l->first = h;
  l->most = fmax(l->most, h), l->before = t;
  return 0;
}

static void first_and_longest_steps_are_kept(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=5", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    longest l = {.before = 0.25};
    steif_options o = steif_defaults();
    o.rtol = 1e-3, o.h0 = 1.7e-5, o.h_max = 0.037, o.observe = measure, o.observer = &l;
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], &o);
    CHECK(!steif_solve_to(s, 2));
    CLOSE(l.first, 1.7e-5, 1e-9);
    CHECK(l.most <= 0.037 * (1 + 1e-12) && l.most > 0.03);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

static void tolerances_by_component(void)
{
  static const double loose[] = {1e-9, 1e-1}, tight[] = {1e-9, 1e-9};
  long steps[2];
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 2; k++) {
    steif_problem p;
    steif_options o = steif_defaults();
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "vdpol", &p));
    o.rtol = 1e-6, o.atols = k ? tight : loose;
    steif_solver *s = smooth_open(ctx, &p, "radau:s=3", &o);
    CHECK(!steif_solve_to(s, p.t1));
    steps[k] = steif_statistics(s)->steps;
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
  }
  CHECK(steps[0] < steps[1]);
  steif_context_free(&ctx);
}

/* pendulum3 has index 1, 1, 2, 2, 3 as posed; its index 2 form 1, 1, 1, 1, 2. */
static void index_vectors_must_fit(void)
{
  static const int flat[] = {1, 1, 1, 1, 1}, low[] = {1, 1, 2, 2, 2}, high[] = {1, 2, 3, 3, 3},
                   one[] = {1, 1}, two[] = {1, 2};
  static const struct {
    const char *problem;
    const int *index;
    const char *words;
  } rows[] = {{"pendulum3", flat,
               "index[2] = 1 of problem 'pendulum3' contradicts its equations, "
               "which show index 2"},
              {"pendulum3", low,
               "index[4] = 2 of problem 'pendulum3' contradicts its equations, "
               "which show index 3"},
              {"pendulum3:index=2", flat, "index[4] = 1 of problem"},
              {"pendulum3", high, NULL}, /* larger than needed may be right at other points */
              {"pendulum3:index=1", high, "index[1] = 2 of problem"},
              {"pendulum3:index=1", high, "show index 1 of all components"},
              {"pendulum3:index=1", flat, NULL}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, rows[i].problem, &p));
    p.index = rows[i].index;
    if (rows[i].words)
      smooth_refused(&p, "radau:s=3", NULL, STEIF_BAD_INPUT, rows[i].words);
    else {
      steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
      steif_solver_free(&s);
    }
    steif_problem_clear(ctx, &p);
  }
  steif_problem p = smooth;
  p.index = two;
  smooth_refused(&p, "radau:s=3", NULL, STEIF_BAD_INPUT, "contradicts its form y' = f");
  p.index = one;
  steif_solver *s = smooth_open(ctx, &p, "radau:s=3", NULL);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_options[] = {
  {"bad options are named", bad_options_are_named},
  {"bad calls are refused", bad_calls_are_refused},
  {"options of zeros are the defaults", options_of_zeros_are_defaults},
  {"the first and the longest step are kept", first_and_longest_steps_are_kept},
  {"tolerances by component", tolerances_by_component},
  {"index vectors must fit the equations", index_vectors_must_fit},
  CU_TEST_INFO_NULL};
