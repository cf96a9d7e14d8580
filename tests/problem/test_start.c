/* Start values and slopes: where they come from and what refuses them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <stdlib.h>
#include <sunmatrix/sunmatrix_dense.h>

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

static int unit(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)t, (void)derivative;
  NV_Ith_S(out, 0) = 1, NV_Ith_S(out, 1) = ((const give *)user)->value;
  return 0;
}

static int undefined(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  F(t, y, yp, r, user);
  NV_Ith_S(r, 1) = sqrt(NV_Ith_S(y, 1));
  return 0;
}

/* Callbacks that make vectors shorter, or swap their arrays. */
static int shorter(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)y, (void)user;
  NV_LENGTH_S(out) = 1;
  return 0;
}

static int longer(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)out, (void)user;
  NV_LENGTH_S(y) = 3;
  return 0;
}

static int elsewhere(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  static double own[2];
  (void)t, (void)y, (void)user;
  if (NV_OWN_DATA_S(out)) free(NV_DATA_S(out));
  NV_OWN_DATA_S(out) = 0;
  NV_DATA_S(out) = own;
  return 0;
}

static void callbacks_that_change_sizes_are_refused(void)
{
  steif_problem p = {.name = "p", .n = 2, .t0 = 0.5, .t1 = 1, .y0 = y0, .f = shorter};
  refused((give){0}, p, STEIF_BAD_INPUT,
          "f of problem 'p' gave a vector back with 1 components, it had 2");
  p.f = longer;
  refused((give){0}, p, STEIF_BAD_INPUT, "with 3 components, it had 2");
  p.E = unit;
  refused((give){0}, p, STEIF_BAD_INPUT, "with 3 components, it had 2");
  p.f = elsewhere;
  refused((give){0}, p, STEIF_BAD_INPUT, "with 2 components in another array");
}

static void bad_starts_are_refused(void)
{
  steif_problem p = {.name = "p", .n = 2, .t0 = 0.5, .t1 = 1, .y0 = y0, .f = f};
  refused((give){.returned = 1}, p, STEIF_CALLBACK, "f of problem 'p' could not be evaluated");
  refused((give){.value = NAN}, p, STEIF_NOT_FINITE,
          "component 1 of f of problem 'p' is not finite at the start, t = 0.5");
  p.E = unit;
  refused((give){.returned = 1}, p, STEIF_CALLBACK, "f of problem 'p' could not be evaluated");
  refused((give){.value = NAN}, p, STEIF_NOT_FINITE, "component 1 of f of problem 'p'");
  p.f = NULL, p.A = unit, p.g = g;
  refused((give){.value = NAN}, p, STEIF_NOT_FINITE, "component 2 of g of problem 'p'");
  p.E = p.A = NULL, p.g = NULL, p.F = undefined, p.yp0 = yp0;
  refused((give){.value = 1}, p, STEIF_NOT_FINITE, "component 2 of F of problem 'p'");
  p.yp0 = NULL;
  p.f = NULL, p.F = F, p.start = begin;
  refused((give){.returned = 1}, p, STEIF_CALLBACK, "start of problem 'p' returned 1");
  refused((give){.value = INFINITY}, p, STEIF_NOT_FINITE, "start value 1 of problem");
}

CU_TestInfo tests_of_start[] = {
  {"slopes come from the form", slopes_come_from_the_form},
  {"a callback may give the start", a_callback_may_give_the_start},
  {"bad starts are refused", bad_starts_are_refused},
  {"callbacks that change sizes are refused", callbacks_that_change_sizes_are_refused},
  CU_TEST_INFO_NULL};
