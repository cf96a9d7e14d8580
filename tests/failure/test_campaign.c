/* test_campaign.c: constructed failures of known cause by many methods. A cause that is named is the one
 * that was built in, always; and it is named in nine of ten runs.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const char *const words[] = {"unknown", "not finite", "blow-up",  "impasse",
                                    "jump",    "Jacobian",   "singular", "accuracy",
                                    "stiff",   "start",      "ringing",  "index"};
static int runs, right, wrong;

static void judge(const steif_problem *p, const char *method, const steif_options *o,
                  enum steif_cause_kind kind, double t)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_failure f;
  memset(&f, 0, sizeof f);
  const int code = steif_failure_find(ctx, p, method, o, &f);
  const bool named = f.cause.kind != STEIF_CAUSE_UNKNOWN;
  const bool good = f.cause.kind == kind && (!(t > 0) || fabs(f.cause.t - t) < 0.02 * t);
  runs++, right += !code && good, wrong += !code && named && !good;
  if (code || !good)
    printf("\n  %s, %s: %s, not %s: %s", p->name, method, words[f.cause.kind], words[kind],
           code ? steif_message(ctx) : f.message);
  CU_ASSERT_EQUAL(code, STEIF_OK);
  steif_context_free(&ctx);
}

/* What the equations of a run are made of. */
typedef struct built {
  int kind;
  double a, b;
} built;

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const built *c = user;
  const double x = NV_Ith_S(y, 0);
  double r = 0;
  switch (c->kind) {
  case 0: r = sqrt(c->a - t) - x; break;
  case 1: r = log(c->a - t) - x; break;
  case 2: r = pow(fabs(x), c->b); break; /* from 1: T = 1 / (b - 1) */
  case 3: r = exp(x); break;             /* from 0: T = 1 */
  default: r = -c->a * (x - cos(t)); break;
  }
  NV_Ith_S(out, 0) = r;
  return 0;
}

static void ends(built c, double y0, enum steif_cause_kind kind, double t)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "auto", "rodas4", "gauss:s=3"};
  const steif_problem p = {.name = c.kind < 2 ? "domain" : "growth",
                           .n = 1,
                           .t1 = 3 * t,
                           .y0 = &y0,
                           .f = f,
                           .user = &c};
  for (int m = 0; m < 5; m++) {
    steif_options o = steif_defaults();
    o.max_steps = 20000;
    judge(&p, methods[m], &o, kind, t);
  }
}

static void domains_and_growth(void)
{
  static const double ends_at[] = {0.3, 0.77, 14400}, powers[] = {1.5, 2, 3};
  for (int k = 0; k < 3; k++)
    for (int kind = 0; kind < 2; kind++)
      ends((built){.kind = kind, .a = ends_at[k]}, 1, STEIF_CAUSE_NOT_FINITE, ends_at[k]);
  for (int k = 0; k < 3; k++)
    ends((built){.kind = 2, .b = powers[k]}, 1, STEIF_CAUSE_BLOW_UP, 1 / (powers[k] - 1));
  ends((built){.kind = 3}, 0, STEIF_CAUSE_BLOW_UP, 1);
}

/* Runs that a limit ends, and steps that are prescribed, have no cause in the equations, except that an
 * explicit method is slow on a stiff one. */
static void limits(void)
{
  static const double zero[] = {0};
  static const char *const explicits[] = {"dopri87"};
  static const char *const implicits[] = {"radau:s=3", "bdf", "auto", "rodas4"};
  built c = {.kind = 4, .a = 1e4};
  const steif_problem p = {.name = "follow", .n = 1, .t1 = 100, .y0 = zero, .f = f, .user = &c};
  steif_options o = steif_defaults();
  for (int k = 0; k < 3; k++, c.a *= 7) {
    o.max_steps = 3000;
    judge(&p, explicits[0], &o, STEIF_CAUSE_STIFF, 0);
    o.max_steps = 12;
    for (int m = 0; m < 4; m++) judge(&p, implicits[m], &o, STEIF_CAUSE_UNKNOWN, 0);
  }
}

/* Van der Pol's equation, an entry of its Jacobian wrong. */
static int vdp(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  (void)t, (void)user;
  NV_Ith_S(r, 0) = b;
  NV_Ith_S(r, 1) = 1e3 * ((1 - a * a) * b - a);
  return 0;
}
static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector u,
               N_Vector v, N_Vector w)
{
  const double a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  const built *c = user;
  (void)t, (void)fy, (void)u, (void)v, (void)w;
  SM_ELEMENT_D(J, 0, 1) = c->kind == 1 ? -1 : 1;
  SM_ELEMENT_D(J, 1, 0) = 1e3 * (-2 * a * b - 1) * (c->kind == 2 ? c->a : 1);
  SM_ELEMENT_D(J, 1, 1) = 1e3 * (1 - a * a) * (c->kind == 0 ? c->a : 1);
  return 0;
}

static void jacobians(void)
{
  static const double y0[] = {2, 0};
  static const double factor[] = {-1, 0};
  for (int k = 0; k < 2; k++) {
    built c = {.a = factor[k]};
    const steif_problem p = {
      .name = "vdp", .n = 2, .t1 = 2, .y0 = y0, .f = vdp, .jac = jac, .user = &c};
    steif_options o = steif_defaults();
    o.max_steps = 200;
    judge(&p, "radau:s=3", &o, STEIF_CAUSE_JACOBIAN, 0);
    judge(&p, "bdf", &o, STEIF_CAUSE_JACOBIAN, 0);
  }
}

/* Index 3 in an integrator for index 1, and starts off the constraints in one that does not look. */
static void foreign_integrators(void)
{
  static const char *const high[] = {"pendulum3", "caraxis"};
  for (int k = 0; k < 3; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    double y0[16];
    CU_ASSERT_FATAL(!steif_problem_find(ctx, k < 2 ? high[k] : "transamp", &p));
    steif_problem q = p;
    memcpy(y0, p.y0, (size_t)p.n * sizeof *y0);
    if (k == 2) y0[0] += 0.1, q.y0 = y0;
    judge(&q, "ida", NULL, k < 2 ? STEIF_CAUSE_INDEX : STEIF_CAUSE_START, 0);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* No tolerance is asked of prescribed steps. */
static void prescribed_steps(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "rober", &p));
  for (double h = 1e9; h > 1e6; h /= 10) {
    steif_options o = steif_defaults();
    o.h = h;
    judge(&p, "gauss:s=3", &o, STEIF_CAUSE_UNKNOWN, 0);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void causes_are_causes(void)
{
  runs = right = wrong = 0;
  domains_and_growth();
  limits();
  jacobians();
  foreign_integrators();
  prescribed_steps();
  printf(" %d of %d right, %d wrong ", right, runs, wrong);
  CHECK(runs >= 60 && 10 * right >= 9 * runs);
  CHECK(wrong == 0);
}

CU_TestInfo tests_of_campaign[] = {{"causes are causes", causes_are_causes}, CU_TEST_INFO_NULL};
