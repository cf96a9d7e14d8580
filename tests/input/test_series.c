/* test_series.c: derivatives of orders 0 .. 12 of expressions against derivatives by hand, and
 * identities between functions. The formulas by hand stand beside each; none uses a Taylor series.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

enum { MOST = 12 };
static const double right_angle = 1.5707963267948966;

static double factorial(int k) { return tgamma(k + 1.); }

/* a (a-1) .. (a-k+1) */
static double falling(double a, int k)
{
  double p = 1;
  for (int j = 0; j < k; j++) p *= a - j;
  return p;
}

/* sin(3 t + 0.5): 3^k sin(. + k pi/2) */
static double sine(double t, int k) { return pow(3, k) * sin(3 * t + 0.5 + k * right_angle); }
static double cosine(double t, int k) { return pow(0.7, k) * cos(0.7 * t + k * right_angle); }
static double decay(double t, int k) { return pow(-2.5, k) * exp(-2.5 * t); }
/* (1 + t)^a */
static double root(double t, int k) { return falling(0.5, k) * pow(1 + t, 0.5 - k); }
static double real_power(double t, int k) { return falling(-1.3, k) * pow(1 + t, -1.3 - k); }
static double fifth(double t, int k) { return falling(5, k) * pow(t, 5 - k > 0 ? 5 - k : 0); }
static double inverse_cube(double t, int k) { return falling(-3, k) * pow(t, -3 - k); }
static double hyperbola(double t, int k)
{
  return (k % 2 ? -1 : 1) * factorial(k) / pow(1 + t, k + 1);
}
static double logarithm(double t, int k)
{
  return k ? (k % 2 ? 1 : -1) * factorial(k - 1) / pow(1 + t, k) : log(1 + t);
}
static double hyperbolic_sine(double t, int k) { return k % 2 ? cosh(t) : sinh(t); }
static double hyperbolic_cosine(double t, int k) { return k % 2 ? sinh(t) : cosh(t); }
/* e^t sin t: 2^(k/2) e^t sin(t + k pi/4) */
static double spiral(double t, int k)
{
  return pow(2, k / 2.) * exp(t) * sin(t + k * right_angle / 2);
}
static double power_of_two(double t, int k) { return pow(log(2), k) * pow(2, t); }
/* atan t, with a = atan t: (k-1)! cos^k(a) sin(k (a + pi/2)) */
static double arctangent(double t, int k)
{
  const double a = atan(t);
  return k ? factorial(k - 1) * pow(cos(a), k) * sin(k * (a + right_angle)) : a;
}
/* f = exp(-t^2): f^(k+1) = -2 t f^(k) - 2 k f^(k-1) */
static double bell(double t, int k)
{
  double before = 0, f = exp(-t * t);
  for (int j = 0; j < k; j++) {
    const double after = -2 * t * f - 2 * j * before;
    before = f, f = after;
  }
  return f;
}
/* t^t: f' = f (1 + log t), by Leibniz' rule */
static double self_power(double t, int k)
{
  double f[MOST + 1] = {pow(t, t)};
  for (int m = 0; m < k; m++)
    for (int j = 0; j <= m; j++) {
      const double choose = factorial(m) / factorial(j) / factorial(m - j),
                   g = j ? (j % 2 ? 1 : -1) * factorial(j - 1) / pow(t, j) : 1 + log(t);
      f[m + 1] += choose * f[m - j] * g;
    }
  return f[k];
}
/* u = tan t or tanh t: u' = 1 + s u^2 with s = 1, -1; derivatives are polynomials in u. */
static double polynomial(double u, double s, int k)
{
  double c[MOST + 3] = {0, 1};
  for (int j = 0; j < k; j++) {
    double d[MOST + 3] = {0};
    for (int i = 1; i <= j + 1; i++) d[i - 1] += i * c[i], d[i + 1] += s * i * c[i];
    memcpy(c, d, sizeof c);
  }
  double sum = 0;
  for (int i = k + 1; i >= 0; i--) sum = sum * u + c[i];
  return sum;
}
static double tangent(double t, int k) { return polynomial(tan(t), 1, k); }
static double hyperbolic_tangent(double t, int k) { return polynomial(tanh(t), -1, k); }

static const struct {
  const char *text;
  double (*by_hand)(double t, int k);
} cases[] = {{"sin(3*t + 0.5)", sine},
             {"cos(0.7*t)", cosine},
             {"exp(-2.5*t)", decay},
             {"sqrt(1 + t)", root},
             {"(1 + t)^0.5", root},
             {"(1 + t)^-1.3", real_power},
             {"t^5", fifth},
             {"t*t^2*t^2", fifth},
             {"exp(5*log(t))", fifth},
             {"t^-3", inverse_cube},
             {"1/t^3", inverse_cube},
             {"1/(1 + t)", hyperbola},
             {"log(1 + t)", logarithm},
             {"sinh(t)", hyperbolic_sine},
             {"cosh(t)", hyperbolic_cosine},
             {"exp(t)*sin(t)", spiral},
             {"2^t", power_of_two},
             {"exp(t*log(2))", power_of_two},
             {"atan(t)", arctangent},
             {"exp(-t^2)", bell},
             {"t^t", self_power},
             {"tan(t)", tangent},
             {"sin(t)/cos(t)", tangent},
             {"tanh(t)", hyperbolic_tangent},
             {"abs(-t^5)", fifth},
             {"abs(t)^5", fifth},
             {"ramp(t + 1) - 1 - t + 1/(1 + t)", hyperbola},
             {"step(t - 0.25) * atan(t)", arctangent}};

static void derivatives_agree_with_those_by_hand(void)
{
  static const double times[] = {0.6321, 0.8093, 1.4142};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    steif_function *f = steif_function_parse(ctx, cases[i].text, 1, NULL);
    if (!f) printf("\n  %s", steif_message(ctx));
    for (int m = 0; m < 3; m++)
      for (int k = 0; k <= MOST; k++) {
        const double value = ask(ctx, f, 1, 0, times[m], k), e = cases[i].by_hand(times[m], k);
        /* The radius of convergence of all these is above a half: k! 2^k bounds their size. */
        const double floor = 0.05 * factorial(k);
        if (!(fabs(value - e) <= 1e-12 * fmax(fabs(e), floor)))
          printf("\n  %s at %g, derivative %d", cases[i].text, times[m], k);
        CLOSE_FLOOR(value, e, 1e-12, floor);
      }
    steif_function_free(&f);
  }
  steif_context_free(&ctx);
}

static void identities_hold_in_every_derivative(void)
{
  static const struct {
    const char *text;
    double constant;
  } same[] = {{"sin(exp(t))^2 + cos(exp(t))^2", 1},
              {"cosh(t^2)^2 - sinh(t^2)^2", 1},
              {"log(exp(sin(t))) - sin(t) + 2.5", 2.5},
              {"tan(t) - sin(t)/cos(t) + 0.5", 0.5},
              {"tanh(t) - sinh(t)/cosh(t) - 3", -3},
              {"tan(atan(t)) - t + 7", 7},
              {"sqrt(1 + t^2)^2 - t^2", 1},
              {"(2 + t)^2.5 * (2 + t)^-2.5", 1},
              {"(t - 3)^7 / (t - 3)^7", 1},
              {"exp(t) * exp(-t)", 1},
              {"4*atan(1) - pi + 6.25", 6.25}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
    steif_function *f = steif_function_parse(ctx, same[i].text, 1, NULL);
    CLOSE(ask(ctx, f, 1, 0, 0.6137, 0), same[i].constant, 1e-14);
    for (int k = 1; k <= MOST; k++)
      CLOSE_FLOOR(ask(ctx, f, 1, 0, 0.6137, k), 0, 1e-12, pow(2, k) * factorial(k));
    steif_function_free(&f);
  }
  steif_context_free(&ctx);
}

/* Order 64, the highest: cos has +-1 at 0, 1/(1 - t) has 64!. */
static void the_highest_order_is_exact(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(ctx, "cos(t); 1/(1 - t); t^64", 3, NULL);
  CLOSE(ask(ctx, f, 3, 0, 0, 64), 1, 1e-13);
  CLOSE(ask(ctx, f, 3, 0, 0, 62), -1, 1e-13);
  CLOSE(ask(ctx, f, 3, 1, 0, 64), factorial(64), 1e-13);
  CLOSE(ask(ctx, f, 3, 2, 0.9, 64), factorial(64), 1e-13);
  N_Vector g = N_VNew_Serial(3, steif_sundials(ctx));
  CHECK(steif_function_value(0, 65, g, f) > 0);
  SAYS(ctx, "64 is the highest");
  CHECK(steif_function_value(0, -1, g, f) < 0);
  N_VDestroy(g);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

/* What has no value, or no derivative of that order, is recoverable and says where. */
static void where_there_is_no_value_it_is_said(void)
{
  static const struct {
    const char *text, *words;
    double t;
    int good, bad; /* derivatives; -1: none */
  } cases_of[] = {{"1/t", "division by zero", 0, -1, 0},
                  {"3 + log(t)", "position 5: the logarithm", 0, -1, 0},
                  {"log(t)", "the logarithm", -2.5, -1, 0},
                  {"sqrt(t)", "a power of zero whose derivative", 0, 0, 1},
                  {"t^2.5", "a power of zero whose derivative", 0, 2, 3},
                  {"sqrt(t^6 + t^7)", "a power of zero whose derivative", 0, 0, 1},
                  {"sqrt(t)", "that is not whole", -0.25, -1, 0},
                  {"t^-2", "a negative power of zero", 0, -1, 0},
                  {"t^-0.5", "a negative power of zero", 0, -1, 0},
                  {"t^t", "the exponent not constant", 0, 0, 1},
                  {"(-2)^t", "the exponent not constant", 1, 0, 1},
                  {"cbrt(t)", "a power of zero whose derivative", 0, 0, 1},
                  {"asin(t)", "outside its domain", 1.5, -1, 0},
                  {"exp(t)", "not finite", 1e3, -1, 0},
                  {"tan(t)^1000000", "not finite", 1.5707963267948966, -1, 0}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof cases_of / sizeof *cases_of; i++) {
    steif_function *f = steif_function_parse(ctx, cases_of[i].text, 1, NULL);
    N_Vector g = N_VNew_Serial(1, steif_sundials(ctx));
    if (!f) printf("\n  %s", steif_message(ctx));
    for (int k = 0; f && k <= cases_of[i].good; k++)
      CHECK(!steif_function_value(cases_of[i].t, k, g, f));
    steif_forget(ctx);
    CHECK(f && steif_function_value(cases_of[i].t, cases_of[i].bad, g, f) > 0);
    SAYS(ctx, cases_of[i].words);
    N_VDestroy(g);
    steif_function_free(&f);
  }
  steif_context_free(&ctx);
}

/* |sin t|, max(sin t, t^2), ramp(sin t) and t |t| at 0: what holds to the right. */
static void kinks_have_the_derivatives_to_the_right(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(
    ctx, "abs(sin(t)); max(sin(t), t^2); ramp(-sin(t)); min(0, sin(t)); abs(sin(t - pi))", 5,
    NULL);
  CHECK(ask(ctx, f, 5, 0, 0, 1) == 1 && ask(ctx, f, 5, 0, 0, 3) == -1);
  CHECK(ask(ctx, f, 5, 1, 0, 1) == 1 && ask(ctx, f, 5, 1, 0, 2) == 0);
  CHECK(ask(ctx, f, 5, 2, 0, 1) == 0 && ask(ctx, f, 5, 3, 0, 1) == 0);
  double where;
  CHECK(steif_function_smooth(f, 1, 3, &where) == 1);
  CHECK(steif_function_smooth(f, -1, 1, &where) == 0 && fabs(where) < 0.01);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

static void whole_powers_are_exact_at_zero(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(ctx, "t^4; (t^2)^0; 0*t; (2*t)^3", 4, NULL);
  for (int k = 0; k <= 6; k++) {
    CHECK(ask(ctx, f, 4, 0, 0, k) == (k == 4 ? 24 : 0));
    CHECK(ask(ctx, f, 4, 1, 0, k) == (k == 0));
    CHECK(ask(ctx, f, 4, 2, 0, k) == 0);
    CHECK(ask(ctx, f, 4, 3, 0, k) == (k == 3 ? 48 : 0));
  }
  steif_function_free(&f);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_series[] = {
  {"derivatives 0 .. 12 agree with those by hand to 1e-12",
   derivatives_agree_with_those_by_hand},
  {"identities hold in every derivative", identities_hold_in_every_derivative},
  {"the highest order, 64, is exact", the_highest_order_is_exact},
  {"where there is no value it is said", where_there_is_no_value_it_is_said},
  {"kinks have the derivatives to the right", kinks_have_the_derivatives_to_the_right},
  {"whole powers are exact at zero", whole_powers_are_exact_at_zero},
  CU_TEST_INFO_NULL};
