/* vector.h: arrays that grow, from the allocator of a context.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_VECTOR_H
#define STF_VECTOR_H

#include "base.h"

typedef struct stf_vector {
  void *data;
  size_t count, room;
} stf_vector;

#define STF_AT(vector, type, i) ((type *)(vector).data + (i))

/* The next item of `size` bytes, zeroed; NULL with the message set. Items move
 * when the vector grows. */
void *stf_vector_push(steif_context *ctx, stf_vector *vector, size_t size);
/* `count` items in all, new ones zeroed. */
int stf_vector_resize(steif_context *ctx, stf_vector *vector, size_t count, size_t size);
/* Room for one item more; what it held is given back. */
int stf_vector_trim(steif_context *ctx, stf_vector *vector, size_t size);
void stf_vector_free(steif_context *ctx, stf_vector *vector);

#endif
