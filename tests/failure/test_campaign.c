/* test_campaign.c: constructed failures of known cause by many methods. A cause that is named is the one
 * that was built in, always; and it is named in nine of ten runs.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const char *const words[] = {"unknown",  "not finite", "blow-up",  "impasse", "jump",
                                    "Jacobian", "singular",   "accuracy", "stiff",   "start",
                                    "ringing",  "index",      "growth",   "events"};
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

/* -- failures of other kinds, each with the time that a formula gives ---------------------- */

typedef struct other {
  const char *name;
  int n, algebraic; /* algebraic: the last equation is */
  void (*f)(double t, const double *y, double *r);
  double y0[2], t1;
  enum steif_cause_kind kind;
  double t; /* 0: none */
} other;

static void forced_pole(double t, const double *y, double *r) { (void)y, r[0] = 1 / (0.5 - t); }
static void double_pole(double t, const double *y, double *r)
{
  (void)y, r[0] = 1 / ((0.7 - t) * (0.7 - t));
}
static void tangent(double t, const double *y, double *r) { (void)t, r[0] = 1 + y[0] * y[0]; }
/* y_2 = y_1 + 1 and y_1' = y_1 (y_1 + 1): T = ln 2 from (1, 2). */
static void twins(double t, const double *y, double *r) { (void)t, r[0] = r[1] = y[0] * y[1]; }
/* 1 / (2 y^2) = 1 / 2 - ln(1 + t): T = sqrt(e) - 1. */
static void slowed(double t, const double *y, double *r)
{
  r[0] = y[0] * y[0] * y[0] / (1 + t);
}
static void circle(double t, const double *y, double *r)
{
  (void)t, r[0] = 1, r[1] = y[0] * y[0] + y[1] * y[1] - 1;
}
static void parabola(double t, const double *y, double *r)
{
  (void)t, r[0] = -1, r[1] = y[1] * y[1] - y[0];
}
/* z^3 - z - 0.4 + t has its minimum at z = 1/sqrt(3): T = 0.4 + 2/(3 sqrt(3)). */
static void s_shape(double t, const double *y, double *r)
{
  (void)t, r[0] = 1, r[1] = y[1] * y[1] * y[1] - y[1] - 0.4 + y[0];
}
/* With u = sqrt(y): 2 u u' = -u - 0.1, T = 2 - 0.2 ln 11. */
static void root(double t, const double *y, double *r) { (void)t, r[0] = -sqrt(y[0]) - 0.1; }
/* T = 1 + O(1e-3). */
static void logarithm(double t, const double *y, double *r)
{
  (void)t, r[0] = -1 + 1e-3 * log(y[0]);
}
static void power(double t, const double *y, double *r)
{
  (void)t, r[0] = -1 + 1e-3 * pow(y[0], 0.3);
}
static void arc(double t, const double *y, double *r) { (void)t, r[0] = 1 + 1e-3 * acos(y[0]); }
static void wave(double t, const double *y, double *r)
{
  (void)t, r[0] = y[1], r[1] = 400 * y[0];
}
static void exponent(double t, const double *y, double *r) { (void)t, r[0] = 30 * y[0]; }
static void square(double t, const double *y, double *r) { (void)y, r[0] = 2 * t * exp(t * t); }
static void tower(double t, const double *y, double *r) { (void)y, r[0] = exp(exp(t)); }

static const other others[] = {
  {"forced pole", 1, 0, forced_pole, {1}, 2, STEIF_CAUSE_BLOW_UP, 0.5},
  {"double pole", 1, 0, double_pole, {1}, 2, STEIF_CAUSE_BLOW_UP, 0.7},
  {"tangent", 1, 0, tangent, {0}, 3, STEIF_CAUSE_BLOW_UP, 1.5707963},
  {"twins", 2, 0, twins, {1, 2}, 3, STEIF_CAUSE_BLOW_UP, 0.69314718},
  {"slowed", 1, 0, slowed, {1}, 3, STEIF_CAUSE_BLOW_UP, 0.6487213},
  {"circle", 2, 1, circle, {0, 1}, 3, STEIF_CAUSE_IMPASSE, 1},
  {"parabola", 2, 1, parabola, {1, 1}, 3, STEIF_CAUSE_IMPASSE, 1},
  {"s shape", 2, 1, s_shape, {0, 1.1597217}, 3, STEIF_CAUSE_IMPASSE, 0.7849002},
  {"root", 1, 0, root, {1}, 3, STEIF_CAUSE_NOT_FINITE, 1.5204209},
  {"logarithm", 1, 0, logarithm, {1}, 3, STEIF_CAUSE_NOT_FINITE, 1},
  {"power", 1, 0, power, {1}, 3, STEIF_CAUSE_NOT_FINITE, 1},
  {"arc", 1, 0, arc, {0}, 3, STEIF_CAUSE_NOT_FINITE, 1},
  {"wave", 2, 0, wave, {1, 20}, 100, STEIF_CAUSE_GROWTH, 0},
  {"exponent", 1, 0, exponent, {1}, 100, STEIF_CAUSE_GROWTH, 0},
  {"square", 1, 0, square, {1}, 100, STEIF_CAUSE_GROWTH, 0},
  {"tower", 1, 0, tower, {1}, 10, STEIF_CAUSE_GROWTH, 0}};

static int call_other(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  ((const other *)user)->f(t, N_VGetArrayPointer(y), N_VGetArrayPointer(r));
  return 0;
}

static int all_but_last(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const other *o = user;
  (void)t, (void)y, (void)yp;
  for (int i = 0; i + 1 < o->n; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

static void other_kinds(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "auto", "rodas4"};
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    for (int m = 0; m < 4; m++) {
      other own = others[k];
      const steif_problem p = {.name = own.name,
                               .n = own.n,
                               .t1 = own.t1,
                               .y0 = own.y0,
                               .f = call_other,
                               .E = own.algebraic ? all_but_last : NULL,
                               .user = &own};
      steif_options o = steif_defaults();
      o.max_steps = 20000;
      judge(&p, methods[m], &o, own.kind, own.t);
    }
}

static int level(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user, *g = NV_Ith_S(y, 0);
  return 0;
}
static int over(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)y, (void)fired;
  *(double *)user *= -1;
  return STEIF_RESTART;
}
static int thrown(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)y, NV_Ith_S(r, 0) = *(const double *)user;
  return 0;
}

/* A relay without hysteresis: y' = -sign(y) from 0.4, with its switch as an event, crosses it for ever. */
static void crowding_events(void)
{
  static const char *const methods[] = {"radau:s=3", "bdf", "auto", "rodas4"};
  static const double y0[] = {0.4};
  for (int m = 0; m < 4; m++) {
    double slope = -1;
    const steif_problem p = {.name = "relay",
                             .n = 1,
                             .t1 = 1,
                             .y0 = y0,
                             .f = thrown,
                             .user = &slope,
                             .events = 1,
                             .event = level,
                             .handle_event = over};
    judge(&p, methods[m], NULL, STEIF_CAUSE_EVENTS, 0.4);
  }
}

static void causes_are_causes(void)
{
  runs = right = wrong = 0;
  domains_and_growth();
  limits();
  jacobians();
  foreign_integrators();
  prescribed_steps();
  other_kinds();
  crowding_events();
  printf(" %d of %d right, %d wrong ", right, runs, wrong);
  CHECK(runs >= 60 && 10 * right >= 9 * runs);
  CHECK(wrong == 0);
}

CU_TestInfo tests_of_campaign[] = {{"causes are causes", causes_are_causes}, CU_TEST_INFO_NULL};
