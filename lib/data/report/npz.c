/* npz.c: arrays as numpy's .npz: a zip archive of stored (not compressed) .npy files.
 *
 * A member is a local header, "\x93NUMPY", a dictionary of type and shape padded to 64 bytes, and the
 * numbers, or texts as code points of 32 bits; after all members comes the list of them. Format:
 * numpy.lib.format (NEP 1) and PKWARE's APPNOTE 4.3 without the 64-bit extension, so that members end below 4 GB.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <stdint.h>
#include <string.h>

enum { HEAD = 256, NAME = 64, MEMBERS = 16 };
static const uint64_t largest = 0xffffffff - 65536;

typedef struct member {
  char name[NAME];
  unsigned char head[HEAD]; /* of the .npy file */
  size_t head_bytes;
  const void *data;
  uint32_t *letters;          /* of texts */
  uint64_t data_bytes, begin; /* begin: of the local header in the archive */
  uint32_t check;
} member;

static uint32_t checksum(uint32_t sum, const void *data, size_t count)
{
  static const uint32_t half[] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190,
                                  0x6b6b51f4, 0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344,
                                  0xd6d6a3e8, 0xcb61b38c, 0x9b64c2b0, 0x86d3d2d4, 0xa00ae278,
                                  0xbdbdf21c}; /* CRC-32, 4 bits at a time */
  const unsigned char *byte = data;
  sum = ~sum;
  for (size_t i = 0; i < count; i++) {
    sum = half[(sum ^ byte[i]) & 15] ^ sum >> 4;
    sum = half[(sum ^ byte[i] >> 4) & 15] ^ sum >> 4;
  }
  return ~sum;
}

static bool little(void)
{
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 1;
}

/* The code points of UTF-8 text into `to` where there is one; how many there are. */
static size_t spell(const char *text, uint32_t *to)
{
  size_t count = 0;
  for (const unsigned char *c = (const unsigned char *)text; *c; count++) {
    const int more = *c >= 0xf0 ? 3 : *c >= 0xe0 ? 2 : *c >= 0xc0 ? 1 : 0;
    uint32_t point = more ? *c & (0x3fu >> more) : *c;
    c++;
    for (int k = 0; k < more && (*c & 0xc0) == 0x80; k++, c++) point = point << 6 | (*c & 0x3f);
    if (to) to[count] = point;
  }
  return count;
}

/* Texts as rows of equal width, zeros behind them; the width. */
static int letters(steif_context *ctx, const steif_array *a, member *m, size_t *width)
{
  *width = 1;
  for (size_t i = 0; i < a->rows; i++) {
    const size_t length = spell(a->text[i], NULL);
    if (length > *width) *width = length;
  }
  m->letters = stf_allocate(ctx, a->rows * *width + 1, sizeof *m->letters);
  if (!m->letters) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < a->rows; i++) spell(a->text[i], m->letters + i * *width);
  return STEIF_OK;
}

static int npy(steif_context *ctx, const steif_array *a, member *m)
{
  enum { FIXED = 10 };
  char shape[64], kind[24] = "f8", *text = (char *)m->head + FIXED;
  size_t width = 1;
  if (a->text) {
    STEIF_TRY(letters(ctx, a, m, &width));
    snprintf(kind, sizeof kind, "U%zu", width);
  }
  if (a->columns)
    snprintf(shape, sizeof shape, "(%zu, %zu)", a->rows, a->columns);
  else
    snprintf(shape, sizeof shape, "(%zu,)", a->rows);
  const int used =
    snprintf(text, HEAD - FIXED, "{'descr': '%c%s', 'fortran_order': False, 'shape': %s, }",
             little() ? '<' : '>', kind, shape);
  const size_t length = ((size_t)used + FIXED + 1 + 63) / 64 * 64 - FIXED;
  memcpy(m->head, "\x93NUMPY\1", 8);
  m->head[8] = length & 255;
  m->head[9] = (unsigned char)(length >> 8);
  memset(text + used, ' ', length - (size_t)used - 1);
  text[length - 1] = '\n';
  m->head_bytes = FIXED + length;
  m->data = a->text ? (const void *)m->letters : a->value;
  m->data_bytes = a->text
                    ? (uint64_t)a->rows * width * sizeof *m->letters
                    : (uint64_t)a->rows * (a->columns ? a->columns : 1) * sizeof *a->value;
  return STEIF_OK;
}

/* `bytes` bytes of a number, the lowest first. */
static void put(FILE *stream, uint64_t value, int bytes)
{
  for (; bytes > 0; bytes--, value >>= 8) putc((int)(value & 255), stream);
}

/* The fields that the header of a member and the list have in common. */
static void describe(FILE *stream, const member *m)
{
  const uint64_t bytes = m->head_bytes + m->data_bytes;
  put(stream, 20, 2); /* version of the format */
  put(stream, 0, 4);  /* flags, stored */
  put(stream, 0, 2);  /* time and date: the beginning of 1980, for equal files of equal runs */
  put(stream, 0x21, 2);
  put(stream, m->check, 4);
  put(stream, bytes, 4);
  put(stream, bytes, 4);
  put(stream, strlen(m->name), 2);
  put(stream, 0, 2);
}

static void write_member(FILE *stream, const member *m)
{
  put(stream, 0x04034b50, 4);
  describe(stream, m);
  fputs(m->name, stream);
  fwrite(m->head, 1, m->head_bytes, stream);
  if (m->data_bytes > 0) fwrite(m->data, 1, (size_t)m->data_bytes, stream);
}

static void write_list(FILE *stream, size_t count, const member *m, uint64_t begin)
{
  uint64_t bytes = 0;
  for (size_t i = 0; i < count; i++) {
    put(stream, 0x02014b50, 4);
    put(stream, 20, 2);
    describe(stream, m + i);
    put(stream, 0, 10); /* no comment, first disk, plain file */
    put(stream, m[i].begin, 4);
    fputs(m[i].name, stream);
    bytes += 46 + strlen(m[i].name);
  }
  put(stream, 0x06054b50, 4);
  put(stream, 0, 4);
  put(stream, count, 2);
  put(stream, count, 2);
  put(stream, bytes, 4);
  put(stream, begin, 4);
  put(stream, 0, 2);
}

/* Headers, checksums and places; the end of the members. */
static int plan(steif_context *ctx, size_t count, const steif_array *array, member *m,
                uint64_t *end)
{
  *end = 0;
  for (size_t i = 0; i < count; i++) {
    m[i].begin = *end;
    snprintf(m[i].name, NAME, "%s.npy", array[i].name);
    STEIF_TRY(npy(ctx, array + i, m + i));
    m[i].check = checksum(0, m[i].head, m[i].head_bytes);
    if (m[i].data_bytes <= largest)
      m[i].check = checksum(m[i].check, m[i].data, (size_t)m[i].data_bytes);
    *end += 30 + strlen(m[i].name) + m[i].head_bytes + m[i].data_bytes;
  }
  STEIF_CHECK(
    *end <= largest, ctx, STEIF_UNSUPPORTED,
    "the arrays take %.1f GB, more than the 4 GB of an .npz file: ask for fewer times",
    (double)*end * 1e-9);
  return STEIF_OK;
}

static int write_all(steif_context *ctx, const char *path, size_t count, const member *m,
                     uint64_t end)
{
  stf_output o;
  STEIF_TRY(stf_output_open(ctx, path, &o));
  for (size_t i = 0; i < count; i++) write_member(o.stream, m + i);
  write_list(o.stream, count, m, end);
  return stf_output_close(ctx, &o, STEIF_OK);
}

int steif_npz_save(steif_context *ctx, const char *path, size_t count, const steif_array *array)
{
  member m[MEMBERS];
  uint64_t end = 0;
  STEIF_CHECK(count <= MEMBERS, ctx, STEIF_BAD_INPUT, "%zu arrays are too many: at most %d",
              count, MEMBERS);
  for (size_t i = 0; i < count; i++)
    STEIF_CHECK(strlen(array[i].name) < NAME - sizeof ".npy", ctx, STEIF_BAD_INPUT,
                "the name \"%s\" of an array is too long", array[i].name);
  memset(m, 0, sizeof m);
  int code = plan(ctx, count, array, m, &end);
  if (!code) code = write_all(ctx, path, count, m, end);
  for (size_t i = 0; i < count; i++)
    if (m[i].letters) stf_release(ctx, m[i].letters);
  return code;
}
