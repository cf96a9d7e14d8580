/* test_matrices.c: entries, eigenvalues and transfer functions, k = 4, dt = 0.1, C = (1, 0), and
 * the identities between schemes. Figures: mpmath, 30 digits, unless a line says otherwise.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"

static steif_context *ctx;
static double A[4];

static steif_discrete made(const char *scheme)
{
  const steif_state_space s = oscillator(4, A);
  steif_discrete d;
  CHECK(steif_c2d(ctx, &s, scheme, 0.1, &d) == STEIF_OK);
  return d;
}

/* |value - expected| <= tolerance, entry by entry; `expected` by rows of two. */
static void near(const double *value, int rows, int columns, const double *expected,
                 double tolerance)
{
  for (int i = 0; value && i < rows; i++)
    for (int j = 0; j < columns; j++)
      CLOSE_FLOOR(value[i + rows * j], expected[i * columns + j], tolerance, 1);
}

typedef struct entry {
  const char *scheme;
  double A[4], B[2], B1[2], re, im;
} entry;

static const entry entries[] = {
  {"zoh",
   {0.980394470885430893, 0.0968922029851602304, -0.387568811940640921, 0.931948369392850778},
   {0.00490138227864227677, 0.0968922029851602304},
   {0, 0},
   0.9561714201391411,
   0.1922645048099431},
  {"exp-trapezoidal",
   {0.980394470885430893, 0.0968922029851602304, -0.387568811940640921, 0.931948369392850778},
   {0.00490138227864227677, 0.0968922029851602304},
   {0.00164276468879657809, 0.0490138227864227677},
   0.9561714201391411,
   0.1922645048099431},
  {"bilinear",
   {0.9806763285024155, 0.0966183574879227, -0.3864734299516908, 0.9323671497584541},
   {0.004830917874396135, 0.0966183574879227},
   {0.0024154589371980676, 0.04830917874396135},
   0.9565217391304348,
   0.1917211094974341},
  {"backward",
   {0.9633027522935780, 0.0917431192660550, -0.3669724770642202, 0.9174311926605505},
   {0.0091743119266055, 0.0917431192660550},
   {0.0091743119266055, 0.0917431192660550},
   0.9403669724770642,
   0.1820471085594902},
  {"forward", {1, 0.1, -0.4, 0.95}, {0, 0.1}, {0, 0}, 0.975, 0.19843134832984429},
};

static void entries_agree(void)
{
  for (size_t i = 0; i < sizeof entries / sizeof *entries; i++) {
    const entry *e = entries + i;
    steif_discrete d = made(e->scheme);
    near(d.form.A, 2, 2, e->A, 5e-16);
    near(d.form.B, 2, 1, e->B, 5e-16);
    near(d.B1, 2, 1, e->B1, 5e-16);
    CLOSE_FLOOR(d.re[0], e->re, 1e-14, 1);
    CLOSE_FLOOR(fabs(d.im[0]), e->im, 1e-14, 1);
    CLOSE_FLOOR(d.re[1], e->re, 1e-14, 1);
    CLOSE_FLOOR(d.im[1], -d.im[0], 0, 1);
    CLOSE(d.alias, 1.984313483298442943 * 0.1 / 3.14159265358979323846, 1e-14);
    steif_discrete_clear(ctx, &d);
  }
}

static void package_forms_agree(void)
{
  steif_discrete d = made("foh");
  near(d.form.B, 2, 1, (double[]){0.009618232274208438, 0.09292004806351939}, 5e-16);
  CLOSE(d.form.D[0], 0.0016427646887965783, 1e-14);
  near(d.form.C, 1, 2, (double[]){1, 0}, 0);
  steif_discrete_clear(ctx, &d);
  d = made("impulse");
  near(d.form.B, 2, 1, (double[]){0.009689220298516023, 0.0931948369392851}, 5e-16);
  near(d.form.D, 1, 1, (double[]){0}, 0);
  steif_discrete_clear(ctx, &d);
  d = made("bilinear");
  near(d.form.C, 1, 2, (double[]){0.9903381642512077, 0.0483091787439614}, 5e-16);
  CLOSE(d.form.D[0], 0.0024154589371981, 1e-13);
  steif_discrete_clear(ctx, &d);
  d = made("backward");
  near(d.form.C, 1, 2, (double[]){0.963302752293578, 0.0917431192660551}, 5e-16);
  CLOSE(d.form.D[0], 0.0091743119266055, 1e-13);
  steif_discrete_clear(ctx, &d);
  d = made("gbt:alpha=0.75");
  near(
    d.form.A, 2, 2,
    (double[]){0.9716981132075472, 0.0943396226415094, -0.3773584905660378, 0.9245283018867925},
    5e-16);
  near(d.form.B, 2, 1, (double[]){0.0070754716981132, 0.0943396226415094}, 5e-16);
  near(d.form.C, 1, 2, (double[]){0.9787735849056604, 0.0707547169811321}, 5e-16);
  CLOSE(d.form.D[0], 0.0053066037735849, 1e-13);
  steif_discrete_clear(ctx, &d);
}

static void respond(const steif_state_space *s, double re, double im, double H[2])
{
  H[0] = H[1] = NAN;
  CHECK(steif_response(ctx, s, re, im, H) == STEIF_OK);
}

/* num/den at z = e^{iw} for coefficients of z^2, z, 1. */
static void quotient(const double *num, const double *den, double w, double H[2])
{
  double n[2] = {0}, d[2] = {0};
  for (int k = 0; k < 3; k++) {
    const double c = cos((2 - k) * w), s = sin((2 - k) * w);
    n[0] += num[k] * c, n[1] += num[k] * s, d[0] += den[k] * c, d[1] += den[k] * s;
  }
  const double square = d[0] * d[0] + d[1] * d[1];
  H[0] = (n[0] * d[0] + n[1] * d[1]) / square, H[1] = (n[1] * d[0] - n[0] * d[1]) / square;
}

static void transfer_functions_agree(void)
{
  static const struct {
    const char *scheme;
    double num[3], den[3];
  } known[] = {
    {"zoh",
     {0, 0.004901382278642277, 0.004820263776964772},
     {1, -1.912342840278281, 0.951229424500714}},
    {"foh",
     {0.0016427646887965783, 0.006476702983327, 0.0016021783834844},
     {1, -1.912342840278281, 0.951229424500714}},
    {"bilinear",
     {0.0024154589371981, 0.0048309178743962, 0.0024154589371981},
     {1, -1.913043478260870, 0.951690821256039}},
    {"matched",
     {0, 0.004860823027804037, 0.004860823027804037},
     {1, -1.912342840278281, 0.951229424500714}},
  };
  double H[2], expected[2];
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    for (double w = 0.37; w < 3; w += 0.83) {
      steif_discrete d = made(known[i].scheme);
      quotient(known[i].num, known[i].den, w, expected);
      respond(&d.form, cos(w), sin(w), H);
      CLOSE_FLOOR(H[0], expected[0], 1e-11, hypot(expected[0], expected[1]));
      CLOSE_FLOOR(H[1], expected[1], 1e-11, hypot(expected[0], expected[1]));
      steif_discrete_clear(ctx, &d);
    }
}

static void gains_agree(void)
{
  static const char *const exact_gain[] = {"zoh",     "foh",      "bilinear",
                                           "matched", "backward", "gbt:alpha=0.3"};
  double H[2];
  for (int i = 0; i < 6; i++) {
    steif_discrete d = made(exact_gain[i]);
    respond(&d.form, 1, 0, H);
    CLOSE(H[0], 0.25, 1e-13);
    steif_discrete_clear(ctx, &d);
  }
  steif_discrete d = made("impulse");
  respond(&d.form, 1, 0, H);
  CLOSE(H[0], 0.249166145, 1e-8);
  steif_discrete_clear(ctx, &d);
}

static void prewarped_is_exact_at_its_frequency(void)
{
  double H[2];
  steif_discrete d = made("bilinear:w=2");
  near(
    d.form.A, 2, 2,
    (double[]){0.9805496025225592, 0.0969275977743551, -0.3877103910974205, 0.9320858036353817},
    5e-16);
  respond(&d.form, cos(0.2), sin(0.2), H);
  CLOSE_FLOOR(H[0], 0, 1e-14, 1);
  CLOSE_FLOOR(H[1], -1, 1e-14, 1);
  steif_discrete_clear(ctx, &d);
  d = made("bilinear");
  respond(&d.form, cos(0.2), sin(0.2), H);
  CLOSE(H[0], -0.026620938, 1e-7);
  CLOSE(H[1], -0.995952888, 1e-8);
  steif_discrete_clear(ctx, &d);
  const steif_state_space s = oscillator(4, A);
  respond(&s, 0, 2, H);
  CLOSE_FLOOR(H[0], 0, 1e-15, 1);
  CLOSE(H[1], -1, 1e-15);
}

/* a = -2, b = 1: ten steps, phi functions, and the difference to the bilinear rule. */
static void scalars_agree(void)
{
  const double a = -2, b = 1, h0 = 1;
  const steif_state_space s = {.n = 1, .m = 1, .A = &a, .B = &b};
  double h[11];
  steif_discrete zoh, foh, tustin;
  CHECK(steif_c2d(ctx, &s, "zoh", 0.1, &zoh) == STEIF_OK);
  CHECK(steif_c2d(ctx, &s, "foh", 0.1, &foh) == STEIF_OK);
  CHECK(steif_c2d(ctx, &s, "bilinear", 0.1, &tustin) == STEIF_OK);
  CLOSE(zoh.form.A[0], 0.818730753077981859, 4e-16);
  CLOSE(zoh.form.B[0], 0.0906346234610090707, 4e-16);
  CLOSE(foh.B1[0], 0.1 * 0.468268826949546467, 4e-16);
  CLOSE(tustin.form.A[0], 0.818181818181818182, 4e-16);
  CLOSE(zoh.form.A[0] - tustin.form.A[0], 5.48934896163676852e-4, 1e-12);
  CHECK(steif_discrete_run(ctx, &zoh, NULL, NULL, 0, &h0, 10, h) == STEIF_OK);
  CLOSE(h[10], 0.135335283236612692, 4e-15);
  steif_discrete_clear(ctx, &zoh);
  steif_discrete_clear(ctx, &foh);
  steif_discrete_clear(ctx, &tustin);
}

/* Two integrators in a row, two inputs: Ad = [1 h; 0 1], phi_1 = [1 h/2; 0 1],
 * phi_2 = [1/2 h/6; 0 1/2]. */
static void singular_systems_with_two_inputs_work(void)
{
  static const double I2[] = {0, 0, 1, 0}, B[] = {0, 1, 3, -2};
  const double h = 0.3125;
  const steif_state_space s = {.n = 2, .m = 2, .A = I2, .B = B};
  steif_discrete d;
  CHECK(steif_c2d(ctx, &s, "foh", h, &d) == STEIF_OK);
  near(d.form.A, 2, 2, (double[]){1, h, 0, 1}, 1e-16);
  near(d.B1, 2, 2, (double[]){h * h / 6, h * (1.5 - h / 3), h / 2, -h}, 1e-16);
  near(d.B0, 2, 2, (double[]){h * h / 3, h * (1.5 - 2 * h / 3), h / 2, -h}, 1e-16);
  steif_discrete_clear(ctx, &d);
}

static void logarithm_undoes_the_hold(void)
{
  static const double B[] = {0.7, -1.3, 0.2, 0, 2.1, 0.4};
  static const double F[] = {-0.31, 2.6, 0, -2.2, -0.17, 0, 0.9, -1.1, 0};
  const steif_state_space s = {.n = 3, .m = 2, .A = F, .B = B};
  double back[9], input[6];
  for (double dt = 1e-3; dt < 1.2; dt *= 7) {
    steif_discrete d;
    CHECK(steif_c2d(ctx, &s, "zoh", dt, &d) == STEIF_OK);
    CHECK(d.alias < 1);
    CHECK(steif_d2c(ctx, 3, 2, d.form.A, d.form.B, dt, back, input) == STEIF_OK);
    for (int i = 0; i < 9; i++) CLOSE_FLOOR(back[i], F[i], 2e-15 / dt, 1);
    for (int i = 0; i < 6; i++) CLOSE_FLOOR(input[i], B[i], 2e-15 / dt, 1);
    steif_discrete_clear(ctx, &d);
  }
}

/* (s - 1)(s + 3)/((s + 1)(s + 2)(s^2 + s + 5)) in a basis of no special kind; and s/(s + 2),
 * whose gain at 0 is 0. */
static void matched_moves_poles_and_zeros(void)
{
  const double h = 0.2;
  static const double M[] = {0, 0, 0, -10, 1, 0, 0, -17, 0, 1, 0, -10, 0, 0, 1, -4},
                      b[] = {0, 0, 0, 1}, c[] = {-3, 2, 1, 0};
  const steif_state_space s = {.n = 4, .m = 1, .p = 1, .A = M, .B = b, .C = c};
  steif_discrete d;
  double H[2];
  CHECK(steif_c2d(ctx, &s, "matched", h, &d) == STEIF_OK);
  respond(&d.form, 1, 0, H);
  CLOSE(H[0], -0.3, 1e-12);
  for (int k = 0; k < 3; k++) {
    const double zero[] = {exp(h), exp(-3 * h), -1};
    respond(&d.form, zero[k], 0, H);
    CLOSE_FLOOR(H[0], 0, 1e-13, 1);
  }
  steif_discrete_clear(ctx, &d);
  const double a = -2, one = 1, minus = -2;
  const steif_state_space wash = {
    .n = 1, .m = 1, .p = 1, .A = &a, .B = &one, .C = &minus, .D = &one};
  CHECK(steif_c2d(ctx, &wash, "matched", h, &d) == STEIF_OK);
  respond(&d.form, 1, 0, H);
  CLOSE_FLOOR(H[0], 0, 1e-15, 1);
  respond(&d.form, exp(5 * h), 0, H);
  CLOSE(H[0], 5.0 / 7, 1e-13);
  steif_discrete_clear(ctx, &d);
}

static void opened(void)
{
  ctx = steif_context_new(NULL);
  CHECK(ctx != NULL);
}
static void closed(void)
{
  CHECK(steif_status(ctx) == STEIF_OK);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_matrices[] = {
  {"a context opens", opened},
  {"entries and eigenvalues agree to 5e-16 and 1e-14", entries_agree},
  {"the forms of control packages agree", package_forms_agree},
  {"transfer functions agree with their polynomials", transfer_functions_agree},
  {"gains at frequency 0 are kept", gains_agree},
  {"a prewarped bilinear rule is exact at its frequency", prewarped_is_exact_at_its_frequency},
  {"one equation, ten steps", scalars_agree},
  {"singular A and two inputs", singular_systems_with_two_inputs_work},
  {"the logarithm undoes the hold", logarithm_undoes_the_hold},
  {"matched moves poles and zeros", matched_moves_poles_and_zeros},
  {"nothing failed on the way", closed},
  CU_TEST_INFO_NULL};
