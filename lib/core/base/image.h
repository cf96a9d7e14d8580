/* image.h: what a run remembers as one block of bytes. A function walks over its parts, each named once:
 * the same walk measures the image, writes it, or reads it into an object that was opened the same way.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_IMAGE_H
#define STF_IMAGE_H

#include "base.h"

typedef struct stf_image {
  steif_context *ctx;
  unsigned char *at;         /* written; NULL: the walk measures, or reads ... */
  const unsigned char *from; /* ... this */
  size_t used, size;
  bool reads;
  int code;               /* the first failure; nothing is read after it */
  unsigned long long sum; /* while measured: a number for the values met, by words */
} stf_image;

/* Every part carries its length, so that an image of another shape is noticed before it is read. */
void stf_keep(stf_image *m, void *part, size_t bytes);
#define STF_KEEP(m, part) stf_keep(m, &(part), sizeof(part))
void stf_keep_vector(stf_image *m, N_Vector v);
void stf_keep_vectors(stf_image *m, int count, N_Vector *v);
/* A count that the reader needs before the part, at most `most`. */
void stf_keep_count(stf_image *m, size_t *count, size_t most);
/* Is the part there? Both sides must agree. `what` for the sentence. */
void stf_keep_presence(stf_image *m, bool present, const char *what);
/* The walk cannot go on; the sentence is there already. */
void stf_image_stop(stf_image *m, int code);

/* 64 bits by which damage is noticed (G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, FNV-1a). */
unsigned long long stf_checksum(const void *bytes, size_t count);

#endif
