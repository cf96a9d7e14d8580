/* Output files are complete or not there. SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700
#include "fixture.h"
#include "folder.h"
#include <dirent.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char text[TEXT], folder[256];

static const char *inside(const char *name)
{
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void enter(void) { CU_ASSERT_PTR_NOT_NULL_FATAL(folder_make(folder, sizeof folder)); }

/* Remove the folder; how many files were in it. */
static int leave(void)
{
  DIR *dir = opendir(folder);
  int count = 0;
  for (struct dirent *e = readdir(dir); e; e = readdir(dir))
    if (*e->d_name != '.') {
      unlink(inside(e->d_name));
      count++;
    }
  closedir(dir);
  rmdir(folder);
  return count;
}

static void saved_file_is_complete(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  enter();
  CHECK(steif_report_save(r, STEIF_CSV, inside("rows.csv")) == STEIF_OK);
  CHECK(!strncmp(contents(inside("rows.csv"), text), "h,verdict,order,x1", 18));
  CHECK(steif_report_save(r, STEIF_JSON, inside("rows.csv")) == STEIF_OK);
  CHECK(*contents(inside("rows.csv"), text) == '{');
  CHECK(leave() == 1);
  steif_report_free(&r), steif_context_free(&ctx);
}

static void unwritable_path_leaves_nothing(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  enter();
  CHECK(steif_report_save(r, STEIF_CSV, inside("no/such/folder.csv")) == STEIF_IO);
  CHECK(strstr(steif_message(ctx), "no/such/folder.csv"));
  CHECK(steif_report_save(r, STEIF_CSV, folder) == STEIF_IO);
  CHECK(steif_report_save(r, STEIF_CSV, "") == STEIF_BAD_INPUT);
  CHECK(steif_report_save(r, STEIF_CSV, NULL) == STEIF_BAD_INPUT);
  CHECK(leave() == 0);
  steif_report_free(&r), steif_context_free(&ctx);
}

static void full_disk_is_told(void)
{
  struct stat info;
  if (stat("/dev/full", &info)) return;
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  CHECK(steif_report_save(r, STEIF_CSV, "/dev/full") == STEIF_IO);
  CHECK(steif_report_save(r, STEIF_JSON, "/dev/full") == STEIF_IO);
  CHECK(!stat("/dev/full", &info) && S_ISCHR(info.st_mode));
  steif_report_free(&r), steif_context_free(&ctx);
}

static void broken_report_keeps_the_old_file(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  enter();
  CHECK(steif_report_save(r, STEIF_JSON, inside("kept.json")) == STEIF_OK);
  steif_report_real(r, "problem.inner", 3.75);
  CHECK(steif_report_save(r, STEIF_JSON, inside("kept.json")) == STEIF_BAD_INPUT);
  CHECK(*contents(inside("kept.json"), text) == '{');
  CHECK(leave() == 1);
  steif_report_free(&r), steif_context_free(&ctx);
}

static void link_stays_a_link(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = mixed(ctx);
  struct stat info;
  char target[512];
  enter();
  CHECK(steif_report_save(r, STEIF_JSON, inside("real.json")) == STEIF_OK);
  CHECK(!chmod(inside("real.json"), 0640));
  strcpy(target, inside("real.json"));
  CHECK(!symlink(target, inside("link.json")));
  CHECK(steif_report_save(r, STEIF_CSV, inside("link.json")) == STEIF_OK);
  CHECK(!lstat(inside("link.json"), &info) && S_ISLNK(info.st_mode));
  CHECK(!strncmp(contents(target, text), "h,verdict", 9));
  CHECK(!stat(target, &info) && (info.st_mode & 0777) == 0640);
  CHECK(leave() == 2);
  steif_report_free(&r), steif_context_free(&ctx);
}

/* Whoever reads the file before the run is at its end, or after it was killed, has all rows so far. */
static void rows_are_there_as_they_come(void)
{
  static const char *const name[] = {"t", "a,b"};
  static const double row[3][2] = {{0, 1}, {0.1, 1e300 * 1e300}, {2, -3}};
  static const char *const line[] = {"t,\"a,b\"\n", "0,1\n", "0.10000000000000001,inf\n",
                                     "2,-3\n"};
  const char *path = "rows.csv";
  char expected[128] = "", found[128];
  steif_context *ctx = steif_context_new(NULL);
  steif_rows *r = steif_rows_new(ctx, path, 2, name);
  CU_ASSERT_FATAL(r != NULL);
  for (int k = 0; k < 4; k++) {
    if (k) CHECK(steif_rows_add(r, row[k - 1]) == STEIF_OK);
    strcat(expected, line[k]);
    FILE *file = fopen(path, "r");
    CU_ASSERT_FATAL(file != NULL);
    found[fread(found, 1, sizeof found - 1, file)] = 0;
    fclose(file);
    CHECK(!strcmp(found, expected));
  }
  CHECK(steif_rows_close(&r) == STEIF_OK && !r);
  remove(path);
  CHECK(!steif_rows_new(ctx, "no_such_folder/rows.csv", 2, name));
  CHECK(steif_status(ctx) == STEIF_IO && strstr(steif_message(ctx), "no_such_folder"));
  CHECK(!steif_rows_new(ctx, "", 2, name) && steif_status(ctx) == STEIF_BAD_INPUT);
  if ((r = steif_rows_new(ctx, "/dev/full", 2, name)))
    CHECK(steif_rows_add(r, row[0]) == STEIF_IO);
  CHECK(steif_status(ctx) == STEIF_IO);
  steif_rows_close(&r);
  CHECK(steif_rows_add(NULL, row[0]) == STEIF_NO_MEMORY && steif_rows_close(NULL) == STEIF_OK);
  steif_context_free(&ctx);
}

static void file_is(const char *path, const char *expected)
{
  char found[256];
  FILE *file = fopen(path, "r");
  CU_ASSERT_FATAL(file != NULL);
  found[fread(found, 1, sizeof found - 1, file)] = 0;
  fclose(file);
  CHECK(!strcmp(found, expected));
}

static void stream_is(FILE *stream, const char *expected)
{
  char found[512];
  fflush(stream), rewind(stream);
  found[fread(found, 1, sizeof found - 1, stream)] = 0;
  fseek(stream, 0, SEEK_END);
  CHECK(!strcmp(found, expected));
}

/* Rows of a report as they come: the file is at every moment what steif_report_save would write, and what has been
 * shown is not shown again. */
static void a_report_as_it_comes(void)
{
  const char *path = "flow.csv";
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  FILE *table = tmpfile();
  CU_ASSERT_FATAL(r && table);
  steif_report_text(r, "method", "be");
  CHECK(steif_report_flow(r, path, table) == STEIF_OK); /* no row has come */
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", 0.5), steif_report_text(r, "rows.status", "ok");
  CHECK(steif_report_flow(r, path, table) == STEIF_OK);
  file_is(path, "h,status\n0.5,ok\n");
  const char *first = "method  be\n\n           h  status\n         0.5  ok\n";
  stream_is(table, first);
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", -0.25), steif_report_text(r, "rows.status", "no");
  steif_report_text(r, "rows.message", "stopped");
  CHECK(steif_report_flow(r, path, table) == STEIF_OK); /* a column more */
  file_is(path, "h,status,message\n0.5,ok,\n-0.25,no,stopped\n");
  steif_report_whole(r, "count", 2);
  CHECK(steif_report_write(r, STEIF_TABLE, table) == STEIF_OK);
  CHECK(steif_report_save(r, STEIF_CSV, path) == STEIF_OK);
  file_is(path, "h,status,message\n0.5,ok,\n-0.25,no,stopped\n");
  char all[512];
  snprintf(all, sizeof all, "%s       -0.25  no\n  -0.25: stopped\n\ncount   2\n", first);
  stream_is(table, all);
  fclose(table);
  remove(path);
  steif_report_free(&r);
  r = steif_report_new(ctx);
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", 1);
  CHECK(steif_report_flow(r, "no_such_folder/rows.csv", NULL) == STEIF_IO);
  CHECK(steif_report_flow(r, "/dev/full", NULL) == STEIF_OK); /* a device is left to the end */
  CHECK(steif_report_flow(NULL, path, NULL) == STEIF_NO_MEMORY);
  steif_report_free(&r);
  steif_context_free(&ctx);
}

/* The names and, one after the other, the numbers stand in the file, behind the signature of HDF5. */
static void arrays_as_hdf5(void)
{
  enum { ROOM = 20000 };
  static const double t[] = {0.1, 0.2, 0.7}, y[] = {1.5, -2.25, 3, 4, 1e300, 6};
  static const char *const names[] = {"position", "speed"};
  static const steif_array array[] = {{"t", 3, 0, t, NULL},
                                      {"solution", 3, 2, y, NULL},
                                      {"none", 0, 0, t, NULL},
                                      {.name = "names", .rows = 2, .text = names}};
  static char file[ROOM];
  steif_context *ctx = steif_context_new(NULL);
  enter();
  const int code = steif_h5_save(ctx, inside("run.h5"), 4, array);
  if (code == STEIF_UNSUPPORTED) {
    CHECK(!!strstr(steif_message(ctx), "libhdf5"));
    CHECK(leave() == 0);
  } else {
    CHECK(code == STEIF_OK);
    FILE *stream = fopen(inside("run.h5"), "rb");
    CU_ASSERT_FATAL(stream != NULL);
    const size_t bytes = fread(file, 1, ROOM, stream);
    fclose(stream);
    CHECK(bytes > 8 && !memcmp(file, "\211HDF\r\n\032\n", 8));
    int found[5] = {0};
    for (size_t i = 0; i + sizeof y <= bytes; i++) {
      found[0] += !memcmp(file + i, t, sizeof t);
      found[1] += !memcmp(file + i, y, sizeof y);
      found[2] += !memcmp(file + i, "solution", sizeof "solution");
      found[4] += !memcmp(file + i, "position\0speed", sizeof "position\0speed");
      found[3] += !memcmp(file + i, "none", sizeof "none");
    }
    for (int i = 0; i < 5; i++) CHECK(found[i] >= 1);
    CHECK(steif_h5_save(ctx, inside("no/such/run.h5"), 4, array) == STEIF_IO);
    CHECK(!!strstr(steif_message(ctx), "no/such/run.h5"));
    CHECK(leave() == 1);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_files[] = {
  {"rows are there as they come", rows_are_there_as_they_come},
  {"a report as it comes", a_report_as_it_comes},
  {"a saved file is complete and replaces the old one", saved_file_is_complete},
  {"an unwritable path leaves nothing", unwritable_path_leaves_nothing},
  {"a full disk is told, a device stays a device", full_disk_is_told},
  {"a broken report keeps the old file", broken_report_keeps_the_old_file},
  {"a link stays a link, permissions stay", link_stays_a_link},
  {"arrays as HDF5", arrays_as_hdf5},
  CU_TEST_INFO_NULL};
