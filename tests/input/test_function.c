/* test_function.c: functions of several components: files, texts, B u(t), breakpoints.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

static const char three[] = "# the load\n"
                            "sin(3*t) + 2*exp(-t)   # component 1\n"
                            "\n"
                            "step(t - 0.5) * t^2\r\n"
                            "0";

static void a_file_has_one_line_for_each_component(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_read(ctx, put("three.txt", three), 3, NULL);
  if (!f) printf("\n  %s", steif_message(ctx));
  CLOSE(ask(ctx, f, 3, 0, 0.25, 0), sin(0.75) + 2 * exp(-0.25), 1e-15);
  CLOSE(ask(ctx, f, 3, 0, 0.25, 3), -27 * cos(0.75) - 2 * exp(-0.25), 1e-15);
  CHECK(ask(ctx, f, 3, 1, 0.25, 0) == 0);
  CHECK(ask(ctx, f, 3, 1, 1.5, 0) == 2.25 && ask(ctx, f, 3, 1, 1.5, 2) == 2);
  CHECK(ask(ctx, f, 3, 2, 1.5, 0) == 0);
  steif_function_free(&f);
  CHECK(!f);
  steif_function_free(&f);
  steif_function_free(NULL);
  steif_context_free(&ctx);
}

static void the_count_of_expressions_is_checked(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(!steif_function_read(ctx, put("few.txt", three), 4, NULL));
  SAYS(ctx, "few.txt ends at line 5 after 3 of 4 expressions");
  CHECK(!steif_function_read(ctx, put("many.txt", three), 2, NULL));
  SAYS(ctx, "many.txt, line 5: more than 2 expressions");
  CHECK(!steif_function_read(ctx, put("wrong.txt", "t\n2*t\n\nt +* 4\n"), 3, NULL));
  SAYS(ctx, "wrong.txt:4:4: expected");
  CHECK(
    !steif_function_read(ctx, put("open.txt", "(t +\n2)\n"), 1, NULL)); /* a line is whole */
  SAYS(ctx, "open.txt:1:5: expected an expression, found the end of the line");
  CHECK(!steif_function_parse(ctx, "2 +; t", 1, NULL));
  SAYS(ctx, "expression 1, position 4: expected an expression");
  CHECK(!steif_function_read(ctx, put("none.txt", ""), 1, NULL));
  SAYS(ctx, "none.txt ends at line 0 after 0 of 1");
  CHECK(!steif_function_parse(ctx, "t; 2*t", 3, NULL));
  SAYS(ctx, "the text ends at expression 2 after 2 of 3");
  CHECK(!steif_function_parse(ctx, "t; 2*t", 1, NULL));
  SAYS(ctx, "the text, expression 2: more than 1");
  CHECK(!steif_function_parse(ctx, "t;; 2*t", 3, NULL));
  SAYS(ctx, "expression 2, position 1");
  CHECK(!steif_function_parse(ctx, "t", 0, NULL) && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(!steif_function_parse(ctx, NULL, 1, NULL) && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(!steif_function_read(ctx, in_folder("gone.txt"), 1, NULL));
  CHECK(steif_status(ctx) == STEIF_IO);
  CHECK(!steif_function_read(ctx, put_bytes("zero.txt", "t\nt*\0 2\n", 8), 2, NULL));
  SAYS(ctx, "zero.txt, line 2: a zero byte");
  steif_context_free(&ctx);
}

static void a_text_may_end_with_a_semicolon(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(ctx, "t; 2.5*t ;\n", 2, NULL);
  CHECK(ask(ctx, f, 2, 1, 3, 0) == 7.5);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

/* B = [2.5 0; -1 4; 0 0.125], u = (t^2, cos t). */
static void multiplies(SUNMatrix B, steif_context *ctx)
{
  steif_function *f = steif_function_parse(ctx, "t^2; cos(t)", 3, B);
  SUNMatDestroy(B);
  const double t = 0.7;
  CLOSE(ask(ctx, f, 3, 0, t, 0), 2.5 * t * t, 1e-15);
  CLOSE(ask(ctx, f, 3, 1, t, 0), -t * t + 4 * cos(t), 1e-15);
  CLOSE(ask(ctx, f, 3, 1, t, 1), -2 * t - 4 * sin(t), 1e-15);
  CLOSE(ask(ctx, f, 3, 2, t, 3), 0.125 * sin(t), 1e-15);
  steif_function_free(&f);
}

static void inputs_go_through_B(void)
{
  steif_context *ctx = steif_context_new(NULL);
  multiplies(
    steif_matrix_read(ctx, put("B.mtx", "%%MatrixMarket matrix coordinate real general\n"
                                        "3 2 4\n1 1 2.5\n2 1 -1\n2 2 4\n3 2 0.125\n")),
    ctx);
  SUNMatrix B = SUNDenseMatrix(3, 2, steif_sundials(ctx));
  memcpy(SM_DATA_D(B), (const double[]){2.5, -1, 0, 0, 4, 0.125}, 6 * sizeof(double));
  CHECK(!steif_function_parse(ctx, "t; t", 4, B));
  SAYS(ctx, "B has 3 rows and f has 4 components");
  CHECK(!steif_function_parse(ctx, "t; t; t", 3, B));
  SAYS(ctx, "more than 2 expressions");
  multiplies(B, ctx);
  B = SUNDenseMatrix(1, 1, steif_sundials(ctx));
  SM_ELEMENT_D(B, 0, 0) = INFINITY;
  CHECK(!steif_function_parse(ctx, "t", 1, B) && steif_status(ctx) == STEIF_NOT_FINITE);
  SUNMatDestroy(B);
  steif_context_free(&ctx);
}

static void breakpoints_of_all_expressions_are_collected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(
    ctx,
    "step(t - 2.5) - step(t - 0.75); t*ramp(t - 1/3) + sin(step(t-2.5)); step(4 - 2*t); "
    "ramp(t + 3)^step(t - 9)",
    4, NULL);
  double times[8] = {0};
  CHECK(f && steif_function_breaks(f, 0, 5, 8, times) == 4);
  CHECK(times[0] == 1. / 3 && times[1] == 0.75 && times[2] == 2 && times[3] == 2.5);
  CHECK(steif_function_breaks(f, -10, 10, 8, times) == 6 && times[0] == -3 && times[5] == 9);
  CHECK(steif_function_breaks(f, 0.75, 2.5, 8, times) == 1 && times[0] == 2);
  times[1] = -8.5;
  CHECK(steif_function_breaks(f, 0, 5, 1, times) == 4 && times[0] == 1. / 3 &&
        times[1] == -8.5);
  CHECK(steif_function_breaks(f, 0, 5, 0, NULL) == 4);
  CHECK(steif_function_breaks(NULL, 0, 5, 8, times) == 0);
  steif_function_free(&f);
  f = steif_function_parse(ctx, "t^2", 1, NULL);
  CHECK(f && steif_function_breaks(f, -1e9, 1e9, 8, times) == 0);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

static void values_at_breakpoints_are_right_limits(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const double c = 0.1 + 0.2, before = nextafter(c, 0);
  steif_function *f = steif_function_parse(
    ctx,
    "step(t - (0.1 + 0.2))*cos(t); ramp(t - (0.1 + 0.2)); step(0.6 - 2*t); ramp(2*(1.25 - t))",
    4, NULL);
  CLOSE(ask(ctx, f, 4, 0, c, 0), cos(c), 1e-15);
  CLOSE(ask(ctx, f, 4, 0, c, 1), -sin(c), 1e-15);
  CHECK(ask(ctx, f, 4, 0, before, 0) == 0 && ask(ctx, f, 4, 0, before, 1) == 0);
  CHECK(ask(ctx, f, 4, 1, c, 0) == 0 && ask(ctx, f, 4, 1, c, 1) == 1);
  CHECK(ask(ctx, f, 4, 1, before, 1) == 0 && ask(ctx, f, 4, 1, c + 2.5, 0) == 2.5);
  double time;
  CHECK(f && steif_function_breaks(f, 0.25, 0.35, 1, &time) == 2);
  CHECK(ask(ctx, f, 4, 2, 0.29, 0) == 1 && ask(ctx, f, 4, 2, 0.3, 0) == 0);
  CHECK(ask(ctx, f, 4, 3, 1, 0) == 0.5 && ask(ctx, f, 4, 3, 1, 1) == -2);
  CHECK(ask(ctx, f, 4, 3, 1.25, 1) == 0 && ask(ctx, f, 4, 3, 1.5, 0) == 0);
  steif_function_free(&f);
  /* 3 t - 0.3 is rounded to 5.6e-17 at the break of the first, 3 t - 2.1 to -4.4e-16 there: t itself decides. */
  f = steif_function_parse(ctx,
                           "step(3*t - 0.3); step(3*t - 2.1); if 3*t < 2.1 then t else 2; "
                           "sign(7*t - 4.9); abs(3*t - 2.1)",
                           5, NULL);
  double at[8];
  const size_t count = steif_function_breaks(f, 0, 5, 8, at);
  CHECK(count >= 2);
  for (size_t k = 0; k < count && count <= 8; k++) {
    const bool first = at[k] < .5;
    CHECK(ask(ctx, f, 5, 0, at[k], 0) == 1 && ask(ctx, f, 5, 0, nextafter(at[0], 0), 0) == 0);
    CHECK(ask(ctx, f, 5, 4, at[k], 1) == (first ? -3 : 3));
  }
  for (int k = 1; k < 4;
       k++) { /* each jumps at one of the breaks, between it and the number before */
    int jumps = 0;
    for (size_t i = 0; i < count; i++)
      jumps += ask(ctx, f, 5, k, at[i], 0) != ask(ctx, f, 5, k, nextafter(at[i], 0), 0) &&
               fabs(at[i] - .7) < 1e-15;
    CHECK(jumps >= 1);
  }
  steif_function_free(&f);
  steif_context_free(&ctx);
}

static void the_vector_is_checked(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(ctx, "t; 1", 2, NULL);
  N_Vector g = N_VNew_Serial(3, steif_sundials(ctx));
  CHECK(steif_function_value(0.5, 0, g, f) == STEIF_BAD_INPUT);
  SAYS(ctx, "a vector of 2 components in host memory is needed, got 3");
  CHECK(steif_function_value(0.5, 0, NULL, f) < 0 && steif_function_value(0.5, 0, g, NULL) < 0);
  N_VDestroy(g);
  steif_function_free(&f);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_function[] = {
  {"a file has one line for each component", a_file_has_one_line_for_each_component},
  {"the count of expressions is checked", the_count_of_expressions_is_checked},
  {"a text may end with a semicolon", a_text_may_end_with_a_semicolon},
  {"inputs go through B, dense or sparse", inputs_go_through_B},
  {"breakpoints of all expressions are collected",
   breakpoints_of_all_expressions_are_collected},
  {"values at breakpoints are right limits", values_at_breakpoints_are_right_limits},
  {"the vector to fill is checked", the_vector_is_checked},
  CU_TEST_INFO_NULL};
