/* Arrays for numpy: the archive as zip readers and numpy read it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include "folder.h"
#include <math.h>
#include <stdint.h>
#include <unistd.h>

static unsigned char file[1 << 16];
static char folder[256], path[512];

static size_t saved(steif_context *ctx, size_t count, const steif_array *array)
{
  CU_ASSERT_PTR_NOT_NULL_FATAL(folder_make(folder, sizeof folder));
  snprintf(path, sizeof path, "%s/a.npz", folder);
  CHECK(steif_npz_save(ctx, path, count, array) == STEIF_OK);
  FILE *stream = fopen(path, "rb");
  CU_ASSERT_PTR_NOT_NULL_FATAL(stream);
  const size_t bytes = fread(file, 1, sizeof file, stream);
  fclose(stream);
  unlink(path), rmdir(folder);
  return bytes;
}

static uint32_t number(const unsigned char *at, int bytes)
{
  uint32_t value = 0;
  for (int i = bytes; i-- > 0;) value = value << 8 | at[i];
  return value;
}

/* Bit by bit: remainder of the division by x^32 + x^26 + ... + 1, in reversed order. */
static uint32_t crc(const unsigned char *data, size_t count)
{
  uint32_t sum = 0xffffffff;
  for (size_t i = 0; i < count; i++) {
    sum ^= data[i];
    for (int bit = 0; bit < 8; bit++) sum = sum & 1 ? sum >> 1 ^ 0xedb88320 : sum >> 1;
  }
  return ~sum;
}

/* Member k by the list at the end: its .npy file, with name, sizes and checksum compared. */
static const unsigned char *member(size_t bytes, size_t k, const char *name, size_t *length)
{
  const unsigned char *end = file + bytes - 22;
  CHECK(number(end, 4) == 0x06054b50 && number(end + 10, 2) > k);
  CHECK(number(end + 16, 4) + number(end + 12, 4) + 22 == bytes);
  const unsigned char *at = file + number(end + 16, 4);
  for (; k > 0; k--) at += 46 + number(at + 28, 2);
  CHECK(number(at, 4) == 0x02014b50 && number(at + 28, 2) == strlen(name));
  CHECK(!memcmp(at + 46, name, strlen(name)));
  const unsigned char *local = file + number(at + 42, 4);
  CHECK(number(local, 4) == 0x04034b50 && !memcmp(local + 4, at + 6, 26));
  const unsigned char *data = local + 30 + number(local + 26, 2) + number(local + 28, 2);
  *length = number(at + 24, 4);
  CHECK(number(at + 20, 4) == *length && number(at + 16, 4) == crc(data, *length));
  CHECK(!memcmp(local + 30, name, strlen(name)));
  return data;
}

static void arrays_come_back(void)
{
  static const sunrealtype t[] = {0.5, 1.25, NAN, 3e-310}, y[] = {1, -2, 3, 4.5, 5, INFINITY};
  const steif_array array[] = {
    {"t", 4, 0, t, NULL}, {"y", 3, 2, y, NULL}, {"none", 0, 0, NULL, NULL}};
  static const char *const name[] = {"t.npy", "y.npy", "none.npy"};
  static const char *const shape[] = {"'shape': (4,), }", "'shape': (3, 2), }",
                                      "'shape': (0,), }"};
  static const size_t size[] = {sizeof t, sizeof y, 0};
  steif_context *ctx = steif_context_new(NULL);
  const size_t bytes = saved(ctx, 3, array);
  for (size_t k = 0; k < 3; k++) {
    size_t length;
    const unsigned char *data = member(bytes, k, name[k], &length);
    const size_t head = 10 + number(data + 8, 2);
    char text[256] = "";
    CHECK(!memcmp(data, "\x93NUMPY\1", 8) && head % 64 == 0 && head < sizeof text);
    memcpy(text, data + 10, head - 10);
    CHECK(strstr(text, "{'descr': '<f8', 'fortran_order': False, ") == text ||
          strstr(text, "{'descr': '>f8', 'fortran_order': False, ") == text);
    CHECK(strstr(text, shape[k]) && text[head - 11] == '\n');
    CHECK(length == head + size[k]);
    CHECK(size[k] == 0 || !memcmp(data + head, array[k].value, size[k]));
  }
  steif_context_free(&ctx);
}

/* Texts by code points: "y1" and the Greek "\u03b8\u2032" have two each, the third has one beyond 16 bits. */
static void texts_come_back(void)
{
  static const char *const text[] = {"y1", "\xce\xb8\xe2\x80\xb2", "\xf0\x9d\x9c\x83", ""};
  static const uint32_t points[] = {'y', '1', 0x3b8, 0x2032, 0x1d703, 0, 0, 0};
  const steif_array array = {.name = "names", .rows = 4, .text = text};
  steif_context *ctx = steif_context_new(NULL);
  const size_t bytes = saved(ctx, 1, &array);
  size_t length;
  const unsigned char *data = member(bytes, 0, "names.npy", &length);
  const size_t head = 10 + number(data + 8, 2);
  CHECK(!memcmp(data + 10 + 12, "U2', ", 5) && length == head + sizeof points);
  CHECK(!memcmp(data + head, points, sizeof points));
  steif_context_free(&ctx);
}

static void too_much_is_rejected(void)
{
  static const sunrealtype value = 1;
  steif_array many[17];
  for (int i = 0; i < 17; i++) many[i] = (steif_array){"x", 1, 0, &value, NULL};
  const steif_array huge = {"x", 80000, 80000, &value, NULL};
  const steif_array named = {
    "a-name-of-more-than-sixty-characters-is-not-one-that-a-user-would-like", 1, 0, &value,
    NULL};
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_npz_save(ctx, "never.npz", 17, many) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "17 arrays are too many"));
  CHECK(steif_npz_save(ctx, "never.npz", 1, &huge) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "51.2 GB, more than the 4 GB"));
  CHECK(steif_npz_save(ctx, "never.npz", 1, &named) == STEIF_BAD_INPUT);
  CHECK(steif_npz_save(ctx, "no/such/folder.npz", 1, many) == STEIF_IO);
  CHECK(access("never.npz", F_OK) != 0);
  steif_context_free(&ctx);
}

static void fields_of_a_report_are_arrays(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_report *r = steif_report_new(ctx);
  const sunrealtype list[] = {1.5, NAN, -INFINITY}, matrix[] = {1, 2, 3, 4, 5, 6.25};
  size_t rows, columns;
  sunrealtype value[6] = {0};
  steif_report_text(r, "title", "no array");
  steif_report_list(r, "x", 3, list);
  steif_report_list(r, "empty", 0, list);
  steif_report_row(r, "sheet");
  steif_report_real(r, "sheet.h", 0.5);
  steif_report_matrix(r, "part.A", 3, 2, matrix);
  const char *name = steif_report_array_at(r, 0, &rows, &columns, value);
  CHECK(name && !strcmp(name, "x") && rows == 3 && columns == 0);
  CHECK(value[0] == 1.5 && isnan(value[1]) && value[2] == -INFINITY);
  name = steif_report_array_at(r, 1, &rows, &columns, NULL);
  CHECK(name && !strcmp(name, "A") && rows == 3 && columns == 2);
  steif_report_array_at(r, 1, &rows, &columns, value);
  CHECK(!memcmp(value, matrix, sizeof matrix));
  CHECK(!steif_report_array_at(r, 2, &rows, &columns, NULL));
  steif_report_free(&r);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_arrays[] = {
  {"arrays come back", arrays_come_back},
  {"texts of an .npz file", texts_come_back},
  {"fields of a report are arrays", fields_of_a_report_are_arrays},
  {"too much is rejected", too_much_is_rejected},
  CU_TEST_INFO_NULL};
