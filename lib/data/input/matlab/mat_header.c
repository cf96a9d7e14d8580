/* mat_header.c: is a MATLAB version 5 file whole, and is each variable as large as it says? Asked before
 * matio reads it, which takes the sizes of a header for memory it needs. All elements are walked through,
 * those inside of compressed ones and of cells and structures too; format: MathWorks, MAT-File Format.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include "mat_bytes.h"
#include <string.h>

#ifdef STEIF_HAVE_MATIO

enum { HEAD = 128, TAG = 8, DEEPEST = 16 };
enum { INT8 = 1, INT32 = 5, UINT32 = 6, MATRIX = 14, COMPRESSED = 15 }; /* types of elements */
enum { CELL = 1, OBJECT = 3, SPARSE = 5, FUNCTION = 16, OPAQUE = 17 };  /* classes */
enum { DIMENSIONS = 32, NAME = 1024 };

typedef struct tag {
  unsigned long type, length;
  bool small; /* of at most four bytes, which are in the tag */
  unsigned char in[4];
} tag;

/* What is left of an element inside of which one reads. */
typedef struct inside {
  stf_mat_bytes *from;
  double left;
  int depth;
} inside;

static unsigned long four(const stf_mat_bytes *from, const unsigned char *b)
{
  unsigned long x = 0;
  for (int k = 0; k < 4; k++) x = 256 * x + b[from->little ? 3 - k : k];
  return x;
}

static bool take(inside *i, size_t count, unsigned char *to)
{
  if ((double)count > i->left) return false;
  i->left -= (double)count;
  return stf_mat_bytes_read(i->from, count, to);
}

static bool tag_of(inside *i, tag *t)
{
  unsigned char b[TAG];
  if (!take(i, TAG, b)) return false;
  const unsigned long first = four(i->from, b);
  t->small = first >> 16;
  t->type = t->small ? first & 0xffff : first;
  t->length = t->small ? first >> 16 : four(i->from, b + 4);
  memcpy(t->in, b + 4, sizeof t->in);
  return !t->small || t->length <= sizeof t->in;
}

/* The contents of an element, to the next multiple of eight bytes; to NULL: passed over. */
static bool contents(inside *i, const tag *t, unsigned char *to)
{
  if (t->small) {
    if (to) memcpy(to, t->in, t->length);
    return true;
  }
  const size_t padding = (TAG - t->length % TAG) % TAG;
  return take(i, t->length, to) && take(i, padding, NULL);
}

/* An element of this type and at most so many bytes; their number, -1: it is another. */
static long element(inside *i, unsigned long type, size_t most, unsigned char *to)
{
  tag t;
  if (!tag_of(i, &t) || t.type != type || t.length > most) return -1;
  return contents(i, &t, to) ? (long)t.length : -1;
}

/* Numbers of any type, at least so many. */
static bool numbers(inside *i, double least)
{
  static const int size[] = {0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8, 0, 0, 1, 2, 4};
  tag t;
  if (!tag_of(i, &t) || t.type >= sizeof size / sizeof *size || !size[t.type]) return false;
  return (double)t.length / size[t.type] >= least && contents(i, &t, NULL);
}

static bool matrix(inside *i);

/* One array in a cell or structure; an empty one may be a tag alone, but not in a function handle. */
static bool nested(inside *i, bool handle)
{
  tag t;
  if (i->depth >= DEEPEST || !tag_of(i, &t) || t.small || t.type != MATRIX) return false;
  if ((double)t.length > i->left) return false;
  inside part = {i->from, (double)t.length, i->depth + 1};
  i->left -= (double)t.length;
  return t.length ? matrix(&part) : !handle;
}

static bool arrays(inside *i, double count, bool handle)
{
  if (count * TAG > i->left) return false;
  for (double k = 0; k < count; k++)
    if (!nested(i, handle)) return false;
  return true;
}

/* Of each field the name, all in one length; an object has the name of its class before. */
static bool structure(inside *i, bool object, double count)
{
  unsigned char b[4];
  tag t;
  if (object && element(i, INT8, NAME, NULL) < 0) return false;
  if (element(i, INT32, sizeof b, b) != sizeof b) return false;
  const unsigned long length = four(i->from, b);
  if (!tag_of(i, &t) || t.type != INT8 || !contents(i, &t, NULL)) return false;
  if (!length || length > NAME || t.length % length) return false;
  return arrays(i, count * (double)(t.length / length), false);
}

/* Row numbers, column pointers, values. */
static bool sparse(inside *i, double columns, bool complex)
{
  return numbers(i, 0) && numbers(i, columns + 1) && numbers(i, 0) &&
         (!complex || numbers(i, 0));
}

/* An opaque array: its name, its kind, and what is passed over. matio takes the tag of the name for that of
 * sizes and the eight bytes after it for the name's tag: a letter there, or the tag of the kind, is none
 * whose length it would believe. */
static bool opaque(inside *i)
{
  unsigned char name[NAME] = {0};
  const long length = element(i, INT8, sizeof name, name);
  for (long k = 0; k < length; k++)
    if (name[k] < ' ') return false;
  return length >= 0 && element(i, INT8, NAME, NULL) >= 0 && take(i, (size_t)i->left, NULL);
}

/* Flags, sizes, name, and what the class has. */
static bool matrix(inside *i)
{
  unsigned char flags[8], size[4 * DIMENSIONS] = {0};
  double count = 1;
  if (element(i, UINT32, sizeof flags, flags) != sizeof flags) return false;
  const unsigned long word = four(i->from, flags), class = word & 255;
  const bool complex = word >> 11 & 1;
  if (class == OPAQUE) return opaque(i);
  if (class < CELL || class > FUNCTION) return false;
  const long length = element(i, INT32, sizeof size, size);
  if (length < 8 || length % 4 || element(i, INT8, NAME, NULL) < 0) return false;
  for (long k = 0; k < length; k += 4) count *= (double)four(i->from, size + k);
  const bool parts = class == CELL || class == FUNCTION;
  const bool good = parts             ? arrays(i, count, class == FUNCTION)
                    : class <= OBJECT ? structure(i, class == OBJECT, count)
                    : class == SPARSE ? sparse(i, (double)four(i->from, size + 4), complex)
                                      : numbers(i, count) && (!complex || numbers(i, count));
  return good && take(i, (size_t)i->left, NULL);
}

/* What is compressed is one array, of a length that is not known before. */
static bool compressed(stf_mat_bytes *from, unsigned long length)
{
  tag t;
  inside all = {from, TAG, 0};
  if (!stf_mat_bytes_inflate(from, length)) return false;
  bool good = tag_of(&all, &t) && t.type == MATRIX && !t.small;
  inside part = {from, (double)t.length, 0};
  good = good && matrix(&part);
  stf_mat_bytes_inflated(from);
  return good;
}

/* Variables follow each other after the head, each with its type and its size before it: do all of them
 * end within the file? matio reads zeros where one does not. */
static bool complete(stf_mat_bytes *from, bool *good)
{
  while (from->left > 0) {
    tag t;
    inside file = {from, (double)from->left, 0};
    if (!tag_of(&file, &t) || t.small || t.length > (unsigned long)from->left) return false;
    const long end = from->left - (long)t.length;
    inside part = {from, (double)t.length, 0};
    if (t.type == COMPRESSED)
      *good = *good && compressed(from, t.length);
    else if (t.type == MATRIX)
      *good = *good && matrix(&part);
    if (!stf_mat_bytes_seek(from, end)) return false;
  }
  return true;
}

/* Bytes 124 to 127 of the file: version 1, and the order of bytes. Version 7.3 (HDF5) has 2. */
int stf_mat_check(steif_context *ctx, const char *path)
{
  unsigned char head[HEAD] = {0};
  stf_mat_bytes from;
  FILE *file = stf_input_open(ctx, path);
  if (!file) return steif_status(ctx);
  const bool opened = stf_mat_bytes_open(&from, file) && stf_mat_bytes_read(&from, HEAD, head);
  const bool little = head[126] == 'I' && head[127] == 'M',
             big = head[126] == 'M' && head[127] == 'I';
  const int version = little ? head[124] + 256 * head[125] : 256 * head[124] + head[125];
  bool good = true;
  from.little = little;
  const bool right = opened && (little || big) && version == 0x100;
  const bool whole = right && complete(&from, &good);
  fclose(file);
  STEIF_CHECK(right, ctx, STEIF_BAD_INPUT,
              "'%s' is no MATLAB file of version 5%s; save it with '-v7' or '-v6'", path,
              opened && version == 0x200 ? " but of version 7.3" : "");
  STEIF_CHECK(whole, ctx, STEIF_BAD_INPUT, "'%s' is cut off; save it again", path);
  STEIF_CHECK(good, ctx, STEIF_BAD_INPUT,
              "'%s' is damaged: a variable says to be larger than the file can hold, or "
              "lengths inside of it do "
              "not add up; save it again",
              path);
  return STEIF_OK;
}

#endif
