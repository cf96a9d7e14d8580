/* A report as JSON, CSV and table. SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <stdlib.h>

static char text[TEXT];

static void json_comes_back(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  json_t *root = json_loads(written(r, STEIF_JSON, text), 0, NULL);
  CU_ASSERT_PTR_NOT_NULL_FATAL(root);
  CHECK(json_real_value(json_object_get(root, "t")) == 0.1);
  CHECK(json_is_null(json_object_get(root, "scd")));
  CHECK(json_is_true(json_object_get(root, "a_stable")));
  const json_t *y = json_object_get(root, "y"), *b = json_object_get(root, "boundary");
  CHECK(json_real_value(json_array_get(y, 0)) == 2.385);
  CHECK(json_array_size(b) == 3);
  CHECK(json_real_value(json_array_get(json_array_get(b, 2), 1)) == 6.75);
  const json_t *stats = json_object_get(root, "stats"), *rows = json_object_get(root, "rows");
  CHECK(json_integer_value(json_object_get(stats, "steps")) == 417);
  CHECK(json_array_size(rows) == 2);
  CHECK(json_real_value(json_object_get(json_array_get(rows, 1), "h")) == 0.25);
  CHECK(!strcmp(json_string_value(json_object_get(json_array_get(rows, 0), "verdict")),
                "say \"yes\", or no"));
  json_decref(root);
  steif_report_free(&r), steif_context_free(&ctx);
}

static void json_is_one_line_of_17_digits(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  written(r, STEIF_JSON, text);
  CHECK(strchr(text, '\n') == text + strlen(text) - 1);
  CHECK(strstr(text, "\"t\":0.10000000000000001,"));
  CHECK(strstr(text, "\"y\":[2.3849999999999998,\"nan\",\"-inf\"]"));
  CHECK(strstr(text, "\"bound\":\"inf\""));
  steif_report_free(&r), steif_context_free(&ctx);
}

static void csv_is_the_first_sheet(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  CU_ASSERT_STRING_EQUAL(written(r, STEIF_CSV, text),
                         "h,verdict,order,x1,x2,x3\n"
                         "0.5,\"say \"\"yes\"\", or no\",,,,\n"
                         "0.25,,nan,2.3849999999999998,nan,-inf\n");
  steif_report_free(&r), steif_context_free(&ctx);
}

static void csv_without_sheet_is_one_row(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  steif_report_text(r, "method", "radau:s=3");
  steif_report_real(r, "stats.cpu_s", 0.7);
  steif_report_text(r, "none", NULL);
  steif_report_truth(r, "good", 0);
  CU_ASSERT_STRING_EQUAL(
    written(r, STEIF_CSV, text),
    "method,stats.cpu_s,none,good\nradau:s=3,0.69999999999999996,,false\n");
  steif_report_free(&r), steif_context_free(&ctx);
}

/* Where the word begins in its line. */
static size_t column(const char *word)
{
  const char *at = strstr(text, word), *start = at;
  CU_ASSERT_PTR_NOT_NULL_FATAL(at);
  while (start > text && start[-1] != '\n') start--;
  return (size_t)(at - start);
}

static void table_columns_are_aligned(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  static const char *const method[] = {"bdf:p=2", "dirk:alexander2"};
  static const double error[] = {1.23456789e-3, 9.87654321e-11};
  steif_report_text(r, "problem", "vdpol");
  steif_report_text(r, "scd", NULL);
  for (int i = 0; i < 2; i++) {
    steif_report_row(r, "rows");
    steif_report_text(r, "rows.method", method[i]);
    steif_report_real(r, "rows.error", error[i]);
    steif_report_whole(r, "rows.steps", i ? 12345 : 67);
    steif_report_text(r, "rows.message", i ? "the step fell below 2.5e-9" : "ok");
  }
  written(r, STEIF_TABLE, text);
  CHECK(column("vdpol") == column("-\n"));
  CHECK(column("1.2346e-03") == column("9.8765e-11"));
  CHECK(column("67\n") + 2 == column("12345\n") + 5);
  CHECK(column("steps") == column("12345"));
  CHECK(strstr(text, "dirk:alexander2: the step fell below 2.5e-9"));
  CHECK(!strstr(text, "ok"));
  steif_report_free(&r), steif_context_free(&ctx);
}

static void table_shortens_long_lists_only(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  sunrealtype many[806];
  for (int i = 0; i < 806; i++) many[i] = 0.37 * i;
  steif_report_list(r, "many", 806, many);
  steif_report_matrix(r, "boundary", 403, 2, many);
  written(r, STEIF_TABLE, text);
  CHECK(strstr(text, "(806 in all)"));
  CHECK(strstr(text, "403 rows of 2 numbers"));
  CHECK(strlen(text) < 400);
  json_t *root = json_loads(written(r, STEIF_JSON, text), 0, NULL);
  CHECK(json_array_size(json_object_get(root, "many")) == 806);
  CHECK(json_array_size(json_object_get(root, "boundary")) == 403);
  json_decref(root);
  steif_report_free(&r), steif_context_free(&ctx);
}

static void bytes_that_are_no_text_do_no_harm(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  steif_report_text(r, "message", "no method \"\xff\xfe\" here");
  json_t *root = json_loads(written(r, STEIF_JSON, text), 0, NULL);
  CHECK(root &&
        !strcmp(json_string_value(json_object_get(root, "message")), "no method \"??\" here"));
  json_decref(root);
  steif_report_free(&r), steif_context_free(&ctx);
}

static void mistakes_are_kept_and_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  steif_report_real(r, "h", 0.25);
  steif_report_real(r, "h.inner", 0.125);
  steif_report_real(r, "later", 2.5);
  CHECK(steif_report_write(r, STEIF_JSON, stdout) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "h.inner"));
  steif_report_free(&r);
  r = steif_report_new(ctx);
  steif_report_whole(r, "rows", 3);
  steif_report_row(r, "rows");
  CHECK(steif_report_write(r, STEIF_TABLE, stdout) == STEIF_BAD_INPUT);
  steif_report_free(&r);
  CHECK(r == NULL);
  steif_report_free(&r);
  CHECK(steif_report_write(NULL, STEIF_JSON, stdout) == STEIF_NO_MEMORY);
  steif_context_free(&ctx);
}

static int left;
static void *meagre(size_t bytes, void *user)
{
  (void)user;
  return left-- > 0 ? malloc(bytes) : NULL;
}
static void release(void *block, void *user)
{
  (void)user;
  free(block);
}

static void memory_failure_is_told(void)
{
  const steif_setup setup = {.allocate = meagre, .release = release};
  left = 1;
  steif_context *ctx = steif_context_new(&setup);
  CU_ASSERT_PTR_NOT_NULL_FATAL(ctx);
  CHECK(steif_report_new(ctx) == NULL);
  CHECK(steif_status(ctx) == STEIF_NO_MEMORY);
  left = 1;
  steif_report *r = steif_report_new(ctx);
  CU_ASSERT_PTR_NOT_NULL_FATAL(r);
  steif_report_text(r, "broken", "\xfe\xdc");
  CHECK(steif_report_write(r, STEIF_JSON, stdout) == STEIF_NO_MEMORY);
  steif_report_free(&r), steif_context_free(&ctx);
}

CU_TestInfo tests_of_forms[] = {
  {"JSON comes back with every value", json_comes_back},
  {"JSON is one line with 17 digits and named infinities", json_is_one_line_of_17_digits},
  {"CSV is the first sheet, lists spread over columns", csv_is_the_first_sheet},
  {"CSV without a sheet is one row", csv_without_sheet_is_one_row},
  {"columns of a table are aligned", table_columns_are_aligned},
  {"long lists are shortened in tables and nowhere else", table_shortens_long_lists_only},
  {"bytes that are no UTF-8 become question marks", bytes_that_are_no_text_do_no_harm},
  {"the first mistake is kept and told", mistakes_are_kept_and_told},
  {"a failing allocator is told", memory_failure_is_told},
  CU_TEST_INFO_NULL};
