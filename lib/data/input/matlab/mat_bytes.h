/* mat_bytes.h: the bytes of a MATLAB file one after another, those of a compressed element inflated.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MAT_BYTES_H
#define STF_MAT_BYTES_H

#include "base.h"
#include <stdio.h>

#ifdef STEIF_HAVE_MATIO
#include <zlib.h>

typedef struct stf_mat_bytes {
  FILE *file;
  bool little;
  long left; /* bytes of the file */
  bool inflating;
  z_stream z;
  long packed; /* bytes of the compressed element that are not in `in` yet */
  unsigned char in[4096];
} stf_mat_bytes;

/* False: where bytes are missing or damaged. */
bool stf_mat_bytes_open(stf_mat_bytes *b, FILE *file);
/* to NULL: they are passed over. */
bool stf_mat_bytes_read(stf_mat_bytes *b, size_t count, unsigned char *to);
/* Go on where so many bytes of the file are left. */
bool stf_mat_bytes_seek(stf_mat_bytes *b, long left);
/* From here on bytes are those that the next `length` bytes of the file stand for. */
bool stf_mat_bytes_inflate(stf_mat_bytes *b, unsigned long length);
void stf_mat_bytes_inflated(stf_mat_bytes *b);

#endif
#endif
