/* test_index_one.c: S and gradients of DAEs of index 1 through events and breaks, and breaks where events are. Models have
 * closed forms: z^3 = c x and x' = -z^3 is x' = -c x.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <steif/gradient.h>
#include <steif/model.h>
#include <string.h>

static const char *const methods[] = {"radau:s=3", "radau:s=5", "radau:s=7",
                                      "gauss:s=3", "dirk:hw43", "bdf"};
enum { METHODS = sizeof methods / sizeof *methods };

/* d(first unknown)/dp_k at t1, forward. */
static void columns(const char *text, const char *method, double rtol, int P, double *S,
                    double *last)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = rtol, o.sensitivities = 1;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "model", NULL, &p));
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  N_Vector d = N_VClone(steif_solution(s));
  for (int k = 0; k < P; k++) {
    CHECK(!steif_sensitivity(s, p.t1, k, d));
    S[k] = NV_Ith_S(d, 0);
    if (last) last[k] = NV_Ith_S(d, p.n - 1);
  }
  N_VDestroy(d);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static int first(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  *g = NV_Ith_S(y, 0);
  return 0;
}

static void gradient(const char *text, const char *method, double rtol, int P, double *dp)
{
  static const steif_functional J = {.count = 1, .end = first};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_gradient g = {0};
  steif_options o = steif_defaults();
  o.rtol = rtol;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "model", NULL, &p));
  const int code = steif_gradient_find(ctx, &p, method, &o, &J, &g);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  for (int k = 0; k < P; k++) dp[k] = g.dp[k];
  steif_gradient_free(ctx, &g);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* x falls to s at log(1/s)/c, and is 3 e^(-c t) after that; z follows. */
static void algebraic_unknowns_follow_after_events(void)
{
  static const char text[] = "param s = 0.5, c = 1.3\nstate x = 1, z ~ 1\nx' = -z^3\n"
                             "0 = z^3 - c*x\nwhen x < s: x = 3*s\ntime 0 to 1.2\n";
  const double c = 1.3, t = 1.2, x = 3 * exp(-c * t), z = cbrt(c * x);
  for (int m = 0; m < METHODS; m++) {
    double S[2], dz[2];
    columns(text, methods[m], 1e-8, 2, S, dz);
    CLOSE_FLOOR(S[0], 0, 1e-5, 1);
    CLOSE(S[1], -t * x, 1e-5);
    CLOSE(dz[1], z / 3 * (1 / c - t), 1e-5);
    gradient(text, methods[m], 1e-8, 2, S);
    CLOSE_FLOOR(S[0], 0, 1e-5, 1);
    CLOSE(S[1], -t * x, 1e-5);
  }
}

/* An algebraic equation that jumps at p: x = exp(-q p - r (t - p)). */
static void algebraic_equations_jump(void)
{
  static const char text[] = "param p = 0.7, q = 1, r = 0.4\nstate x = 1, z ~ 1\nx' = -z^3\n"
                             "0 = z^3 - x*(if t < p then q else r)\ntime 0 to 1.5\n";
  const double p = 0.7, q = 1, r = 0.4, t = 1.5, x = exp(-q * p - r * (t - p));
  const double known[] = {(r - q) * x, -p * x, (p - t) * x}, z = cbrt(r * x);
  for (int m = 0; m < METHODS; m++) {
    double S[3], dz[3];
    columns(text, methods[m], 1e-8, 3, S, dz);
    for (int k = 0; k < 3; k++) CLOSE(S[k], known[k], 1e-5);
    CLOSE(dz[0], z / 3 * (r - q), 1e-5);
    CLOSE(dz[2], z / 3 * (p - t + 1 / r), 1e-5);
    gradient(text, methods[m], 1e-8, 3, S);
    for (int k = 0; k < 3; k++) CLOSE(S[k], known[k], 1e-5);
  }
}

/* Systems of so many unknowns that S is iterated, not factored: what is left of S in algebraic unknowns must not
 * stop the run, whatever the tolerance and the number of stages are. */
static void larger_systems_run(void)
{
  static const char text[] =
    "param c = 1.3, d = 1\nstate x[i in 1:8] = i/8, z[i in 1:8] ~ 1\nfor i in 1:8\n"
    "x[i]' = -z[i]\n0 = z[i] + z[i]^3/(1 + d) - c*x[i]\nend\ntime 0 to 1.5\n";
  static const char *const those[] = {"radau:s=3", "radau:s=5", "radau:s=7", "radau:s=9",
                                      "gauss:s=4"};
  double reference[2], S[2];
  columns(text, "radau:s=5", 1e-11, 2, reference, NULL);
  for (int m = 0; m < 5; m++)
    for (double rtol = 1e-4; rtol > 1e-10; rtol /= 100) {
      columns(text, those[m], rtol, 2, S, NULL);
      for (int k = 0; k < 2; k++) CLOSE_FLOOR(S[k], reference[k], 100 * rtol, 0.1);
    }
}

/* x = 1 + p + a p - 0.4 (t - p): the jump of f and the event move together, and count once. */
static void a_break_and_an_event_at_once_count_once(void)
{
  static const char text[] =
    "param p = 0.7, a = 0.3\nstate x = 1\n"
    "x' = (if t < p then 1 else -0.4)\nat p: x = x + a*p\ntime 0 to 3\n";
  for (int m = 0; m < METHODS; m++) {
    double S[2];
    columns(text, methods[m], 1e-6, 2, S, NULL);
    CLOSE(S[0], 1.4 + 0.3, 1e-8);
    CLOSE(S[1], 0.7, 1e-8);
    gradient(text, methods[m], 1e-6, 2, S);
    CLOSE(S[0], 1.4 + 0.3, 1e-8);
    CLOSE(S[1], 0.7, 1e-8);
  }
}

/* What moves apart has no derivative, unless nothing jumps; so have two breaks at one time. */
static void what_moves_apart_is_refused(void)
{
  static const struct {
    const char *text, *part;
  } apart[] = {
    {"param p = 0.7\nstate x = 1\nx' = (if t < 0.7 then 1 else -0.4)\nat p: x = x + p\n"
     "time 0 to 3\n",
     "a break and an event of problem 'model' at once at t = 0.7"},
    {"param p = 0.7, q = 0.7\nstate x = 1\n"
     "x' = (if t < p then 1 else -0.4) + (if t < q then 2 else 0)\ntime 0 to 3\n",
     "move one of them a little"}};
  static const char smooth[] = "param p = 1\ntable w = (0, 0), (1, 1), (3, 0) linear\n"
                               "state x = 1\nx' = w(t)\nat p: x = x + p\ntime 0 to 3\n";
  double S;
  for (int i = 0; i < 2; i++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    steif_options o = steif_defaults();
    o.sensitivities = 1;
    CU_ASSERT_FATAL(!steif_model_parse(ctx, apart[i].text, "model", NULL, &p));
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
    CHECK(s && steif_solve_to(s, 3) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(ctx), apart[i].part) != NULL);
    if (!strstr(steif_message(ctx), apart[i].part)) puts(steif_message(ctx));
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
  columns(smooth, "radau:s=3", 1e-6, 1, &S, NULL);
  CLOSE(S, 1, 1e-8);
}

CU_TestInfo tests_of_index_one[] = {
  {"algebraic unknowns follow after events", algebraic_unknowns_follow_after_events},
  {"algebraic equations jump", algebraic_equations_jump},
  {"larger systems run", larger_systems_run},
  {"a break and an event at once", a_break_and_an_event_at_once_count_once},
  {"what moves apart is refused", what_moves_apart_is_refused},
  CU_TEST_INFO_NULL};
