/* Derivatives by parameters in the four forms, by callbacks and by differences, against those on paper.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <steif/parameters.h>

/* y1' = a y2 sin(t), b y2' = sqrt(b) y1 - a^2 y2 with p = (a, b). */
static double p[2] = {1.7, 0.31};

static void sides(double t, const double *y, double *f)
{
  f[0] = p[0] * y[1] * sin(t);
  f[1] = sqrt(p[1]) * y[0] - p[0] * p[0] * y[1];
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)user;
  if (p[1] < 0) return 1;
  sides(t, N_VGetArrayPointer(y), N_VGetArrayPointer(out));
  return 0;
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(M, 0, 0) = 1;
  SM_ELEMENT_D(M, 1, 1) = p[1];
  return 0;
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(M, 1, 0) = sqrt(p[1]);
  SM_ELEMENT_D(M, 1, 1) = -p[0] * p[0];
  return 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)derivative, (void)user;
  NV_Ith_S(out, 0) = p[0] * sin(t);
  NV_Ith_S(out, 1) = 0;
  return 0;
}

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  (void)user;
  double v[2];
  sides(t, N_VGetArrayPointer(y), v);
  NV_Ith_S(r, 0) = NV_Ith_S(yp, 0) - v[0];
  NV_Ith_S(r, 1) = p[1] * NV_Ith_S(yp, 1) - v[1];
  return 0;
}

static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(y, 0) = p[0] * p[0];
  NV_Ith_S(y, 1) = p[0] * p[1];
  N_VConst(0, yp);
  return 0;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  (void)user, (void)yp;
  NV_Ith_S(out, 0) = k ? 0 : -NV_Ith_S(y, 1) * sin(t);
  NV_Ith_S(out, 1) =
    k ? NV_Ith_S(yp, 1) - NV_Ith_S(y, 0) / (2 * sqrt(p[1])) : 2 * p[0] * NV_Ith_S(y, 1);
  return 0;
}

typedef struct point {
  steif_context *ctx;
  N_Vector y, yp, out, w;
} point;

static point open_point(void)
{
  point s = {.ctx = steif_context_new(NULL)};
  s.y = N_VNew_Serial(2, steif_sundials(s.ctx));
  s.yp = N_VClone(s.y), s.out = N_VClone(s.y), s.w = N_VClone(s.y);
  NV_Ith_S(s.y, 0) = 0.83, NV_Ith_S(s.y, 1) = -1.71;
  NV_Ith_S(s.yp, 0) = 2.39, NV_Ith_S(s.yp, 1) = 0.57;
  NV_Ith_S(s.w, 0) = -0.41, NV_Ith_S(s.w, 1) = 1.13;
  return s;
}

static void close_point(point *s)
{
  N_VDestroy(s->y), N_VDestroy(s->yp), N_VDestroy(s->out), N_VDestroy(s->w);
  steif_context_free(&s->ctx);
}

static const steif_parameters differences = {.count = 2, .value = p};
static const steif_parameters callback = {.count = 2, .value = p, .dFdp = exact};
static const double y0[] = {1, 1};

static void of_all_forms(void)
{
  const steif_problem forms[] = {
    {.name = "mass", .n = 2, .t1 = 1, .y0 = y0, .f = f, .E = E, .parameters = &differences},
    {.name = "implicit", .n = 2, .t1 = 1, .y0 = y0, .F = F, .parameters = &differences},
    {.name = "by callback", .n = 2, .t1 = 1, .y0 = y0, .F = F, .parameters = &callback}};
  point s = open_point();
  N_Vector wanted = N_VClone(s.y);
  for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
    double pulled[2];
    CHECK(!steif_parameter_pull(s.ctx, &forms[i], 0.6, s.y, s.yp, s.w, pulled));
    for (int k = 0; k < 2; k++) {
      CHECK(!steif_parameter_slope(s.ctx, &forms[i], k, 0.6, s.y, s.yp, s.out));
      exact(0.6, s.y, s.yp, k, wanted, NULL);
      for (int j = 0; j < 2; j++) CLOSE_FLOOR(NV_Ith_S(s.out, j), NV_Ith_S(wanted, j), 1e-9, 1);
      CLOSE_FLOOR(pulled[k], N_VDotProd(s.w, wanted), 1e-9, 1);
    }
  }
  CHECK(p[0] == 1.7 && p[1] == 0.31);
  N_VDestroy(wanted);
  close_point(&s);
}

/* E y' - A y - g: the sine stands alone in g, so that the first row differs from that of f. */
static void of_the_descriptor_form_and_of_the_ode(void)
{
  const steif_problem d = {
    .name = "d", .n = 2, .t1 = 1, .y0 = y0, .E = E, .A = A, .g = g, .parameters = &differences};
  const steif_problem o = {
    .name = "o", .n = 2, .t1 = 1, .y0 = y0, .f = f, .parameters = &differences};
  point s = open_point();
  CHECK(!steif_parameter_slope(s.ctx, &d, 0, 0.6, s.y, s.yp, s.out));
  CLOSE(NV_Ith_S(s.out, 0), -sin(0.6), 1e-9);
  CLOSE(NV_Ith_S(s.out, 1), 2 * p[0] * NV_Ith_S(s.y, 1), 1e-9);
  CHECK(!steif_parameter_slope(s.ctx, &d, 1, 0.6, s.y, s.yp, s.out));
  CLOSE(NV_Ith_S(s.out, 1), NV_Ith_S(s.yp, 1) - NV_Ith_S(s.y, 0) / (2 * sqrt(p[1])), 1e-9);
  CHECK(!steif_parameter_slope(s.ctx, &o, 1, 0.6, s.y, s.yp, s.out));
  CLOSE(NV_Ith_S(s.out, 1), -NV_Ith_S(s.y, 0) / (2 * sqrt(p[1])), 1e-9);
  CHECK(NV_Ith_S(s.out, 0) == 0);
  close_point(&s);
}

/* Below b = 0 f has no value: differences are to the right, and shorter than b in the end. */
static void at_a_border(void)
{
  const steif_problem o = {
    .name = "o", .n = 2, .t1 = 1, .y0 = y0, .f = f, .parameters = &differences};
  point s = open_point();
  const double before = p[1];
  p[1] = 1e-9;
  static double scale[] = {1, 1e-3};
  const steif_parameters scaled = {.count = 2, .value = p, .scale = scale};
  steif_problem q = o;
  q.parameters = &scaled;
  CHECK(!steif_parameter_slope(s.ctx, &q, 1, 0.6, s.y, s.yp, s.out));
  CLOSE(NV_Ith_S(s.out, 1), -NV_Ith_S(s.y, 0) / (2 * sqrt(p[1])), 1e-5);
  p[1] = -1;
  CHECK(steif_parameter_slope(s.ctx, &q, 1, 0.6, s.y, s.yp, s.out) > 0);
  CHECK(p[1] == -1);
  p[1] = before;
  close_point(&s);
}

static int unit_start(int k, N_Vector S0, void *user)
{
  (void)user;
  NV_Ith_S(S0, k) = 1;
  return 0;
}

static void of_the_start(void)
{
  steif_problem o = {.name = "o", .n = 2, .t1 = 1, .start = start, .f = f};
  point s = open_point();
  o.parameters = &differences;
  CHECK(!steif_parameter_start(s.ctx, &o, 0, s.out));
  CLOSE(NV_Ith_S(s.out, 0), 2 * p[0], 1e-9);
  CLOSE(NV_Ith_S(s.out, 1), p[1], 1e-9);
  const steif_parameters values = {.count = 2, .value = p, .start = unit_start};
  o.parameters = &values;
  CHECK(!steif_parameter_start(s.ctx, &o, 1, s.out));
  CHECK(NV_Ith_S(s.out, 0) == 0 && NV_Ith_S(s.out, 1) == 1);
  o.parameters = &differences, o.start = NULL, o.y0 = y0;
  CHECK(!steif_parameter_start(s.ctx, &o, 1, s.out));
  CHECK(N_VMaxNorm(s.out) == 0);
  close_point(&s);
}

static void wrong_calls_are_told(void)
{
  static const char *const names[] = {"alpha", "beta"};
  const steif_parameters named = {.count = 2, .value = p, .name = names};
  steif_problem o = {.name = "o", .n = 2, .t1 = 1, .y0 = y0, .f = f};
  point s = open_point();
  CHECK(steif_parameter_slope(s.ctx, &o, 0, 0, s.y, s.yp, s.out) == STEIF_BAD_INPUT);
  o.parameters = &named;
  CHECK(steif_parameter_find(s.ctx, &o, "beta") == 1);
  CHECK(steif_parameter_find(s.ctx, &o, "bet") == -1);
  CHECK(strstr(steif_message(s.ctx), "did you mean 'beta'") != NULL);
  CHECK(steif_parameter_slope(s.ctx, &o, 2, 0, s.y, s.yp, s.out) == STEIF_BAD_INPUT);
  CHECK(steif_parameter_slope(s.ctx, &o, 0, 0, NULL, s.yp, s.out) == STEIF_BAD_INPUT);
  const double before = p[0];
  p[0] = NAN;
  CHECK(steif_parameter_slope(s.ctx, &o, 0, 0, s.y, s.yp, s.out) == STEIF_NOT_FINITE);
  p[0] = before;
  close_point(&s);
}

/* y1' = s(q) - y1, y2' = q - y2 with a function s that changes within far less than q or 1. */
static double q = 0;
static int sharp = 0;
static long calls = 0;

static int of_sharp(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  const double s = sharp == 0   ? sin(1e6 * q)
                   : sharp == 1 ? exp((q - 300) * 1e3)
                   : sharp == 2 ? 0.1 * q
                                : cos(1e12 * q);
  calls++;
  NV_Ith_S(out, 0) = s - NV_Ith_S(y, 0);
  NV_Ith_S(out, 1) = q - NV_Ith_S(y, 1);
  return 0;
}

static const steif_parameters of_q = {.count = 1, .value = &q};

static void of_sharp_functions(void)
{
  static const double at[] = {0, 300, 300, 300}, slope[] = {-1e6, -1e3, -0.1, 0};
  const steif_problem o = {
    .name = "sharp", .n = 2, .t1 = 1, .y0 = y0, .f = of_sharp, .parameters = &of_q};
  point s = open_point();
  for (sharp = 0; sharp < 4; sharp++) {
    q = at[sharp];
    const int code = steif_parameter_slope(s.ctx, &o, 0, 0.6, s.y, s.yp, s.out);
    CHECK(code == (sharp < 3 ? STEIF_OK : STEIF_UNSUPPORTED) && q == at[sharp]);
    if (sharp < 3) CLOSE(NV_Ith_S(s.out, 0), slope[sharp], 1e-6);
    if (sharp < 3) CLOSE(NV_Ith_S(s.out, 1), -1, 1e-6);
    CHECK(sharp < 3 || strstr(steif_message(s.ctx), "parameter 1 = 300 cannot be had"));
  }
  close_point(&s);
}

/* Two evaluations each, and two more of the 1st, 4th, 16th, 65th, 129th and 193rd. A function that turns sharp is seen by
 * then. */
static void lengths_are_kept(void)
{
  const steif_problem o = {
    .name = "sharp", .n = 2, .t1 = 1, .y0 = y0, .f = of_sharp, .parameters = &of_q};
  point s = open_point();
  stf_pool *pool = stf_pool_new(s.ctx);
  stf_slopes *slopes;
  CU_ASSERT_FATAL(!stf_slopes_open(pool, s.ctx, &o, STEIF_ODE, s.y, &slopes));
  sharp = 2, q = 300, calls = 0;
  for (int i = 0; i < 200; i++) CHECK(!stf_slopes_at(slopes, 0, 0, s.y, s.yp, s.out));
  CHECK(calls == 2 * (200 + 6));
  sharp = 1;
  for (int i = 0; i < 64; i++) CHECK(!stf_slopes_at(slopes, 0, 0, s.y, s.yp, s.out));
  CLOSE(NV_Ith_S(s.out, 0), -1e3, 1e-6);
  stf_pool_free(&pool);
  close_point(&s);
}

CU_TestInfo tests_of_parameters[] = {
  {"functions that are sharp in p", of_sharp_functions},
  {"lengths are kept", lengths_are_kept},
  {"mass, implicit and callbacks", of_all_forms},
  {"descriptor and ode", of_the_descriptor_form_and_of_the_ode},
  {"a border of p", at_a_border},
  {"start values", of_the_start},
  {"wrong calls", wrong_calls_are_told},
  CU_TEST_INFO_NULL};
