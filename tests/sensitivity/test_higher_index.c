/* test_higher_index.c: S of DAEs of index 2 and 3 as posed, and the derivatives of their starts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <steif/model.h>
#include <string.h>

static const char *const methods[] = {"radau:s=3", "radau:s=5"};

static void parsed(steif_context *ctx, const char *text, steif_problem *p)
{
  const int code = steif_model_parse(ctx, text, "model", NULL, p);
  if (code) printf("\n  %s", steif_message(ctx));
  CU_ASSERT_FATAL(!code);
}

/* Rows x, y, u, v, lambda at 1 of the pendulum of index 3, columns L, g, phi0, omega0; Radau IIA in 113-bit arithmetic
 * of index 3 and 1, and the equation of the angle, agree in these digits. */
static const sunrealtype pendulum[5][4] = {
  {-0.37888952725984, -0.041393985654835, -0.50345099387397, 0.052263069153515},
  {-1.1340419598124, 0.052446610521732, 0.63787764755634, -0.066217852405440},
  {-3.6510158043248, 0.29311416454479, -0.11158933458522, -0.75081526419237},
  {3.3014865718326, -0.23637477778594, 1.7833590591427, 0.78083799120454},
  {7.9869739797136, -0.81416656266194, -2.5796544030551, 3.3487913962921}};

static void pendulums(const char *name, const char *method, sunrealtype rtol,
                      sunrealtype position, sunrealtype velocity, sunrealtype force)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  const sunrealtype error[] = {position, position, velocity, velocity, force};
  sunrealtype S[6];
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  o.rtol = rtol, o.t1 = 1, o.sensitivities = 1;
  for (int k = 0; k < 4; k++) {
    sensitivity_at(ctx, &p, method, &o, k, 1, S, NULL);
    for (int i = 0; i < 5; i++) CLOSE(S[i], pendulum[i][k], error[i]);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* Velocities and multipliers of index 3 have the orders s and s - 1. */
static void pendulums_to_eight_digits(void)
{
  pendulums("pendulum3", "radau:s=3", 1e-10, 1e-8, 1e-7, 1e-4);
  pendulums("pendulum3", "radau:s=5", 1e-10, 1e-8, 1e-7, 1e-5);
  pendulums("pendulum3:index=2", "radau:s=3", 1e-10, 1e-8, 1e-8, 1e-6);
  pendulums("pendulum3:index=2", "radau:s=5", 1e-10, 1e-8, 1e-8, 1e-6);
  pendulums("pendulum3:index=ggl", "radau:s=5", 1e-10, 1e-8, 1e-8, 1e-6);
  pendulums("pendulum3:index=1", "radau:s=3", 1e-10, 1e-8, 1e-8, 1e-8);
  pendulums("pendulum3:index=1", "gauss:s=3", 1e-10, 1e-8, 1e-8, 1e-8);
  pendulums("pendulum3:index=1", "dirk:hw43", 1e-8, 1e-6, 1e-6, 1e-6);
  pendulums("pendulum3:index=2", "bdf", 1e-8, 1e-6, 1e-6, 1e-5);
  pendulums("pendulum3", "bdf", 1e-8, 1e-5, 1e-4, 1e-3);
}

/* Multipliers and velocities of index 3 computed from positions, as y is for output: within a tolerance or a few, where
 * those of the stages are some hundred off. */
static void shown_values_are_as_good_as_positions(void)
{
  static const char *const each[] = {"radau:s=2", "radau:s=3", "radau:s=5", "bdf"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
  o.rtol = 1e-6, o.t1 = 1, o.sensitivities = 1;
  for (size_t m = 0; m < sizeof each / sizeof *each; m++) {
    steif_solver *s = steif_solver_new(ctx, &p, each[m], &o);
    CU_ASSERT_FATAL(s && !steif_solve_to(s, 1));
    N_Vector d = N_VClone(steif_solution(s));
    for (int k = 0; k < 4; k++) {
      CHECK(!steif_sensitivity_output(s, 1, k, d));
      for (int i = 0; i < 5; i++) CLOSE_FLOOR(NV_Ith_S(d, i), pendulum[i][k], 1e-5, 1);
    }
    CHECK(steif_sensitivity_output(s, 1, 4, d) == STEIF_BAD_INPUT);
    N_VDestroy(d);
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* At 1, columns L1, L2, m1, m2, g; Radau IIA in 113-bit arithmetic, index 1 and 3. */
static void double_pendulums(void)
{
  static const char text[] =
    "param L1 = 1, L2 = 0.75, m1 = 1, m2 = 0.5, g = 9.81\n"
    "state x1 = L1, y1 = 0, x2 = L1 + 0.6*L2, y2 = -0.8*L2\n"
    "state u1 = 0, v1 = 0, u2 = 0, v2 = 0, a, b\n"
    "x1' = u1\ny1' = v1\nx2' = u2\ny2' = v2\n"
    "m1*u1' = -a*x1 + b*(x2 - x1)\nm1*v1' = -a*y1 + b*(y2 - y1) - m1*g\n"
    "m2*u2' = -b*(x2 - x1)\nm2*v2' = -b*(y2 - y1) - m2*g\n"
    "x1^2 + y1^2 = L1^2\n(x2 - x1)^2 + (y2 - y1)^2 = L2^2\ntime 0 to 1\n";
  static const sunrealtype positions[4][5] = {
    {-0.5816928197462, 0.4785413905578, -0.2189797960546, 0.4379595921092, -0.04721587184614},
    {-0.8259379149712, -0.4511484773563, 0.2064448415772, -0.4128896831543, 0.04451311654694},
    {-0.7718272484943, -0.7993000191453, -0.2026724288877, 0.4053448577754, -0.005097819960077},
    {-1.773329062245, -1.736205296783, 0.2877002743306, -0.5754005486612, 0.2543765787300}};
  static const sunrealtype u1[] = {-2.555549033950, 3.044103990382, 0.8167709354407,
                                   -1.633541870881, -0.06665691788563};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  sunrealtype S[10];
  steif_options o = steif_defaults();
  o.rtol = 1e-10, o.sensitivities = 1;
  parsed(ctx, text, &p);
  for (int m = 0; m < 2; m++)
    for (int k = 0; k < 5; k++) {
      sensitivity_at(ctx, &p, methods[m], &o, k, 1, S, NULL);
      for (int i = 0; i < 4; i++) CLOSE(S[i], positions[i][k], 1e-8);
      CLOSE(S[4], u1[k], 1e-6);
    }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* IDAS' example of a slider-crank, stabilised (index 2), at 10 by k and c; the same arithmetic. */
static void slider_crank(void)
{
  static const char text[] =
    "param k = 1, c = 1, a = 0.5, J1 = 1, m2 = 1, J2 = 2, l0 = 1, F = 1\n"
    "state q = 1.5707963267948966, x ~ 0.86602540378443865, p ~ -0.52359877559829887\n"
    "state qd = 0, xd = 0, pd = 0, r, s, mu, nu\n"
    "let s21 = sin(p - q)\n"
    "let l = sqrt(x^2 - x*(cos(p) + a*cos(q)) + (1 + a^2)/4 + a*cos(p - q)/2)\n"
    "let ld = (2*x*xd - xd*(cos(p) + a*cos(q)) + x*(sin(p)*pd + a*sin(q)*qd)"
    " - a*s21*(pd - qd)/2)/(2*l)\n"
    "let f = (k*(l - l0) + c*ld)/l\n"
    "q' = qd - a*sin(q)*mu + a*cos(q)*nu\nx' = xd - mu\np' = pd - sin(p)*mu + cos(p)*nu\n"
    "J1*qd' = -f*a*(s21/2 + x*sin(q))/2 - a*sin(q)*r + a*cos(q)*s\n"
    "m2*xd' = f*(cos(p)/2 - x + a*cos(q)/2) + F - r\n"
    "J2*pd' = -f*(x*sin(p) - a*s21/2)/2 - F*sin(p) - sin(p)*r + cos(p)*s\n"
    "x - cos(p) - a*cos(q) = 0\n-sin(p) - a*sin(q) = 0\n"
    "a*sin(q)*qd + xd + sin(p)*pd = 0\n-a*cos(q)*qd - cos(p)*pd = 0\ntime 0 to 10\n";
  static const sunrealtype expected[3][2] = {{-0.17397792926032, -0.26876066709188},
                                             {0.097011312197657, 0.14986283083465},
                                             {0.028811885375126, 0.044508527986945}};
  static const int active[] = {0, 1};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  sunrealtype S[10];
  steif_options o = steif_defaults();
  o.rtol = 1e-10, o.sensitivities = 1, o.active = active, o.active_count = 2;
  parsed(ctx, text, &p);
  for (int m = 0; m < 2; m++)
    for (int k = 0; k < 2; k++) {
      sensitivity_at(ctx, &p, methods[m], &o, k, 10, S, NULL);
      for (int i = 0; i < 3; i++) CLOSE(S[i], expected[i][k], 1e-8);
    }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* ---- starts ----------------------------------------------------------------------------------- */

static int (*right)(int k, N_Vector S0, void *user);

/* The velocities left where they were: on the constraint, off its derivative. */
static int without_velocities(int k, N_Vector S0, void *user)
{
  const int code = right(k, S0, user);
  NV_Ith_S(S0, 2) = NV_Ith_S(S0, 3) = 0;
  return code;
}

static void hidden_constraints_are_checked(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
  steif_parameters q = *p.parameters;
  right = q.start;
  q.start = without_velocities, p.parameters = &q, o.sensitivities = 1;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  CHECK(!s && steif_status(ctx) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "hidden constraints") != NULL);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* x' = -z, z^3 + z = k x^2 with z(0) = 0.3, repaired to 1 at k = 2: dz/dk = x^2 / (3 z^2 + 1) = 1/4 there. */
static int cubic(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype x = NV_Ith_S(y, 0), z = NV_Ith_S(y, 1), k = *(const sunrealtype *)user;
  (void)t;
  NV_Ith_S(ydot, 0) = -z;
  NV_Ith_S(ydot, 1) = z * z * z + z - k * x * x;
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const sunrealtype d[] = {1, 0};
  (void)t, (void)y, (void)yp, (void)user;
  return steif_fill_diagonal(E, d);
}

static void repaired_starts_have_derivatives(void)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype k[] = {2};
  const sunrealtype y0[] = {1, 0.3};
  const steif_parameters q = {.count = 1, .value = k};
  const steif_problem p = {.name = "cubic",
                           .n = 2,
                           .t1 = 1,
                           .y0 = y0,
                           .f = cubic,
                           .E = mass,
                           .user = k,
                           .parameters = &q};
  steif_options o = steif_defaults();
  o.sensitivities = 1, o.rtol = 1e-8;
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
  CU_ASSERT_FATAL(s != NULL);
  CHECK(steif_initial_used(s)->moved == 1);
  N_Vector d = N_VNew_Serial(2, steif_sundials(ctx));
  CHECK(!steif_sensitivity(s, 0, 0, d));
  CLOSE_FLOOR(NV_Ith_S(d, 0), 0, 1e-12, 1);
  CLOSE(NV_Ith_S(d, 1), 0.25, 1e-9);
  N_VDestroy(d);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_higher_index[] = {
  {"pendulums to eight digits", pendulums_to_eight_digits},
  {"shown values are as good as positions", shown_values_are_as_good_as_positions},
  {"double pendulums", double_pendulums},
  {"the slider-crank", slider_crank},
  {"hidden constraints are checked", hidden_constraints_are_checked},
  {"repaired starts have derivatives", repaired_starts_have_derivatives},
  CU_TEST_INFO_NULL};
