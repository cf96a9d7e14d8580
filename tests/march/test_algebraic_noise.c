/* Algebraic unknowns whose equation rounds at more than the share of the tolerance that a step may have: Robertson's
 * kinetics with y3 = u - y1 - y2, tolerances of y3 a millionth of those of y1, in units of u.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include <sunmatrix/sunmatrix_dense.h>

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double u = *(const double *)user, *a = N_VGetArrayPointer(y), x = a[0] / u,
               z = a[2] / u;
  const double w = a[1] / u, slow = 0.04 * x, back = 1e4 * w * z, fast = 3e7 * w * w;
  (void)t;
  NV_Ith_S(r, 0) = u * (back - slow);
  NV_Ith_S(r, 1) = u * (slow - back - fast);
  NV_Ith_S(r, 2) = a[0] + a[1] + a[2] - u;
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = SM_ELEMENT_D(E, 1, 1) = 1;
  return 0;
}

/* y at t = 40 by Radau methods of 5 to 9 stages in 113-bit arithmetic. */
static const double known[3] = {0.715827068719405, 9.18553476455776e-6, 0.284163745745830};

static void run(const char *method, double u, double rtol, double fine)
{
  const double y0[3] = {u, 0, 0}, atols[3] = {rtol * u, fine * rtol * u, fine * rtol * u};
  const steif_problem p = {
    .name = "robertson", .n = 3, .t1 = 40, .y0 = y0, .f = f, .E = mass, .user = &u};
  steif_options o = steif_defaults();
  o.rtol = rtol;
  o.atols = atols;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = smooth_open(ctx, &p, method, &o);
  const int code = steif_solve_to(s, 40);
  if (code) printf("\n  %s, u = %g, rtol %g: %s", method, u, rtol, steif_message(ctx));
  CHECK(code == STEIF_OK);
  for (int i = 0; i < 3; i++) {
    const double off = fabs(NV_Ith_S(steif_solution(s), i) / u - known[i]);
    CHECK(off <= 10 * (rtol * known[i] + atols[i] / u));
  }
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void rounding_of_algebraic_equations_is_no_error(void)
{
  static const char *const methods[] = {"bdf", "bdf:p=4", "radau:s=3", "dirk:hw43"};
  static const double units[] = {1, 1e6, 1e-6};
  for (int m = 0; m < 4; m++)
    for (int k = 0; k < 3; k++) {
      run(methods[m], units[k], 1e-4, 1e-6);
      run(methods[m], units[k], 1e-6, 1e-6);
      run(methods[m], units[k], 1e-8, 1e-6);
    }
}

/* Tolerances below the rounding itself cannot be kept, and are not said to be. */
static void below_rounding_is_refused(void)
{
  const double u = 1, y0[3] = {1, 0, 0}, atols[3] = {1e-9, 1e-18, 1e-18};
  const steif_problem p = {
    .name = "robertson", .n = 3, .t1 = 40, .y0 = y0, .f = f, .E = mass, .user = (void *)&u};
  steif_options o = steif_defaults();
  o.rtol = 1e-9;
  o.atols = atols;
  o.max_steps = 20000;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = smooth_open(ctx, &p, "bdf", &o);
  CHECK(steif_solve_to(s, 40) != STEIF_OK);
  CHECK(strlen(steif_message(ctx)) > 20);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* A current that a prescribed voltage drives through a capacitor, index 2: q' = i, 0 = q - u, 0 = u - sin t. What
 * Newton's iteration leaves in the constraints, i amplifies by 1/h. */
static int capacitor(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double u = NV_Ith_S(y, 0), q = NV_Ith_S(y, 1), i = NV_Ith_S(y, 2);
  (void)user;
  NV_Ith_S(r, 0) = i;
  NV_Ith_S(r, 1) = q - u;
  NV_Ith_S(r, 2) = u - sin(t);
  return 0;
}

static int charge(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 1) = 1;
  return 0;
}

/* All methods with a step size of their own: in few steps, the constraints to rounding and i to the tolerance. */
static void constraints_keep_their_digits(void)
{
  static const char *const methods[] = {"bdf", "bdf:p=3", "bdf:p=5", "radau:s=3", "auto"};
  static const sunrealtype y0[3] = {0, 0, 1}, rtols[] = {1e-4, 1e-6, 1e-7};
  const steif_problem p = {
    .name = "capacitor", .n = 3, .t1 = 1, .y0 = y0, .f = capacitor, .E = charge};
  for (int m = 0; m < 5; m++)
    for (int k = 0; k < 3; k++) {
      steif_context *ctx = steif_context_new(NULL);
      steif_options o = steif_defaults();
      o.rtol = o.atol = rtols[k];
      steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
      const int code = steif_solve_to(s, 1);
      if (code) printf("\n  %s, rtol %g: %s", methods[m], rtols[k], steif_message(ctx));
      CHECK(code == STEIF_OK);
      const N_Vector y = steif_solution(s);
      CHECK(fabs(NV_Ith_S(y, 0) - sin(1)) <= 1e-12 && fabs(NV_Ith_S(y, 1) - sin(1)) <= 1e-12);
      CHECK(fabs(NV_Ith_S(y, 2) - cos(1)) <= 100 * rtols[k]);
      CHECK(steif_statistics(s)->steps < 1000);
      steif_solver_free(&s);
      steif_context_free(&ctx);
    }
}

CU_TestInfo tests_of_algebraic_noise[] = {
  {"rounding of algebraic equations is no error", rounding_of_algebraic_equations_is_no_error},
  {"tolerances below rounding are refused", below_rounding_is_refused},
  {"constraints of index 2 keep their digits", constraints_keep_their_digits},
  CU_TEST_INFO_NULL};
