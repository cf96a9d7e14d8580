/* Chosen steps on published problems: digits against the reference solutions of the collection
 * (IVP Test Set; Hairer and Wanner II), mescd = -log10 max |y - ref| / (atol/rtol + |ref|).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"

static double digits(steif_context *ctx, const char *problem, const char *method, double rtol,
                     steif_stats *n)
{
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *s = smooth_open(ctx, &p, method, &o);
  double scd, mescd = NAN;
  if (steif_solve_to(s, p.t1)) printf("\n  %s %s: %s", problem, method, steif_message(ctx));
  const double scale = p.rtol_scale > 0 ? p.rtol_scale : 1;
  if (steif_time(s) == p.t1)
    CHECK(!steif_problem_digits(ctx, &p, p.t1, steif_solution(s), scale, &scd, &mescd));
  *n = *steif_statistics(s);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  return mescd;
}

static void at_least(const char *problem, const char *method, double rtol, double floor)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_stats n;
  const double found = digits(ctx, problem, method, rtol, &n);
  if (!(found >= floor))
    printf("\n  %s %s rtol %g: %.2f digits, %.2f wanted", problem, method, rtol, found, floor);
  CHECK(found >= floor);
  CHECK(n.rejected <= n.steps);
  steif_context_free(&ctx);
}

static void radau_reaches_the_tolerance(void)
{
  static const char *const problems[] = {"hires", "vdpol",    "orego",    "rober",
                                         "pollu", "chemakzo", "transamp", "medakzo:n=400"};
  for (int i = 0; i < 8; i++)
    for (int k = 4; k <= 8; k += 2) at_least(problems[i], "radau:s=3", pow(10, -k), k - 1);
}

/* Less than a digit below rtol is not reached here: the seven bodies of plei magnify errors in
 * their close encounters, the beam oscillates at frequencies of up to 6400 and the order falls
 * to that of the stages, e5 ends at concentrations of 1e-22 after thirteen decades, the
 * multipliers of the car axis (index 3) lose two orders. */
static void harder_problems_reach_less(void)
{
  static const struct {
    const char *problem;
    double floor[3];
  } rows[] = {{"plei", {2.4, 3.9, 5.5}},
              {"beam", {3, 3.4, 4.3}},
              {"e5", {3.5, 4.5, 4.5}},
              {"caraxis", {1.2, 2.7, 4.2}}};
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++)
      at_least(rows[i].problem, "radau:s=3", pow(10, -4 - 2 * k), rows[i].floor[k]);
}

static void the_ring_modulator_is_fast(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_stats n;
  CHECK(digits(ctx, "ringmod", "radau:s=3", 1e-5, &n) >= 2.4);
  CHECK(n.steps > 20000 && n.steps < 90000);
  CHECK(n.cpu_s < 20); /* a fifth of a second, where no tool slows it down */
  steif_context_free(&ctx);
}

/* BDF of order up to 3: mescd about 4 at 1e-5. */
static void bdf_follows_the_tolerance(void)
{
  static const struct {
    const char *problem;
    double floor;
  } rows[] = {{"hires", 3},           {"vdpol", 3.2}, {"orego", 2.6},
              {"rober", 4.3},         {"pollu", 4.3}, {"chemakzo", 4.3},
              {"medakzo:n=400", 4.5}, {"e5", 3.6},    {"transamp", 4.3}};
  for (int i = 0; i < 9; i++) at_least(rows[i].problem, "bdf:p=3", 1e-5, rows[i].floor);
}

static void more_orders_reach_more(void)
{
  static const char *const methods[] = {"radau:s=4", "radau:s=5", "gauss:s=3", "dirk:hw43"};
  static const double floor[] = {6, 6, 6, 3.5};
  for (int m = 0; m < 4; m++) at_least("hires", methods[m], 1e-7, floor[m]);
}

/* Seven bodies are not stiff: digits follow the tolerance, close encounters or not. */
static void explicit_steps_follow_the_tolerance(void)
{
  for (int k = 2; k <= 8; k += 2) at_least("plei", "dopri87", pow(10, -k), k);
}

/* What Newton leaves in the past values must not hold the step of BDF down: a few thousand
 * steps. */
static void smooth_tails_take_few_steps(void)
{
  static const struct {
    const char *problem;
    double rtol;
    long most;
  } rows[] = {{"e5", 1e-11, 16000}, {"pollu", 1e-13, 3000}, {"transamp", 1e-9, 40000}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++) {
    steif_stats n;
    digits(ctx, rows[i].problem, "bdf:p=5", rows[i].rtol, &n);
    if (n.steps > rows[i].most) printf("\n  %s: %ld steps", rows[i].problem, n.steps);
    CHECK(n.steps > 100 && n.steps <= rows[i].most);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_digits[] = {
  {"radau reaches a tenth of the tolerance", radau_reaches_the_tolerance},
  {"harder problems reach less", harder_problems_reach_less},
  {"the ring modulator is fast", the_ring_modulator_is_fast},
  {"BDF follows the tolerance", bdf_follows_the_tolerance},
  {"more orders reach more", more_orders_reach_more},
  {"explicit steps follow the tolerance", explicit_steps_follow_the_tolerance},
  {"smooth tails take few steps", smooth_tails_take_few_steps},
  CU_TEST_INFO_NULL};
