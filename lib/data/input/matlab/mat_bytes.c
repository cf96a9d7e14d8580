/* mat_bytes.c: the bytes of a MATLAB file one after another.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "mat_bytes.h"
#include <string.h>

#ifdef STEIF_HAVE_MATIO

bool stf_mat_bytes_open(stf_mat_bytes *b, FILE *file)
{
  *b = (stf_mat_bytes){.file = file};
  if (fseek(file, 0, SEEK_END)) return false;
  b->left = ftell(file);
  return b->left >= 0 && !fseek(file, 0, SEEK_SET);
}

/* Fill z's output, at most what `in` and the rest of the element stand for. */
static bool inflate_more(stf_mat_bytes *b)
{
  z_stream *z = &b->z;
  while (z->avail_out > 0) {
    if (!z->avail_in && b->packed > 0) {
      const size_t part = b->packed < (long)sizeof b->in ? (size_t)b->packed : sizeof b->in;
      if (fread(b->in, 1, part, b->file) != part) return false;
      b->packed -= (long)part;
      z->next_in = b->in;
      z->avail_in = (uInt)part;
    }
    const int code = inflate(z, Z_SYNC_FLUSH);
    if (code == Z_STREAM_END) return !z->avail_out;
    if (code != Z_OK) return false;
  }
  return true;
}

static bool inflate_read(stf_mat_bytes *b, size_t count, unsigned char *to)
{
  unsigned char over[4096];
  while (count > 0) {
    const size_t part = count < sizeof over ? count : sizeof over;
    b->z.next_out = to ? to : over;
    b->z.avail_out = (uInt)part;
    if (!inflate_more(b)) return false;
    if (to) to += part;
    count -= part;
  }
  return true;
}

bool stf_mat_bytes_read(stf_mat_bytes *b, size_t count, unsigned char *to)
{
  if (b->inflating) return inflate_read(b, count, to);
  if (count > (size_t)b->left) return false;
  b->left -= (long)count;
  return to ? fread(to, 1, count, b->file) == count : !fseek(b->file, (long)count, SEEK_CUR);
}

bool stf_mat_bytes_seek(stf_mat_bytes *b, long left)
{
  b->left = left;
  return !fseek(b->file, -left, SEEK_END);
}

bool stf_mat_bytes_inflate(stf_mat_bytes *b, unsigned long length)
{
  memset(&b->z, 0, sizeof b->z);
  b->packed = (long)length;
  b->inflating = inflateInit(&b->z) == Z_OK;
  return b->inflating;
}

void stf_mat_bytes_inflated(stf_mat_bytes *b)
{
  b->inflating = false;
  inflateEnd(&b->z);
}

#endif
