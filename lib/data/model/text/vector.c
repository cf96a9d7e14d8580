/* vector.c: arrays that grow by doubling.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "vector.h"
#include <string.h>

static int widen(steif_context *ctx, stf_vector *v, size_t room, size_t size)
{
  if (room <= v->room) return STEIF_OK;
  const size_t doubled = 2 * v->room, wanted = room > doubled ? room : doubled;
  void *data = stf_allocate(ctx, wanted < 16 ? 16 : wanted, size);
  if (!data) return STEIF_NO_MEMORY;
  if (v->count) memcpy(data, v->data, v->count * size);
  if (v->data) stf_release(ctx, v->data);
  v->data = data;
  v->room = wanted < 16 ? 16 : wanted;
  return STEIF_OK;
}

void *stf_vector_push(steif_context *ctx, stf_vector *v, size_t size)
{
  if (widen(ctx, v, v->count + 1, size)) return NULL;
  char *item = (char *)v->data + v->count++ * size;
  return memset(item, 0, size);
}

int stf_vector_resize(steif_context *ctx, stf_vector *v, size_t count, size_t size)
{
  STEIF_TRY(widen(ctx, v, count, size));
  if (count > v->count) memset((char *)v->data + v->count * size, 0, (count - v->count) * size);
  v->count = count;
  return STEIF_OK;
}

int stf_vector_trim(steif_context *ctx, stf_vector *v, size_t size)
{
  if (v->room - v->count <= v->count / 8) return STEIF_OK;
  void *data = stf_allocate(ctx, v->count + 1, size);
  if (!data) return STEIF_NO_MEMORY;
  const stf_vector exact = {data, v->count, v->count + 1};
  if (v->count) memcpy(data, v->data, v->count * size);
  stf_vector_free(ctx, v);
  *v = exact;
  return STEIF_OK;
}

void stf_vector_free(steif_context *ctx, stf_vector *v)
{
  if (v->data) stf_release(ctx, v->data);
  *v = (stf_vector){0};
}
