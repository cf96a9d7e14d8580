/* test_corners.c: laws with corners along which a solution slides: runs that would not end say so.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth.h"
#include "suite.h"

/* Two pipes in parallel with a given sum of flows: index 2 for the pressure p. The friction of the first pipe jumps
 * up, by *user, where its flow becomes turbulent:
 *   q1' = p - q1 - r(q1), q2' = p - q2, 0 = q1 + q2 - 0.3 - 0.2 sin t.
 * By symmetry q1 = q2 = 0.15 + 0.1 sin t up to q1 = 0.2, at t = pi/6. */
static int flows(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double q1 = NV_Ith_S(y, 0), q2 = NV_Ith_S(y, 1), p = NV_Ith_S(y, 2);
  NV_Ith_S(r, 0) = p - q1 - (q1 > 0.2 ? *(double *)user : 0);
  NV_Ith_S(r, 1) = p - q2;
  NV_Ith_S(r, 2) = q1 + q2 - 0.3 - 0.2 * sin(t);
  return 0;
}

static int inertia(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const sunrealtype d[] = {1, 1, 0};
  (void)t, (void)y, (void)yp, (void)user;
  return steif_fill_diagonal(E, d);
}

static steif_problem network(double *jump)
{
  static const sunrealtype y0[] = {0.15, 0.15, 0.25};
  return (steif_problem){
    .name = "network", .n = 3, .t1 = 5, .y0 = y0, .f = flows, .E = inertia, .user = jump};
}

static void sliding_ends_with_the_corner(void)
{
  static const char *const methods[] = {"auto", "radau:s=5", "bdf", "dirk:hw43", "rodas5p"};
  double jump = 0.5;
  const steif_problem p = network(&jump);
  for (int m = 0; m < 5; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = 1e-6;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(steif_solve_to(s, 5) == STEIF_STEP_SIZE);
    CHECK(strstr(steif_message(ctx), "corner of e1 at y1 = 0.2,") != NULL);
    CHECK(steif_statistics(s)->steps < 10000 && steif_time(s) > 0.523);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* The same without a jump, and with a jump down, away from which the flow goes: no corner stops these. */
static void what_gets_past_is_left_alone(void)
{
  double jump = 0;
  const steif_problem p = network(&jump);
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = 1e-6;
    jump = k ? -0.05 : 0;
    steif_solver *s = smooth_open(ctx, &p, "auto", &o);
    CHECK(steif_solve_to(s, 0.5) == STEIF_OK);
    CLOSE(NV_Ith_S(steif_solution(s), 0), 0.15 + 0.1 * sin(0.5), 1e-5);
    CHECK(steif_solve_to(s, 1.5) == STEIF_OK && steif_statistics(s)->steps < 1000);
    if (k == 0) CLOSE(NV_Ith_S(steif_solution(s), 0), 0.15 + 0.1 * sin(1.5), 1e-5);
    if (k == 1) CHECK(NV_Ith_S(steif_solution(s), 0) > 0.25);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_corners[] = {
  {"sliding ends with the corner", sliding_ends_with_the_corner},
  {"what gets past is left alone", what_gets_past_is_left_alone},
  CU_TEST_INFO_NULL};
