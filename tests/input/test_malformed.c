/* test_malformed.c: files that are no Matrix Market files: each is rejected with the file, the line
 * and what was expected.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <sys/stat.h>

#define HEAD "%%MatrixMarket matrix "
#define REAL HEAD "coordinate real general\n"

static const struct {
  const char *text;
  int code;
  const char *line, *words;
} bad[] = {
  {"", STEIF_BAD_INPUT, "bad.mtx is empty", "Matrix Market"},
  {"\n", STEIF_BAD_INPUT, "line 1", "expected '%%MatrixMarket"},
  {"3 3 3\n1 1 1\n", STEIF_BAD_INPUT, "line 1", "found '3 3 3'"},
  {"\x89PNG\r\n\x1a\n", STEIF_BAD_INPUT, "line 1", "found '?PNG'"},
  {"%%MatrixMarket", STEIF_BAD_INPUT, "line 1", "the word 'matrix', found the end of the line"},
  {"%%MatrixMarketmatrix coordinate\n", STEIF_BAD_INPUT, "line 1", "expected '%%MatrixMarket"},
  {HEAD "\n", STEIF_BAD_INPUT, "line 1", "expected 'coordinate' or 'array'"},
  {HEAD "elemental real general\n", STEIF_BAD_INPUT, "line 1", "found 'elemental real"},
  {HEAD "array float general\n", STEIF_BAD_INPUT, "line 1",
   "'real', 'integer' or 'pattern', found"},
  {HEAD "array real upper\n", STEIF_BAD_INPUT, "line 1", "'skew-symmetric', found 'upper'"},
  {HEAD "array real general now\n", STEIF_BAD_INPUT, "line 1", "end of the line, found 'now'"},
  {HEAD "array pattern general\n1 1\n", STEIF_BAD_INPUT, "line 1", "found 'pattern'"},
  {HEAD "coordinate pattern skew-symmetric\n", STEIF_BAD_INPUT, "line 1", "for a pattern"},
  {HEAD "coordinate complex general\n", STEIF_UNSUPPORTED, "line 1", "systems here are real"},
  {HEAD "array complex hermitian\n", STEIF_UNSUPPORTED, "line 1",
   "real and the imaginary parts"},
  {REAL, STEIF_BAD_INPUT, "line 1", "ends before its sizes"},
  {REAL "%only\n% comments\n", STEIF_BAD_INPUT, "line 3", "ends before its sizes"},
  {REAL "3 3\n1 1 1\n", STEIF_BAD_INPUT, "line 2", "expected the sizes 'rows columns entries'"},
  {REAL "3 3 1 1\n1 1 1\n", STEIF_BAD_INPUT, "line 2", "rows columns entries"},
  {REAL "3 -3 1\n1 1 1\n", STEIF_BAD_INPUT, "line 2", "found '3 -3 1'"},
  {REAL "0 3 0\n", STEIF_BAD_INPUT, "line 2", "rows columns entries"},
  {REAL "3 3.5 1\n1 1 1\n", STEIF_BAD_INPUT, "line 2", "rows columns entries"},
  {REAL "99999999999999999999 1 1\n1 1 1\n", STEIF_BAD_INPUT, "line 2", "rows columns entries"},
  {HEAD "array real general\n2 2 4\n1\n2\n3\n4\n", STEIF_BAD_INPUT, "line 2", "'rows columns'"},
  {HEAD "array real general\n9000000000 9000000000\n", STEIF_BAD_INPUT, "line 2", "too large"},
  {HEAD "coordinate real symmetric\n2 3 1\n1 1 1\n", STEIF_BAD_INPUT, "line 2", "of 2 x 3"},
  {REAL "3 3 2\n1 1 1\n", STEIF_BAD_INPUT, "line 3", "ends after 1 of 2 entries"},
  {REAL "3 3 2\n1 1 1\n\n\n", STEIF_BAD_INPUT, "line 5", "ends after 1 of 2 entries"},
  {HEAD "array real general\n2 2\n1\n2\n3\n", STEIF_BAD_INPUT, "line 5",
   "after 3 of 4 entries"},
  {REAL "3 3 1\n1 1 1\n2 2 2\n", STEIF_BAD_INPUT, "line 4",
   "end of the file after the last entry"},
  {REAL "3 3 1\n4 1 1\n", STEIF_BAD_INPUT, "line 3", "a row from 1 to 3, found '4 1 1'"},
  {REAL "3 3 1\n0 1 1\n", STEIF_BAD_INPUT, "line 3", "a row from 1 to 3"},
  {REAL "3 2 1\n1 3 1\n", STEIF_BAD_INPUT, "line 3", "a column from 1 to 2, found '3 1'"},
  {REAL "3 3 1\n1.5 1 1\n", STEIF_BAD_INPUT, "line 3", "a row from 1 to 3"},
  {REAL "3 3 1\n1 1\n", STEIF_BAD_INPUT, "line 3",
   "one number and the end of the line, found the end"},
  {REAL "3 3 1\n1 1 x\n", STEIF_BAD_INPUT, "line 3",
   "one number and the end of the line, found 'x'"},
  {REAL "3 3 1\n1 1 1.0D+3\n", STEIF_BAD_INPUT, "line 3", "found 'D+3'"},
  {REAL "3 3 1\n1 1 0x1p3\n", STEIF_BAD_INPUT, "line 3", "one number"},
  {REAL "3 3 1\n1 1 1 2\n", STEIF_BAD_INPUT, "line 3", "found '2'"},
  {REAL "3 3 1\n% late\n1 1 1\n", STEIF_BAD_INPUT, "line 3", "found '% late'"},
  {HEAD "coordinate pattern general\n3 3 1\n1 1 1\n", STEIF_BAD_INPUT, "line 3", "found '1'"},
  {HEAD "coordinate integer general\n3 3 1\n1 1 1.5\n", STEIF_BAD_INPUT, "line 3",
   "an integer"},
  {HEAD "array real general\n2 1\n1 2\n", STEIF_BAD_INPUT, "line 3", "found '2'"},
  {HEAD "coordinate real skew-symmetric\n3 3 1\n2 2 1\n", STEIF_BAD_INPUT, "line 3", "(2, 2)"},
  {HEAD "coordinate real symmetric\n3 3 3\n2 1 1\n1 1 4\n1 3 1\n", STEIF_BAD_INPUT, "line 5",
   "than that of line 3"},
  {REAL "3 3 2\n1 1 1\n2 3 nan\n", STEIF_NOT_FINITE, "line 4", "entry (2, 3) is"},
  {REAL "3 3 1\n3 1 -inf\n", STEIF_NOT_FINITE, "line 3", "entry (3, 1) is -inf"},
  {REAL "3 3 1\n3 1 1e999\n", STEIF_NOT_FINITE, "line 3", "entry (3, 1) is inf"},
  {HEAD "array real general\n2 2\n1\n2\n3\nnan\n", STEIF_NOT_FINITE, "line 6", "entry (2, 2)"},
  {HEAD "array real symmetric\n2 2\n1\n2\nnan\n", STEIF_NOT_FINITE, "line 5", "entry number 3"},
  {REAL "2 2 2\n1 2 9e307\n1 2 9.5e307\n", STEIF_NOT_FINITE, "entry (1, 2)", "finite"},
};

static void malformed_files_are_rejected_with_the_line(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    steif_forget(ctx);
    SUNMatrix M = steif_matrix_read(ctx, put("bad.mtx", bad[i].text));
    if (M) printf("\n  accepted: %s", bad[i].text);
    CHECK(!M);
    CHECK(steif_status(ctx) == bad[i].code);
    SAYS(ctx, "bad.mtx");
    SAYS(ctx, bad[i].line);
    SAYS(ctx, bad[i].words);
    if (M) SUNMatDestroy(M);
  }
  steif_context_free(&ctx);
}

/* A good file cut off anywhere: before its last digit it must not be read. */
static void truncated_files_are_rejected(void)
{
  static const char whole[] = REAL "3 3 3\n1 1 2.5\n2 2 3.25\n3 1 7.75\n";
  steif_context *ctx = steif_context_new(NULL);
  for (size_t size = 0; size + 5 < sizeof whole; size++) {
    steif_forget(ctx);
    CHECK(!steif_matrix_read(ctx, put_bytes("cut.mtx", whole, size)));
    SAYS(ctx, "cut.mtx");
  }
  steif_context_free(&ctx);
}

static void zero_bytes_and_long_lines_are_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  static const char zero[] = REAL "1 1 1\n1 1 4\0.5\n";
  char text[2600] = REAL;
  CHECK(!steif_matrix_read(ctx, put_bytes("zero.mtx", zero, sizeof zero - 1)));
  SAYS(ctx, "line 3");
  SAYS(ctx, "a zero byte");
  memset(text + strlen(text), '%', 2000);
  strcat(text, "\n1 1 1\n1 1 4\n");
  CHECK(!steif_matrix_read(ctx, put("long.mtx", text)));
  SAYS(ctx, "line 2: longer than 1000 characters");
  steif_context_free(&ctx);
}

static void what_is_no_file_is_rejected(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(!steif_matrix_read(ctx, in_folder("missing.mtx")) && steif_status(ctx) == STEIF_IO);
  SAYS(ctx, "missing.mtx': No such file");
  const char *folder = in_folder("folder.mtx");
  CHECK(!mkdir(folder, 0700));
  CHECK(!steif_matrix_read(ctx, folder) && steif_status(ctx) == STEIF_IO);
  SAYS(ctx, "folder.mtx': it is a directory");
  CHECK(!steif_matrix_read(ctx, "/dev/null") && steif_status(ctx) == STEIF_IO);
  SAYS(ctx, "a device");
  CHECK(!steif_matrix_read(ctx, "") && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(!steif_matrix_read(ctx, NULL) && steif_status(ctx) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_malformed[] = {
  {"malformed files are rejected with file, line and expectation",
   malformed_files_are_rejected_with_the_line},
  {"truncated files are rejected", truncated_files_are_rejected},
  {"zero bytes and long lines are rejected", zero_bytes_and_long_lines_are_rejected},
  {"missing files, folders and devices are rejected", what_is_no_file_is_rejected},
  CU_TEST_INFO_NULL};
