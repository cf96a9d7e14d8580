/* test_causes.c: constructed failures of a toy stepper, and healthy runs, each with its
 * cause.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models/models.h"
#include "suite.h"
#include "toy.h"
#include <string.h>

typedef struct failure {
  const char *name;
  double rtol, t1;
  int trapezoid;
  enum steif_cause_kind kind;
  double moved[3]; /* component (from 1), by; what is done to the start */
  double at;       /* time of the event, 0: not looked at */
  double within;   /* relative error of that time, 0: 5e-3 */
  int unknown;     /* from 1, 0: not looked at, -1: none may be named */
  long most;       /* steps */
  double h0;
} failure;

static const char *const words[] = {"unknown",  "not finite", "blow-up",  "impasse", "jump",
                                    "Jacobian", "singular",   "accuracy", "stiff",   "start",
                                    "ringing",  "index",      "growth",   "events"};

static toy run; /* large */

static int begin(steif_context *ctx, const char *name, steif_problem *p, steif_point *names)
{
  const model *m = model_find(name);
  *names = (steif_point){0};
  if (!m) return steif_problem_find(ctx, name, p);
  *p = model_problem(m, 1);
  *names = model_inquiry(m);
  return 0;
}

static void end(steif_context *ctx, const char *name, steif_problem *p)
{
  if (!model_find(name)) steif_problem_clear(ctx, p);
}

static void fail_and_explain(const failure *f, steif_cause *cause)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_point names;
  double y[TOY_LARGEST];
  CU_ASSERT_FATAL(!begin(ctx, f->name, &p, &names));
  memcpy(y, p.y0, (size_t)p.n * sizeof *y);
  if (f->moved[0] > 0) y[(int)f->moved[0] - 1] += f->moved[1];
  run = (toy){.rtol = f->rtol,
              .atol = f->rtol,
              .t1 = p.t0 + f->t1,
              .trapezoid = f->trapezoid,
              .most = f->most,
              .h0 = f->h0};
  CHECK(!toy_run(ctx, &p, y, NULL, &run));
  const int code = toy_explain(ctx, &p, &run, names, cause);
  if (code || cause->kind != f->kind)
    printf("\n  %s: %s, %ld steps to t = %g, h = %.1e: %s: %s", f->name,
           run.failed ? "failed" : "finished", run.scene.steps, run.t[run.scene.count - 1],
           run.scene.h, code ? "" : words[cause->kind],
           code ? steif_message(ctx) : cause->message);
  CHECK(code == 0);
  CHECK(cause->kind == f->kind);
  if (f->at > 0) CLOSE(cause->t, f->at, f->within > 0 ? f->within : 5e-3);
  if (f->unknown) CHECK(cause->unknown == (f->unknown > 0 ? f->unknown - 1 : -1));
  CHECK(strlen(cause->message) > 30);
  end(ctx, f->name, &p);
  steif_context_free(&ctx);
}

#define ALL(table)                                                                             \
  for (size_t k = 0; k < sizeof(table) / sizeof *(table); k++) {                               \
    steif_cause cause;                                                                         \
    fail_and_explain(&(table)[k], &cause);                                                     \
  }

static void plain_weights_and_higher_index(void)
{
  static const failure table[] = {
    {.name = "pendulum3", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_INDEX, .unknown = 5},
    {.name = "jay3", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_INDEX, .unknown = 5},
    {.name = "cstr", .rtol = 1e-7, .t1 = 1, .kind = STEIF_CAUSE_INDEX},
    {.name = "caraxis", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_INDEX}};
  ALL(table)
}

static void inconsistent_starts(void)
{
  static const failure table[] = {
    {.name = "pendulum3",
     .rtol = 1e-6,
     .t1 = 1,
     .kind = STEIF_CAUSE_START,
     .moved = {1, .0413}},
    {.name = "transamp", .rtol = 1e-6, .t1 = .1, .kind = STEIF_CAUSE_START, .moved = {4, -4}},
    {.name = "mnali", .rtol = 1e-6, .t1 = 1e-2, .kind = STEIF_CAUSE_START, .moved = {3, .5}},
    {.name = "hess2", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_START, .moved = {1, .2}},
    {.name = "wrong_by_four", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_START}};
  ALL(table)
}

static void singular_systems(void)
{
  static const failure table[] = {
    {.name = "ungrounded", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_SINGULAR},
    {.name = "twice", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_SINGULAR},
    {.name = "ltvb", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_SINGULAR}};
  ALL(table)
  steif_cause cause;
  fail_and_explain(&table[2], &cause); /* solvable, of index 2 */
  CHECK(strstr(cause.message, "index 2") && strstr(cause.message, "turn with time"));
}

static void blow_ups(void)
{
  static const failure table[] = {
    {.name = "square", .rtol = 1e-5, .t1 = 2, .kind = STEIF_CAUSE_BLOW_UP, .at = 1},
    {.name = "exponential", .rtol = 1e-5, .t1 = 2, .kind = STEIF_CAUSE_BLOW_UP, .at = 1},
    {.name = "coupled", .rtol = 1e-5, .t1 = 4, .kind = STEIF_CAUSE_BLOW_UP}};
  ALL(table)
}

/* Times by separation of variables: 1.92 - ln 2.2; 1. */
static void impasses(void)
{
  static const failure table[] = {
    {.name = "vanderpol",
     .rtol = 1e-5,
     .t1 = 3,
     .kind = STEIF_CAUSE_IMPASSE,
     .unknown = 2,
     .at = 1.13154263963,
     .within = 1.7e-3},
    {.name = "fold", .rtol = 1e-5, .t1 = 3, .kind = STEIF_CAUSE_IMPASSE, .at = 1},
    {.name = "cubic", .rtol = 1e-5, .t1 = 20, .kind = STEIF_CAUSE_IMPASSE, .unknown = 2}};
  ALL(table)
}

static void jumps(void)
{
  static const failure table[] = {
    {.name = "algebraic_jump",
     .rtol = 1e-6,
     .t1 = 1,
     .kind = STEIF_CAUSE_JUMP,
     .at = .4371,
     .within = 1e-12,
     .unknown = -1},
    {.name = "voltage_step",
     .rtol = 1e-6,
     .t1 = 1,
     .kind = STEIF_CAUSE_JUMP,
     .at = .3217,
     .within = 1e-12,
     .unknown = -1},
    {.name = "switched", .rtol = 1e-6, .t1 = 1, .kind = STEIF_CAUSE_JUMP, .unknown = 1},
    {.name = "relay",
     .rtol = 1e-6,
     .t1 = 1,
     .kind = STEIF_CAUSE_JUMP,
     .at = .4 / .7,
     .unknown = 1}};
  ALL(table)
}

static void limits_of_accuracy(void)
{
  static const failure table[] = {
    {.name = "noisy8", .rtol = 1e-9, .t1 = 1, .kind = STEIF_CAUSE_ACCURACY},
    {.name = "noisy6", .rtol = 1e-8, .t1 = 1, .kind = STEIF_CAUSE_ACCURACY},
    {.name = "oscillator", .rtol = 1e-16, .t1 = 1, .kind = STEIF_CAUSE_ACCURACY},
    {.name = "hess2", .rtol = 1e-15, .t1 = 1, .kind = STEIF_CAUSE_ACCURACY}};
  ALL(table)
}

static void ringing(void)
{
  static const char *const names[] = {"stiff", "fast", "fast_cubic", "fast_algebraic"};
  for (int k = 0; k < 4; k++) {
    const failure one[] = {{.name = names[k],
                            .rtol = 1e-6,
                            .t1 = 1,
                            .trapezoid = 1,
                            .most = 300,
                            .h0 = 1e-3,
                            .kind = STEIF_CAUSE_RINGING}};
    steif_cause cause;
    fail_and_explain(one, &cause);
  }
}

static void domains_that_end(void)
{
  static const failure table[] = {
    {.name = "root", .rtol = 1e-5, .t1 = 1, .kind = STEIF_CAUSE_NOT_FINITE, .at = .5}};
  ALL(table)
}

/* Five states of runs where all is well. */
static void healthy_runs_have_no_cause(void)
{
  static const failure table[] = {{.name = "rober:form=mass", .rtol = 1e-6, .t1 = 100},
                                  {.name = "chemakzo", .rtol = 1e-6, .t1 = 180},
                                  {.name = "vdpol", .rtol = 1e-6, .t1 = .5},
                                  {.name = "growing", .rtol = 1e-6, .t1 = 3},
                                  {.name = "transamp", .rtol = 1e-5, .t1 = .05},
                                  {.name = "oscillator", .rtol = 1e-6, .t1 = 3},
                                  {.name = "pendulum3:index=1", .rtol = 1e-6, .t1 = 2},
                                  {.name = "hess2", .rtol = 1e-5, .t1 = 1},
                                  {.name = "pendulum3", .rtol = 1e-4, .t1 = 1},
                                  {.name = "front", .rtol = 1e-6, .t1 = .2}};
  for (size_t k = 0; k < sizeof table / sizeof *table; k++)
    for (int part = 1; part <= 5; part++) {
      steif_context *ctx = steif_context_new(NULL);
      steif_problem p;
      steif_point names;
      steif_cause cause;
      const failure *f = &table[k];
      static const int hess[] = {1, 1, 2};
      CU_ASSERT_FATAL(!begin(ctx, f->name, &p, &names));
      if (!strcmp(f->name, "hess2")) p.index = hess;
      run = (toy){.rtol = f->rtol,
                  .atol = f->rtol * (p.rtol_scale > 0 ? p.rtol_scale : 1),
                  .t1 = p.t0 + f->t1 * part / 5,
                  .weighted = p.index != NULL};
      CHECK(!toy_run(ctx, &p, NULL, NULL, &run));
      const int code = toy_explain(ctx, &p, &run, names, &cause);
      if (code || cause.kind || run.failed)
        printf("\n  %s at %g (%s, %ld steps, h = %.1e): %s %s", f->name, run.t1,
               run.failed ? "failed" : "finished", run.scene.steps, run.scene.h,
               code ? "" : words[cause.kind], code ? steif_message(ctx) : cause.message);
      CHECK(code == 0 && cause.kind == STEIF_CAUSE_UNKNOWN && !run.failed);
      CHECK(strncmp(cause.message, "No cause", 8) == 0);
      end(ctx, f->name, &p);
      steif_context_free(&ctx);
    }
}

CU_TestInfo tests_of_causes[] = {
  {"plain weights and higher index", plain_weights_and_higher_index},
  {"inconsistent starts", inconsistent_starts},
  {"singular systems", singular_systems},
  {"blow-ups", blow_ups},
  {"impasses", impasses},
  {"jumps", jumps},
  {"limits of accuracy", limits_of_accuracy},
  {"ringing", ringing},
  {"domains that end", domains_that_end},
  {"healthy runs have no cause", healthy_runs_have_no_cause},
  CU_TEST_INFO_NULL};
