/* test_diode.c: a diode that is closed has next to no conductance, and index 1 all the same.
 *
 *     C u' = i - u/1000,   L i' = 5 sin(6283 t) - R i - v - u,   0 = i - I (e^{v/V} - 1),
 * C = 1e-6, L = 1e-3, R = 10, V = 0.026, from rest. dv of the last equation is I/V e^{v/V}: 4e-15 at the start with
 * I = 1e-16, 1e30 times that where the diode conducts, 1e-40 where it does not. Taken as 0, v has index 2, and an error of v
 * as large as the tolerance over h would be none.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/index.h>
#include <steif/solver.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const sunrealtype volt = 0.026, leak = 1e-16, ohm = 10;

static int circuit(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)user;
  NV_Ith_S(r, 0) = x[1] - x[0] / 1000;
  NV_Ith_S(r, 1) = 5 * sin(6283 * t) - ohm * x[1] - x[2] - x[0];
  NV_Ith_S(r, 2) = x[1] - leak * (exp(x[2] / volt) - 1);
  return 0;
}

static int slopes(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                  N_Vector b, N_Vector c)
{
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -1e-3, SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -1, SM_ELEMENT_D(J, 1, 1) = -ohm, SM_ELEMENT_D(J, 1, 2) = -1;
  SM_ELEMENT_D(J, 2, 1) = 1;
  SM_ELEMENT_D(J, 2, 2) = -leak / volt * exp(NV_Ith_S(y, 2) / volt);
  return 0;
}

static int storage(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1e-6, SM_ELEMENT_D(E, 1, 1) = 1e-3;
  return 0;
}

static const sunrealtype rest[3];
static const steif_problem diode = {
  .name = "diode", .n = 3, .t1 = 2e-3, .y0 = rest, .f = circuit, .jac = slopes, .E = storage};

/* u at 2 ms: radau:s=5 and rodas5p at rtol 1e-10 agree to these digits. */
static const sunrealtype u_at_end = 2.2049629369;

/* With and without its Jacobian. */
static void runs_keep_the_diode(void)
{
  static const char *const method[] = {"auto",      "radau:s=3", "radau:s=5",
                                       "gauss:s=3", "rodas5p",   "bdf"};
  steif_context *ctx = steif_context_new(NULL);
  for (int exact = 0; exact < 2; exact++)
    for (size_t i = 0; i < sizeof method / sizeof *method; i++) {
      steif_problem p = diode;
      if (!exact) p.jac = NULL;
      steif_solver *s = steif_solver_new(ctx, &p, method[i], NULL);
      CU_ASSERT_FATAL(s != NULL);
      const int code = steif_solve_to(s, p.t1);
      const sunrealtype *x = N_VGetArrayPointer(steif_solution(s));
      CHECK(code == STEIF_OK);
      CHECK(fabs(x[0] - u_at_end) <= 1e-5 * (1 + u_at_end));
      CHECK(fabs(x[1] - leak * (exp(x[2] / volt) - 1)) <= 1e-5);
      steif_solver_free(&s);
    }
  steif_context_free(&ctx);
}

static void its_index_is_one(void)
{
  static const int ones[] = {1, 1, 1}, two[] = {1, 1, 2};
  steif_context *ctx = steif_context_new(NULL);
  steif_diagnosis d = {0};
  CHECK(!steif_diagnose(ctx, &diode, NULL, &d));
  CHECK(d.index == 1 && d.number[0] == 1 && d.number[1] == 1 && d.number[2] == 1);
  steif_diagnosis_clear(&d);
  for (int k = 0; k < 2; k++) {
    steif_problem p = diode;
    p.index = k ? two : ones;
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", NULL);
    CHECK(s != NULL);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
}

/* A source of sin(t) + x between two nodes and g from each to ground, x' = 0: by elimination v = -w = (sin(t) + x)/2
 * for every g > 0. With g = 1e-12 the matrix is regular, of condition 2e12. */
static const sunrealtype g = 1e-12;

static int source(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y), flow = x[1] - x[2] - sin(t) - x[0];
  (void)user;
  NV_Ith_S(r, 0) = 0 * x[0] * x[0];
  NV_Ith_S(r, 1) = flow + g * x[1];
  NV_Ith_S(r, 2) = -flow + g * x[2];
  return 0;
}

static int source_slopes(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                         N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  for (int i = 1; i < 3; i++) {
    const sunrealtype sign = i == 1 ? 1 : -1;
    SM_ELEMENT_D(J, i, 0) = -sign;
    SM_ELEMENT_D(J, i, 1) = sign + (i == 1 ? g : 0);
    SM_ELEMENT_D(J, i, 2) = -sign + (i == 2 ? g : 0);
  }
  return 0;
}

static int first_alone(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}

static void nearly_singular_is_not_surely_so(void)
{
  const steif_problem p = {.name = "floating",
                           .n = 3,
                           .t1 = 1,
                           .y0 = rest,
                           .f = source,
                           .jac = source_slopes,
                           .E = first_alone};
  steif_context *ctx = steif_context_new(NULL);
  steif_diagnosis d = {0};
  CHECK(!steif_diagnose(ctx, &p, NULL, &d));
  CHECK(d.verdict == STEIF_REGULAR || d.confidence != STEIF_SURE);
  steif_diagnosis_clear(&d);
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", NULL);
  CU_ASSERT_FATAL(s != NULL);
  CHECK(steif_solve_to(s, 1) == STEIF_OK);
  const sunrealtype *x = N_VGetArrayPointer(steif_solution(s));
  CLOSE(x[1] - x[2], sin(1), 1e-8);
  CLOSE(x[1], sin(1) / 2, 1e-3); /* as far as its condition lets it be known */
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* y' = z, 0 = -y + sin t - w/10, 0 = w - cos t + w^2/100, of index 2, whose Jacobian has rounding at dz of the second
 * equation, where nothing depends on z. By the last two w = 50 (sqrt(1 + cos t/25) - 1), and y and z follow. */
static sunrealtype residue;

static int chain(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  (void)user;
  NV_Ith_S(r, 0) = x[1];
  NV_Ith_S(r, 1) = -x[0] + sin(t) - x[2] / 10;
  NV_Ith_S(r, 2) = x[2] - cos(t) + x[2] * x[2] / 100;
  return 0;
}

static int chain_slopes(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                        N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = -1, SM_ELEMENT_D(J, 1, 1) = residue, SM_ELEMENT_D(J, 1, 2) = -0.1;
  SM_ELEMENT_D(J, 2, 2) = 1 + NV_Ith_S(y, 2) / 50;
  return 0;
}

static void rounding_is_no_entry(void)
{
  static const char *const method[] = {"auto", "radau:s=3", "bdf", "rodas5p"};
  static const sunrealtype rounding[] = {0, 0.1 + 0.2 - 0.3, 1e-20, 1e-30};
  const sunrealtype at_start = 50 * (sqrt(1.04) - 1), y0[] = {-at_start / 10, 1, at_start};
  const steif_problem p = {.name = "chain",
                           .n = 3,
                           .t1 = 3,
                           .y0 = y0,
                           .f = chain,
                           .jac = chain_slopes,
                           .E = first_alone};
  const sunrealtype w = 50 * (sqrt(1 + cos(3.0) / 25) - 1),
                    wp = -sin(3.0) / sqrt(1 + cos(3.0) / 25);
  for (size_t k = 0; k < sizeof rounding / sizeof *rounding; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_diagnosis d = {0};
    residue = rounding[k];
    CHECK(!steif_diagnose(ctx, &p, NULL, &d) && d.index == 2 && d.number[1] == 2);
    steif_diagnosis_clear(&d);
    for (size_t i = 0; i < sizeof method / sizeof *method; i++) {
      steif_solver *s = steif_solver_new(ctx, &p, method[i], NULL);
      CU_ASSERT_FATAL(s != NULL);
      CHECK(steif_solve_to(s, 3) == STEIF_OK);
      const sunrealtype *x = N_VGetArrayPointer(steif_solution(s));
      CHECK(fabs(x[0] - sin(3.0) + w / 10) <= 1e-5);
      CHECK(fabs(x[1] - cos(3.0) + wp / 10) <= 2e-5); /* 10 (1 + |z|) rtol */
      steif_solver_free(&s);
    }
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_diode[] = {
  {"rounding is no entry", rounding_is_no_entry},
  {"runs keep the diode", runs_keep_the_diode},
  {"its index is one", its_index_is_one},
  {"nearly singular is not surely so", nearly_singular_is_not_surely_so},
  CU_TEST_INFO_NULL};
