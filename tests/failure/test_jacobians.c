/* test_jacobians.c: forged Jacobians are found before the first step, with their entry.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models/models.h"
#include "suite.h"
#include "toy.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* One entry, or a whole column (row -1), of one matrix is multiplied by `factor`. */
typedef struct forgery {
  const char *name;
  char which; /* 'E', 'A' */
  sunindextype row, column;
  double factor, given, measured; /* of F_y and F_y'; NaN: not looked at */
} forgery;

static const forgery *crime;
static steif_problem honest;

static void forge(char which, SUNMatrix M)
{
  if (crime->which != which) return;
  for (sunindextype i = 0; i < honest.n; i++)
    if (crime->row < 0 || crime->row == i) SM_ELEMENT_D(M, i, crime->column) *= crime->factor;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const int code = honest.jac(t, y, fy, J, user, a, b, c);
  forge('A', J);
  return code;
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *user, N_Vector x1, N_Vector x2, N_Vector x3)
{
  const int code = honest.idajac(t, c, y, yp, r, J, user, x1, x2, x3);
  forge('A', J);
  return code;
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const int code = honest.E(t, y, yp, M, user);
  forge('E', M);
  return code;
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const int code = honest.A(t, y, yp, M, user);
  forge('A', M);
  return code;
}

/* Measured values: 115.83 * 0.444; 4 * 18.7 * 0.444^3 sqrt(0.00123) + k (signs of F = y' -
 * f); x of the pendulum; the capacitance. */
static const forgery crimes[] = {{"chemakzo", 'A', 5, 3, 0, 0, -51.42852},
                                 {"chemakzo", 'A', 2, 0, -1, 0.2296164848, -0.2296164848},
                                 {"pendulum3", 'A', 2, 4, 0, 0, .8253356149096783},
                                 {"amplifier", 'E', 0, 1, 0, 0, -1e-6},
                                 {"rot1", 'A', -1, 1, .5, NAN, NAN}};

static steif_problem forged(steif_context *ctx, const forgery *f)
{
  const model *m = model_find(f->name);
  crime = f;
  if (m)
    honest = model_problem(m, 1);
  else
    CHECK(!steif_problem_find(ctx, f->name, &honest));
  steif_problem p = honest;
  if (honest.jac) p.jac = jac;
  if (honest.idajac) p.idajac = idajac;
  if (m) p.E = E, p.A = A;
  return p;
}

static void check(const forgery *f, const steif_cause *cause)
{
  if (cause->kind != STEIF_CAUSE_JACOBIAN) printf("\n  %s: %s", f->name, cause->message);
  CHECK(cause->kind == STEIF_CAUSE_JACOBIAN);
  CHECK(cause->unknown == f->column && (f->row < 0 || cause->equation == f->row));
  if (isnan(f->given)) {
    CLOSE(cause->value[0], f->factor * cause->value[1], 1e-6);
  } else {
    CLOSE_FLOOR(cause->value[0], f->given, 2e-6, 1e-9);
    CLOSE(cause->value[1], f->measured, 2e-6);
  }
  CHECK((strstr(cause->message, "missing") != NULL) == (f->factor == 0));
  CHECK((strstr(cause->message, "wrong sign") != NULL) == (f->factor == -1));
}

static void forged_jacobians_are_found_before_the_first_step(void)
{
  for (size_t k = 0; k < sizeof crimes / sizeof *crimes; k++) {
    steif_context *ctx = steif_context_new(NULL);
    const steif_problem p = forged(ctx, &crimes[k]);
    steif_cause cause;
    CHECK(!steif_check_jacobian(ctx, &p, NULL, &cause));
    check(&crimes[k], &cause);
    if (!model_find(crimes[k].name)) steif_problem_clear(ctx, &honest);
    steif_context_free(&ctx);
  }
}

static void forged_jacobians_explain_a_failure(void)
{
  static toy run;
  for (size_t k = 0; k < sizeof crimes / sizeof *crimes; k++) {
    steif_context *ctx = steif_context_new(NULL);
    const steif_problem p = forged(ctx, &crimes[k]);
    steif_cause cause;
    run = (toy){.rtol = 1e-5, .atol = 1e-5, .t1 = p.t0 + 1e-2, .most = 2};
    CHECK(!toy_run(ctx, &p, NULL, NULL, &run));
    CHECK(!toy_explain(ctx, &p, &run, (steif_point){0}, &cause));
    CHECK(cause.kind == STEIF_CAUSE_JACOBIAN && cause.unknown == crimes[k].column);
    if (!model_find(crimes[k].name)) steif_problem_clear(ctx, &honest);
    steif_context_free(&ctx);
  }
}

static void honest_jacobians_are_not_accused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const model *const all[] = {models, troubles};
  for (int k = 0; k < 2; k++)
    for (const model *m = all[k]; m->name; m++) {
      const steif_problem p = model_problem(m, 1);
      const steif_point q = model_inquiry(m);
      steif_cause cause;
      CHECK(!steif_check_jacobian(ctx, &p, &q, &cause));
      if (cause.kind) printf("\n  %s: %s", m->name, cause.message);
      CHECK(cause.kind == STEIF_CAUSE_UNKNOWN && strstr(cause.message, "agree") != NULL);
    }
  steif_context_free(&ctx);
}

/* y' = c b((y - m)/w), b of one of four kinds, w from 10 times |y| down to 1e-9 of it. */
typedef struct bend {
  int kind;
  double m, w, c;
} bend;

static double shape(int kind, double x, double *slope)
{
  const double bell = exp(-x * x), well = 1 + x * x;
  *slope = kind == 0   ? 1 - tanh(x) * tanh(x)
           : kind == 1 ? -2 * x * bell
           : kind == 2 ? cos(x)
                       : -2 * x / well / well;
  return kind == 0 ? tanh(x) : kind == 1 ? bell : kind == 2 ? sin(x) : 1 / well;
}

static int bent(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const bend *b = user;
  double slope;
  (void)t;
  NV_Ith_S(ydot, 0) = b->c * shape(b->kind, (NV_Ith_S(y, 0) - b->m) / b->w, &slope);
  return 0;
}

static int bent_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector p,
                    N_Vector q, N_Vector r)
{
  const bend *b = user;
  double slope;
  (void)t, (void)fy, (void)p, (void)q, (void)r;
  shape(b->kind, (NV_Ith_S(y, 0) - b->m) / b->w, &slope);
  SM_ELEMENT_D(J, 0, 0) = b->c / b->w * slope;
  return 0;
}

/* An exact Jacobian is not accused, however narrow the bends of f are. */
static void exact_jacobians_are_not_accused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 4 * 10 * 7 * 5; k++) {
    const double y0 = pow(10, 3 * (k % 5) - 8), away = (k / 5 % 7 - 3) * 0.77 + 0.1;
    bend b = {.kind = k / 350, .w = 10 * y0 * pow(10, -(k / 35 % 10 + 0.4)), .c = 1e3};
    b.m = y0 - away * b.w;
    const steif_problem p = {
      .name = "bent", .n = 1, .t1 = 1, .y0 = &y0, .f = bent, .jac = bent_jac, .user = &b};
    steif_cause cause;
    CHECK(!steif_check_jacobian(ctx, &p, NULL, &cause));
    if (cause.kind == STEIF_CAUSE_JACOBIAN)
      printf("\n  kind %d, y %g, w %g: %s", b.kind, y0, b.w, cause.message);
    CHECK(cause.kind != STEIF_CAUSE_JACOBIAN);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_jacobians[] = {
  {"forged Jacobians are found before the first step",
   forged_jacobians_are_found_before_the_first_step},
  {"forged Jacobians explain a failure", forged_jacobians_explain_a_failure},
  {"honest Jacobians are not accused", honest_jacobians_are_not_accused},
  {"exact Jacobians are not accused", exact_jacobians_are_not_accused},
  CU_TEST_INFO_NULL};
