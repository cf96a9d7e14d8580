/* Starts of models: which solution a slope says.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <math.h>

static const char *const methods[] = {"auto",      "bdf",       "radau:s=2",    "radau:s=3",
                                      "radau:s=7", "gauss:s=3", "dirk:esdirk43"};
enum { METHODS = sizeof methods / sizeof *methods };

static void ends_at(const char *text, double expected)
{
  fixture s;
  double y[3];
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  for (int k = 0; k < METHODS; k++) {
    CHECK(fixture_run(&s, methods[k], 1e-7, y) == STEIF_OK);
    CLOSE_FLOOR(y[0], expected, 1e-6, 1);
  }
  fixture_close(&s);
}

/* x'^2 = x has x = (1 +- t/2)^2 from 1; x'^3 = x only x = (1 + 2 t/3)^(3/2). */
static void the_slope_of_a_square(void)
{
  ends_at("state x = 1, x' = 1\nx'^2 = x\ntime 0 to 1\n", 2.25);
  ends_at("state x = 1, x' = -1\nx'^2 = x\ntime 0 to 1\n", 0.25);
  ends_at("state x = 1, x' ~ 0.5\nx'^3 = x\ntime 0 to 1\n", pow(5.0 / 3, 1.5));
}

/* x'^2 + x' = 2 x: x' = (-1 +- sqrt(1 + 8 x))/2; with w = sqrt(1 + 8 x), w' = 4 x'/w = 2 (-1 +- w)/w, so that
 * t = (w - 3 +- log((w -+ 1)/(3 -+ 1)))/2 for both signs, w(0) = 3. By bisection. */
static double of_branch(double sign, double t)
{
  double low = 1.2, high = 6;
  for (int k = 0; k < 200; k++) {
    const double w = (low + high) / 2;
    const double at = sign * (w - 3 + sign * log((w - sign) / (3 - sign))) / 2;
    (at < t) == (sign > 0) ? (low = w) : (high = w);
  }
  return (low * low - 1) / 8;
}

static void two_branches(void)
{
  ends_at("state x = 1, x' = -2\nx'^2 + x' = 2*x\ntime 0 to 0.1\n", of_branch(-1, 0.1));
  ends_at("state x = 1, x' = 1\nx'^2 + x' = 2*x\ntime 0 to 0.1\n", of_branch(1, 0.1));
}

/* Slopes of arrays, by their indices, and of second order: x'' = -1 or 2 of x''^2 - x'' = 2. */
static void slopes_of_arrays(void)
{
  ends_at("state u[i in 1:3] = i, u[i in 1:3]' = if abs(i - 2) < 0.5 then -1 else 1\n"
          "for i in 1:3\n u[i]'^2 = 1\nend\ntime 0 to 1\n",
          2);
  ends_at("state x = 1, x' = 0, x'' = -1\nx''^2 - x'' = 2\ntime 0 to 1\n", 0.5);
  ends_at("state x = 1, x' = 0, x'' = 2\nx''^2 - x'' = 2\ntime 0 to 1\n", 2);
}

/* Guesses far from the constraints end on them to rounding: two pendulums, one at the end of the other. */
static void constraints_to_rounding(void)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s,
                               "param c = 0.9688365352131203\n"
                               "state x ~ 1.2035949479197967, y ~ -0.28434425171542221, z ~ 0\n"
                               "x' = y + z\ny' = -x*z + t\n0 = x*y + sin(x) - c*t\n"
                               "time 1.6388750759841662 to 1.7388750759841662\n",
                               "") == STEIF_OK);
  const sunrealtype *y = s.p.y0, c = 0.9688365352131203;
  CHECK(fabs(y[0] * y[1] + sin(y[0]) - c * s.p.t0) < 1e-12);
  CHECK(fabs((y[1] + cos(y[0])) * (y[1] + y[2]) + y[0] * (s.p.t0 - y[0] * y[2]) - c) < 1e-12);
  fixture_close(&s);
  CU_ASSERT_FATAL(
    fixture_text(&s,
                 "param l1 = 1.8579955021450902, l2 = 1.0967683163999851\n"
                 "param m1 = 1.8298236534808692, m2 = 2.8666606022614673, g = 9.81\n"
                 "state x1 ~ -0.11945656073319821, y1 ~ 0.74374927222378995\n"
                 "state x2 ~ 0.038589268889907574, y2 ~ 1.1792922880815828\n"
                 "state u1 ~ 1.3096509748807332, v1 ~ 0.36249369744336823\n"
                 "state u2 ~ 1.1583399850882625, v2 ~ 0.14452335031179747, p, q\n"
                 "x1' = u1\ny1' = v1\nx2' = u2\ny2' = v2\n"
                 "m1*u1' = -p*x1 + q*(x2 - x1)\nm1*v1' = -p*y1 + q*(y2 - y1) - m1*g\n"
                 "m2*u2' = -q*(x2 - x1)\nm2*v2' = -q*(y2 - y1) - m2*g\n"
                 "x1^2 + y1^2 = l1^2\n(x2 - x1)^2 + (y2 - y1)^2 = l2^2\ntime 0 to 0.1\n",
                 "") == STEIF_OK);
  y = s.p.y0;
  const sunrealtype dx = y[2] - y[0], dy = y[3] - y[1];
  CHECK(fabs(hypot(y[0], y[1]) - 1.8579955021450902) < 1e-12);
  CHECK(fabs(hypot(dx, dy) - 1.0967683163999851) < 1e-12);
  CHECK(fabs(y[0] * y[4] + y[1] * y[5]) < 1e-12);
  CHECK(fabs(dx * (y[6] - y[4]) + dy * (y[7] - y[5])) < 1e-12);
  fixture_close(&s);
}

/* Two equations with the same derivative: their sum is a constraint, which no structure shows. */
static void equations_with_one_derivative(void)
{
  static const struct {
    double C, R, w, a, b, t;
  } k[] = {{0.22976518763715531, 17.352492519083199, 9.2614218311142551, -0.59656967294632468,
            0.14035061490771142, 0.26494301185719149},
           {3.5813845050453947e-05, 113.70353812719136, 7.1567372621449969, 123.77934570500216,
            0.85583685285321631, 0.65200972728847417}};
  for (int i = 0; i < 2; i++) {
    fixture s;
    char text[600];
    snprintf(text, sizeof text,
             "param C = %.17g, R = %.17g, w = %.17g\nstate a ~ %.17g, b ~ %.17g\n"
             "C*(a' - b') = -b/R + sin(w*t)\nC*(b' - a') = 1e-3*(exp(b) - 1) - (1 - a)/R\n"
             "time %.17g to %.17g\n",
             k[i].C, k[i].R, k[i].w, k[i].a, k[i].b, k[i].t, k[i].t + 0.1);
    CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
    const sunrealtype a = s.p.y0[0], b = s.p.y0[1];
    const sunrealtype sum =
      -b / k[i].R + sin(k[i].w * k[i].t) + 1e-3 * (exp(b) - 1) - (1 - a) / k[i].R;
    CHECK(fabs(sum) < 1e-12);
    CHECK(fabs(b - k[i].b) > 0.1);
    fixture_close(&s);
  }
}

static void opens_at(const char *text, double z, const char *said)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  const double sign = s.p.y0[1] * z < 0 ? -1 : 1;
  CLOSE(sign * s.p.y0[1], z, 1e-9);
  CHECK(said[0] || sign > 0);
  CHECK(strstr(steif_model_start(&s.p), said) != NULL);
  fixture_close(&s);
}

static void fails(const char *text, const char *said)
{
  fixture s;
  CHECK(fixture_text(&s, text, "") == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(s.ctx), said) != NULL);
  fixture_close(&s);
}

/* From z = 0, where F_z = 0, no step leads anywhere: others near it are tried, and x stays. */
static void singular_guesses(void)
{
  opens_at("state x = 0.01, z\nx' = -z\n0 = z^2 - x\ntime 0 to 0.1\n", 0.1, "may be");
  opens_at("state x = 0.5, z\nx' = -z\n0 = cos(z) - 1 + x\ntime 0 to 0.1\n", 1.0471975511965977,
           "may be");
  opens_at("state x = 1e-12, z\nx' = -z\n0 = z^2 - x\ntime 0 to 0.1\n", 1e-6, "may be");
  fails("state x = 0.01, z ~ 0\nx' = -z\n0 = z^2 - x\ntime 0 to 0.1\n",
        "lies between two solutions");
  fails("state x = -0.01, z ~ 0\nx' = -z\n0 = z^2 - x\ntime 0 to 0.1\n", "x = -0.01");
}

/* Conditions are as they are at the start, not at its guess. */
static void conditions_of_the_start(void)
{
  opens_at("state x = 0.5, z\nx' = -z\n0 = z*abs(z) - x\ntime 0 to 0.1\n", sqrt(0.5), "");
  opens_at("state x = 0.5, z ~ 3\nx' = -z\n0 = if z > 1 then z - x else 2*z - x\n"
           "time 0 to 0.1\n",
           0.25, "");
  fails("state x = 1, z\nx' = -z\n0 = if z > 1 then z - 0.5 else z - 2\ntime 0 to 0.1\n",
        "no start was found at which the conditions");
  fails("state x = 1, z ~ 3\nx' = -z\n0 = if z > 1 then z - 0.5 else z - 2\ntime 0 to 0.1\n",
        "give a guess of z nearer");
}

CU_TestInfo tests_of_starts[] = {
  {"the slope of a square", the_slope_of_a_square},
  {"two branches", two_branches},
  {"slopes of arrays and of second order", slopes_of_arrays},
  {"constraints to rounding", constraints_to_rounding},
  {"equations with one derivative", equations_with_one_derivative},
  {"singular guesses", singular_guesses},
  {"conditions of the start", conditions_of_the_start},
  CU_TEST_INFO_NULL,
};
