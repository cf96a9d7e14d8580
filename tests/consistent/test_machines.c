/* test_machines.c: DAEs without an index, from data as they stand in a drawing, and circuits by their pattern alone,
 * solved by auto to within ten tolerances of a tight run of another method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/solver.h>
#include <string.h>

static const double rtols[] = {1e-4, 1e-6, 1e-8};

/* The end of p from its start. */
static void end_of(const steif_problem *p, const char *method, double rtol, double *y)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = rtol, o.atol = rtol;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code) printf("\n  %s %s %g: %s", p->name, method, rtol, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  memcpy(y, NV_DATA_S(steif_solution(s)), (size_t)p->n * sizeof *y);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

/* Largest distance of the first `count` components, in tolerances. */
static double distance(const double *y, const double *right, int count, double rtol)
{
  double worst = 0;
  for (int i = 0; i < count; i++)
    worst = fmax(worst, fabs(y[i] - right[i]) / (rtol * (1 + fabs(right[i]))));
  return worst;
}

/* -- a slider crank -------------------------------------------------------------------------- */

/* A crank of length 1, a rod of length 2 and a slider on y = 0: angles a and b of crank and rod, the place x of the
 * slider; masses 1, thin rods with their centres in the middle, a torque of 1 at the crank.
 *   constraints sin a + 2 sin b = 0, x = cos a + 2 cos b
 * Unknowns a, b, x, their velocities u, v, w, and two multipliers; index 3. The centre of the rod is at
 * (cos a + cos b, sin a + sin b), and M of a and b is
 *   [1/3 + 1, cos(a - b); cos(a - b), 1 + 1/3]  (moments 1/3 of the crank about 0, 4/12 of the rod). */
enum { CRANK = 8 };

static int crank(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const double *q = N_VGetArrayPointer(y), *d = N_VGetArrayPointer(yp);
  double *F = N_VGetArrayPointer(r);
  const double a = q[0], b = q[1], x = q[2], u = q[3], v = q[4];
  (void)t, (void)user;
  for (int i = 0; i < 3; i++) F[i] = d[i] - q[3 + i];
  /* G^T lambda with G = [cos a, 2 cos b, 0; sin a, 2 sin b, 1] */
  F[3] =
    4.0 / 3 * d[3] + cos(a - b) * d[4] + sin(a - b) * v * v - 1 + cos(a) * q[6] + sin(a) * q[7];
  F[4] = cos(a - b) * d[3] + 4.0 / 3 * d[4] - sin(a - b) * u * u + 2 * cos(b) * q[6] +
         2 * sin(b) * q[7];
  F[5] = d[5] + q[7];
  F[6] = sin(a) + 2 * sin(b);
  F[7] = x - cos(a) - 2 * cos(b);
  return 0;
}

/* The same with one unknown, a, and its velocity: q' = S(a) u, M q'' by differentiation. */
static int reduced(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const double a = NV_Ith_S(y, 0), u = NV_Ith_S(y, 1);
  const double b = -asin(sin(a) / 2), k = -cos(a) / (2 * cos(b)); /* v = k u */
  const double v = k * u, s = -sin(a) - 2 * sin(b) * k;           /* w = s u */
  /* v' = k u' + (sin a u^2 + 2 sin b v^2)/(2 cos b); w' = s u' - cos a u^2 - 2 cos b v^2 - 2 sin b (v' - k u') */
  const double c = (sin(a) * u * u + 2 * sin(b) * v * v) / (2 * cos(b));
  const double e = -cos(a) * u * u - 2 * cos(b) * v * v - 2 * sin(b) * c;
  const double m = 4.0 / 3 + 2 * cos(a - b) * k + 4.0 / 3 * k * k + s * s;
  const double rest =
    cos(a - b) * c + sin(a - b) * v * v + k * (4.0 / 3 * c - sin(a - b) * u * u) + s * e;
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = u, NV_Ith_S(ydot, 1) = (1 - rest) / m;
  return 0;
}

/* a = 0.5 and u = 1 to three digits: b = -0.24207, x = 2.81927, v = -0.45197, w = -0.69611. */
static const double drawn[CRANK] = {0.5, -0.242, 2.82, 1, -0.452, -0.696, 0, 0};

/* What the run starts from, and its end by the equations of one unknown. */
static void right_end(const double *from, double t1, double *right)
{
  const double start[] = {from[0], from[3]};
  double z[2];
  const steif_problem p = {.name = "reduced", .n = 2, .t1 = t1, .y0 = start, .f = reduced};
  end_of(&p, "dopri87", 1e-12, z);
  const double b = -asin(sin(z[0]) / 2), v = -cos(z[0]) / (2 * cos(b)) * z[1];
  right[0] = z[0], right[1] = b, right[2] = cos(z[0]) + 2 * cos(b), right[3] = z[1];
  right[4] = v, right[5] = -sin(z[0]) * z[1] - 2 * sin(b) * v;
}

static void crank_turns(double rtol)
{
  const steif_problem p = {.name = "crank", .n = CRANK, .t1 = 3, .y0 = drawn, .F = crank};
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = rtol, o.atol = rtol;
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
  const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  if (code) printf("\n  crank, rtol %g: %s", rtol, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  const steif_repair *repair = steif_initial_used(s);
  const double *y0 = repair->y;
  CHECK(repair->moved > 0 && strstr(repair->message, "to fulfil e") != NULL);
  for (int i = 0; i < 6; i++) CHECK(fabs(y0[i] - drawn[i]) < 3e-3);
  double right[6];
  right_end(y0, p.t1, right);
  const double off = distance(NV_DATA_S(steif_solution(s)), right, 6, rtol);
  if (!(off < 10)) printf("\n  crank, rtol %g: %g tolerances", rtol, off);
  CHECK(off < 10);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static void a_slider_crank_starts_from_its_drawing(void)
{
  for (int k = 0; k < 3; k++) crank_turns(rtols[k]);
}

/* -- a ring of gates ------------------------------------------------------------------------- */

/* GATES inverters in a ring, each with the charge q_i of its output and the voltage v_i: q_i' = g(v_{i-1}) - v_i,
 * 0 = q_i - v_i - v_i^3 / 10, g(v) = 5 / (1 + exp(4 (v - 1))) (a junction capacitance; the odd ring oscillates). */
enum { GATES = 151, RING = 2 * GATES };

static int ring(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const double *q = N_VGetArrayPointer(y), *v = q + GATES;
  double *f = N_VGetArrayPointer(r);
  (void)t, (void)user;
  for (int i = 0; i < GATES; i++) {
    const double before = v[(i + GATES - 1) % GATES];
    f[i] = 5 / (1 + exp(4 * (before - 1))) - v[i];
    f[GATES + i] = q[i] - v[i] - v[i] * v[i] * v[i] / 10;
  }
  return 0;
}

static int charges(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp;
  return steif_fill_diagonal(E, user);
}

/* The same with voltages alone: (1 + 0.3 v^2) v' = g - v. */
static int voltages(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const double *v = N_VGetArrayPointer(y);
  (void)t, (void)user;
  for (int i = 0; i < GATES; i++)
    NV_Ith_S(ydot, i) =
      (5 / (1 + exp(4 * (v[(i + GATES - 1) % GATES] - 1))) - v[i]) / (1 + 0.3 * v[i] * v[i]);
  return 0;
}

/* A step runs round: charges of high and low in turn, voltages guessed as 1. */
static void start_of_the_ring(double *y, double *v)
{
  for (int i = 0; i < GATES; i++) {
    v[i] = i % 2 ? 0.1 : 2 + 0.01 * i;
    y[i] = v[i] + v[i] * v[i] * v[i] / 10, y[GATES + i] = 1;
  }
}

static void a_ring_of_gates_runs_by_its_pattern(void)
{
  static double y0[RING], v0[GATES], d[RING], right[RING], v[GATES], y[RING];
  for (int i = 0; i < RING; i++) d[i] = i < GATES;
  start_of_the_ring(y0, v0);
  steif_problem p = {
    .name = "ring", .n = RING, .t1 = 20, .y0 = y0, .f = ring, .E = charges, .user = d};
  const steif_problem ode = {
    .name = "voltages", .n = GATES, .t1 = p.t1, .y0 = v0, .f = voltages};
  steif_context *ctx = steif_context_new(NULL);
  steif_pattern *pattern = NULL;
  CU_ASSERT_FATAL(!steif_pattern_find(ctx, &p, &pattern));
  CHECK(pattern->column[RING] == 5 * GATES);
  p.pattern = pattern, p.storage = STEIF_SPARSE;
  end_of(&ode, "dopri87", 1e-12, v);
  for (int i = 0; i < GATES; i++) right[i] = v[i] + v[i] * v[i] * v[i] / 10;
  for (int k = 0; k < 3; k++) {
    end_of(&p, "auto", rtols[k], y);
    const double off = distance(y, right, GATES, rtols[k]);
    if (!(off < 10)) printf("\n  ring, rtol %g: %g tolerances", rtols[k], off);
    CHECK(off < 10);
  }
  steif_pattern_free(ctx, &pattern);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_machines[] = {
  {"a slider crank starts from its drawing", a_slider_crank_starts_from_its_drawing},
  {"a ring of gates runs by its pattern", a_ring_of_gates_runs_by_its_pattern},
  CU_TEST_INFO_NULL};
