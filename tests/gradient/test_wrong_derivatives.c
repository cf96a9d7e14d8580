/* test_wrong_derivatives.c: derivatives that are not those of F, or of a functional, are refused where they are used, and
 * right ones are not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include <math.h>
#include <stdbool.h>
#include <steif/hessian.h>
#include <steif/sensitivity.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* y1' = -k1 y1 + y2^2/2, y2' = k2 sin y1 - y2^2, from (1, 0.3) to 3, its derivatives times factors. */
static sunrealtype k[] = {1, 2};
static const sunrealtype start[] = {1, 0.3};
static struct factors {
  sunrealtype jac, late, E, p, transposed, S0, gy, gp;
} by;
static const struct factors right = {1, 1, 1, 1, 1, 0, 1, 1};

static int f(sunrealtype t, N_Vector y, N_Vector d, void *user)
{
  const sunrealtype a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  (void)t, (void)user;
  NV_Ith_S(d, 0) = -k[0] * a + b * b / 2, NV_Ith_S(d, 1) = k[1] * sin(a) - b * b;
  return 0;
}

/* As M y' - f. */
static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  f(t, y, r, user);
  NV_Ith_S(r, 0) = NV_Ith_S(yp, 0) - NV_Ith_S(r, 0);
  NV_Ith_S(r, 1) = 3 * NV_Ith_S(yp, 1) - NV_Ith_S(r, 1);
  return 0;
}

static void fill(sunrealtype t, N_Vector y, SUNMatrix J)
{
  const sunrealtype a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1);
  SM_ELEMENT_D(J, 0, 0) = -k[0], SM_ELEMENT_D(J, 0, 1) = b * by.jac * (t > 1 ? by.late : 1);
  SM_ELEMENT_D(J, 1, 0) = k[1] * cos(a), SM_ELEMENT_D(J, 1, 1) = -2 * b;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)fy, (void)user, (void)a, (void)b, (void)c;
  fill(t, y, J);
  return 0;
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)yp, (void)user;
  fill(t, y, A);
  return 0;
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1, SM_ELEMENT_D(E, 1, 1) = 3 * by.E;
  return 0;
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  const sunrealtype a = NV_Ith_S(y, 0), b = NV_Ith_S(y, 1), u = NV_Ith_S(x, 0),
                    v = NV_Ith_S(x, 1);
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = -k[0] * u + b * by.jac * v;
  NV_Ith_S(out, 1) = k[1] * cos(a) * u - 2 * b * v;
  return 0;
}

static int dFdp(sunrealtype t, N_Vector y, N_Vector yp, int i, N_Vector out, void *user)
{
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = i ? 0 : by.p * NV_Ith_S(y, 0);
  NV_Ith_S(out, 1) = i ? -by.p * sin(NV_Ith_S(y, 0)) : 0;
  return 0;
}

static int dFdp_transposed(sunrealtype t, N_Vector y, N_Vector yp, N_Vector w, sunrealtype *out,
                           void *user)
{
  (void)t, (void)yp, (void)user;
  out[0] += by.transposed * NV_Ith_S(w, 0) * NV_Ith_S(y, 0);
  out[1] -= NV_Ith_S(w, 1) * sin(NV_Ith_S(y, 0));
  return 0;
}

static int S0(int i, N_Vector out, void *user)
{
  (void)i, (void)user;
  N_VConst(by.S0, out);
  return 0;
}

static int g(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  value[0] = k[1] * NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

static int slopes(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                  void *user)
{
  (void)t, (void)i, (void)at_end, (void)user;
  NV_Ith_S(dy, 0) = by.gy * 2 * k[1] * NV_Ith_S(y, 0);
  dp[1] = by.gp * NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

static const steif_parameters parameters = {.count = 2, .value = k, .dFdp = dFdp, .start = S0};
static const steif_problem ode = {
  .name = "two", .n = 2, .t1 = 3, .y0 = start, .f = f, .jac = jac, .parameters = &parameters};
static const steif_functional J = {.count = 1, .integrand = g, .slopes = slopes},
                              at_end = {.count = 1, .end = g, .slopes = slopes};

/* The code of a gradient, of S forward, of H v; the sentence of each has `word` in it. */
static void codes(const steif_problem *p, const steif_functional *functional, int expected,
                  const char *word, int which)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  steif_gradient found = {0};
  o.rtol = 1e-6;
  int code = 0;
  if (which == 0) code = steif_gradient_find(ctx, p, "radau:s=3", &o, functional, &found);
  if (which == 1) {
    o.sensitivities = 1;
    steif_solver *s = steif_solver_new(ctx, p, "radau:s=3", &o);
    code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
    steif_solver_free(&s);
  }
  if (which == 2) {
    const sunrealtype v[] = {1, 1};
    sunrealtype Hv[2];
    steif_direction *d = steif_direction_new(ctx, p, v, NULL);
    code = steif_hessian_product(ctx, d, "radau:s=3", &o, functional, &found, Hv, NULL);
    steif_direction_free(&d);
  }
  if (code != expected || !strstr(steif_message(ctx), word))
    printf("\n  %d: %d, %s", which, code, steif_message(ctx));
  CHECK(code == expected);
  CHECK(strstr(steif_message(ctx), word) != NULL);
  steif_gradient_free(ctx, &found);
  steif_context_free(&ctx);
}

static void all(const steif_problem *p, int expected, const char *word)
{
  for (int which = 0; which < 3; which++) codes(p, &J, expected, word, which);
}

static void matrices(void)
{
  static const sunrealtype off[] = {1.05, 0, -1};
  steif_problem mass = ode, implicit = ode, products = ode;
  implicit.f = NULL, implicit.jac = NULL;
  implicit.F = F, implicit.E = fill_E, implicit.A = fill_A;
  products.storage = STEIF_KRYLOV, products.jac = NULL, products.Av = Av;
  mass.E = fill_E; /* of y1' and 3 y2' */
  const steif_problem *const form[] = {&ode, &mass, &implicit};
  for (int i = 0; i < 3; i++) {
    by = right;
    all(form[i], STEIF_OK, "");
    for (int j = 0; j < 3; j++) {
      by.jac = off[j];
      all(form[i], STEIF_BAD_INPUT, "equation e1 by y2");
    }
  }
  by = right, by.late = -1;
  all(&ode, STEIF_BAD_INPUT, "equation e1 by y2");
  by = right, by.E = 1.01;
  all(&implicit, STEIF_BAD_INPUT, "matrix dF/dy' of problem");
  by = right;
  codes(&products, &J, STEIF_OK, "", 1);
  by.jac = 1.05;
  codes(&products, &J, STEIF_BAD_INPUT, "this entry of .Av", 1);
}

static void slopes_of_F(void)
{
  by = right, by.p = -1;
  all(&ode, STEIF_BAD_INPUT, "wrong sign");
  by.p = 1.01;
  all(&ode, STEIF_BAD_INPUT, "dF/dp of parameter 1");
  by.p = NAN;
  codes(&ode, &J, STEIF_NOT_FINITE, "parameter 1", 0);
  codes(&ode, &J, STEIF_NOT_FINITE, "parameter 1", 1);
  codes(&ode, &J, STEIF_NOT_FINITE, "along", 2);
  by = right, by.S0 = NAN;
  codes(&ode, &J, STEIF_NOT_FINITE, "dy0/dp of parameter 1", 0);
  by = right;
  steif_parameters q = parameters;
  steif_problem p = ode;
  q.dFdp_transposed = dFdp_transposed, p.parameters = &q;
  codes(&p, &J, STEIF_OK, "", 0);
  by.transposed = 1.01;
  codes(&p, &J, STEIF_BAD_INPUT, "dFdp_transposed", 0);
}

static void slopes_of_functionals(void)
{
  static const sunrealtype off[] = {-1, 1.01};
  for (int which = 0; which < 3; which += 2)
    for (int j = 0; j < 2; j++) {
      by = right, by.gy = off[j];
      codes(&ode, &J, STEIF_BAD_INPUT, "dy of the integrand", which);
      codes(&ode, &at_end, STEIF_BAD_INPUT, "dy of the end", which);
      by = right, by.gp = off[j];
      codes(&ode, &J, STEIF_BAD_INPUT, "by parameter 2", which);
      codes(&ode, &at_end, STEIF_BAD_INPUT, "by parameter 2", which);
    }
  by = right, by.gp = NAN;
  codes(&ode, &J, STEIF_NOT_FINITE, "by parameter 2", 0);
}

CU_TestInfo tests_of_wrong_derivatives[] = {{"matrices", matrices},
                                            {"dF/dp, dy0/dp", slopes_of_F},
                                            {"slopes of functionals", slopes_of_functionals},
                                            CU_TEST_INFO_NULL};
