/* test_start.c: start values, slopes and references of the differential-algebraic problems
 * fulfil the equations and the constraints hidden in them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* y (and slopes where given) into s->y and s->yp. */
static void put(fixture *s, const double *y, const double *yp)
{
  for (sunindextype i = 0; i < s->p.n; i++) {
    NV_Ith_S(s->y, i) = y[i];
    NV_Ith_S(s->yp, i) = yp ? yp[i] : 0;
  }
}

/* M y' = f(t0, y0) row by row, to rounding of the terms of the row. */
static void start_slopes_fulfil_the_equations(void)
{
  static const char *const specs[] = {"rober:form=mass", "chemakzo", "transamp", "caraxis"};
  for (size_t k = 0; k < sizeof specs / sizeof *specs; k++) {
    fixture s;
    if (fixture_open(&s, specs[k])) continue;
    put(&s, s.p.y0, s.p.yp0);
    SUNMatrix M = fixture_matrix(&s, 0);
    CHECK(s.p.E(0, s.y, s.yp, M, s.p.user) == 0);
    CHECK(s.p.f(0, s.y, s.r, s.p.user) == 0);
    for (sunindextype i = 0; i < s.p.n; i++) {
      double sum = 0, size = 0;
      for (sunindextype j = 0; j < s.p.n; j++) {
        sum += SM_ELEMENT_D(M, i, j) * NV_Ith_S(s.yp, j);
        size += fabs(SM_ELEMENT_D(M, i, j)) * (1 + fabs(NV_Ith_S(s.yp, j)));
      }
      CLOSE_FLOOR(NV_Ith_S(s.r, i), sum, 1e-12, size > 0 ? size : 1e-3);
    }
    SUNMatDestroy(M);
    fixture_close(&s);
  }
}

/* d/dt of f_i (+ f_j) along the start slopes: zero where M has no such row. */
static double drift(fixture *s, int i, int j)
{
  const double h = 1e-7 * s->p.t1;
  double sum = 0;
  for (int sign = -1; sign <= 1; sign += 2) {
    put(s, s->p.y0, s->p.yp0);
    N_VLinearSum(1, s->y, sign * h, s->yp, s->y);
    CHECK(s->p.f(sign * h, s->y, s->r, s->p.user) == 0);
    sum += sign / (2 * h) * (NV_Ith_S(s->r, i) + (j < 0 ? 0 : NV_Ith_S(s->r, j)));
  }
  return sum;
}

static void start_slopes_keep_the_constraints(void)
{
  static const struct {
    const char *spec;
    int i, j;
    double size;
  } rows[] = {{"rober:form=mass", 2, -1, 0.04},
              {"chemakzo", 5, -1, 0.04},
              {"transamp", 0, 1, 0.05},
              {"transamp", 3, 4, 3e-3},
              {"transamp", 6, 7, 1e-3},
              {"caraxis", 8, -1, 0.5},
              {"caraxis", 9, -1, 1}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    fixture s;
    if (fixture_open(&s, rows[k].spec)) continue;
    CLOSE_FLOOR(drift(&s, rows[k].i, rows[k].j), 0, 1e-7, rows[k].size);
    fixture_close(&s);
  }
}

/* The constraints of the car axis and their first and second derivatives; the second ones take
 * the accelerations from f and so see the multipliers. */
static void car_axis(fixture *s, double t, const double *y, double out[6])
{
  const double K = 5e-4, yb = 0.1 * sin(10 * t), vb = cos(10 * t), ab = -100 * yb;
  const double xb = sqrt(1 - yb * yb), ub = -yb * vb / xb;
  const double bb = -(vb * vb + yb * ab + ub * ub) / xb;
  put(s, y, NULL);
  CHECK(s->p.f(t, s->y, s->r, s->p.user) == 0);
  const double *f = NV_DATA_S(s->r) + 4, *q = y + 4;
  const double dx = y[0] - y[2], dy = y[1] - y[3], dq = q[0] - q[2], dr = q[1] - q[3];
  out[0] = y[0] * xb + y[1] * yb;
  out[1] = dx * dx + dy * dy - 1;
  out[2] = q[0] * xb + q[1] * yb + y[0] * ub + y[1] * vb;
  out[3] = dx * dq + dy * dr;
  out[4] = (f[0] * xb + f[1] * yb) / K + 2 * (q[0] * ub + q[1] * vb) + y[0] * bb + y[1] * ab;
  out[5] = (dx * (f[0] - f[2]) + dy * (f[1] - f[3])) / K + dq * dq + dr * dr;
}

static void car_axis_fulfils_hidden_constraints(void)
{
  static const double tolerance[] = {1e-14, 1e-14, 1e-12, 1e-12, 1e-9, 1e-9};
  double out[6];
  fixture s;
  if (fixture_open(&s, "caraxis")) return;
  car_axis(&s, 0, s.p.y0, out);
  for (int i = 0; i < 6; i++) CLOSE_FLOOR(out[i], 0, 1e-13, 1);
  car_axis(&s, 3, s.p.reference->value, out);
  for (int i = 0; i < 6; i++) CLOSE_FLOOR(out[i], 0, tolerance[i], 1);
  fixture_close(&s);
}

/* The start slopes keep all six: those of the multipliers too are consistent. */
static void slopes_of_the_car_axis_keep_hidden_constraints(void)
{
  const double h = 1e-6;
  double y[10], ahead[6], before[6];
  fixture s;
  if (fixture_open(&s, "caraxis")) return;
  for (int i = 0; i < 10; i++) y[i] = s.p.y0[i] + h * s.p.yp0[i];
  car_axis(&s, h, y, ahead);
  for (int i = 0; i < 10; i++) y[i] = s.p.y0[i] - h * s.p.yp0[i];
  car_axis(&s, -h, y, before);
  for (int i = 0; i < 6; i++) CLOSE_FLOOR((ahead[i] - before[i]) / (2 * h), 0, 1e-6, 1);
  fixture_close(&s);
}

CU_TestInfo tests_of_start[] = {
  {"start slopes fulfil the equations", start_slopes_fulfil_the_equations},
  {"start slopes keep the constraints", start_slopes_keep_the_constraints},
  {"car axis fulfils hidden constraints", car_axis_fulfils_hidden_constraints},
  {"slopes of the car axis keep hidden constraints",
   slopes_of_the_car_axis_keep_hidden_constraints},
  CU_TEST_INFO_NULL};
