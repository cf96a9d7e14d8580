/* ring.c: see ring.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ring.h"

static const double start[] = {0.8, -0.35};
enum { MOST = 2 * STEIF_STAGES };

static void curved(long double t, const long double *y, long double *f)
{
  f[0] = -31.7L * y[0] + y[0] * y[1] + sinl(t), f[1] = 2.3L * y[0] - y[1] * y[1] * y[1];
}

static void curved_jac(long double t, const long double *y, long double J[2][2])
{
  (void)t;
  J[0][0] = -31.7L + y[1], J[0][1] = y[0];
  J[1][0] = 2.3L, J[1][1] = -3 * y[1] * y[1];
}

static void straight(long double t, const long double *y, long double *f)
{
  f[0] = -44.1L * y[0] + 17.3L * y[1] + t * t, f[1] = 0.6L * y[0] - 1.9L * y[1];
}

static void straight_jac(long double t, const long double *y, long double J[2][2])
{
  (void)t, (void)y;
  J[0][0] = -44.1L, J[0][1] = 17.3L;
  J[1][0] = 0.6L, J[1][1] = -1.9L;
}

/* At the start the slope of the cubic says nothing about where the root is. */
static void cubic(long double t, const long double *y, long double *f)
{
  (void)t;
  const long double x = y[0] - 0.8L;
  f[0] = 50 - x * x * x, f[1] = -y[1];
}

static void cubic_jac(long double t, const long double *y, long double J[2][2])
{
  (void)t;
  const long double x = y[0] - 0.8L;
  J[0][0] = -3 * x * x, J[0][1] = J[1][0] = 0, J[1][1] = -1;
}

/* f = -y: with the Jacobian times 17/3 and h = 1 the iteration contracts by 1 - 2/(1 + 17/3) =
 * 0.7. */
static void decay(long double t, const long double *y, long double *f)
{
  (void)t;
  f[0] = -y[0], f[1] = -y[1];
}

static void decay_jac(long double t, const long double *y, long double J[2][2])
{
  (void)t, (void)y;
  J[0][0] = J[1][1] = -1, J[0][1] = J[1][0] = 0;
}

const ring ring_nonlinear = {curved, curved_jac, 1, 0, 0},
           ring_linear = {straight, straight_jac, 1, 0, 0},
           ring_cubic = {cubic, cubic_jac, 1, 0, 0},
           ring_slow = {decay, decay_jac, 17.0 / 3, 0, 0};

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  ring *r = user;
  const long double x[] = {NV_Ith_S(y, 0), NV_Ith_S(y, 1)};
  long double v[2];
  r->calls++;
  r->f(t, x, v);
  NV_Ith_S(out, 0) = (double)v[0], NV_Ith_S(out, 1) = (double)v[1] + r->poison;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)fy, (void)a, (void)b, (void)c;
  const ring *r = user;
  const long double x[] = {NV_Ith_S(y, 0), NV_Ith_S(y, 1)};
  long double v[2][2];
  r->jac(t, x, v);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) SM_ELEMENT_D(J, i, j) = r->factor * (double)v[i][j];
  return 0;
}

static int open_transform(stage_room *s, const char *spec, stf_transform *transform)
{
  if (!spec) return stf_transform_single(s->pool, 1, transform);
  s->table = steif_table_new(s->ctx, spec);
  return s->table ? stf_transform_build(s->pool, s->ctx, s->table, transform)
                  : steif_status(s->ctx);
}

void room_open(stage_room *s, const ring *r, const char *spec, int linear, double h)
{
  static const double one[] = {1};
  *s = (stage_room){.r = *r, .ctx = steif_context_new(NULL), .h = h};
  s->pool = stf_pool_new(s->ctx);
  s->problem = (steif_problem){.name = "ring",
                               .n = 2,
                               .t0 = 0.2,
                               .t1 = 1,
                               .y0 = start,
                               .f = f,
                               .jac = jac,
                               .linear = linear,
                               .user = &s->r};
  s->y = N_VNew_Serial(2, steif_sundials(s->ctx));
  s->yp = stf_pool_vector(s->pool, s->y), s->weights = stf_pool_vector(s->pool, s->y);
  for (int i = 0; i < 2; i++) NV_Ith_S(s->y, i) = start[i];
  N_VConst(1, s->weights);
  stf_transform transform;
  CU_ASSERT_FATAL(!stf_system_open(s->pool, s->ctx, &s->problem, STEIF_ODE, STEIF_DENSE, 1,
                                   NULL, s->y, s->yp, &s->system));
  CU_ASSERT_FATAL(!open_transform(s, spec, &transform));
  CU_ASSERT_FATAL(!stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  s->newton.tolerance = 1e-12, s->newton.iterations = 60;
  s->Z = stf_pool_vectors(s->pool, transform.s, s->y);
  s->base = stf_pool_array(s->pool, (size_t)transform.s, sizeof *s->base);
  for (int j = 0; j < transform.s; j++) s->base[j] = s->y;
  s->stages = (stf_stages){
    .t = 0.2, .h = h, .c = s->table ? s->table->c : one, .base = s->base, .Z = s->Z};
  CU_ASSERT_FATAL(!stf_newton_prepare(&s->newton, 0.2, h, s->y, s->yp, false));
}

void room_close(stage_room *s)
{
  steif_table_free(s->ctx, &s->table);
  stf_pool_free(&s->pool);
  N_VDestroy(s->y);
  steif_context_free(&s->ctx);
}

/* x := M^{-1} x by elimination with pivots, M and x overwritten. */
static void eliminate(int n, long double M[MOST][MOST], long double *x)
{
  for (int k = 0; k < n; k++) {
    int p = k;
    for (int i = k; i < n; i++)
      if (fabsl(M[i][k]) > fabsl(M[p][k])) p = i;
    for (int j = 0; j < n; j++) {
      const long double m = M[k][j];
      M[k][j] = M[p][j], M[p][j] = m;
    }
    const long double kept = x[k];
    x[k] = x[p], x[p] = kept;
    for (int i = k + 1; i < n; i++) {
      const long double l = M[i][k] / M[k][k];
      for (int j = k; j < n; j++) M[i][j] -= l * M[k][j];
      x[i] -= l * x[k];
    }
  }
  for (int i = n; i-- > 0;) {
    for (int j = i + 1; j < n; j++) x[i] -= M[i][j] * x[j];
    x[i] /= M[i][i];
  }
}

/* G_j = (1/h) sum_m B_jm Z_m - f(t + c_j h, y + Z_j) and its matrix of order 2s. */
static void linearise(const stage_room *s, const long double *Z, long double M[MOST][MOST],
                      long double *G)
{
  const stf_transform *transform = &s->newton.transform;
  const int count = transform->s;
  for (int j = 0; j < count; j++) {
    const long double y[] = {start[0] + Z[2 * j], start[1] + Z[2 * j + 1]};
    const long double t = 0.2 + (long double)s->stages.c[j] * s->h;
    long double v[2], J[2][2];
    s->r.f(t, y, v), s->r.jac(t, y, J);
    for (int i = 0; i < 2; i++) {
      const int k = 2 * j + i;
      G[k] = -v[i];
      for (int m = 0; m < count; m++) {
        const long double b = (long double)transform->B[j * count + m] / s->h;
        G[k] += b * Z[2 * m + i];
        for (int l = 0; l < 2; l++) M[k][2 * m + l] = (l == i ? b : 0) - (m == j ? J[i][l] : 0);
      }
    }
  }
}

void room_reference(const stage_room *s, long double *Z)
{
  static long double M[MOST][MOST], G[MOST];
  const int n = 2 * s->newton.transform.s;
  for (int k = 0; k < n; k++) Z[k] = 0;
  for (int m = 0; m < 60; m++) {
    linearise(s, Z, M, G);
    eliminate(n, M, G);
    for (int k = 0; k < n; k++) Z[k] -= G[k];
  }
}

double room_error(const stage_room *s)
{
  long double Z[MOST], worst = 0;
  room_reference(s, Z);
  for (int j = 0; j < s->newton.transform.s; j++)
    for (int i = 0; i < 2; i++)
      worst = fmaxl(worst, fabsl(NV_Ith_S(s->Z[j], i) - Z[2 * j + i]));
  return (double)worst;
}
