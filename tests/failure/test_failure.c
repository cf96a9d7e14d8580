/* test_failure.c: failed runs of the solver, and what is said of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <string.h>

/* y1' = y1^2, y2' = -y2: y1 = 1/(1 - t). */
static int burst(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  NV_Ith_S(r, 1) = -NV_Ith_S(y, 1);
  return 0;
}
static const sunrealtype ones[] = {1, 1};
static const steif_problem blow_up = {.name = "burst", .n = 2, .t1 = 2, .y0 = ones, .f = burst};

/* y2 has to be the square root of 0.5 - t. */
static int root(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 1);
  NV_Ith_S(r, 1) = NV_Ith_S(y, 1) * NV_Ith_S(y, 1) - (0.5 - t);
  return 0;
}
static int first_only(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}
static const sunrealtype at_root[] = {1, 0.70710678118654752};
static const steif_problem turns = {
  .name = "turns", .n = 2, .t1 = 1, .y0 = at_root, .f = root, .E = first_only, .dae_index = 1};

static void find_from(const steif_problem *p, const char *method, double rtol,
                      enum steif_initial initial, steif_failure *f)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = rtol, o.initial = initial;
  memset(f, 0, sizeof *f);
  const int code = steif_failure_find(ctx, p, method, &o, f);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(!code && f->code < 0);
  steif_context_free(&ctx);
}

static void find(const steif_problem *p, const char *method, double rtol, steif_failure *f)
{
  find_from(p, method, rtol, STEIF_REPAIR, f);
}

/* From a start that stays as it is. */
static void find_given(const steif_problem *p, const char *method, double rtol,
                       steif_failure *f)
{
  find_from(p, method, rtol, STEIF_AS_GIVEN, f);
}

static void a_blow_up_is_told_with_its_time(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf:p=5", "rodas4", "auto"};
  for (int m = 0; m < 4; m++) {
    steif_failure f;
    find(&blow_up, methods[m], 1e-5, &f);
    CHECK(f.cause.kind == STEIF_CAUSE_BLOW_UP);
    CLOSE(f.cause.t, 1, 5e-3);
    CHECK(f.t < 1.01 && f.h > 0 && f.order > 0 && f.steps > 5);
    CHECK(f.count == 2 && f.worst[0].component == 0);
    CHECK(strstr(f.message, "worst y1") && strstr(f.message, "blows up"));
  }
}

static void an_impasse_is_told_with_its_time(void)
{
  steif_failure f;
  find(&turns, "radau:s=3", 1e-5, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_IMPASSE);
  CLOSE(f.cause.t, 0.5, 5e-3);
}

/* x' = -1/x reaches 0 at t = 1/2, x' = 1/(1/2 - x) its pole at t = 1/8 going down; 1/(t - 0.3) is a pole in time. */
static int poles(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype x = NV_Ith_S(y, 0);
  const int kind = *(const int *)user;
  NV_Ith_S(r, 0) = kind == 0 ? -1 / x : kind == 1 ? 1 / (0.5 - x) : 1 / (t - 0.3);
  return 0;
}

static void a_pole_is_no_jump(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "bdf", "dirk:hw43", "rodas4"};
  static const sunrealtype at[] = {0.5, 0.125, 0.3};
  for (int kind = 0; kind < 3; kind++)
    for (int m = 0; m < 5; m++) {
      steif_failure f;
      const steif_problem p = {
        .name = "poles", .n = 1, .t1 = 1, .y0 = ones, .f = poles, .user = &kind};
      find(&p, methods[m], 1e-6, &f);
      CHECK(f.cause.kind != STEIF_CAUSE_JUMP && f.cause.kind != STEIF_CAUSE_JACOBIAN);
      CHECK(kind == 2 || (f.cause.kind == STEIF_CAUSE_IMPASSE &&
                          strstr(f.message, kind ? "y1 passes 0.5:" : "y1 passes 0:")));
      if (f.cause.kind != STEIF_CAUSE_UNKNOWN) CLOSE(f.cause.t, at[kind], 1e-3);
    }
}

/* y1 + y1^3/5 = sin t + 1/2, y2, y3, y4 its derivatives (1 + y1^2/10 times as small): index 4. */
static int chain(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const double *a = N_VGetArrayPointer(y), *b = N_VGetArrayPointer(yp);
  (void)user;
  NV_Ith_S(r, 0) = a[0] + a[0] * a[0] * a[0] / 5 - sin(t) - .5;
  for (int i = 1; i < 4; i++) NV_Ith_S(r, i) = b[i - 1] - a[i] * (1 + a[0] * a[0] / 10);
  return 0;
}

static void index_four_is_refused_with_names(void)
{
  double y0[4], yp0[4];
  for (int declared = 0; declared < 2; declared++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_failure f;
    steif_start start;
    steif_problem p = {.name = "chain", .n = 4, .t1 = 1, .F = chain, .y0 = y0, .yp0 = yp0};
    p.dae_index = declared ? 4 : -1;
    memset(y0, 0, sizeof y0), memset(yp0, 0, sizeof yp0);
    CU_ASSERT_FATAL(!steif_consistent(ctx, &p, NULL, NULL, &start));
    memcpy(y0, start.y, sizeof y0), memcpy(yp0, start.yp, sizeof yp0);
    steif_start_clear(&start);
    find(&p, "auto", 1e-6, &f);
    CHECK(f.code == (declared ? STEIF_UNSUPPORTED : f.code) && f.steps == 0);
    CHECK(f.cause.kind == STEIF_CAUSE_INDEX && f.cause.value[0] == 4 && f.cause.unknown == 3);
    CHECK(strstr(f.message, "y2 (2), y3 (3), y4 (4)") &&
          strstr(f.message, "e1 (3), e2 (2), e3 (1)"));
    steif_context_free(&ctx);
  }
}

static void an_inconsistent_start_is_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_failure f;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "switchrlc", &p));
  find_given(&p, "radau:s=3", 1e-8, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_START && f.steps == 0);
  CHECK(strstr(f.message, "equation switch") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Impulses of ut5, regular and of index 3, drive y to 1e16 in many short steps: what fails is still the
 * start. From x(0+) they stop, too; which cause that has is not known, and what serves is. */
static void impulses_of_the_start_are_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_failure f;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "ut5", &p));
  find_given(&p, "radau:s=5", 1e-6, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_START && f.steps > 1);
  CHECK(strstr(f.message, "method descriptor") != NULL);
  find(&p, "radau:s=5", 1e-6, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_UNKNOWN);
  CHECK(strstr(f.message, "method descriptor") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* A run that ends at max_steps: x'' = -k^2 x - d x' + noise, or with a rod of length 1 and multiplier. */
typedef struct spring {
  double k, d, noise;
  unsigned state;
} spring;

static int swings(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  spring *s = user;
  (void)t;
  NV_Ith_S(r, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(r, 1) = -s->k * s->k * NV_Ith_S(y, 0) - s->d * NV_Ith_S(y, 1);
  return 0;
}

static void limited(const steif_problem *p, const char *method, long steps, steif_failure *f)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.max_steps = steps;
  memset(f, 0, sizeof *f);
  CHECK(!steif_failure_find(ctx, p, method, &o, f) && f->code == STEIF_STEP_LIMIT);
  steif_context_free(&ctx);
}

/* Eigenvalues -1 and -1e4; and +-i, where accuracy holds the steps. */
static void steps_that_stability_holds_are_told(void)
{
  spring stiff = {.k = 100, .d = 10001}, free = {.k = 1};
  steif_problem p = {
    .name = "spring", .n = 2, .t1 = 1000, .y0 = ones, .f = swings, .user = &stiff};
  steif_failure f;
  limited(&p, "dopri87", 3000, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_STIFF && strstr(f.message, "Use an implicit method"));
  CLOSE(f.cause.value[1], 1e4, 1e-3);
  CHECK(f.cause.value[0] > 2 && f.cause.value[0] < 8);
  limited(&p, "radau:s=3", 30, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_UNKNOWN);
  p.user = &free;
  limited(&p, "dopri87", 300, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_UNKNOWN);
}

/* x' = u, u' = -lambda x + noise, 0 = x u + sin t u: the column of lambda is made of noise. */
static int noisy(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  spring *s = user;
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *out = N_VGetArrayPointer(r);
  s->state = s->state * 1103515245u + 12345u;
  out[0] = x[2], out[1] = x[3];
  out[2] = -x[4] * x[0];
  out[3] = -x[4] * x[1] - 1 + s->noise * ((s->state >> 8 & 65535) / 65536. - 0.5);
  out[4] = x[0] * x[2] + x[1] * x[3];
  (void)t;
  return 0;
}
static int four(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  for (int i = 0; i < 4; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static void noise_in_differences_is_told_by_name(void)
{
  static const char *const unknown[] = {"x", "y", "u", "v", "force"};
  static const char *const equation[] = {"kin-x", "kin-y", "dyn-x", "dyn-y", "rod"};
  static const int index[] = {1, 1, 1, 1, 2};
  static const sunrealtype hangs[] = {0.6, -0.8, 0, 0, 0.8};
  spring s = {.noise = 1e-4};
  const steif_names names = {.equation = equation, .unknown = unknown};
  const steif_problem p = {.name = "rod",
                           .n = 5,
                           .names = &names,
                           .t1 = 3,
                           .y0 = hangs,
                           .f = noisy,
                           .E = four,
                           .user = &s,
                           .index = index,
                           .dae_index = 2};
  for (unsigned seed = 1; seed <= 10; seed++) {
    steif_failure f;
    s.state = 7919 * seed;
    find(&p, "radau:s=3", 1e-6, &f);
    CHECK(f.cause.kind == STEIF_CAUSE_ACCURACY && f.cause.equation == 3);
    CHECK(strstr(f.message, "Noise") && strstr(f.message, "in dyn-y spoils the Jacobian"));
    CHECK(strstr(f.message, "it moves force by") != NULL);
  }
}

/* u_t = 20 u_xx + u^2 on a sparse chain, and what stops it: its own growth, NaN behind t = 0.3, a refusal. */
enum { LINKS = 1000 };
typedef struct link {
  int kind;
} link_kind;

static int links(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const int kind = ((link_kind *)user)->kind;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *out = N_VGetArrayPointer(r);
  for (int i = 0; i < LINKS; i++) {
    const sunrealtype left = u[i ? i - 1 : 0], right = u[i < LINKS - 1 ? i + 1 : i];
    out[i] = 20 * (left - 2 * u[i] + right) + u[i] * u[i];
  }
  if (t > 0.3 && kind == 1) out[700] = NAN;
  return t > 0.3 && kind == 2 ? -5 : 0;
}

static void large_problems_are_looked_at_too(void)
{
  sunrealtype y0[LINKS];
  for (int i = 0; i < LINKS; i++) y0[i] = 1;
  link_kind kind = {0};
  const steif_problem p = {.name = "links",
                           .n = LINKS,
                           .t1 = 2,
                           .y0 = y0,
                           .f = links,
                           .storage = STEIF_BAND,
                           .lower = 1,
                           .upper = 1,
                           .user = &kind};
  steif_failure f;
  find(&p, "radau:s=3", 1e-5, &f);
  CHECK(f.cause.kind == STEIF_CAUSE_BLOW_UP);
  CLOSE(f.cause.t, 1, 1e-4);
  for (kind.kind = 1; kind.kind <= 2; kind.kind++) {
    find(&p, "bdf", 1e-5, &f);
    CHECK(f.cause.kind == STEIF_CAUSE_NOT_FINITE);
    CHECK(f.cause.equation == (kind.kind == 1 ? 700 : -1));
    CLOSE_FLOOR(f.cause.t, 0.3, 0.1, 1);
  }
}

static void good_runs_have_no_failure(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_failure f;
  steif_options o = steif_defaults();
  o.t1 = 0.5;
  CHECK(steif_failure_find(ctx, &blow_up, "radau:s=3", &o, &f) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "does not fail") != NULL);
  CHECK(steif_failure_find(ctx, &blow_up, "rado", &o, &f) == STEIF_UNKNOWN_NAME);
  CHECK(steif_failure_find(ctx, NULL, "auto", &o, &f) == STEIF_BAD_INPUT);
  CHECK(steif_failure_find(ctx, &blow_up, "auto", &o, NULL) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void memory_may_fail_at_any_request(void)
{
  long refused = 0;
  for (long k = 1;; k += 7) {
    failing x = {.refuse_at = k};
    const steif_setup setup = failing_setup(&x);
    steif_context *ctx = steif_context_new(&setup);
    steif_failure f;
    const int code =
      ctx ? steif_failure_find(ctx, &blow_up, "radau:s=3", NULL, &f) : STEIF_NO_MEMORY;
    steif_context_free(&ctx);
    CHECK(x.alive == 0);
    if (x.served < k) {
      CHECK(!code);
      break;
    }
    CHECK(code == STEIF_NO_MEMORY);
    refused++;
  }
  CHECK(refused > 10);
}

/* A relay that switches against itself: its slope changes sign at every event, but methods that damp stiff
 * components are not to blame. */
static void a_relay_does_not_ring(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "bdf", "gauss:s=2"};
  static const char relay[] = "state x = 1\nx' = if x > 0 then -1 else 1\ntime 0 to 3\n";
  for (int m = 0; m < 4; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_model_parse(ctx, relay, "relay.steif", NULL, &p));
    const steif_options o = steif_defaults();
    steif_failure f = {0};
    CHECK(!steif_failure_find(ctx, &p, methods[m], &o, &f));
    CHECK(f.code == STEIF_STEP_SIZE);
    CLOSE(f.t, 1, 1e-4);
    CHECK(f.cause.kind != STEIF_CAUSE_RINGING);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_failure[] = {
  {"a relay does not ring", a_relay_does_not_ring},
  {"index 4 is refused with names", index_four_is_refused_with_names},
  {"a blow-up is told with its time", a_blow_up_is_told_with_its_time},
  {"an impasse is told with its time", an_impasse_is_told_with_its_time},
  {"a pole is no jump", a_pole_is_no_jump},
  {"an inconsistent start is told", an_inconsistent_start_is_told},
  {"impulses of the start are told", impulses_of_the_start_are_told},
  {"steps that stability holds are told", steps_that_stability_holds_are_told},
  {"noise in differences is told by name", noise_in_differences_is_told_by_name},
  {"large problems are looked at too", large_problems_are_looked_at_too},
  {"good runs have no failure", good_runs_have_no_failure},
  {"memory may fail at any request", memory_may_fail_at_any_request},
  CU_TEST_INFO_NULL};
