/* test_samples.c: derivatives from samples. The leading errors of the one-sided formulas over m
 * points at distance h are those of the remainder of interpolation, f^(m)(x) w(t) / m! with
 * w(t) = t (t - h) .. (t - (m-1) h):
 *   derivative 1:  (-1)^(m-1) h^(m-1) f^(m) / m
 *   derivative 2:  (-1)^m 2 H_(m-1) h^(m-2) f^(m) / m,   H_k = 1 + 1/2 + .. + 1/k.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static const double w = 3, a = 0.75, b = -1.375; /* f = a cos 3 t + b sin 3 t + 0.1 */

static double exact(double t, int k)
{
  const double turn = k * 1.5707963267948966;
  return pow(w, k) * (a * cos(w * t + turn) + b * sin(w * t + turn)) + (k ? 0 : 0.1);
}

/* count samples of f and of 2 f - t from t0 on. */
static const char *sampled(double t0, double h, int count)
{
  const char *path = in_folder("samples.csv");
  FILE *file = fopen(path, "w");
  fprintf(file, "# a test\nt,f_1,f_2\n");
  for (int i = 0; i < count; i++) {
    const double t = t0 + i * h, f = exact(t, 0);
    fprintf(file, "%.17g, %.17g, %.17g\n", t, f, 2 * f - t);
  }
  fclose(file);
  return path;
}

static void first_derivatives_have_the_error_of_theory(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 6; m <= 8; m += 2)
    for (double h = 0.1; h > 0.005; h /= 10) {
      double accuracy = -1;
      steif_function *f = steif_function_samples(ctx, sampled(0, h, 20), 2, NULL, m, &accuracy);
      const double theory = (m % 2 ? 1 : -1) * pow(h, m - 1) * exact(0, m) / m,
                   error = ask(ctx, f, 2, 0, 0, 1) - exact(0, 1);
      /* Later terms are O(m w h) of the leading one; rounding is some eps / h. */
      CHECK(fabs(error + theory) <= fmax(m * w * h * fabs(theory), 1e-14 / h) ||
            fabs(error - theory) <= fmax(m * w * h * fabs(theory), 1e-14 / h));
      CLOSE_FLOOR(ask(ctx, f, 2, 1, 0, 1), 2 * exact(0, 1) - 1, fabs(2 * error) + 1e-12, 1);
      /* The estimate is the error of m - 1 points: above that of m, below what theory says. */
      CHECK(accuracy * fabs(exact(0, 1)) > 0.5 * fabs(error));
      CHECK(accuracy <= 4 * pow(w * h, m - 2) + 1e-13 / h);
      steif_function_free(&f);
    }
  steif_context_free(&ctx);
}

/* The orders of E6: from distance 0.1 to 0.01 the error of f'', which dominates x(0+) for index 3,
 * falls by 10^(m-2). */
static void second_derivatives_fall_by_their_order(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 6; m <= 8; m += 2) {
    double error[2], harmonic = 0;
    for (int k = 1; k < m; k++) harmonic += 1. / k;
    for (int i = 0; i < 2; i++) {
      const double h = i ? 0.01 : 0.1;
      steif_function *f = steif_function_samples(ctx, sampled(0, h, 20), 2, NULL, m, NULL);
      error[i] = fabs(ask(ctx, f, 2, 0, 0, 2) - exact(0, 2));
      steif_function_free(&f);
    }
    const double theory = 2 * harmonic / m * pow(0.01, m - 2) * fabs(exact(0, m));
    CLOSE_FLOOR(error[1], theory, 0.3, 1e-11 / 0.3);
    CHECK(log10(error[0] / error[1]) > m - 2.8 && log10(error[0] / error[1]) < m - 1.2);
  }
  steif_context_free(&ctx);
}

/* A polynomial of degree 5 is exact with 6 points, in all derivatives, at and between samples. */
static void polynomials_are_exact(void)
{
  steif_context *ctx = steif_context_new(NULL);
  char text[4096] = "";
  for (int i = 0; i < 12; i++) {
    const double t = -0.5 + 0.25 * i;
    sprintf(text + strlen(text), "%.17g,%.17g\n", t, pow(t, 5) - 2 * t * t + 3);
  }
  steif_function *f = steif_function_samples(ctx, put("poly.csv", text), 1, NULL, 6, NULL);
  if (!f) printf("\n  %s", steif_message(ctx));
  static const double times[] = {-0.5, -0.4, 0, 0.33, 1, 1.25, 2, 2.2, 2.25};
  for (int i = 0; i < 9; i++) {
    const double t = times[i], d[] = {pow(t, 5) - 2 * t * t + 3,
                                      5 * pow(t, 4) - 4 * t,
                                      20 * pow(t, 3) - 4,
                                      60 * t * t,
                                      120 * t,
                                      120};
    for (int k = 0; k < 6; k++)
      CLOSE_FLOOR(ask(ctx, f, 1, 0, t, k), d[k], 1e-11 * pow(4, k), 3);
  }
  N_Vector g = N_VNew_Serial(1, steif_sundials(ctx));
  CHECK(steif_function_value(0, 6, g, f) > 0);
  SAYS(ctx, "derivative 6 from 6 samples; 5 is the highest");
  CHECK(steif_function_value(-0.51, 0, g, f) > 0);
  SAYS(ctx, "outside the samples, from -0.5 to 2.25");
  CHECK(steif_function_value(2.26, 0, g, f) > 0 && steif_function_value(NAN, 0, g, f) > 0);
  CHECK(steif_function_value(0, -1, g, f) < 0);
  N_VDestroy(g);
  CHECK(f && steif_function_breaks(f, -9, 9, 0, NULL) == 0);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

/* f = B u with B = (0 1; 2 0; 1 -1) from samples of u. The error of a derivative of each order is at
 * most what it is estimated to be. */
static void inputs_are_sampled(void)
{
  static const double entry[] = {0, 2, 1, 1, 0, -1};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix B = SUNDenseMatrix(3, 2, steif_sundials(ctx));
  memcpy(SM_DATA_D(B), entry, sizeof entry);
  steif_function *f = steif_function_samples(ctx, sampled(0, 0.01, 30), 3, B, 0, NULL);
  CU_ASSERT_FATAL(f != NULL);
  for (int d = 0; d < 5; d++) {
    double accuracy = -1;
    const double u = exact(0, d), v = 2 * u - (d == 1), size = fmax(fabs(u), fabs(v));
    CHECK(!steif_function_accuracy(f, 0, d, &accuracy));
    CHECK(fabs(ask(ctx, f, 3, 0, 0, d) - v) <= 2 * accuracy * size + 1e-15);
    CHECK(fabs(ask(ctx, f, 3, 1, 0, d) - 2 * u) <= 4 * accuracy * size + 1e-15);
    CHECK(fabs(ask(ctx, f, 3, 2, 0, d) - (u - v)) <= 3 * accuracy * size + 1e-15);
    CHECK(d ? accuracy < 1e-3 && accuracy > 0 : accuracy < 1e-9);
  }
  double accuracy = -1;
  CHECK(!steif_function_accuracy(f, 0, 7, &accuracy) && isinf(accuracy));
  CHECK(steif_function_accuracy(f, 0, -1, &accuracy) == STEIF_BAD_INPUT);
  steif_function_free(&f);
  f = steif_function_parse(ctx, "t; t^2; 1", 3, NULL);
  CHECK(f && !steif_function_accuracy(f, 0, 2, &accuracy) && accuracy == 0);
  steif_function_free(&f);
  CHECK(!steif_function_samples(ctx, in_folder("samples.csv"), 2, B, 0, NULL));
  SAYS(ctx, "B has 3 rows and f has 2 components");
  SUNMatDestroy(B);
  steif_context_free(&ctx);
}

/* E6: 8 points with w h near 0.03 are the default. */
static void the_default_is_eight_points(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double accuracy, eight;
  steif_function *f =
                   steif_function_samples(ctx, sampled(0.4, 0.01, 30), 2, NULL, 0, &accuracy),
                 *g = steif_function_samples(ctx, in_folder("samples.csv"), 2, NULL, 8, &eight);
  CHECK(f && g && accuracy == eight && accuracy > 0 && accuracy < 1e-9);
  CHECK(ask(ctx, f, 2, 0, 0.4, 2) == ask(ctx, g, 2, 0, 0.4, 2));
  CLOSE(ask(ctx, f, 2, 0, 0.4, 1), exact(0.4, 1), 1e-10);
  /* Between samples the formula is central: its error is far below the one-sided bound. */
  CLOSE(ask(ctx, f, 2, 0, 0.5551, 0), exact(0.5551, 0), 1e-14);
  steif_function_free(&f), steif_function_free(&g);
  f = steif_function_samples(ctx, sampled(0, 0.01, 3), 2, NULL, 0, NULL);
  CLOSE(ask(ctx, f, 2, 0, 0, 1), exact(0, 1), 1e-3);
  CHECK(isnan(ask(ctx, f, 2, 0, 0, 3)));
  steif_function_free(&f);
  steif_context_free(&ctx);
}

/* What was before a sample has no part in the derivative there. */
static void at_a_sample_the_formula_looks_forward(void)
{
  steif_context *ctx = steif_context_new(NULL);
  char text[2048] = "";
  for (int i = 0; i < 20; i++)
    sprintf(text + strlen(text), "%.17g %.17g\n", 0.1 * i, i < 7 ? 55.5 : 0.25 * i);
  steif_function *f = steif_function_samples(ctx, put("jump.csv", text), 1, NULL, 5, NULL);
  CLOSE(ask(ctx, f, 1, 0, 0.7, 1), 2.5, 1e-12);
  CLOSE_FLOOR(ask(ctx, f, 1, 0, 0.7, 2), 0, 1e-10, 1);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

static void bad_files_are_rejected_with_the_line(void)
{
  static const struct {
    const char *text;
    sunindextype n;
    int points, code;
    const char *words;
  } cases[] = {
    {"", 1, 0, STEIF_BAD_INPUT, "formulas over 0 points"},
    {"t,f\n", 1, 4, STEIF_BAD_INPUT, "has 0 samples and the formulas take 4"},
    {"0,1\n1,2\n2,3\n", 1, 4, STEIF_BAD_INPUT, "has 3 samples and the formulas take 4"},
    {"0,1\n1,2\n2,3\n", 1, 1, STEIF_BAD_INPUT, "take from 2 to 24"},
    {"0,1\n1,2\n2,3\n", 1, 25, STEIF_BAD_INPUT, "take from 2 to 24"},
    {"t,f\n0,1\n1,two\n2,3\n", 1, 2, STEIF_BAD_INPUT,
     "line 3: expected a number in column 2 of 2, found 'two'"},
    {"0,1\n1\n2,3\n", 1, 2, STEIF_BAD_INPUT, "line 2: expected a number in column 2 of 2"},
    {"0,1\n1,,2\n2,3\n", 1, 2, STEIF_BAD_INPUT,
     "line 2: expected a number in column 2 of 2, found ',2'"},
    {"0,1\n1,2,3\n2,3\n", 1, 2, STEIF_BAD_INPUT, "line 2: expected 2 columns, found ',3'"},
    {"0,1\n# note\n1,inf\n2,3\n", 1, 2, STEIF_NOT_FINITE, "line 3: column 2 is inf"},
    {"0,1\n1,2\nt,f\n", 1, 2, STEIF_BAD_INPUT, "line 3: expected a number in column 1"},
    {"0,1\n1,2\n2.1,3\n", 1, 2, STEIF_BAD_INPUT,
     "sample 2 is at t = 1, and equal distances of 1.05"},
    {"2,1\n1,2\n0,3\n", 1, 2, STEIF_BAD_INPUT, "let them ascend"},
    {"1,1\n1,2\n1,3\n", 1, 2, STEIF_BAD_INPUT, "let them ascend"},
    {"0,1\n1,2\n", 0, 2, STEIF_BAD_INPUT, "0 components"},
    {"0,1\n1,2\n", 2000000000, 2, STEIF_BAD_INPUT, "too short for"},
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    steif_forget(ctx);
    double accuracy;
    steif_function *f = steif_function_samples(ctx, put("bad.csv", cases[i].text), cases[i].n,
                                               NULL, cases[i].points, &accuracy);
    CHECK(!f && steif_status(ctx) == cases[i].code);
    SAYS(ctx, cases[i].words);
    steif_function_free(&f);
  }
  CHECK(!steif_function_samples(ctx, in_folder("gone.csv"), 1, NULL, 0, NULL));
  CHECK(steif_status(ctx) == STEIF_IO);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_samples[] = {
  {"first derivatives have the error of theory", first_derivatives_have_the_error_of_theory},
  {"second derivatives fall by their order", second_derivatives_fall_by_their_order},
  {"polynomials are exact at and between samples", polynomials_are_exact},
  {"f = B u from samples of u, with its accuracy", inputs_are_sampled},
  {"the default is eight points", the_default_is_eight_points},
  {"at a sample the formula looks forward", at_a_sample_the_formula_looks_forward},
  {"bad files are rejected with the line", bad_files_are_rejected_with_the_line},
  CU_TEST_INFO_NULL};
