/* test_mat_bytes.c: MATLAB files written byte by byte: what they say of themselves is not believed.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

#ifdef STEIF_HAVE_MATIO

/* 40000 x 40000 in a few bytes: as full (class 6), sparse (5), cells (1), structures (2), functions (16),
 * and of classes that should have no sizes (17) or do not exist, before memory is taken. */
static void sizes_beyond_the_file_are_rejected(void)
{
  static const unsigned char classes[] = {6, 5, 1, 2, 16, 17, 251};
  for (int k = 0; k < 7; k++) {
    unsigned char bytes[184] = {0}, *b = bytes + 128;
    const int32_t size = 40000;
    memcpy(bytes, "MATLAB 5.0", 10);
    bytes[125] = 1, bytes[126] = 'I', bytes[127] = 'M';
    b[0] = 14, b[4] = 48;                    /* a matrix of 48 bytes */
    b[8] = 6, b[12] = 8, b[16] = classes[k]; /* flags */
    b[24] = 5, b[28] = 8;                    /* two sizes */
    memcpy(b + 32, &size, 4), memcpy(b + 36, &size, 4);
    b[40] = 1, b[42] = 1, b[44] = 'E'; /* its name, at most 4 letters */
    steif_context *ctx = steif_context_new(NULL);
    CHECK(!steif_matrix_read_mat(ctx, put_bytes("huge.mat", bytes, sizeof bytes), "E", NULL));
    CHECK(steif_status(ctx) == STEIF_BAD_INPUT);
    SAYS(ctx, "larger than the file can hold");
    steif_context_free(&ctx);
  }
}

/* A file of one opaque array, 48 bytes, with a name of 8 bytes, and after it E = 2.5. */
static const char *opaque_file(const void *name, const void *kind)
{
  static const double x = 2.5;
  unsigned char bytes[256] = {0}, *b = bytes + 128, *e = bytes + 184;
  memcpy(bytes, "MATLAB 5.0", 10);
  bytes[125] = 1, bytes[126] = 'I', bytes[127] = 'M';
  b[0] = 14, b[4] = 48, b[8] = 6, b[12] = 8, b[16] = 17;
  b[24] = 1, b[28] = 8;
  memcpy(b + 32, name, 8), memcpy(b + 40, kind, 8);
  e[0] = 14, e[4] = 64, e[8] = 6, e[12] = 8, e[16] = 6;
  e[24] = 5, e[28] = 8, e[32] = 1, e[36] = 1;
  e[40] = 1, e[42] = 1, e[44] = 'E', e[48] = 9, e[52] = 8;
  memcpy(e + 56, &x, sizeof x);
  return put_bytes("opaque.mat", bytes, sizeof bytes);
}

/* Tables, strings and objects of MATLAB are opaque to matio, which takes bytes 8 after the tag of their name for
 * another tag: a name that looks like one would have it ask for four gigabytes. */
static void opaque_arrays_are_passed_over(void)
{
  static const char kind[8] = {1, 0, 4, 0, 'M', 'C', 'O', 'S'};
  static const char tag[8] = {1, 0, 0, 0, 0, 0, '\xff', '\xff'};
  steif_context *ctx = steif_context_new(NULL);
  int found = 0;
  SUNMatrix E = steif_matrix_read_mat(ctx, opaque_file("my table", kind), "E", &found);
  CHECK(E && found && at(E, 0, 0) == 2.5);
  if (E) SUNMatDestroy(E);
  CHECK(!steif_matrix_read_mat(ctx, opaque_file(tag, kind), "E", NULL));
  SAYS(ctx, "larger than the file can hold");
  CHECK(!steif_matrix_read_mat(ctx, opaque_file("my table", tag), "E", NULL));
  SAYS(ctx, "larger than the file can hold");
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_mat_bytes[] = {
  {"sizes beyond the file are rejected", sizes_beyond_the_file_are_rejected},
  {"opaque arrays are passed over", opaque_arrays_are_passed_over},
  CU_TEST_INFO_NULL};

#else

CU_TestInfo tests_of_mat_bytes[] = {CU_TEST_INFO_NULL};

#endif
