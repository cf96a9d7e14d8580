/* test_measurements.c: files of measurements, good and bad.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "folder.h"
#include "made_data.h"
#include "suite.h"
#include <string.h>

static int read_text(steif_context *ctx, const char *text, int count, const double *sd,
                     steif_measurements *data)
{
  char folder[256], path[300];
  prey P;
  prey_open(&P, 1, 1, 1, 1);
  CHECK(folder_make(folder, sizeof folder) != NULL);
  snprintf(path, sizeof path, "%s/data.csv", folder);
  FILE *file = fopen(path, "w");
  fputs(text, file);
  fclose(file);
  const int code = steif_measurements_read(ctx, &P.problem, path, 0, 0, count, sd, data);
  remove(path);
  remove(folder);
  return code;
}

static void a_good_file(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_measurements d;
  const double sd[] = {0.5, 2};
  CHECK(!read_text(ctx, "# made\n\nt, y2 ,\"y1\"\n0,3,NA\n 1.5 ,,-4e-1\r\n2,5,6", 2, sd, &d));
  CHECK(d.count == 4 && d.sd);
  if (d.count == 4) {
    CHECK(d.t[0] == 0 && d.component[0] == 1 && d.value[0] == 3 && d.sd[0] == 0.5);
    CHECK(d.t[1] == 1.5 && d.component[1] == 0 && d.value[1] == -0.4 && d.sd[1] == 2);
    CHECK(d.t[3] == 2 && d.component[3] == 0 && d.value[3] == 6 && d.sd[3] == 2);
  }
  steif_measurements_free(ctx, &d);
  CHECK(!read_text(ctx, "t,sd_y1,y1\n0,0.25,1\n1,,\n2,0.75,2\n", 0, NULL, &d));
  CHECK(d.count == 2 && d.sd && d.sd[0] == 0.25 && d.sd[1] == 0.75 && d.value[1] == 2);
  steif_measurements_free(ctx, &d);
  CHECK(!read_text(ctx, "\xEF\xBB\xBFt,y1\r\n0,1\r\n2,5\r\n", 0, NULL, &d)); /* Excel */
  CHECK(d.count == 2 && d.t[1] == 2 && d.value[1] == 5);
  steif_measurements_free(ctx, &d);
  CHECK(!read_text(ctx, "t,y1\n0,1\n", 0, NULL, &d) && !d.sd);
  steif_measurements_free(ctx, &d);
  CHECK(!d.t);
  steif_context_free(&ctx);
}

static void bad_files_are_told(void)
{
  static const double minus[] = {-1}, three[] = {1, 1, 1};
  static const struct {
    const char *text, *part;
    int code, count;
    const double *sd;
  } bad[] = {
    {"time,y1\n0,1\n", "line 1, column 1: the first line is 't'", STEIF_BAD_INPUT, 0, NULL},
    {"t\n0\n", "no columns but t", STEIF_BAD_INPUT, 0, NULL},
    {"t,y3\n0,1\n", "line 1, column 2: problem 'prey' has no unknown or output 'y3'",
     STEIF_UNKNOWN_NAME, 0, NULL},
    {"t,yy1\n0,1\n", "the nearest is 'y1'", STEIF_UNKNOWN_NAME, 0, NULL},
    {"t,y1,y1\n0,1,2\n", "line 1, column 3: 'y1' stands in column 2 too", STEIF_BAD_INPUT, 0,
     NULL},
    {"t,y1,sd_y2\n0,1,2\n", "of a column that is not there", STEIF_BAD_INPUT, 0, NULL},
    {"t,y1,sd_y1,y2\n0,1,2,3\n", "has no standard deviations, and others have", STEIF_BAD_INPUT,
     0, NULL},
    {"t,y1\n0,1\n2,1\n1,1\n", "line 4, column 1: t = 1 comes after 2 in line 3; sort",
     STEIF_BAD_INPUT, 0, NULL},
    {"t,y1\n0,1\n2,1\n2,1\n", "line 4, column 1: t = 2 stands in line 3 too", STEIF_BAD_INPUT,
     0, NULL},
    {"t,y1\n0,1\n11,1\n", "line 3, column 1: t = 11 lies outside the interval [0, 10]",
     STEIF_BAD_INPUT, 0, NULL},
    {"t,y1\n-1,1\n", "lies outside", STEIF_BAD_INPUT, 0, NULL},
    {"t,y1\n0,nan\n", "line 2, column 2: nan is not finite", STEIF_NOT_FINITE, 0, NULL},
    {"t,y1\nNaN,1\n", "line 2, column 1: NaN is not finite", STEIF_NOT_FINITE, 0, NULL},
    {"t,y1\n0,1e999\n", "is not finite", STEIF_NOT_FINITE, 0, NULL},
    {"t,y1\n0,1.5x\n", "line 2, column 2: '1.5x' is not a number", STEIF_BAD_INPUT, 0, NULL},
    {"t,y1\n,1\n", "line 2, column 1: '' is not a number", STEIF_BAD_INPUT, 0, NULL},
    {"t,y1\n0,1,2\n", "line 2, column 3: the first line names 2 columns", STEIF_BAD_INPUT, 0,
     NULL},
    {"t,y1,y2\n0,1\n", "line 2, column 3: the row ends", STEIF_BAD_INPUT, 0, NULL},
    {"t,y1,sd_y1\n0,1,0\n", "line 2, column 3: the standard deviation 0 must be positive",
     STEIF_BAD_INPUT, 0, NULL},
    {"t,y1,sd_y1\n0,1,\n", "line 2, column 3: '' is not a number", STEIF_BAD_INPUT, 0, NULL},
    {"t,y1\n0,1\n", "deviation -1 of column 2", STEIF_BAD_INPUT, 1, minus},
    {"t,y1\n0,1\n", "3 standard deviations for 1 columns", STEIF_BAD_INPUT, 3, three},
    {"t,y1\n", "has no measurements", STEIF_BAD_INPUT, 0, NULL},
    {"", "has no measurements", STEIF_BAD_INPUT, 0, NULL}};
  steif_context *ctx = steif_context_new(NULL);
  steif_measurements d;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    CHECK(read_text(ctx, bad[i].text, bad[i].count, bad[i].sd, &d) == bad[i].code);
    const int said = strstr(steif_message(ctx), bad[i].part) != NULL;
    if (!said) printf("\n  no '%s' in '%s'", bad[i].part, steif_message(ctx));
    CHECK(said && !d.t);
  }
  CHECK(steif_measurements_read(ctx, &(steif_problem){.n = 1}, "/no/such.csv", 0, 0, 0, NULL,
                                &d) == STEIF_IO);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_measurements[] = {
  {"a good file", a_good_file}, {"bad files are told", bad_files_are_told}, CU_TEST_INFO_NULL};
