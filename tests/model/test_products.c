/* test_products.c: F_y v + F_y' v' + F_p q, the transposed products and derivatives by parameters of 50
 * models: against central differences of F, against the entries of E and A, and against each other.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <stdlib.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { POINTS = 3, PARAMETERS = 24 };

typedef struct vectors {
  N_Vector y, yp, v, vp, w, r[2], by_y, by_yp;
  SUNMatrix M;
  double q[PARAMETERS], by_p[PARAMETERS];
} vectors;

static unsigned long long seed = 2027;
static double number(double low, double high)
{
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * (double)(seed >> 40) / (1 << 24);
}

static vectors vectors_new(const fixture *s)
{
  vectors x = {.y = N_VNew_Serial(s->p.n, steif_sundials(s->ctx))};
  N_Vector *all[] = {&x.yp, &x.v, &x.vp, &x.w, &x.r[0], &x.r[1], &x.by_y, &x.by_yp};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) *all[i] = N_VClone(x.y);
  x.M = SUNDenseMatrix(s->p.n, s->p.n, steif_sundials(s->ctx));
  return x;
}

static void vectors_free(vectors *x)
{
  N_Vector all[] = {x->y, x->yp, x->v, x->vp, x->w, x->r[0], x->r[1], x->by_y, x->by_yp};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) N_VDestroy(all[i]);
  SUNMatDestroy(x->M);
}

/* Near the start, where all models have values, or between 0.5 and 2.5. */
static void draw(const fixture *s, vectors *x, bool near_start)
{
  for (int i = 0; i < s->p.n; i++) {
    const double at =
      near_start ? s->p.y0[i] * number(0.97, 1.03) + number(0, 1e-3) : number(0.5, 2.5);
    NV_Ith_S(x->y, i) = at;
    NV_Ith_S(x->yp, i) = number(-1, 1);
    NV_Ith_S(x->v, i) = near_start ? at * number(-1, 1) : number(-1, 1);
    NV_Ith_S(x->vp, i) = number(-1, 1);
    NV_Ith_S(x->w, i) = number(-1, 1);
  }
  const int count = s->p.parameters ? s->p.parameters->count : 0;
  for (int k = 0; k < count && k < PARAMETERS; k++)
    x->q[k] = s->p.parameters->value[k] * number(-1, 1);
}

static void times(const steif_problem *p, const vectors *x, steif_matrix_fill fill, double t,
                  N_Vector of, N_Vector out)
{
  SUNMatZero(x->M);
  CHECK(fill(t, x->y, x->yp, x->M, p->user) == 0);
  SUNMatMatvec(x->M, of, out);
}

/* F of any form. */
static void residual(const steif_problem *p, vectors *x, double t, N_Vector r)
{
  N_Vector f = x->by_y, e = x->by_yp;
  if (p->F) {
    CHECK(p->F(t, x->y, x->yp, r, p->user) == 0);
    return;
  }
  if (p->f)
    CHECK(p->f(t, x->y, f, p->user) == 0);
  else {
    times(p, x, p->A, t, x->y, f);
    CHECK(p->g(t, 0, e, p->user) == 0);
    N_VLinearSum(1, f, 1, e, f);
  }
  if (p->E)
    times(p, x, p->E, t, x->yp, e);
  else
    N_VScale(1, x->yp, e);
  N_VLinearSum(1, e, -1, f, r);
}

static void move(vectors *x, double h)
{
  N_VLinearSum(1, x->y, h, x->v, x->y);
  N_VLinearSum(1, x->yp, h, x->vp, x->yp);
}

/* The quotient of differences along (v, v') at both sides. */
static void against_differences(const fixture *s, vectors *x, double t, double tolerance)
{
  const double h = 1e-5;
  N_Vector out = N_VClone(x->y);
  CHECK(!steif_model_tangent(s->ctx, &s->p, t, x->y, x->yp, x->v, x->vp, NULL, out));
  move(x, h), residual(&s->p, x, t, x->r[0]);
  move(x, -2 * h), residual(&s->p, x, t, x->r[1]);
  move(x, h);
  double size = N_VMaxNorm(out);
  for (int i = 0; i < s->p.n; i++)
    CLOSE_FLOOR(NV_Ith_S(out, i), (NV_Ith_S(x->r[0], i) - NV_Ith_S(x->r[1], i)) / (2 * h),
                tolerance, 1e-4 * size + 1);
  N_VDestroy(out);
}

/* w . E v and w . A v both ways, and E v by the entries of E. */
static void operators(const fixture *s, vectors *x, double t, double size)
{
  const steif_problem *p = &s->p;
  N_Vector to = x->r[0], back = x->r[1];
  CHECK(!p->Av(t, x->y, x->yp, x->v, to, p->user));
  CHECK(!p->Atv(t, x->y, x->yp, x->w, back, p->user));
  CLOSE_FLOOR(N_VDotProd(x->w, to), N_VDotProd(x->v, back), 1e-12, size);
  CHECK(!p->E == !p->Ev && !p->E == !p->Etv);
  if (!p->E) return;
  times(p, x, p->E, t, x->v, back);
  CHECK(!p->Ev(t, x->y, x->yp, x->v, to, p->user));
  for (int i = 0; i < p->n; i++)
    CLOSE_FLOOR(NV_Ith_S(to, i), NV_Ith_S(back, i), 1e-12, N_VMaxNorm(back));
  CHECK(!p->Etv(t, x->y, x->yp, x->w, back, p->user));
  CLOSE_FLOOR(N_VDotProd(x->w, to), N_VDotProd(x->v, back), 1e-12,
              size + N_VMaxNorm(to) * N_VMaxNorm(x->w));
}

/* w . (F_y v + F_y' v' + F_p q) both ways, and F_y v by the entries of A. */
static void against_each_other(const fixture *s, vectors *x, double t)
{
  const int count = s->p.parameters ? s->p.parameters->count : 0;
  N_Vector out = N_VClone(x->y);
  CHECK(!steif_model_tangent(s->ctx, &s->p, t, x->y, x->yp, x->v, x->vp, x->q, out));
  CHECK(!steif_model_adjoint(s->ctx, &s->p, t, x->y, x->yp, x->w, x->by_y, x->by_yp, x->by_p));
  double back = N_VDotProd(x->by_y, x->v) + N_VDotProd(x->by_yp, x->vp), size = 0;
  for (int k = 0; k < count; k++) back += x->by_p[k] * x->q[k];
  for (int i = 0; i < s->p.n; i++)
    size += fabs(NV_Ith_S(x->w, i) * NV_Ith_S(out, i)) +
            fabs(NV_Ith_S(x->by_y, i) * NV_Ith_S(x->v, i));
  CLOSE_FLOOR(N_VDotProd(x->w, out), back, 1e-12, size);
  CHECK(!steif_model_tangent(s->ctx, &s->p, t, x->y, x->yp, x->v, NULL, NULL, out));
  SUNMatZero(x->M);
  if (s->p.jac)
    s->p.jac(t, x->y, out, x->M, s->p.user, NULL, NULL, NULL);
  else
    s->p.A(t, x->y, x->yp, x->M, s->p.user);
  SUNMatMatvec(x->M, x->v, x->r[0]);
  CHECK(!s->p.Av(t, x->y, x->yp, x->v, x->r[1], s->p.user));
  for (int i = 0; i < s->p.n; i++) {
    double row = 0;
    for (int j = 0; j < s->p.n; j++) row += fabs(SM_ELEMENT_D(x->M, i, j) * NV_Ith_S(x->v, j));
    CLOSE_FLOOR(-NV_Ith_S(x->r[0], i), NV_Ith_S(out, i), 1e-12, row);
    CLOSE_FLOOR(NV_Ith_S(x->r[1], i), NV_Ith_S(x->r[0], i), 1e-12, row);
  }
  operators(s, x, t, size);
  N_VDestroy(out);
}

/* The car axis with another length L contradicts its fixed start: there is no start to differentiate. */
static bool moves_no_start(const fixture *s, int k)
{
  return strstr(s->p.name, "caraxis") && !strcmp(s->p.parameters->name[k], "L");
}

/* dF/dp_k by the callback, against F of the same text with another value; and dy0/dp_k. */
static void by_parameters(fixture *s, vectors *x, double t)
{
  const int count = s->p.parameters ? s->p.parameters->count : 0;
  N_Vector out = N_VClone(x->y), S0 = N_VClone(x->y);
  for (int k = 0; k < count; k++) {
    const double p = s->p.parameters->value[k], h = 1e-5 * (p != 0 ? fabs(p) : 1);
    CHECK(!steif_parameter_slope(s->ctx, &s->p, k, t, x->y, x->yp, out));
    const int started = steif_parameter_start(s->ctx, &s->p, k, S0);
    if (moves_no_start(s, k)) {
      CHECK(started == STEIF_BAD_INPUT && strstr(steif_message(s->ctx), "L"));
      continue;
    }
    CHECK(!started);
    double largest = 0;
    for (int i = 0; i < s->p.n; i++) largest = fmax(largest, fabs(s->p.y0[i]));
    char name[40];
    snprintf(name, sizeof name, "%s", s->p.parameters->name[k]);
    for (int side = 0; side < 2; side++) {
      CHECK(!steif_model_set(s->ctx, &s->p, name, side ? p - h : p + h));
      residual(&s->p, x, t, x->r[side]);
      N_Vector kept = side ? x->vp : x->v;
      for (int i = 0; i < s->p.n; i++) NV_Ith_S(kept, i) = s->p.y0[i];
    }
    CHECK(!steif_model_set(s->ctx, &s->p, name, p));
    for (int i = 0; i < s->p.n; i++) {
      const double size = fabs(NV_Ith_S(x->r[0], i)) / (p != 0 ? fabs(p) : 1);
      CLOSE_FLOOR(NV_Ith_S(out, i), (NV_Ith_S(x->r[0], i) - NV_Ith_S(x->r[1], i)) / (2 * h),
                  1e-6, 1e-3 * size + 1e-3);
      CLOSE_FLOOR(NV_Ith_S(S0, i), (NV_Ith_S(x->v, i) - NV_Ith_S(x->vp, i)) / (2 * h), 1e-6,
                  1e-3 * (1 + largest / (p != 0 ? fabs(p) : 1)));
    }
  }
  N_VDestroy(out), N_VDestroy(S0);
}

static void check_model(fixture *s, bool near_start, double tolerance)
{
  vectors x = vectors_new(s);
  for (int k = 0; k < POINTS; k++) {
    draw(s, &x, near_start);
    against_differences(s, &x, 0.013, tolerance);
    against_each_other(s, &x, 0.013);
  }
  by_parameters(s, &x, 0.013);
  vectors_free(&x);
}

static const char *const sides[] = {
  "sin(x*y) + cos(z)^2 - tan(x/5)",
  "asin(x/9) + acos(y/9) + atan(z) + atan2(x, y + z)",
  "sinh(x/3) + cosh(y/3)*tanh(z)",
  "asinh(x) + acosh(y + 2) + atanh(z/9)",
  "exp(-x) + expm1(y/2) + log(z) + log10(x + 1) + log1p(y)",
  "sqrt(x*y) + cbrt(z + x) + erf(y/2)",
  "abs(x - 9)*y + sign(z)*x + min(x, y + 9) + max(z, y - 9)",
  "hypot(x, y) + mod(z, 100) + ramp(x)*y + step(x)*z + floor(x + 0.5)*y",
  "x^2 + y^3 + z^4 + x^5 + y^-1 + z^0.5 + 2^x + x^y",
  "if x > 9 then sqrt(x - 9) else x*y*z",
  "if x < 9 and y < 9 then x/y else log(-x)",
  "-x^2*-y + (x - y - z) - x/y/z + a*x*y + b^2*z/a",
  "q + f(x, y)*g(z) + sum(k in 1:4: k*x^k)*y + t*x + b^x",
};

static void of_all_functions(void)
{
  char text[1000];
  fixture s;
  for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
    for (int form = 0; form < 3; form++) {
      static const char *const left[] = {"z'", "a*z' + b*y'", "z' + b*z'^3*x"};
      snprintf(text, sizeof text,
               "param a = 0.7, b = 1.3\nstate x = a^2, y = 1, z = sin(b) + 1\nlet q = x*y + a\n"
               "function f(u, v) = u*v + g(u)\nfunction g(u) = exp(-u)/(1 + u^2)\nx' = a*y\n"
               "y' = -x\n%s = %s\ntime 0 to 1\n",
               left[form], sides[i]);
      CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
      check_model(&s, false, 2e-7);
      fixture_close(&s);
    }
}

static void of_the_examples(void)
{
  static const char *const names[] = {"rober",    "vdpol",     "orego",   "akzo",
                                      "transamp", "pendulum",  "caraxis", "bounce",
                                      "hunters",  "converter", "reactor", "brusselator"};
  char path[100];
  fixture s;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    snprintf(path, sizeof path, "%s.steif", names[i]);
    CU_ASSERT_FATAL(fixture_example(&s, path) == STEIF_OK);
    check_model(&s, true, 1e-6);
    fixture_close(&s);
  }
}

/* Loops with slots (rows that are no multiples of counters), borders, three dimensions. */
static void of_loops(void)
{
  static const char *const texts[] = {
    "param n = 20 whole, c = 2\nstate u[i in 1:n] = 1 + i/n, w[1:n]\nfor i in 1:n\n"
    "u[i]' = w[i] - c*u[i]\n0 = w[i] - u[i]^2 - c/i\nend\ntime 0 to 1\n",
    "param n = 70 whole, c = 0.3\nstate u[i in 1:n, j in 1:3, k in 1:2] = c\n"
    "boundary u[0, j in 1:3, k in 1:2] = c^2, u[n+1, j in 1:3, k in 1:2] = u[n, j, k]\n"
    "for i in 1:n\nfor j in 1:3\nfor k in 1:2\n"
    "u[i,j,k]' = c*u[i-1,j,k]*u[i+1,j,k] - i*sin(u[i,j,k]) + "
    "u[n+1-i,j,3-k]\nend\nend\nend\ntime 0 to 1\n",
    "param n = 9 whole, c = 0.3\nstate u[i in 1:n] = 1\nfor i in 1:n\n"
    "u[i]' + c*sum(k in 1:n: u[k]')*u[i] = -c*u[i]\nend\ntime 0 to 1\n"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_text(&s, texts[i], "") == STEIF_OK);
    check_model(&s, true, 1e-6);
    fixture_close(&s);
  }
}

/* Parameters of the problem: those of the text that are numbers, not whole, not changed by events. */
static void the_list(void)
{
  fixture s;
  CU_ASSERT_FATAL(
    fixture_text(&s,
                 "param n = 3 whole, a = 2, b = 3*a, c = 1\nstate x[1:n] = a\nfor i in 1:n\n"
                 "x[i]' = -b*x[i]*c\nend\nwhen x[1] < 0.5: c = 2\ntime 0 to 1\n",
                 "") == STEIF_OK);
  const steif_parameters *p = s.p.parameters;
  CU_ASSERT_FATAL(p != NULL && p->count == 1);
  CU_ASSERT_STRING_EQUAL(p->name[0], "a");
  CHECK(p->value[0] == 2);
  CHECK(steif_parameter_find(s.ctx, &s.p, "n") == -1);
  fixture_close(&s);
  CU_ASSERT_FATAL(fixture_text(&s,
                               "param a = 2, b = 3*a\nstate x = b\nx' = -b*x\ntime 0 to 1\n",
                               ":b=5") == STEIF_OK);
  CHECK(s.p.parameters->count == 2 && steif_parameter_find(s.ctx, &s.p, "b") == 1);
  N_Vector S0 = N_VNew_Serial(1, steif_sundials(s.ctx));
  CHECK(!steif_parameter_start(s.ctx, &s.p, 1, S0) && NV_Ith_S(S0, 0) == 1);
  CHECK(!steif_parameter_start(s.ctx, &s.p, 0, S0) && NV_Ith_S(S0, 0) == 0);
  N_VDestroy(S0);
  fixture_close(&s);
  CU_ASSERT_FATAL(fixture_text(&s, "state x = 1\nx' = -x\ntime 0 to 1\n", "") == STEIF_OK);
  CHECK(s.p.parameters == NULL);
  fixture_close(&s);
}

/* sum F_k s^k against F at t + s, along cubic curves; coefficient 12 still shows at s = 0.1. */
static void along_a_curve(fixture *s, bool near_start)
{
  enum { ORDER = 22 };
  const size_t n = (size_t)s->p.n;
  vectors x = vectors_new(s);
  double *y = calloc((ORDER + 2) * n, sizeof *y), *F = calloc((ORDER + 1) * n, sizeof *F);
  draw(s, &x, near_start);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 4; k++)
      y[k * n + i] = k ? NV_Ith_S(x.y, i) * number(-0.3, 0.3) : NV_Ith_S(x.y, i);
  const int code = steif_model_taylor(s->ctx, &s->p, 0.4, ORDER, y, F);
  if (code) printf("\n  %s", steif_message(s->ctx));
  CHECK(code == STEIF_OK);
  for (double at = -0.1; !code && at < 0.15; at += 0.05) {
    for (size_t i = 0; i < n; i++) {
      NV_Ith_S(x.y, i) = y[i] + at * (y[n + i] + at * (y[2 * n + i] + at * y[3 * n + i]));
      NV_Ith_S(x.yp, i) = y[n + i] + at * (2 * y[2 * n + i] + 3 * at * y[3 * n + i]);
    }
    residual(&s->p, &x, 0.4 + at, x.r[0]);
    for (size_t i = 0; i < n; i++) {
      double sum = 0, size = 0;
      for (size_t k = ORDER + 1; k--;) {
        sum = sum * at + F[k * n + i];
        size = fmax(size, fabs(F[k * n + i] * pow(at, (double)k)));
      }
      CLOSE_FLOOR(NV_Ith_S(x.r[0], i), sum, 2e-13, 10 * size);
    }
  }
  free(y), free(F);
  vectors_free(&x);
}

static void taylor_coefficients(void)
{
  char text[1000];
  fixture s;
  for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
    snprintf(text, sizeof text,
             "param a = 0.7, b = 1.3\nstate x = a^2, y = 1, z = sin(b) + 1\nlet q = x*y + a\n"
             "function f(u, v) = u*v + g(u)\nfunction g(u) = exp(-u)/(1 + u^2)\nx' = a*y\n"
             "y' = -x*acosh(1.5 + y)\nz' + b*z'^3*x = %s\ntime 0 to 1\n",
             sides[i]);
    CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
    along_a_curve(&s, false);
    fixture_close(&s);
  }
  CU_ASSERT_FATAL(
    fixture_text(&s,
                 "table f = (0, 1), (1, 3), (2, 2), (9, 5) cubic\ntable g = (0, 1), (2, 7), "
                 "(9, 5) linear\n"
                 "state x = 1, y = 1.5\nx' = f(y)*g(2.5 + t)\ny' = g(5 + x)\ntime 0 to 1\n",
                 "") == STEIF_OK);
  along_a_curve(&s, true);
  fixture_close(&s);
  CU_ASSERT_FATAL(fixture_example(&s, "brusselator.steif") == STEIF_OK);
  along_a_curve(&s, true);
  fixture_close(&s);
}

/* x' = x^2, x(0) = 1: x = 1/(1 - t), all coefficients are 1. */
static void series_of_a_solution(void)
{
  enum { ORDER = 40 };
  fixture s;
  double x[ORDER + 2] = {1}, F[ORDER + 1];
  CU_ASSERT_FATAL(fixture_text(&s, "state x = 1\nx' = x^2\ntime 0 to 1\n", "") == STEIF_OK);
  for (int k = 0; k < ORDER; k++) {
    CHECK(!steif_model_taylor(s.ctx, &s.p, 0, k, x, F));
    x[k + 1] = -F[k] / (k + 1);
    CLOSE(x[k + 1], 1, 1e-13);
  }
  CHECK(steif_model_taylor(s.ctx, &s.p, 0, 65, x, F) == STEIF_BAD_INPUT);
  x[0] = NAN;
  CHECK(steif_model_taylor(s.ctx, &s.p, 0, 1, x, F) == STEIF_RETRY);
  fixture_close(&s);
}

CU_TestInfo tests_of_products[] = {{"all functions, three forms", of_all_functions},
                                   {"the examples", of_the_examples},
                                   {"loops", of_loops},
                                   {"the list of parameters", the_list},
                                   {"Taylor coefficients", taylor_coefficients},
                                   {"the series of a solution", series_of_a_solution},
                                   CU_TEST_INFO_NULL};
