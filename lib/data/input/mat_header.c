/* mat_header.c: is a MATLAB version 5 file whole, and can its variables be as large as they say? Asked
 * before matio reads it, which takes the sizes of a header for memory it needs.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <string.h>

#ifdef STEIF_HAVE_MATIO
#include <zlib.h>

enum { HEAD = 128, TAG = 8, LOOKED = 128 };
enum { MATRIX = 14, COMPRESSED = 15, CELL = 1, SPARSE = 5 }; /* types of elements, classes */
static const double deflated = 1032; /* bytes from one: the most that deflate can do */

/* Four bytes as a whole number. */
static unsigned long four(const unsigned char *b, bool little)
{
  unsigned long x = 0;
  for (int k = 0; k < 4; k++) x = 256 * x + b[little ? 3 - k : k];
  return x;
}

/* The first LOOKED bytes of what is compressed in `used` bytes of `b`, in their place. */
static size_t inflated(unsigned char *b, size_t used)
{
  unsigned char out[LOOKED] = {0};
  z_stream z = {.next_in = b, .avail_in = (uInt)used, .next_out = out, .avail_out = LOOKED};
  if (inflateInit(&z) != Z_OK) return 0;
  inflate(&z, Z_SYNC_FLUSH);
  const size_t got = LOOKED - z.avail_out;
  inflateEnd(&z);
  memcpy(b, out, got);
  return got;
}

/* b: array flags, with the class in the lowest byte, and sizes, each in an element of its own; room: of
 * the bytes that follow. An entry has a byte at least, a cell has eight, a column of a sparse matrix
 * four. */
static bool believable(const unsigned char *b, size_t used, double room, bool little)
{
  double entries = 1;
  if (used < 4 * TAG) return true; /* matio's to reject */
  if (four(b + 4, little) != TAG) return false;
  const unsigned long kind = four(b + TAG, little) & 255,
                      length = four(b + 2 * TAG + 4, little);
  const size_t sizes = length / 4, name = 3 * TAG + (length + 7) / 8 * 8;
  if (length > LOOKED - 4 * TAG) return false; /* matio takes memory for as many sizes */
  if (name + TAG <= used && !(four(b + name, little) >> 16) &&
      four(b + name + 4, little) > LOOKED)
    return false; /* and for a name of this length, where its tag is not of the short kind */
  for (size_t k = 0; k < sizes && 3 * TAG + 4 * k + 4 <= used; k++) {
    const double size = (double)four(b + 3 * TAG + 4 * k, little);
    entries = kind == SPARSE ? size : entries * size; /* sparse: columns stand last */
  }
  return entries * (kind == CELL ? 8 : kind == SPARSE ? 4 : 1) <= room;
}

/* The element at `at` with the type and the length of its tag. */
static bool element(FILE *file, long at, unsigned long type, unsigned long length, bool little)
{
  unsigned char b[LOOKED] = {0};
  double room = (double)length;
  if (type != MATRIX && type != COMPRESSED) return true;
  if (fseek(file, at + TAG, SEEK_SET)) return false;
  size_t used = fread(b, 1, length < LOOKED ? length : LOOKED, file);
  const unsigned char *from = b;
  if (type == COMPRESSED) {
    used = inflated(b, used);
    if (used < TAG) return true;
    room *= deflated;
    from += TAG;
    used -= TAG;
  }
  return believable(from, used, room, little);
}

/* Elements follow each other after the head, each with its type and its size before it: do all of
 * them end within the file? matio reads zeros where one does not. */
static bool complete(FILE *file, bool little, bool *good)
{
  unsigned char tag[TAG];
  if (fseek(file, 0, SEEK_END)) return false;
  const long size = ftell(file);
  for (long at = HEAD; at < size;) {
    if (fseek(file, at, SEEK_SET) || fread(tag, 1, sizeof tag, file) != sizeof tag)
      return false;
    const unsigned long type = four(tag, little), length = four(tag + 4, little);
    if (length > (unsigned long)(size - at - TAG)) return false;
    *good = *good && element(file, at, type, length, little);
    at += TAG + (long)length;
  }
  return true;
}

/* Bytes 124 to 127 of the file: version 1, and the order of bytes. Version 7.3 (HDF5) has 2. */
int stf_mat_check(steif_context *ctx, const char *path)
{
  unsigned char head[HEAD] = {0};
  FILE *file = stf_input_open(ctx, path);
  if (!file) return steif_status(ctx);
  bool good = true;
  const size_t used = fread(head, 1, sizeof head, file);
  const bool little = head[126] == 'I' && head[127] == 'M',
             big = head[126] == 'M' && head[127] == 'I', whole = complete(file, little, &good);
  fclose(file);
  const int version = little ? head[124] + 256 * head[125] : 256 * head[124] + head[125];
  STEIF_CHECK(used == sizeof head && (little || big) && version == 0x100, ctx, STEIF_BAD_INPUT,
              "'%s' is no MATLAB file of version 5%s; save it with '-v7' or '-v6'", path,
              used == sizeof head && version == 0x200 ? " but of version 7.3" : "");
  STEIF_CHECK(whole, ctx, STEIF_BAD_INPUT, "'%s' is cut off; save it again", path);
  STEIF_CHECK(
    good, ctx, STEIF_BAD_INPUT,
    "'%s' has a variable that says to be larger than the file can hold; save it again", path);
  return STEIF_OK;
}

#endif
