/* test_interface.c: models by the functions of steif/model.h, and linear ones by those of steif/linear.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <steif/linear.h>

static int parse(fixture *s, const char *text)
{
  *s = (fixture){.ctx = steif_context_new(NULL)};
  const int code = steif_model_parse(s->ctx, text, "m.steif", NULL, &s->p);
  if (code) printf("\n  %s", steif_message(s->ctx));
  return code;
}

/* No `time`: a run says its end, and meets the break of the source there; without, it is told what is missing. */
static void no_interval(void)
{
  fixture s;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!parse(&s, "state x = 0\nx' = if t < 1.5 then 1 else 0\n"));
  CHECK(s.p.t0 == 0 && s.p.t1 == 0 && s.p.break_count == 1);
  CHECK(!steif_solver_new(s.ctx, &s.p, "radau:s=3", &o));
  CHECK(!!strstr(steif_message(s.ctx), "m.steif: no time interval; set options.t1, or in a "
                                       "model add 'time 0 to 10 {s}'"));
  o.t1 = 3;
  steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
  CU_ASSERT_FATAL(solver != NULL);
  CHECK(steif_solve_to(solver, 3) == STEIF_OK);
  CLOSE(NV_Ith_S(steif_solution(solver), 0), 1.5, 1e-12);
  steif_solver_free(&solver);
  fixture_close(&s);
}

/* x' = -k x, solved for two values of k; a parameter that does not exist leaves the problem as it is. */
static void parameters_between_runs(void)
{
  fixture s;
  double k;
  CU_ASSERT_FATAL(!parse(
    &s,
    "param k = 1, twice = 2*k\nstate x = 1\nx' = -twice*x\noutput y = 10*x\ntime 0 to 1\n"));
  for (int turn = 0; turn < 2; turn++) {
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", NULL);
    CU_ASSERT_FATAL(solver != NULL);
    CHECK(steif_solve_to(solver, 1) == STEIF_OK);
    CLOSE(NV_Ith_S(steif_solution(solver), 0), exp(turn ? -6 : -2), 1e-4);
    double y;
    CHECK(!steif_model_outputs(&s.p, 1, steif_solution(solver), &y));
    CLOSE(y, 10 * NV_Ith_S(steif_solution(solver), 0), 1e-15);
    steif_solver_free(&solver);
    CHECK(steif_model_set(s.ctx, &s.p, "no", 1) == STEIF_UNKNOWN_NAME);
    CHECK(!steif_model_set(s.ctx, &s.p, "k", 3));
  }
  CU_ASSERT_STRING_EQUAL(steif_model_parameter(&s.p, 1, &k), "twice");
  CHECK(k == 6 && !steif_model_parameter(&s.p, 2, &k));
  CU_ASSERT_STRING_EQUAL(steif_model_output(&s.p, 0), "y");
  CHECK(!steif_model_output(&s.p, 1));
  fixture_close(&s);
}

static void facts(void)
{
  fixture s;
  steif_model_facts f;
  CU_ASSERT_FATAL(!fixture_example(&s, "brusselator.steif:n=1000"));
  CHECK(!steif_model_describe(s.ctx, &s.p, &f));
  CHECK(f.n == 2000 && f.entries == 8 * 1000 - 4 && f.loops == 1 && f.equations == 2 &&
        f.form == STEIF_ODE);
  CHECK(s.p.storage == STEIF_SPARSE);
  fixture_close(&s);
  s.ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(s.ctx, "rober", &s.p));
  CHECK(steif_model_describe(s.ctx, &s.p, &f) == STEIF_BAD_INPUT);
  steif_problem_clear(s.ctx, &s.p);
  steif_context_free(&s.ctx);
}

/* u1 - u2 = 1 + sin(t)^2 with C1 u1' = i, C2 u2' = -i: from u1 - u2 = 2 the capacitors share a charge at
 * once. C1 u1 + C2 u2 is kept: u1+ = (C1 u1 + C2 u2 + C2)/(C1 + C2), and the impulse of i is C1 (u1+ - u1). */
static void a_linear_model_has_impulses(void)
{
  fixture s;
  steif_linear l;
  steif_impulse i = {0};
  CU_ASSERT_FATAL(
    !parse(&s, "param C1 = 1, C2 = 3\nstate u1 = 2, u2 = 0, i = 0\nC1*u1' = i\nC2*u2' = -i\n"
               "0 = u1 - u2 - 1 - sin(t)^2\ntime 0 to 1\n"));
  CHECK(steif_problem_form(s.ctx, &s.p) == STEIF_DESCRIPTOR);
  CU_ASSERT_FATAL(!steif_linear_of(s.ctx, &s.p, &l));
  CHECK(!steif_impulse_find(s.ctx, l.E, l.F, s.p.y0, 0, l.f, l.user, NULL, NULL, &i));
  CHECK(i.index == 2 && i.certified);
  CLOSE(i.x_plus[0], (2 + 3.0) / 4, 1e-12);
  CLOSE(i.x_plus[1], (2 - 1.0) / 4, 1e-12);
  CLOSE(i.c[2], (2 + 3.0) / 4 - 2, 1e-12);
  steif_impulse_clear(s.ctx, &i);
  SUNMatDestroy(l.E);
  SUNMatDestroy(l.F);
  fixture_close(&s);
}

/* Derivatives of g by Taylor arithmetic against those of exp(2 t) sin(t) = Im exp((2 + i) t), order by order. */
static void forcing_has_derivatives(void)
{
  fixture s;
  CU_ASSERT_FATAL(!parse(
    &s, "state x = 1, y\nx' = y\n0 = x + y - exp(2*t)*sin(t) - log(1 + t)\ntime 0 to 1\n"));
  CHECK(steif_problem_form(s.ctx, &s.p) == STEIF_DESCRIPTOR);
  N_Vector g = N_VNew_Serial(2, steif_sundials(s.ctx));
  const double t = 0.3, angle = atan2(1, 2);
  double factorial = 1;
  for (int k = 1; k < 20; k++) {
    const double wave = pow(5, k / 2.0) * exp(2 * t) * sin(t + k * angle);
    const double log_part = (k % 2 ? 1 : -1) * factorial / pow(1 + t, k);
    CHECK(s.p.g(t, k, g, s.p.user) == 0);
    CLOSE(fabs(NV_Ith_S(g, 1)), fabs(wave + log_part), 1e-11);
    CHECK(NV_Ith_S(g, 0) == 0);
    factorial *= k;
  }
  N_VDestroy(g);
  fixture_close(&s);
}

/* Lines in another order, CRLF, a byte-order mark, primes beyond ASCII and no end of the last line. */
static void texts_in_other_clothes(void)
{
  static const char *const texts[] = {
    "param k = 2\nlet a = k*x\nstate x = 1\nx' = -a\ntime 0 to 1\n",
    "\xef\xbb\xbftime 0 to 1\r\nx' = -a\r\nlet a = k*x\r\nparam k = 2\r\nstate x = 1",
    ("x\xe2\x80\xb2 =\n  \xe2\x88\x92"
     "a\nstate x = 1 # start\nlet a =\n k*\n x\nparam k = 2 {1/s} in [0, 3]\ntime 0 to 1 {s}"),
    "state \xce\xb1 = 1\n\xce\xb1' = -2\xc2\xb7\xce\xb1\ntime 0 to 1\n"};
  for (int i = 0; i < 4; i++) {
    fixture s;
    CU_ASSERT_FATAL(!parse(&s, texts[i]));
    N_Vector y = N_VNew_Serial(1, steif_sundials(s.ctx)), f = N_VClone(y);
    NV_Ith_S(y, 0) = 0.7;
    CHECK(s.p.f(0, y, f, s.p.user) == 0);
    CHECK(NV_Ith_S(f, 0) == -(2 * 0.7));
    N_VDestroy(y), N_VDestroy(f);
    fixture_close(&s);
  }
}

/* Operators bind as on paper. */
static void precedence(void)
{
  static const struct {
    const char *text;
    double value;
  } rows[] = {{"-2^2", -4},
              {"2^3^2", 512},
              {"2^-1", 0.5},
              {"8/4/2", 1},
              {"8-4-2", 2},
              {"-3*-2", 6},
              {"2*3+4*5", 26},
              {"if not 1 < 2 and 3 < 4 then 1 else 2", 2},
              {"mod(-1, 3)", 2},
              {"if 1 < 2 or 1 < 0 and 1 < 0 then 1 else 2", 1},
              {"(1 + 2)*3", 9},
              {"sum(i in 1:4: i^2)", 30},
              {"5. + .5 + 1E+2", 105.5},
              {"atan2(1, -1)*4", 3 * 3.14159265358979312}};
  char text[200];
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    fixture s;
    snprintf(text, sizeof text, "state x = %s\nx' = x\ntime 0 to 1\n", rows[i].text);
    CU_ASSERT_FATAL(!parse(&s, text));
    CLOSE(s.p.y0[0], rows[i].value, 1e-15);
    fixture_close(&s);
  }
}

/* Known numbers belong to the parameters in the file; formulas follow others. */
static void references_belong_to_parameters(void)
{
  static const char *const known[] = {"0.7357588823428847", "a*exp(-k)"};
  char text[200];
  for (int i = 0; i < 2; i++) {
    fixture s;
    snprintf(
      text, sizeof text,
      "param k = 1, a = 2\nstate y = a\ny' = -k*y\ntime 0 to 1\nreference at 1, y = %s digits "
      "12\n",
      known[i]);
    CU_ASSERT_FATAL(!parse(&s, text));
    CU_ASSERT_FATAL(s.p.reference != NULL);
    CLOSE(s.p.reference->value[0], 2 * exp(-1), 1e-15);
    CHECK(steif_model_set(s.ctx, &s.p, "k", 3) == STEIF_OK);
    CHECK((s.p.reference != NULL) == (i == 1));
    if (s.p.reference) CLOSE(s.p.reference->value[0], 2 * exp(-3), 1e-15);
    CHECK(steif_model_set(s.ctx, &s.p, "k", 1) == STEIF_OK); /* as in the file */
    CU_ASSERT_FATAL(s.p.reference != NULL);
    CLOSE(s.p.reference->value[0], 2 * exp(-1), 1e-15);
    fixture_close(&s);
  }
}

/* Guesses that do not fulfil the rod and its derivative are moved, and told; others are not. */
static void moved_guesses_are_told(void)
{
  static const char rod[] =
    "state x ~ %s, y = 0, u ~ %s, v = 0, w\nx' = u\ny' = v\nu' = -w*x\nv' = -w*y - 1\n"
    "0 = x^2 + y^2 - 1\ntime 0 to 1\n";
  static const struct {
    const char *x, *u, *told;
  } rows[] = {
    {"1", "0", NULL}, {"1.5", "0", "x from 1.5 to 1"}, {"1", "0.5", "u from 0.5 to "}};
  char text[300];
  for (int i = 0; i < 3; i++) {
    fixture s;
    snprintf(text, sizeof text, rod, rows[i].x, rows[i].u);
    CU_ASSERT_FATAL(!parse(&s, text));
    const char *told = steif_model_start(&s.p);
    CHECK(rows[i].told ? !!strstr(told, rows[i].told) : !told[0]);
    CLOSE(s.p.y0[0], 1, 1e-12);
    CHECK(fabs(s.p.y0[2]) <= 1e-12);
    fixture_close(&s);
  }
  fixture s; /* where the gradient of the rod vanishes nothing is known to be near */
  snprintf(text, sizeof text, rod, "0", "0");
  CU_ASSERT_FATAL(!parse(&s, text));
  CHECK(!!strstr(steif_model_start(&s.p), "not moved: no consistent start"));
  CHECK(s.p.y0[0] == 0);
  fixture_close(&s);
  CHECK(!steif_model_start(&(steif_problem){.name = "p"})[0]);
}

/* x' = z, 0 = z^2 - x from x = 1: both z = 1 and z = -1. Guesses about half way choose neither. */
static void guesses_between_solutions_are_refused(void)
{
  static const char fold[] = "state x = 1, z %s\nx' = z\n0 = z^2 - x\ntime 0 to 1\n";
  static const struct {
    const char *guess;
    double z; /* 0: refused */
  } rows[] = {{"~ 0", 0},   {"~ 0.01", 0},  {"~ -0.1", 0},
              {"~ 0.4", 1}, {"~ -0.4", -1}, {"~ 3", 1}};
  char text[200];
  for (int i = 0; i < 6; i++) {
    fixture s;
    snprintf(text, sizeof text, fold, rows[i].guess);
    const int code = parse(&s, text);
    CHECK((code == 0) == (rows[i].z != 0));
    if (!code) {
      CLOSE(s.p.y0[1], rows[i].z, 1e-10);
      CHECK(strstr(steif_model_start(&s.p), "may be") == NULL);
    } else {
      CHECK(code == STEIF_BAD_INPUT);
      CHECK(strstr(steif_message(s.ctx), "the guess z ~") != NULL);
      CHECK(strstr(steif_message(s.ctx), "1 and -1:") ||
            strstr(steif_message(s.ctx), "-1 and 1:"));
    }
    fixture_close(&s);
  }
  fixture s; /* without a guess one is taken, and both are told */
  snprintf(text, sizeof text, fold, "");
  CU_ASSERT_FATAL(!parse(&s, text));
  CLOSE(fabs(s.p.y0[1]), 1, 1e-10);
  CHECK(strstr(steif_model_start(&s.p), "z may be ") != NULL);
  fixture_close(&s);
}

static void equations_are_named_by_the_text(void)
{
  static const char text[] =
    "param n = 2 whole\nstate u[i in 1:n] = i, w[i in 1:n], z = 0, x = 1\nstate x' = 0\n"
    "for i in 1:n\n  u[i]' = w[i]\n  sum: 0 = w[i] + u[i]\nend\n3*z' = 1\n"
    "spring: x'' = -x\ntime 0 to 1\n";
  static const char *const name[] = {
    "u[1]' (line 5)", "u[2]' (line 5)", "sum (line 6, element 1)", "sum (line 6, element 2)",
    "z' (line 8)",    "velocity of x",  "spring (line 9)"};
  fixture s;
  CU_ASSERT_FATAL(!fixture_text(&s, text, ""));
  CU_ASSERT_EQUAL_FATAL(s.p.n, sizeof name / sizeof *name);
  CU_ASSERT_PTR_NOT_NULL_FATAL(s.p.names->equation);
  for (int i = 0; i < s.p.n; i++) CU_ASSERT_STRING_EQUAL(s.p.names->equation[i], name[i]);
  fixture_close(&s);
}

CU_TestInfo tests_of_interface[] = {
  {"equations are named by the text", equations_are_named_by_the_text},
  {"references belong to parameters", references_belong_to_parameters},
  {"moved guesses are told", moved_guesses_are_told},
  {"guesses between two solutions are refused", guesses_between_solutions_are_refused},
  {"no interval", no_interval},
  {"parameters between runs", parameters_between_runs},
  {"facts", facts},
  {"impulses of a linear model", a_linear_model_has_impulses},
  {"derivatives of the forcing", forcing_has_derivatives},
  {"texts", texts_in_other_clothes},
  {"precedence", precedence},
  CU_TEST_INFO_NULL};
