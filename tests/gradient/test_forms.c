/* test_forms.c: first and second derivatives of problems in every form, with matrices that depend on y and p.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include <string.h>

static const char *const methods[] = {"radau:s=1", "radau:s=3", "gauss:s=2", "bdf:p=3",
                                      "dirk:hw43"};
enum { METHODS = sizeof methods / sizeof *methods };

static sunrealtype *at(N_Vector v) { return NV_DATA_S(v); }

static const sunrealtype *p_of(void *user) { return ((struct subject *)user)->p; }

static void begin(struct subject *s, const char *name)
{
  memset(s, 0, sizeof *s);
  s->parameters.count = 4, s->parameters.value = s->p;
  s->p[0] = 1.5, s->p[1] = 1, s->p[2] = 3, s->p[3] = 0.7, s->y0[0] = 1, s->y0[1] = 1.25;
  s->problem.name = name, s->problem.n = 2, s->problem.y0 = s->y0;
  s->problem.parameters = &s->parameters, s->problem.user = s;
}

/* ---- implicit: E and A depend on y, y' and p ----------------------------------------------------- */

static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1];
  const sunrealtype *d = at(yp);
  (void)t;
  at(r)[0] = (1 + p[0] * a * a) * d[0] + 0.1 * d[0] * d[0] * d[0] - p[0] * a + p[1] * a * b;
  at(r)[1] = (2 + p[1] * b) * d[1] + 0.2 * p[2] * a * d[0] + p[2] * b - p[3] * a * b;
  return 0;
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *user, N_Vector t1, N_Vector t2, N_Vector t3)
{
  static const sunindextype row[] = {0, 0, 1, 1}, column[] = {0, 1, 0, 1};
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1];
  const sunrealtype *d = at(yp);
  const sunrealtype value[] = {2 * p[0] * a * d[0] - p[0] + p[1] * b +
                                 c * (1 + p[0] * a * a + 0.3 * d[0] * d[0]),
                               p[1] * a, 0.2 * p[2] * d[0] - p[3] * b + c * 0.2 * p[2] * a,
                               p[1] * d[1] + p[2] - p[3] * a + c * (2 + p[1] * b)};
  (void)t, (void)r, (void)t1, (void)t2, (void)t3;
  return steif_fill_triplets(J, 4, row, column, value);
}

static int F_by(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype a = at(y)[0], b = at(y)[1], *d = at(yp);
  const sunrealtype by[4][2] = {
    {a * a * d[0] - a, 0}, {a * b, b * d[1]}, {0, 0.2 * a * d[0] + b}, {0, -a * b}};
  (void)t, (void)user;
  memcpy(at(out), by[k], sizeof by[k]);
  return 0;
}

static void implicit(struct subject *s)
{
  begin(s, "implicit");
  s->problem.F = F, s->problem.idajac = idajac, s->parameters.dFdp = F_by;
}

/* ---- mass: constant M(p) --------------------------------------------------------------------------- */

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1];
  (void)t;
  at(out)[0] = p[0] * a - p[1] * a * b, at(out)[1] = -p[2] * b + p[3] * a * b;
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector t1,
               N_Vector t2, N_Vector t3)
{
  static const sunindextype row[] = {0, 0, 1, 1}, column[] = {0, 1, 0, 1};
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1];
  const sunrealtype value[] = {p[0] - p[1] * b, -p[1] * a, p[3] * b, -p[2] + p[3] * a};
  (void)t, (void)fy, (void)t1, (void)t2, (void)t3;
  return steif_fill_triplets(J, 4, row, column, value);
}

static int M(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const sunindextype row[] = {0, 0, 1}, column[] = {0, 1, 1};
  const sunrealtype *p = p_of(user), value[] = {p[0] * p[0], 0.2 * p[3], 1 + p[2]};
  (void)t, (void)y, (void)yp;
  return steif_fill_triplets(E, 3, row, column, value);
}

static int M_by(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1], *d = at(yp);
  const sunrealtype by[4][2] = {
    {2 * p[0] * d[0] - a, 0}, {a * b, 0}, {0, d[1] + b}, {0.2 * d[1], -a * b}};
  (void)t;
  memcpy(at(out), by[k], sizeof by[k]);
  return 0;
}

static void mass(struct subject *s)
{
  begin(s, "mass");
  s->problem.f = f, s->problem.jac = jac, s->problem.E = M, s->parameters.dFdp = M_by;
}

/* ---- mass: M(y; p), the implicit form above without the cube of y1' -------------------------------- */

static int f_varying(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1];
  (void)t;
  at(out)[0] = p[0] * a - p[1] * a * b, at(out)[1] = -p[2] * b + p[3] * a * b;
  return 0;
}

static int M_varying(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  static const sunindextype row[] = {0, 1, 1}, column[] = {0, 0, 1};
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1];
  const sunrealtype value[] = {1 + p[0] * a * a, 0.2 * p[2] * a, 2 + p[1] * b};
  (void)t, (void)yp;
  return steif_fill_triplets(E, 3, row, column, value);
}

static void varying(struct subject *s)
{
  begin(s, "varying");
  s->problem.f = f_varying, s->problem.jac = jac, s->problem.E = M_varying;
  s->parameters.dFdp = F_by;
}

/* ---- descriptor: E(p) x' = A(p) x + g(t; p) ------------------------------------------------------- */

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix J, void *user)
{
  static const sunindextype row[] = {0, 0, 1, 1}, column[] = {0, 1, 0, 1};
  const sunrealtype *p = p_of(user), value[] = {-p[0] * p[0], p[1], p[3], -p[2]};
  (void)t, (void)y, (void)yp;
  return steif_fill_triplets(J, 4, row, column, value);
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  if (derivative) return 1;
  at(out)[0] = sin(t), at(out)[1] = p_of(user)[1] * p_of(user)[1] * cos(t);
  return 0;
}

static int A_by(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *p = p_of(user), a = at(y)[0], b = at(y)[1], *d = at(yp);
  const sunrealtype by[4][2] = {{2 * p[0] * d[0] + 2 * p[0] * a, 0},
                                {-b, -2 * p[1] * cos(t)},
                                {0, d[1] + b},
                                {0.2 * d[1], -a}};
  memcpy(at(out), by[k], sizeof by[k]);
  return 0;
}

static void descriptor(struct subject *s)
{
  begin(s, "descriptor");
  s->problem.E = M, s->problem.A = A, s->problem.g = g, s->problem.linear = 1;
  s->parameters.dFdp = A_by;
}

/* ---- laws --------------------------------------------------------------------------------------- */

static int bowl(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const sunrealtype a = at(y)[0], b = at(y)[1];
  (void)t;
  value[0] = sin(a) * b + p_of(user)[0] * a * a;
  return 0;
}

static int of_bowl(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                   void *user)
{
  const sunrealtype a = at(y)[0], b = at(y)[1];
  (void)t, (void)i, (void)at_end;
  at(dy)[0] = cos(a) * b + 2 * p_of(user)[0] * a, at(dy)[1] = sin(a);
  dp[0] = a * a;
  return 0;
}

static const steif_functional J = {
  .count = 1, .integrand = bowl, .end = bowl, .slopes = of_bowl};

static steif_options coarse(void)
{
  steif_options o = steif_defaults();
  o.h = 0.125, o.t1 = 1, o.newton = 1e-8;
  return o;
}

static void product(steif_context *ctx, const struct subject *s, const char *method,
                    const sunrealtype *v, const sunrealtype *u, sunrealtype *Hp,
                    sunrealtype *Hy, steif_gradient *gradient)
{
  const steif_options o = coarse();
  steif_direction *d = steif_direction_new(ctx, &s->problem, v, u);
  CU_ASSERT_FATAL(d != NULL);
  const int code = steif_hessian_product(ctx, d, method, &o, &J, gradient, Hp, Hy);
  if (code) printf("\n  %s, %s: %s", s->problem.name, method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  steif_direction_free(&d);
}

/* v H w = w H v. */
static void second(const struct subject *s)
{
  static const sunrealtype v[2][4] = {{1, -1, 0.5, 2}, {0.3, 1, 1, -0.4}};
  static const sunrealtype u[2][2] = {{1, -2}, {0.5, 0.25}};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    sunrealtype Hp[2][4], Hy[2][2], product_of[2] = {0, 0}, size = 0;
    for (int i = 0; i < 2; i++) {
      steif_gradient found = {0};
      product(ctx, s, methods[m], v[i], u[i], Hp[i], Hy[i], &found);
      steif_gradient_free(ctx, &found);
    }
    for (int i = 0; i < 2; i++) {
      for (int k = 0; k < 4; k++)
        product_of[i] += Hp[i][k] * v[1 - i][k], size += fabs(Hp[i][k] * v[1 - i][k]);
      for (int k = 0; k < 2; k++)
        product_of[i] += Hy[i][k] * u[1 - i][k], size += fabs(Hy[i][k] * u[1 - i][k]);
    }
    CLOSE_FLOOR(product_of[0], product_of[1], 1e-11, size);
  }
  steif_context_free(&ctx);
}

/* Gradients of runs on the same steps, p + theta e_k and y0 + theta (1, -2), differenced. */
static void second_by_differences(struct subject *s, double tolerance)
{
  static const sunrealtype place[] = {0.5, -0.5, 1, -1}, weight[] = {8, -8, -1, 1}, d = 2e-3;
  static const sunrealtype v[] = {1, -1, 0.5, 2}, u[] = {1, -2};
  const steif_options o = coarse();
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    sunrealtype Hp[4], Hy[2], sum[6] = {0};
    steif_gradient found = {0};
    product(ctx, s, methods[m], v, u, Hp, Hy, &found);
    steif_gradient_free(ctx, &found);
    for (int j = 0; j < 4; j++) {
      const struct subject kept = *s;
      for (int k = 0; k < 4; k++) s->p[k] += place[j] * d * v[k];
      for (int k = 0; k < 2; k++) s->y0[k] += place[j] * d * u[k];
      CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s->problem, methods[m], &o, &J, &found));
      for (int k = 0; k < 4; k++) sum[k] += weight[j] / (6 * d) * found.dp[k];
      for (int k = 0; k < 2; k++) sum[4 + k] += weight[j] / (6 * d) * found.dy0[k];
      steif_gradient_free(ctx, &found);
      memcpy(s->p, kept.p, sizeof s->p), memcpy(s->y0, kept.y0, sizeof s->y0);
    }
    for (int k = 0; k < 4; k++) CLOSE_FLOOR(Hp[k], sum[k], tolerance, 1);
    for (int k = 0; k < 2; k++) CLOSE_FLOOR(Hy[k], sum[4 + k], tolerance, 1);
  }
  steif_context_free(&ctx);
}

static void every_form(void)
{
  struct subject s;
  implicit(&s), second(&s), second_by_differences(&s, 1e-7);
  mass(&s), second(&s), second_by_differences(&s, 1e-7);
  varying(&s), second_by_differences(&s, 1e-6); /* d(M y')/dy is made by differences */
  descriptor(&s), second(&s), second_by_differences(&s, 1e-7);
}

/* The same gradient where derivatives by p are differences. */
static void without_callbacks(void)
{
  void (*const of[])(struct subject *) = {implicit, mass, varying, descriptor};
  const steif_options o = coarse();
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  for (int i = 0; i < 4; i++) {
    steif_gradient exact = {0}, found = {0};
    of[i](&s);
    CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s.problem, "radau:s=3", &o, &J, &exact));
    s.parameters.dFdp = NULL;
    CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s.problem, "radau:s=3", &o, &J, &found));
    for (int k = 0; k < 4; k++) CLOSE_FLOOR(found.dp[k], exact.dp[k], 1e-8, 1);
    steif_gradient_free(ctx, &exact), steif_gradient_free(ctx, &found);
  }
  steif_context_free(&ctx);
}

/* y'(t0) that the user gives has no derivative. */
static void given_slopes(void)
{
  static const sunrealtype yp0[] = {0.1, -0.5};
  const steif_options o = coarse();
  steif_context *ctx = steif_context_new(NULL);
  steif_gradient found = {0};
  struct subject s;
  mass(&s);
  s.problem.yp0 = yp0;
  CHECK(steif_gradient_find(ctx, &s.problem, "dirk:esdirk43", &o, &J, &found) ==
        STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "for y' = f only") != NULL);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_forms[] = {{"second derivatives in every form", every_form},
                                {"gradients without callbacks", without_callbacks},
                                {"slopes at the start", given_slopes},
                                CU_TEST_INFO_NULL};
