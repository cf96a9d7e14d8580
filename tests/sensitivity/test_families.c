/* test_families.c: every family that carries S: against differences of the run on the same mesh, its order, events.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { N = 2, P = 4 };
static sunrealtype rate[P];
static const sunrealtype ones[] = {1, 1};

static void end_of(steif_context *ctx, const steif_problem *p, const char *method,
                   const steif_options *o, sunrealtype t, sunrealtype *y)
{
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  const int code = s ? steif_solve_to(s, t) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(!code);
  memcpy(y, NV_DATA_S(steif_solution(s)), (size_t)p->n * sizeof *y);
  steif_solver_free(&s);
}

/* (8 (y(d/2) - y(-d/2)) - (y(d) - y(-d))) / 6 d, d = 1/500 of p. */
static void difference(steif_context *ctx, const steif_problem *p, const char *method,
                       const steif_options *o, sunrealtype t, int k, sunrealtype *out)
{
  static const sunrealtype by[] = {0.5, -0.5, 1, -1}, weight[] = {8, -8, -1, 1};
  sunrealtype *value = p->parameters->value;
  const sunrealtype at = value[k], d = at / 500;
  sunrealtype y[N];
  for (int i = 0; i < N; i++) out[i] = 0;
  for (int j = 0; j < 4; j++) {
    CU_ASSERT_FATAL(!steif_parameter_set(ctx, p, k, at + by[j] * d));
    end_of(ctx, p, method, o, t, y);
    for (int i = 0; i < N; i++) out[i] += weight[j] * y[i] / (6 * d);
  }
  CU_ASSERT_FATAL(!steif_parameter_set(ctx, p, k, at));
}

/* x' = p1 x - p2 x y, y' = -p3 y + p4 x y, x(0) = y(0) = 1. */
static int hunters(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  (void)t;
  NV_Ith_S(out, 0) = p[0] * u[0] - p[1] * u[0] * u[1];
  NV_Ith_S(out, 1) = -p[2] * u[1] + p[3] * u[0] * u[1];
  return 0;
}

static int by_y(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                N_Vector b, N_Vector c)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  (void)t, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = p[0] - p[1] * u[1], SM_ELEMENT_D(J, 0, 1) = -p[1] * u[0];
  SM_ELEMENT_D(J, 1, 0) = p[3] * u[1], SM_ELEMENT_D(J, 1, 1) = -p[2] + p[3] * u[0];
  return 0;
}

static int by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *u = NV_DATA_S(y), xy = u[0] * u[1];
  const sunrealtype x[] = {-u[0], xy, 0, 0}, z[] = {0, 0, u[1], -xy};
  (void)t, (void)yp, (void)user;
  NV_Ith_S(out, 0) = x[k], NV_Ith_S(out, 1) = z[k];
  return 0;
}

static const steif_parameters rates = {.count = P, .value = rate, .dFdp = by_p};

static steif_problem of_hunters(void)
{
  static const sunrealtype given[] = {1.5, 1, 3, 1};
  memcpy(rate, given, sizeof rate);
  return (steif_problem){.name = "hunters",
                         .n = N,
                         .t1 = 10,
                         .y0 = ones,
                         .f = hunters,
                         .jac = by_y,
                         .user = rate,
                         .autonomous = 1,
                         .parameters = &rates};
}

/* m x' = a sin(b t) - x^3 - y, y' = x - c y^2: p = (m, a, b, c). */
static int driven(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  NV_Ith_S(out, 0) = p[1] * sin(p[2] * t) - u[0] * u[0] * u[0] - u[1];
  NV_Ith_S(out, 1) = u[0] - p[3] * u[1] * u[1];
  return 0;
}

static int driven_mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const sunrealtype d[] = {((const sunrealtype *)user)[0], 1};
  (void)t, (void)y, (void)yp;
  return steif_fill_diagonal(E, d);
}

static int driven_by_y(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                       N_Vector a, N_Vector b, N_Vector c)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  (void)t, (void)fy, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 0) = -3 * u[0] * u[0], SM_ELEMENT_D(J, 0, 1) = -1;
  SM_ELEMENT_D(J, 1, 0) = 1, SM_ELEMENT_D(J, 1, 1) = -2 * p[3] * u[1];
  return 0;
}

static int driven_by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  const sunrealtype x[] = {NV_Ith_S(yp, 0), -sin(p[2] * t), -p[1] * t * cos(p[2] * t), 0};
  NV_Ith_S(out, 0) = x[k], NV_Ith_S(out, 1) = k == 3 ? u[1] * u[1] : 0;
  return 0;
}

static const steif_parameters of_force = {.count = P, .value = rate, .dFdp = driven_by_p};

static steif_problem of_driven(void)
{
  static const sunrealtype given[] = {1.5, 2, 3, 0.5};
  memcpy(rate, given, sizeof rate);
  return (steif_problem){.name = "driven",
                         .n = N,
                         .t1 = 10,
                         .y0 = ones,
                         .f = driven,
                         .E = driven_mass,
                         .jac = driven_by_y,
                         .user = rate,
                         .parameters = &of_force};
}

/* q' = p / m, p' = -k sin q + a cos(b t): p = (m, k, a, b), derivatives by differences. */
static int swing(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *p = user, *u = NV_DATA_S(y);
  NV_Ith_S(out, 0) = u[1] / p[0];
  NV_Ith_S(out, 1) = -p[1] * sin(u[0]) + p[2] * cos(p[3] * t);
  return 0;
}

static const steif_parameters of_swing_parameters = {.count = P, .value = rate};

static steif_problem of_swing(void)
{
  static const sunrealtype given[] = {1.5, 2, 0.5, 3};
  memcpy(rate, given, sizeof rate);
  return (steif_problem){.name = "swing",
                         .n = N,
                         .positions = 1,
                         .t1 = 10,
                         .y0 = ones,
                         .f = swing,
                         .user = rate,
                         .parameters = &of_swing_parameters};
}

static void agree(steif_problem p, const char *method, const steif_options *o, sunrealtype t)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options with = *o;
  with.sensitivities = 1;
  for (int k = 0; k < P; k++) {
    sunrealtype S[N], expected[N];
    sensitivity_at(ctx, &p, method, &with, k, t, S, NULL);
    difference(ctx, &p, method, o, t, k, expected);
    const sunrealtype size = fmax(fabs(expected[0]), fabs(expected[1]));
    for (int i = 0; i < N; i++) {
      if (!(fabs(S[i] - expected[i]) <= 1e-8 * size)) printf("\n  %s, p%d:", method, k + 1);
      CLOSE_FLOOR(S[i], expected[i], 1e-8, size);
    }
  }
  steif_context_free(&ctx);
}

/* Newton's iteration to 1e-8 of its tolerance: differences see what it leaves, S does not. */
static void agree_with_differences(void)
{
  static const char *const methods[] = {"glm:irks,p=1",    "glm:irks,p=2",
                                        "glm:irks,p=4",    "glm:dimsim1,p=3",
                                        "glm:dimsim2,p=3", "glm:ab,p=3",
                                        "glm:am,p=4",      "glm:nordsieck,of=bdf,p=3",
                                        "glm:nord22",      "rk4",
                                        "dopri87",         "dirk:hw43",
                                        "dirk:esdirk43",   "dirk:alexander2",
                                        "bdf:p=3",         "gauss:s=2",
                                        "radau:s=3",       "rodas4",
                                        "rodas4p",         "rodas4p2",
                                        "rodas5p"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_options o = steif_defaults();
    o.h = 0.05, o.newton = 1e-8;
    agree(of_hunters(), methods[m], &o, 2);
    agree(of_hunters(), methods[m], &o, 1.98); /* inside of a step */
  }
}

/* f that depends on t, M on p; kicks and drifts. */
static void agree_where_t_and_M_count(void)
{
  static const char *const rodas[] = {"rodas4", "rodas5p", "radau:s=2", "glm:irks,p=3"};
  static const char *const sympl[] = {"symeuler", "symeuler:first=q",
                                      "verlet",   "verlet:first=drift",
                                      "pefrl",    "verlet:compensated=1"};
  steif_options o = steif_defaults();
  o.h = 0.05, o.newton = 1e-8;
  for (size_t m = 0; m < sizeof rodas / sizeof *rodas; m++) {
    agree(of_driven(), rodas[m], &o, 2);
    agree(of_driven(), rodas[m], &o, 1.98);
  }
  for (size_t m = 0; m < sizeof sympl / sizeof *sympl; m++) {
    agree(of_swing(), sympl[m], &o, 2);
    agree(of_swing(), sympl[m], &o, 1.98);
  }
}

/* Steps of many lengths, for those that can change them. */
static void agree_on_a_mesh(void)
{
  static const char *const methods[] = {"glm:irks,p=2", "glm:irks,p=3", "glm:ab,p=3",
                                        "glm:am,p=4",   "glm:bdf,p=3",  "dopri87",
                                        "rodas5p"};
  enum { STEPS = 60 };
  sunrealtype mesh[STEPS + 1] = {0};
  for (int i = 0; i < STEPS; i++) mesh[i + 1] = mesh[i] + 0.03 * (1 + 0.5 * sin(i));
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
    steif_options o = steif_defaults();
    o.mesh = mesh, o.mesh_size = STEPS + 1, o.newton = 1e-8;
    agree(of_hunters(), methods[m], &o, mesh[STEPS]);
  }
}

/* The order of S is that of y: dx/dp1 at 1, by halving h. */
static void order_is_that_of_the_method(void)
{
  static const struct {
    const char *spec;
    int order;
    sunrealtype h;
  } of[] = {{"glm:irks,p=2", 2, 0.01},
            {"glm:irks,p=3", 3, 0.02},
            {"glm:dimsim1,p=3", 3, 0.01},
            {"glm:dimsim2,p=3", 3, 0.01},
            {"glm:ab,p=3", 3, 0.01},
            {"glm:am,p=3", 3, 0.01},
            {"rk4", 4, 0.02},
            {"rodas4", 4, 0.02},
            {"rodas5p", 5, 0.04}};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = of_hunters();
  for (size_t m = 0; m < sizeof of / sizeof *of; m++) {
    sunrealtype S[3][N];
    for (int i = 0; i < 3; i++) {
      steif_options o = steif_defaults();
      o.sensitivities = 1, o.h = of[m].h / (1 << i), o.newton = 1e-8;
      sensitivity_at(ctx, &p, of[m].spec, &o, 0, 1, S[i], NULL);
    }
    const sunrealtype order = log2((S[0][0] - S[1][0]) / (S[1][0] - S[2][0]));
    if (!(fabs(order - of[m].order) < 0.3)) printf("\n  %s:", of[m].spec);
    CLOSE_FLOOR(order, of[m].order, 0.3, 1);
  }
  steif_context_free(&ctx);
}

/* dx/dp at 10: Radau IIA with two numbers of stages in 113-bit arithmetic. */
static void errors_are_tested(void)
{
  static const sunrealtype expected[] = {2.16055752356262, 0.188568777078059, 0.563182794168198,
                                         0.939651287153080};
  static const char *const methods[] = {
    "glm:irks,p=3", "glm:irks,p=4", "glm:ab,p=4", "glm:am,p=4", "dopri87", "rodas4", "rodas5p"};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = of_hunters();
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (int k = 0; k < P; k++) {
      sunrealtype S[N];
      steif_options o = steif_defaults();
      steif_sensitivity_cost cost;
      o.sensitivities = 1, o.rtol = 1e-6;
      sensitivity_at(ctx, &p, methods[m], &o, k, 10, S, &cost);
      CLOSE_FLOOR(S[0], expected[k], 1e-4, 1);
      CHECK(cost.tested && cost.columns == P);
    }
  steif_context_free(&ctx);
}

/* The ball at 1 and 2, one and three impacts; closed forms. Columns H, g, e. */
static void events_are_passed(void)
{
  static const sunrealtype expected[2][2][3] = {
    {{1.386502226263018, -0.09362872311284219, 2.42944691807002},
     {3.986502226263018, -0.5936287231128422, 4.42944691807002}},
    {{0.4266108641635286, -0.01690816879066987, 2.499324113317087},
     {9.727065432081764, -1.008454084395335, 31.53766205665854}}};
  static const char *const methods[] = {"glm:irks,p=3", "glm:ab,p=4", "dopri87", "rodas5p"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (int at = 0; at < 2; at++)
      for (int k = 0; k < 3; k++) {
        sunrealtype S[N];
        steif_options o = steif_defaults();
        o.sensitivities = 1, o.rtol = 1e-8, o.t1 = 1 + at;
        sensitivity_at(ctx, &p, methods[m], &o, k, o.t1, S, NULL);
        for (int i = 0; i < N; i++) CLOSE(S[i], expected[at][i][k], 1e-6);
      }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_families[] = {
  {"S and differences of the run agree", agree_with_differences},
  {"the same where t and M count", agree_where_t_and_M_count},
  {"the same with steps of many lengths", agree_on_a_mesh},
  {"the order is that of the method", order_is_that_of_the_method},
  {"errors are tested", errors_are_tested},
  {"events are passed", events_are_passed},
  CU_TEST_INFO_NULL};
