/* test_grammar.c: how expressions are read, and how those that cannot be are rejected.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* Values at t = 1.75, computed beside them by C's own arithmetic. */
static void precedence_is_that_of_mathematics(void)
{
  const double t = 1.75;
  const struct {
    const char *text;
    double value;
  } cases[] = {{"2 + 3 * t", 2 + 3 * t},
               {"2 - 3 - t", 2 - 3 - t},
               {"2 / 4 / t", 2. / 4 / t},
               {"2 / 4 * t", 2. / 4 * t},
               {"-t^2", -(t * t)},
               {"(-t)^2", t * t},
               {"2^-t", pow(2, -t)},
               {"2^3^2", 512},
               {"-2^-2", -0.25},
               {"2 * -t", -2 * t},
               {"- - + t", t},
               {"--t--t", 2 * t},
               {"((((t))))", t},
               {".5e1 + 2.E-1 + 1e+2", 105.2},
               {"2.5\t*\n t", 2.5 * t},
               {"pi*t", 3.141592653589793 * t},
               {"exp (1) ^ 2", exp(2)},
               {"sqrt(abs(-16))", 4},
               {"t^(1/2 + 1/2)", t},
               {"t^(sin(0) + 3)", t * t * t},
               {"1e-400 + t", t},
               {"8^(1/3)", 2},
               {"1 + step(0.5)", 2},
               {"step(step(t)) + sign(step(t - 2)) + (if step(t - 1) > 0 then 3 else 4)", 4},
               {"if t < 1 then 5 elseif not t < 1.5 and t <= 2 then 6 else 7", 6},
               {"sum(k in 1:3: t^k/k)", t + t * t / 2 + t * t * t / 3},
               {"noevent(if t^2 > 3 then 1 else 2)", 1},
               {"ramp(t^2 - 3) + floor(2.5) + mod(7, 4)", 5.0625},
               {"hypot(3, 4*t/1.75) + atan2(0, -1) - pi + cbrt(27) + log10(1000)", 11}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    steif_function *f = steif_function_parse(ctx, cases[i].text, 1, NULL);
    if (!f) printf("\n  %s", steif_message(ctx));
    CLOSE(ask(ctx, f, 1, 0, t, 0), cases[i].value, 4e-16);
    steif_function_free(&f);
  }
  steif_context_free(&ctx);
}

static void what_cannot_be_read_is_rejected_with_its_place(void)
{
  static const struct {
    const char *text;
    int code;
    const char *place, *words;
  } cases[] = {
    {"2 +", STEIF_BAD_INPUT, "position 4",
     "expected an expression, found the end of the expression"},
    {"2 * * t", STEIF_BAD_INPUT, "position 5", "expected an expression, found '*'"},
    {"(2 + t", STEIF_BAD_INPUT, "position 7",
     "expected ')' or an operator, found the end of the expression"},
    {"2 + t)", STEIF_BAD_INPUT, "position 6",
     "an operator or the end of the expression, found ')'"},
    {"2 t", STEIF_BAD_INPUT, "position 3",
     "an operator or the end of the expression, found 't'"},
    {"sin t", STEIF_BAD_INPUT, "position 5",
     "an operator or the end of the expression, found 't'"},
    {"sin(t, 2)", STEIF_BAD_INPUT, "position 1", "'sin' takes 1 argument, got 2"},
    {"sine(t)", STEIF_UNKNOWN_NAME, "position 1", "unknown name 'sine'; did you mean 'sin'?"},
    {"3*T", STEIF_UNKNOWN_NAME, "position 3", "unknown name 'T'; did you mean 't'?"},
    {"expt(t)", STEIF_UNKNOWN_NAME, "position 1", "did you mean 'exp'?"},
    {"x", STEIF_UNKNOWN_NAME, "position 1", "unknown name 'x'"},
    {"0x10", STEIF_BAD_INPUT, "position 1", "a hexadecimal number"},
    {"1.2.3", STEIF_BAD_INPUT, "position 4", "found '.3'"},
    {". + t", STEIF_BAD_INPUT, "position 1", "a '.' without digits"},
    {"t + 1e400", STEIF_BAD_INPUT, "position 5", "beyond 1.8e308"},
    {"t & 2", STEIF_BAD_INPUT, "position 3", "'&': write 'and'"},
    {"t ** 2", STEIF_BAD_INPUT, "position 3", "'**': a power is written ^"},
    {"()", STEIF_BAD_INPUT, "position 2", "found ')'"},
    {"\xff", STEIF_BAD_INPUT, "position 1", "bytes that are not UTF-8"},
    {"t^(1/0)", STEIF_NOT_FINITE, "position 5", "a constant that is not finite"},
    {"t^exp(1000)", STEIF_NOT_FINITE, "position", "not finite"},
    {"step(2*sin(t))", STEIF_BAD_INPUT, "position 1", "expected t - c"},
    {"step(t - t)", STEIF_BAD_INPUT, "position 1", "expected t - c"},
    {"sign(t^2 - 1)", STEIF_BAD_INPUT, "position 1", "expected t - c"},
    {"if t^2 < 1 then t else 1", STEIF_BAD_INPUT, "position 8", "expected t - c"},
    {"if t then 1 else 2", STEIF_BAD_INPUT, "position 6", "expected a condition"},
    {"floor(2*t)", STEIF_BAD_INPUT, "position 1", "'floor' of t jumps without end"},
    {"1 + mod(t, 2)", STEIF_BAD_INPUT, "position 5", "'mod' of t jumps without end"},
    {"ln(t)", STEIF_UNKNOWN_NAME, "position 1", "'ln' is written log"},
    {"sum(k in 1:2: x*k)", STEIF_UNKNOWN_NAME, "position 15", "unknown name 'x'"},
    {"step(1/t)", STEIF_BAD_INPUT, "position 1", "expected t - c"},
    {"step(1e-300*(t - 1e300)*1e-300)", STEIF_BAD_INPUT, "position 1", "expected t - c"},
  };
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    steif_forget(ctx);
    steif_function *f = steif_function_parse(ctx, cases[i].text, 1, NULL);
    if (f) printf("\n  accepted: %s", cases[i].text);
    CHECK(!f && steif_status(ctx) == cases[i].code);
    SAYS(ctx, "expression 1");
    SAYS(ctx, cases[i].place);
    SAYS(ctx, cases[i].words);
    steif_function_free(&f);
  }
  steif_context_free(&ctx);
}

static void nesting_is_bounded(void)
{
  static char text[40000];
  static const char *const openings[] = {"(", "-", "sin(", "2^", "1+("};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 5; i++) {
    *text = 0;
    for (int k = 0; k < 5000; k++) strcat(text, openings[i]);
    CHECK(!steif_function_parse(ctx, text, 1, NULL));
    SAYS(ctx, "nested more than 200 deep; simplify it");
  }
  memset(text, 0, sizeof text);
  for (int k = 0; k < 5000; k++) strcpy(text + 2 * k, "1+");
  strcpy(text + 10000, "t");
  steif_function *f = steif_function_parse(ctx, text, 1, NULL);
  CHECK(ask(ctx, f, 1, 0, 0.75, 0) == 5000.75);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_grammar[] = {
  {"precedence is that of mathematics", precedence_is_that_of_mathematics},
  {"what cannot be read is rejected with its place",
   what_cannot_be_read_is_rejected_with_its_place},
  {"nesting is bounded, length is not", nesting_is_bounded},
  CU_TEST_INFO_NULL};
