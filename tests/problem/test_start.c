/* Start values and slopes: where they come from and what refuses them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

typedef struct give {
  int returned, slopes;
  double value;
} give;

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const give *x = user;
  NV_Ith_S(out, 0) = x->value + t, NV_Ith_S(out, 1) = 0.3 * NV_Ith_S(y, 0);
  return x->returned;
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  (void)t, (void)user;
  N_VLinearSum(1, yp, 0.7, y, r);
  return 0;
}

static int begin(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const give *x = user;
  NV_Ith_S(y, 0) = x->value, NV_Ith_S(y, 1) = t;
  if (x->slopes && yp) N_VConst(-0.77, yp);
  return x->returned;
}

static const double y0[] = {1.4, -0.2}, yp0[] = {0.5, 0.6};

typedef struct outcome {
  steif_context *ctx;
  N_Vector y, yp;
  bool known;
  int code;
} outcome;

static outcome start(const steif_problem *p)
{
  outcome o = {.ctx = steif_context_new(NULL)};
  stf_space space;
  o.y = N_VNew_Serial(2, steif_sundials(o.ctx)), o.yp = N_VClone(o.y);
  N_VConst(0, o.y), N_VConst(0, o.yp);
  stf_space_open(&space, o.y);
  o.code =
    stf_system_start(o.ctx, p, steif_problem_form(o.ctx, p), &space, o.y, o.yp, &o.known);
  return o;
}

static void finish(outcome *o)
{
  N_VDestroy(o->y), N_VDestroy(o->yp);
  steif_context_free(&o->ctx);
}

static void slopes_come_from_the_form(void)
{
  give x = {.value = 2.6};
  steif_problem p = {.name = "p", .n = 2, .t0 = 0.5, .t1 = 1, .y0 = y0, .f = f, .user = &x};
  outcome o = start(&p);
  CHECK(!o.code && o.known);
  CLOSE(NV_Ith_S(o.y, 1), -0.2, 0);
  CLOSE(NV_Ith_S(o.yp, 0), 3.1, 1e-16);
  CLOSE(NV_Ith_S(o.yp, 1), 0.42, 1e-15);
  finish(&o);
  p.f = NULL, p.F = F;
  o = start(&p);
  CHECK(!o.code && !o.known && NV_Ith_S(o.yp, 0) == 0);
  finish(&o);
  p.yp0 = yp0;
  o = start(&p);
  CHECK(!o.code && o.known && NV_Ith_S(o.yp, 1) == 0.6);
  finish(&o);
}

static void a_callback_may_give_the_start(void)
{
  give x = {.value = 2.6, .slopes = 1};
  steif_problem p = {
    .name = "p", .n = 2, .t0 = 0.5, .t1 = 1, .F = F, .start = begin, .user = &x};
  outcome o = start(&p);
  CHECK(!o.code && o.known);
  CHECK(NV_Ith_S(o.y, 0) == 2.6 && NV_Ith_S(o.y, 1) == 0.5 && NV_Ith_S(o.yp, 1) == -0.77);
  finish(&o);
}

static void refused(give x, steif_problem p, int code, const char *words)
{
  p.user = &x;
  outcome o = start(&p);
  const int good = o.code == code && strstr(steif_message(o.ctx), words);
  if (!good) printf("\n  code %d: %s", o.code, steif_message(o.ctx));
  CHECK(good);
  finish(&o);
}

static void bad_starts_are_refused(void)
{
  steif_problem p = {.name = "p", .n = 2, .t0 = 0.5, .t1 = 1, .y0 = y0, .f = f};
  refused((give){.returned = 1}, p, STEIF_CALLBACK, "f of problem 'p' could not be evaluated");
  refused((give){.value = NAN}, p, STEIF_NOT_FINITE, "slope 0 at the start");
  p.f = NULL, p.F = F, p.start = begin;
  refused((give){.returned = 1}, p, STEIF_CALLBACK, "start of problem 'p' returned 1");
  refused((give){.value = INFINITY}, p, STEIF_NOT_FINITE, "start value 0 of problem");
}

CU_TestInfo tests_of_start[] = {
  {"slopes come from the form", slopes_come_from_the_form},
  {"a callback may give the start", a_callback_may_give_the_start},
  {"bad starts are refused", bad_starts_are_refused},
  CU_TEST_INFO_NULL};
