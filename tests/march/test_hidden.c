/* test_hidden.c: steif_hidden_error beside the true errors of velocities and multipliers, from far below a tolerance
 * to thousands of them: of mechanisms whose motion is known from equations without constraints, of problems with
 * references, and where neither is, beside a tight run of another method.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/solver.h>
#include <stdlib.h>
#include <string.h>

static steif_context *ctx;

/* The end of p; NULL options: tight ones. */
static int end_of(const steif_problem *p, const char *method, const steif_options *options,
                  double *y, sunrealtype *said)
{
  const steif_options tight = {.rtol = 1e-12, .atol = 1e-12};
  steif_solver *s = steif_solver_new(ctx, p, method, options ? options : &tight);
  int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code) printf("\n  %s %s: %s", p->name, method, steif_message(ctx));
  if (!code) memcpy(y, NV_DATA_S(steif_solution(s)), (size_t)p->n * sizeof *y);
  if (!code && said) code = steif_hidden_error(s, said);
  steif_solver_free(&s);
  return code;
}

/* Within a factor of 2 of the largest error of components of index above 1, beyond one tolerance: the second run has
 * errors of its own in these. */
static void judge(const steif_problem *p, const double *right, const char *method, double rtol,
                  int recompute)
{
  const double one = 1;
  const steif_options o = {.rtol = rtol, .atol = rtol, .recompute = recompute};
  double *y = calloc((size_t)p->n, sizeof *y), true_error = 0;
  sunrealtype said = NAN;
  CU_ASSERT_FATAL(y && !end_of(p, method, &o, y, &said));
  for (sunindextype i = 0; i < p->n; i++)
    if (p->index[i] > 1)
      true_error = fmax(true_error, fabs(y[i] - right[i]) / (rtol * (1 + fabs(y[i]))));
  const int good = said <= 2 * true_error + one && true_error <= 2 * said + one;
  if (!good) printf("\n  %s, %s, %g: %g, said %g", p->name, method, rtol, true_error, said);
  CHECK(good);
  free(y);
}

static void judge_all(const steif_problem *p, const double *right, int methods,
                      const char *const *method)
{
  for (int i = 0; i < methods; i++)
    for (double rtol = 1e-3; rtol > 1e-6; rtol *= 1e-2)
      for (int recompute = 0; recompute < 2; recompute++)
        judge(p, right, method[i], rtol, recompute);
}

static const char *const any[] = {"radau:s=2", "radau:s=3", "radau:s=5", "bdf",
                                  "auto",      "gauss:s=3", "dirk:hw43"};
enum { AT_THREE = 5, AT_TWO = 7 }; /* of these serve index 3, and 2 */

/* -- a double pendulum, masses and rods of 1 ----------------------------------------------------- */

/* Positions x1 y1 x2 y2, velocities, forces l1 l2: q1'' = -l1 r1 + l2 r2 - g e, q2'' = -l2 r2 - g e, r1 = q1,
 * r2 = q2 - q1, |r|^2 = 1. */
static const int index_of_two[] = {1, 1, 1, 1, 2, 2, 2, 2, 3, 3};
static const double g = 9.81;

static int swing(sunrealtype t, N_Vector Y, N_Vector R, void *user)
{
  const double *y = N_VGetArrayPointer(Y), *v = y + 4;
  double *f = N_VGetArrayPointer(R);
  (void)t, (void)user;
  for (int i = 0; i < 4; i++) f[i] = v[i];
  for (int c = 0; c < 2; c++) {
    const double r1 = y[c], r2 = y[2 + c] - y[c];
    f[4 + c] = -y[8] * r1 + y[9] * r2 - c * g;
    f[6 + c] = -y[9] * r2 - c * g;
  }
  f[8] = (y[0] * y[0] + y[1] * y[1] - 1) / 2;
  f[9] = (pow(y[2] - y[0], 2) + pow(y[3] - y[1], 2) - 1) / 2;
  return 0;
}

static int differential(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const double d[] = {1, 1, 1, 1, 1, 1, 1, 1, 0, 0};
  (void)t, (void)y, (void)yp, (void)user;
  return steif_fill_diagonal(E, d);
}

/* r_k = (sin a_k, -cos a_k) turning at w_k; the forces follow from r1 r1'' = -w1^2 and r2 r2'' = -w2^2:
 *   l1 - c l2 = w1^2 - g y1,  2 l2 - c l1 = w2^2,  c = r1 r2. */
static void by_angles(const double *z, double *y)
{
  const double c = cos(z[0] - z[1]), w1 = z[2] * z[2], w2 = z[3] * z[3];
  for (int k = 0; k < 2; k++) {
    y[2 * k] = sin(z[k]), y[2 * k + 1] = -cos(z[k]);
    y[4 + 2 * k] = z[2 + k] * cos(z[k]), y[5 + 2 * k] = z[2 + k] * sin(z[k]);
  }
  y[8] = (w1 - g * y[1] + c * w2 / 2) / (1 - c * c / 2);
  y[9] = (w2 + c * y[8]) / 2;
  for (int i = 0; i < 2; i++) y[2 + i] += y[i], y[6 + i] += y[4 + i];
}

static int turn(sunrealtype t, N_Vector Z, N_Vector R, void *user)
{
  const double *z = N_VGetArrayPointer(Z), s = sin(z[0] - z[1]);
  double *f = N_VGetArrayPointer(R), y[10];
  (void)t, (void)user;
  by_angles(z, y);
  f[0] = z[2], f[1] = z[3];
  f[2] = -y[9] * s - g * sin(z[0]); /* (cos a1, sin a1) q1'' */
  f[3] = y[8] * s;                  /* (cos a2, sin a2) (q2'' - q1'') */
  return 0;
}

static void a_double_pendulum(void)
{
  static const double z0[] = {1.5, 0.3, 0, 1};
  double y0[10], z[4], right[10];
  const steif_problem angles = {.name = "angles", .n = 4, .t1 = 3, .y0 = z0, .f = turn};
  by_angles(z0, y0);
  const steif_problem p = {.name = "double pendulum",
                           .n = 10,
                           .t1 = angles.t1,
                           .y0 = y0,
                           .f = swing,
                           .E = differential,
                           .index = index_of_two};
  ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!end_of(&angles, "dopri87", NULL, z, NULL));
  by_angles(z, right);
  judge_all(&p, right, AT_THREE, any);
  steif_context_free(&ctx);
}

/* -- a slider crank ------------------------------------------------------------------------------ */

/* A crank of length 1 at the angle a, a rod of length 2 at b, a slider at x on the axis, masses 1, a torque of 1:
 * sin a + 2 sin b = 0, x = cos a + 2 cos b; then their velocities u, v, w and two multipliers. */
static const int index_of_crank[] = {1, 1, 1, 2, 2, 2, 3, 3};

static int crank(sunrealtype t, N_Vector Y, N_Vector Yp, N_Vector R, void *user)
{
  const double *y = N_VGetArrayPointer(Y), *d = N_VGetArrayPointer(Yp);
  double *F = N_VGetArrayPointer(R);
  const double c = cos(y[0] - y[1]), s = sin(y[0] - y[1]);
  (void)t, (void)user;
  for (int i = 0; i < 3; i++) F[i] = d[i] - y[3 + i];
  F[3] = 4. / 3 * d[3] + c * d[4] + s * y[4] * y[4] - 1 + cos(y[0]) * y[6] + sin(y[0]) * y[7];
  F[4] =
    c * d[3] + 4. / 3 * d[4] - s * y[3] * y[3] + 2 * cos(y[1]) * y[6] + 2 * sin(y[1]) * y[7];
  F[5] = d[5] + y[7];
  F[6] = sin(y[0]) + 2 * sin(y[1]);
  F[7] = y[2] - cos(y[0]) - 2 * cos(y[1]);
  return 0;
}

/* All of it from a and u; returns u'. v = k u, w = s u, v' = k u' + c, w' = s u' + e. */
static double by_the_crank(const double *z, double *y)
{
  const double a = z[0], u = z[1], b = -asin(sin(a) / 2), k = -cos(a) / (2 * cos(b));
  const double v = k * u, s = -sin(a) - 2 * sin(b) * k, turn = cos(a - b), pull = sin(a - b);
  const double c = (sin(a) * u * u + 2 * sin(b) * v * v) / (2 * cos(b));
  const double e = -cos(a) * u * u - 2 * cos(b) * v * v - 2 * sin(b) * c;
  const double m = 4. / 3 + 2 * turn * k + 4. / 3 * k * k + s * s;
  const double rest = turn * c + pull * v * v + k * (4. / 3 * c - pull * u * u) + s * e;
  const double du = (1 - rest) / m, dv = k * du + c, dw = s * du + e;
  const double force =
    -(turn * du + 4. / 3 * dv - pull * u * u - 2 * sin(b) * dw) / (2 * cos(b));
  const double all[] = {a, b, cos(a) + 2 * cos(b), u, v, s * u, force, -dw};
  memcpy(y, all, sizeof all);
  return du;
}

static int one_freedom(sunrealtype t, N_Vector Z, N_Vector R, void *user)
{
  double y[8];
  (void)t, (void)user;
  NV_Ith_S(R, 0) = NV_Ith_S(Z, 1);
  NV_Ith_S(R, 1) = by_the_crank(NV_DATA_S(Z), y);
  return 0;
}

static void a_slider_crank(void)
{
  static const double z0[] = {0.5, 1};
  double y0[8], z[2], right[8];
  const steif_problem free = {
    .name = "one freedom", .n = 2, .t1 = 3, .y0 = z0, .f = one_freedom};
  by_the_crank(z0, y0);
  const steif_problem p = {
    .name = "crank", .n = 8, .t1 = free.t1, .y0 = y0, .F = crank, .index = index_of_crank};
  ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!end_of(&free, "dopri87", NULL, z, NULL));
  by_the_crank(z, right);
  judge_all(&p, right, AT_THREE, any);
  steif_context_free(&ctx);
}

/* -- problems of the collection ------------------------------------------------------------------ */

/* To t1, 0: its own. */
static void collected(const char *name, double t1, int methods, const char *const *method)
{
  const steif_options tight = {.rtol = 1e-10, .atol = 1e-10, .recompute = 1};
  steif_problem p;
  ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p));
  const int whole = t1 == 0 && p.reference && !p.reference->count;
  if (t1 > 0) p.t1 = t1;
  double *right = calloc((size_t)p.n, sizeof *right);
  CU_ASSERT_FATAL(right != NULL);
  N_Vector known = N_VMake_Serial(p.n, right, steif_sundials(ctx));
  if (whole)
    memcpy(right, p.reference->value, (size_t)p.n * sizeof *right);
  else if (!p.exact || p.exact(p.t1, known, NULL, p.user))
    CU_ASSERT_FATAL(!end_of(&p, "radau:s=4", &tight, right, NULL));
  judge_all(&p, right, methods, method);
  N_VDestroy(known);
  free(right);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* At tight tolerances, too. */
static void a_car_axis_at(double rtol)
{
  static const char *const method[] = {"radau:s=3", "bdf"};
  steif_problem p;
  ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "caraxis", &p));
  for (int i = 0; i < 2; i++) judge(&p, p.reference->value, method[i], rtol, 0);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void known_problems(void)
{
  a_car_axis_at(1e-8);
  collected("caraxis", 0, AT_THREE, any);
  collected("andrews", 0, AT_THREE, any);
  collected("pendulum3", 0, AT_THREE, any);
  collected("pendulum3:index=2", 0, AT_TWO, any);
  collected("pendulum3:index=ggl", 0, AT_TWO, any);
}

static void fekete_points_on_their_way(void)
{
  static const char *const some[] = {"radau:s=2", "gauss:s=3"};
  collected("fekete", 1, 2, some);
}

CU_TestInfo tests_of_hidden[] = {{"a double pendulum", a_double_pendulum},
                                 {"a slider crank", a_slider_crank},
                                 {"known problems", known_problems},
                                 {"Fekete points on their way", fekete_points_on_their_way},
                                 CU_TEST_INFO_NULL};
