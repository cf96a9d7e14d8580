/* subjects.c: problems with parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include "base/failing.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static sunrealtype *at(N_Vector v) { return NV_DATA_S(v); }

static void begin(struct subject *s, const char *name, sunindextype n, int count)
{
  memset(s, 0, sizeof *s);
  s->parameters.count = count, s->parameters.value = s->p;
  s->problem.name = name, s->problem.n = n, s->problem.y0 = s->y0;
  s->problem.parameters = &s->parameters, s->problem.user = s, s->problem.autonomous = 1;
}

/* ---- Robertson ---- */

static int rober(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  (void)t;
  const sunrealtype a = p[0] * x[0], b = p[1] * x[1] * x[2], c = p[2] * x[1] * x[1];
  at(f)[0] = -a + b, at(f)[1] = a - b - c, at(f)[2] = c;
  return 0;
}

static int rober_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector t1, N_Vector t2, N_Vector t3)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  (void)t, (void)fy, (void)t1, (void)t2, (void)t3;
  sunrealtype *J0 = SM_COLUMN_D(J, 0), *J1 = SM_COLUMN_D(J, 1), *J2 = SM_COLUMN_D(J, 2);
  J0[0] = -p[0], J0[1] = p[0], J0[2] = 0;
  J1[0] = p[1] * x[2], J1[2] = 2 * p[2] * x[1], J1[1] = -J1[0] - J1[2];
  J2[0] = p[1] * x[1], J2[1] = -J2[0], J2[2] = 0;
  return 0;
}

static int rober_slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *x = at(y);
  const sunrealtype r = k == 0 ? x[0] : k == 1 ? x[1] * x[2] : x[1] * x[1];
  (void)t, (void)yp, (void)user;
  at(out)[0] = k == 0 ? r : k == 1 ? -r : 0;
  at(out)[1] = k == 0 ? -r : r;
  at(out)[2] = k == 2 ? -r : 0;
  return 0;
}

void subject_robertson(struct subject *s)
{
  begin(s, "robertson", 3, 3);
  s->p[0] = 0.04, s->p[1] = 1e4, s->p[2] = 3e7, s->y0[0] = 1;
  s->problem.t1 = 40, s->problem.f = rober, s->problem.jac = rober_jac;
  s->problem.rtol_scale = 1e-6;
  s->parameters.dFdp = rober_slope;
}

/* ---- Lotka and Volterra ---- */

static int lotka(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  (void)t;
  at(f)[0] = p[0] * x[0] - p[1] * x[0] * x[1], at(f)[1] = -p[2] * x[1] + p[3] * x[0] * x[1];
  return 0;
}

static int lotka_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector t1, N_Vector t2, N_Vector t3)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  (void)t, (void)fy, (void)t1, (void)t2, (void)t3;
  SM_ELEMENT_D(J, 0, 0) = p[0] - p[1] * x[1], SM_ELEMENT_D(J, 0, 1) = -p[1] * x[0];
  SM_ELEMENT_D(J, 1, 0) = p[3] * x[1], SM_ELEMENT_D(J, 1, 1) = -p[2] + p[3] * x[0];
  return 0;
}

static int lotka_slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *x = at(y), xy = x[0] * x[1];
  const sunrealtype by[4][2] = {{-x[0], 0}, {xy, 0}, {0, x[1]}, {0, -xy}};
  (void)t, (void)yp, (void)user;
  memcpy(at(out), by[k], sizeof by[k]);
  return 0;
}

static int lotka_slopes(sunrealtype t, N_Vector y, N_Vector yp, N_Vector w, sunrealtype *out,
                        void *user)
{
  const sunrealtype *x = at(y), *v = at(w);
  (void)t, (void)yp, (void)user;
  out[0] -= v[0] * x[0], out[1] += v[0] * x[0] * x[1];
  out[2] += v[1] * x[1], out[3] -= v[1] * x[0] * x[1];
  return 0;
}

void subject_lotka(struct subject *s)
{
  begin(s, "lotka", 2, 4);
  s->p[0] = 1.5, s->p[1] = 1, s->p[2] = 3, s->p[3] = 1, s->y0[0] = s->y0[1] = 1;
  s->problem.t1 = 10, s->problem.f = lotka, s->problem.jac = lotka_jac;
  s->parameters.dFdp = lotka_slope;
  s->parameters.dFdp_transposed = lotka_slopes;
}

/* ---- Van der Pol ---- */

static int vanderpol(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
  const sunrealtype *x = at(y), eps = ((struct subject *)user)->p[0];
  (void)t;
  at(f)[0] = x[1], at(f)[1] = ((1 - x[0] * x[0]) * x[1] - x[0]) / eps;
  return 0;
}

static int vanderpol_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                         N_Vector t1, N_Vector t2, N_Vector t3)
{
  const sunrealtype *x = at(y), eps = ((struct subject *)user)->p[0];
  (void)t, (void)fy, (void)t1, (void)t2, (void)t3;
  SM_ELEMENT_D(J, 0, 0) = 0, SM_ELEMENT_D(J, 0, 1) = 1;
  SM_ELEMENT_D(J, 1, 0) = (-2 * x[0] * x[1] - 1) / eps;
  SM_ELEMENT_D(J, 1, 1) = (1 - x[0] * x[0]) / eps;
  return 0;
}

static int vanderpol_slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out,
                           void *user)
{
  const sunrealtype *x = at(y), eps = ((struct subject *)user)->p[0];
  (void)t, (void)yp, (void)k;
  at(out)[0] = 0, at(out)[1] = ((1 - x[0] * x[0]) * x[1] - x[0]) / (eps * eps);
  return 0;
}

void subject_vanderpol(struct subject *s)
{
  begin(s, "vanderpol", 2, 1);
  s->p[0] = 1e-6, s->y0[0] = 2, s->y0[1] = -0.66;
  s->problem.t1 = 2, s->problem.f = vanderpol, s->problem.jac = vanderpol_jac;
  s->parameters.dFdp = vanderpol_slope;
}

/* ---- pendulum ---- */

static int pendulum(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y), *d = at(yp);
  (void)t;
  at(r)[0] = d[0] - x[2], at(r)[1] = d[1] - x[3];
  at(r)[2] = d[2] + x[0] * x[4], at(r)[3] = d[3] + x[1] * x[4] + p[1];
  at(r)[4] = x[0] * x[0] + x[1] * x[1] - p[0] * p[0];
  return 0;
}

static int pendulum_jac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                        SUNMatrix J, void *user, N_Vector t1, N_Vector t2, N_Vector t3)
{
  const sunrealtype *x = at(y);
  (void)t, (void)yp, (void)r, (void)user, (void)t1, (void)t2, (void)t3;
  SUNMatZero(J);
  for (int i = 0; i < 4; i++) SM_ELEMENT_D(J, i, i) = c;
  SM_ELEMENT_D(J, 0, 2) = SM_ELEMENT_D(J, 1, 3) = -1;
  SM_ELEMENT_D(J, 2, 0) = SM_ELEMENT_D(J, 3, 1) = x[4];
  SM_ELEMENT_D(J, 2, 4) = x[0], SM_ELEMENT_D(J, 3, 4) = x[1];
  SM_ELEMENT_D(J, 4, 0) = 2 * x[0], SM_ELEMENT_D(J, 4, 1) = 2 * x[1];
  return 0;
}

static int pendulum_slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out,
                          void *user)
{
  (void)t, (void)y, (void)yp;
  N_VConst(0, out);
  if (k == 0) at(out)[4] = -2 * ((struct subject *)user)->p[0];
  if (k == 1) at(out)[3] = 1;
  return 0;
}

/* (x, y) = L (sin phi, -cos phi), (u, v) = L omega (cos phi, sin phi), lambda = omega^2 + g cos phi / L. */
static int pendulum_start(int k, N_Vector S, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, L = p[0], w = p[3];
  const sunrealtype s = sin(p[2]), c = cos(p[2]);
  const sunrealtype by[4][5] = {{s, -c, w * c, w * s, -p[1] * c / (L * L)},
                                {0, 0, 0, 0, c / L},
                                {L * c, L * s, -L * w * s, L * w * c, -p[1] * s / L},
                                {0, 0, L * c, L * s, 2 * w}};
  memcpy(at(S), by[k], sizeof by[k]);
  return 0;
}

void subject_pendulum(struct subject *s)
{
  static const int index[] = {1, 1, 2, 2, 3};
  begin(s, "swing", 5, 4);
  const sunrealtype phi = acos(-1) / 2 - 0.6, w = 0.7;
  s->p[0] = 1, s->p[1] = 9.81, s->p[2] = phi, s->p[3] = w;
  s->y0[0] = sin(phi), s->y0[1] = -cos(phi), s->y0[2] = w * cos(phi), s->y0[3] = w * sin(phi);
  s->y0[4] = w * w + 9.81 * cos(phi);
  s->problem.t1 = 1, s->problem.F = pendulum, s->problem.idajac = pendulum_jac;
  s->problem.index = index, s->problem.dae_index = 3;
  s->parameters.dFdp = pendulum_slope, s->parameters.start = pendulum_start;
}

/* ---- Brusselator: u_1, v_1, u_2, ... ---- */

enum { POINTS = 20 };

static int brusselator(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  const sunrealtype a = p[2] * (POINTS + 1) * (POINTS + 1);
  (void)t;
  for (int i = 0; i < POINTS; i++) {
    const sunrealtype u = x[2 * i], v = x[2 * i + 1], ul = i ? x[2 * i - 2] : 1,
                      vl = i ? x[2 * i - 1] : 3, ur = i < POINTS - 1 ? x[2 * i + 2] : 1,
                      vr = i < POINTS - 1 ? x[2 * i + 3] : 3;
    at(f)[2 * i] = p[0] + u * u * v - (p[1] + 1) * u + a * (ul - 2 * u + ur);
    at(f)[2 * i + 1] = p[1] * u - u * u * v + a * (vl - 2 * v + vr);
  }
  return 0;
}

/* All entries of the pattern below, in triplets: dense, band and sparse alike. */
static int brusselator_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                           N_Vector t1, N_Vector t2, N_Vector t3)
{
  const sunrealtype *p = ((struct subject *)user)->p, *x = at(y);
  const sunrealtype a = p[2] * (POINTS + 1) * (POINTS + 1);
  sunindextype row[8 * POINTS], column[8 * POINTS], n = 0;
  sunrealtype value[8 * POINTS];
  (void)t, (void)fy, (void)t1, (void)t2, (void)t3;
  for (int i = 0; i < 2 * POINTS; i++) {
    const int of_u = i % 2 == 0, point = i - i % 2;
    const sunrealtype u = x[point], v = x[point + 1];
    const sunrealtype by_u = of_u ? 2 * u * v - p[1] - 1 - 2 * a : p[1] - 2 * u * v,
                      by_v = of_u ? u * u : -u * u - 2 * a;
    row[n] = i, column[n] = point, value[n++] = by_u;
    row[n] = i, column[n] = point + 1, value[n++] = by_v;
    if (i >= 2) row[n] = i, column[n] = i - 2, value[n++] = a;
    if (i < 2 * POINTS - 2) row[n] = i, column[n] = i + 2, value[n++] = a;
  }
  return steif_fill_triplets(J, n, row, column, value);
}

static int brusselator_slope(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out,
                             void *user)
{
  const sunrealtype *x = at(y), c = (POINTS + 1) * (POINTS + 1);
  (void)t, (void)yp, (void)user;
  for (int i = 0; i < 2 * POINTS; i++) {
    const sunrealtype wall = i % 2 ? 3 : 1, left = i < 2 ? wall : x[i - 2],
                      right = i < 2 * POINTS - 2 ? x[i + 2] : wall;
    const sunrealtype of_A = i % 2 ? 0 : -1, of_B = i % 2 ? -x[i - 1] : x[i];
    at(out)[i] = k == 0 ? of_A : k == 1 ? of_B : -c * (left - 2 * x[i] + right);
  }
  return 0;
}

static sunindextype column[2 * POINTS + 1], row[10 * POINTS];
static const steif_pattern pattern = {column, row};

static void fill_pattern(void)
{
  sunindextype count = 0;
  for (int j = 0; j < 2 * POINTS; j++) {
    column[j] = count;
    for (int i = j - 2; i <= j + 2; i++)
      if (i >= 0 && i < 2 * POINTS && (abs(i - j) != 1 || i / 2 == j / 2)) row[count++] = i;
  }
  column[2 * POINTS] = count;
}

void subject_brusselator(struct subject *s, enum steif_storage storage)
{
  begin(s, "bruss", 2 * POINTS, 3);
  s->p[0] = 1, s->p[1] = 3, s->p[2] = 0.02;
  const sunrealtype pi = acos(-1);
  for (int i = 0; i < POINTS; i++)
    s->y0[2 * i] = 1 + sin(2 * pi * (i + 1) / (POINTS + 1)), s->y0[2 * i + 1] = 3;
  s->problem.t1 = 10, s->problem.f = brusselator, s->problem.jac = brusselator_jac;
  s->parameters.dFdp = brusselator_slope;
  s->problem.storage = storage, s->problem.lower = s->problem.upper = 2;
  fill_pattern();
  if (storage == STEIF_SPARSE) s->problem.pattern = &pattern, s->problem.nnz = 10 * POINTS;
}

/* ---- calls ---- */

void gradient_of(steif_context *ctx, const struct subject *s, const char *method,
                 sunrealtype rtol, sunrealtype t1, const steif_functional *J, steif_gradient *g)
{
  steif_options o = steif_defaults();
  o.rtol = rtol, o.t1 = t1;
  const int code = steif_gradient_find(ctx, &s->problem, method, &o, J, g);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
}

int weighted_sum(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = 0;
  for (sunindextype i = 0; i < NV_LENGTH_S(y); i++)
    g[0] += cos(1.0 + (double)i) * NV_Ith_S(y, i);
  return 0;
}

int weighted_slopes(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                    void *user)
{
  (void)t, (void)y, (void)i, (void)at_end, (void)dp, (void)user;
  for (sunindextype j = 0; j < NV_LENGTH_S(dy); j++) NV_Ith_S(dy, j) = cos(1.0 + (double)j);
  return 0;
}

static bool survives(const steif_problem *p, const char *method, const steif_options *o,
                     const steif_functional *J, int checkpoints, long k)
{
  failing f = {.refuse_at = 0};
  const steif_setup setup = failing_setup(&f);
  steif_context *ctx = steif_context_new(&setup);
  f.served = 0, f.refuse_at = k;
  steif_gradient g = {.checkpoints = checkpoints};
  const int code = steif_gradient_find(ctx, p, method, o, J, &g);
  CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
  CHECK(code == STEIF_OK || !g.value);
  const bool all = code == STEIF_OK && f.served < k;
  steif_gradient_free(ctx, &g);
  steif_context_free(&ctx);
  CHECK(f.alive == 0);
  return all;
}

void requests_fail(const steif_problem *p, const char *method, const steif_options *o,
                   const steif_functional *J, int checkpoints)
{
  enum { MOST = 4000 };
  long k = 2;
  while (k < MOST && !survives(p, method, o, J, checkpoints, k)) k++;
  CHECK(k < MOST);
}
