/* A run that succeeds is right: errors of at most ten tolerances at the end of the problems of the
 * collection, relative to atol/rtol + |reference|; multipliers of index 2 and 3 have two digits less.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <stdbool.h>

typedef struct row {
  const char *problem;
  double less; /* digits that no local error control keeps: lost to the problem's own growth */
} row;

/* Perturbations of lorenz grow 38 000-fold to its end, those of lorenz96 460 000-fold, those of
 * steyer 105-fold on the way (25 directions and times, integrated). e5 ends at 1e-22 after thirteen
 * decades, from 1e-10 whose rounding stays in y2 = y3 + y4: its runs say so (stats.rounding). */
static const row rows[] = {
  {"andrews", 0},    {"beam", 0},     {"bounce", 0},    {"caraxis", 0},
  {"chemakzo", 0},   {"e5", 0},       {"hires", 0},     {"impact", 0},
  {"jordan", 0},     {"kepler", 0},   {"lorenz", 3.6},  {"lorenz96", 4.7},
  {"orego", 0},      {"pendulum", 0}, {"pendulum3", 0}, {"medakzo:n=100", 0},
  {"plei", 0},       {"pollu", 0},    {"prothero", 0},  {"rober", 0},
  {"steyer", 0.7},   {"swing", 0},    {"stiffpair", 0}, {"transamp", 0},
  {"heat:n=100", 0}, {"vdpol", 0}};

/* Tolerances of error beyond which a component is wrong. */
static double allowed(const steif_problem *p, sunindextype i)
{
  const int multiplier = p->index && p->dae_index >= 2 && p->index[i] >= p->dae_index;
  return multiplier ? 1000 : 10;
}

/* The largest error in units of what is allowed; NaN when nothing is known. */
static double excess(const steif_problem *p, double rtol, N_Vector y)
{
  const steif_reference *r = p->reference;
  const double floor = p->rtol_scale > 0 ? p->rtol_scale : 1;
  N_Vector known = N_VClone(y);
  double most = 0;
  if (!r && (!p->exact || p->exact(p->t1, known, NULL, p->user))) most = NAN;
  const sunindextype count = r && r->count ? r->count : p->n;
  for (sunindextype k = 0; k < count && !isnan(most); k++) {
    const sunindextype i = r && r->component ? r->component[k] : k;
    const double value = r ? r->value[k] : NV_Ith_S(known, i);
    const double error = fabs(NV_Ith_S(y, i) - value) / (floor + fabs(value));
    most = fmax(most, error / (allowed(p, i) * rtol));
    if (isnan(error)) most = INFINITY;
  }
  N_VDestroy(known);
  return most;
}

/* Failures are failures; successes are looked at. Returns 1 when the run succeeded. */
static int look(const row *at, const char *method, double rtol)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, at->problem, &p));
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const int good = s && steif_solve_to(s, p.t1) == STEIF_OK;
  if (good) {
    const double found = excess(&p, rtol, steif_solution(s));
    const double rounding = steif_statistics(s)->rounding;
    const int told = rounding > 1, wrong = found > pow(10, at->less);
    const int alarm = told && strcmp(at->problem, "e5");
    if ((wrong && !told) || alarm)
      printf("\n  %s %s %g: %.3g times what is allowed, rounding %.3g", at->problem, method,
             rtol, found, rounding);
    CHECK(told || !wrong);
    CHECK(!alarm);
  } else {
    CHECK(strlen(steif_message(ctx)) > 20);
    CHECK(steif_status(ctx) != STEIF_STEP_LIMIT);
  }
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return good;
}

/* least: how many runs succeed. Index 3 is not for all. */
static void success_means_digits(void)
{
  static const struct {
    const char *method;
    double rtol[3];
    int least;
  } runs[] = {{"auto", {1e-4, 1e-6, 1e-8}, 78},      {"radau:s=3", {1e-4, 1e-6, 1e-8}, 78},
              {"radau:s=5", {1e-3, 1e-5, 1e-7}, 78}, {"radau:s=7", {1e-3, 1e-5, 1e-7}, 78},
              {"gauss:s=4", {1e-4, 1e-5, 1e-7}, 62}, {"bdf", {1e-4, 1e-6, 1e-7}, 78},
              {"rodas4", {1e-4, 1e-6}, 40},          {"rodas5p", {1e-3, 1e-4, 1e-6}, 60},
              {"dirk:hw43", {1e-4, 1e-6}, 42},       {"dirk:esdirk43", {1e-4, 1e-6}, 42},
              {"dirk:trbdf2", {1e-3, 1e-4}, 42}};
  for (size_t m = 0; m < sizeof runs / sizeof *runs; m++) {
    int succeeded = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
      for (int k = 0; k < 3 && runs[m].rtol[k] > 0; k++)
        succeeded += look(rows + i, runs[m].method, runs[m].rtol[k]);
    if (succeeded < runs[m].least) printf("\n  %s: %d succeed", runs[m].method, succeeded);
    CHECK(succeeded >= runs[m].least);
  }
}

/* y1 of Robertson's kinetics falls below zero, and then without end, when stiff components are left
 * off their slow manifold. */
static void gauss_stays_on_the_slow_manifold(void)
{
  static const char *const methods[] = {"gauss:s=2", "gauss:s=3", "gauss:s=4", "gauss:s=5"};
  static const double rtol[] = {1e-3, 1e-4, 1e-6, 1e-8};
  const row rober = {"rober", 0};
  for (int m = 0; m < 4; m++)
    for (int k = 0; k < 4; k++) CHECK(look(&rober, methods[m], rtol[k]));
}

/* Rounding of F and M y' in the amplifier, whose algebraic equations are what M cancels, is of the size
 * of the tightest tolerances where the eigenvectors of a split multiply it. */
static void the_amplifier_reaches_eleven_digits(void)
{
  static const struct {
    const char *method;
    double rtol;
  } runs[] = {{"auto", 1e-11},      {"radau:s=5", 1e-11}, {"radau:s=5", 1e-12},
              {"radau:s=7", 1e-11}, {"radau:s=7", 1e-12}, {"radau:s=9", 1e-11},
              {"radau:s=9", 1e-12}, {"gauss:s=4", 1e-9}};
  const row transamp = {"transamp", 0};
  for (size_t k = 0; k < sizeof runs / sizeof *runs; k++)
    CHECK(look(&transamp, runs[k].method, runs[k].rtol));
}

/* Algebraic unknowns that a method does not damp come to be off by many tolerances now and then; what
 * takes them back is no single correction. */
static void gauss_passes_every_tolerance(void)
{
  const row transamp = {"transamp", 0};
  for (double rtol = 1e-4; rtol > 3e-8; rtol *= 0.4642)
    CHECK(look(&transamp, "gauss:s=4", rtol));
  CHECK(look(&transamp, "gauss:s=4", 4.870e-8));
}

/* No estimate of theirs would tell that the multipliers are wrong. */
static void methods_that_miss_multipliers_refuse(void)
{
  static const char *const methods[] = {"dirk:hw43", "dirk:esdirk43", "rodas4", "gauss:s=3"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "caraxis", &p));
  for (int m = 0; m < 4; m++)
    smooth_refused(&p, methods[m], NULL, STEIF_UNSUPPORTED, "index 3");
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Methods of low order keep tight tolerances where the problem forgets their errors, and say so where it does not,
 * before a million steps. `least` runs of each are a success. */
static void low_orders_are_right_or_say_so(void)
{
  static const row some[] = {{"chemakzo", 0}, {"dahlquist", 0}, {"hires", 0},
                             {"kepler", 0},   {"pollu", 0},     {"prothero", 0},
                             {"swing", 0},    {"stiffpair", 0}, {"forced", 0}};
  static const struct {
    const char *method;
    double rtol[3];
    int least;
  } runs[] = {{"be", {1e-3, 1e-5, 1e-8}, 8},
              {"radau:s=1", {1e-3, 1e-5, 1e-8}, 8},
              {"bdf:p=2", {1e-3, 1e-6, 1e-9}, 13},
              {"glm:nord22", {1e-3, 1e-4, 1e-6}, 20},
              {"glm:irks,p=2", {1e-3, 1e-5, 1e-6}, 20},
              {"bdf", {1e-6, 1e-9, 1e-11}, 19},
              {"dirk:esdirk43", {1e-3, 1e-7, 1e-11}, 25},
              {"rodas5p", {1e-3, 1e-7, 1e-11}, 25}};
  for (size_t m = 0; m < sizeof runs / sizeof *runs; m++) {
    int succeeded = 0;
    for (size_t i = 0; i < sizeof some / sizeof *some; i++)
      for (int k = 0; k < 3; k++) succeeded += look(some + i, runs[m].method, runs[m].rtol[k]);
    if (succeeded < runs[m].least) printf("\n  %s: %d succeed", runs[m].method, succeeded);
    CHECK(succeeded >= runs[m].least);
  }
}

/* Kepler's ellipse magnifies errors a hundredfold: what order 2 has left is told; the other forgets them. */
static void order_2_ends_early(void)
{
  const row ellipse = {"kepler", 0}, forced = {"forced", 0};
  CHECK(!look(&ellipse, "glm:nord22", 1e-8));
  CHECK(look(&forced, "glm:nord22", 1e-9));
  look(&ellipse, "glm:dimsim1,p=3", 1e-9);
}

/* Stars that pass close to each other magnify errors thousands of times and give most of that back: errors that
 * are small beside what they were are still the errors of the run. */
static void encounters_are_counted(void)
{
  const row stars = {"plei", 0};
  look(&stars, "bdf:p=2", 1e-4);
  look(&stars, "bdf:p=2", 1e-5);
  look(&stars, "glm:am,p=4", 1e-9);
}

/* BDF above order 2 amplifies the oscillations of the beam: 58 000 steps. */
static void bdf_takes_the_stable_order(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "beam", &p));
  o.rtol = 1e-4;
  steif_solver *s = smooth_open(ctx, &p, "bdf:p=5", &o);
  CHECK(!steif_solve_to(s, p.t1));
  CHECK(steif_statistics(s)->steps < 20000);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Counts of the day they were written, a quarter more at most: thrift. Steps, evaluations of f,
 * Jacobians, factorisations. */
static void counts_do_not_grow(void)
{
  static const struct {
    const char *problem, *method;
    double rtol;
    long most[4];
  } runs[] = {{"vdpol", "radau:s=7", 1e-6, {110, 4803, 119, 620}},
              {"rober", "radau:s=7", 1e-6, {67, 2780, 65, 284}},
              {"hires", "radau:s=7", 1e-6, {32, 1678, 43, 208}},
              {"pollu", "radau:s=7", 1e-6, {16, 544, 17, 96}},
              {"chemakzo", "radau:s=5", 1e-4, {14, 299, 17, 57}},
              {"transamp", "radau:s=7", 1e-6, {258, 18493, 476, 2136}},
              {"hires", "bdf:p=5", 1e-6, {832, 2133, 44, 47}}};
  for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    steif_options o = steif_defaults();
    CU_ASSERT_FATAL(!steif_problem_find(ctx, runs[i].problem, &p));
    o.rtol = runs[i].rtol;
    steif_solver *s = smooth_open(ctx, &p, runs[i].method, &o);
    CHECK(!steif_solve_to(s, p.t1));
    const steif_stats *n = steif_statistics(s);
    const long found[] = {n->steps, n->nfe, n->nje, n->nlu};
    for (int k = 0; k < 4; k++) {
      if (found[k] > runs[i].most[k] * 5 / 4)
        printf("\n  %s %s, count %d: %ld", runs[i].problem, runs[i].method, k, found[k]);
      CHECK(found[k] <= runs[i].most[k] * 5 / 4);
    }
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* A thermostat: x' = x up to 2, x' = -3 down to 1. What errors grow between two switches, the second takes back:
 * a cycle of ln 2 + 1/3 keeps them, where x' alone doubles them, 2^40 in 40 cycles. */
static int heated(sunrealtype t, N_Vector y, N_Vector f, void *on)
{
  (void)t;
  NV_Ith_S(f, 0) = *(const bool *)on ? NV_Ith_S(y, 0) : -3;
  return 0;
}

static int border(sunrealtype t, N_Vector y, sunrealtype *g, void *on)
{
  (void)t;
  g[0] = *(const bool *)on ? NV_Ith_S(y, 0) - 2 : 1 - NV_Ith_S(y, 0);
  return 0;
}

static int switched(sunrealtype t, N_Vector y, const int *fired, void *on)
{
  (void)t, (void)y, (void)fired;
  *(bool *)on = !*(bool *)on;
  return STEIF_RESTART;
}

static void switches_take_back_what_grew(void)
{
  static const char *const methods[] = {"bdf", "bdf:p=3"};
  static const sunrealtype one = 1;
  for (int k = 0; k < 4; k++) {
    bool on = true;
    const sunrealtype end = 40 * (log(2) + 1 / 3.0) + 0.3;
    const steif_problem p = {.name = "thermostat",
                             .n = 1,
                             .t1 = end,
                             .y0 = &one,
                             .f = heated,
                             .events = 1,
                             .event = border,
                             .handle_event = switched,
                             .user = &on};
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = o.atol = k < 2 ? 1e-6 : 1e-8;
    steif_solver *s = smooth_open(ctx, &p, methods[k % 2], &o);
    if (steif_solve_to(s, end))
      printf("\n  thermostat %s: %s", methods[k % 2], steif_message(ctx));
    CHECK(steif_status(ctx) == STEIF_OK);
    CHECK(fabs(NV_Ith_S(steif_solution(s), 0) - exp(0.3)) <= 10 * o.rtol * (1 + exp(0.3)));
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_success[] = {
  {"success means digits", success_means_digits},
  {"Gauss stays on the slow manifold", gauss_stays_on_the_slow_manifold},
  {"the amplifier reaches eleven digits", the_amplifier_reaches_eleven_digits},
  {"Gauss passes every tolerance", gauss_passes_every_tolerance},
  {"methods that miss multipliers refuse", methods_that_miss_multipliers_refuse},
  {"low orders are right or say so", low_orders_are_right_or_say_so},
  {"close encounters are counted", encounters_are_counted},
  {"switches take back what grew", switches_take_back_what_grew},
  {"order 2 ends early", order_2_ends_early},
  {"BDF takes the stable order", bdf_takes_the_stable_order},
  {"counts do not grow", counts_do_not_grow},
  CU_TEST_INFO_NULL};
