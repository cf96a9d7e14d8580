/* pool.c: blocks, vectors and owned objects that live until one free.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <stdint.h>

typedef struct entry {
  struct entry *next;
  void *object;
  void (*destroy)(void *object);
} entry;

/* Alignment of every block: a cache line, so that stage arrays start on one. */
enum { LINE = 64 };

struct stf_pool {
  steif_context *ctx;
  entry *first;
};

stf_pool *stf_pool_new(steif_context *ctx)
{
  stf_pool *pool = stf_allocate(ctx, 1, sizeof *pool);
  if (pool) pool->ctx = ctx;
  return pool;
}

static void link_in(stf_pool *pool, entry *e, void *object, void (*destroy)(void *))
{
  *e = (entry){pool->first, object, destroy};
  pool->first = e;
}

void *stf_claim(stf_pool *pool, size_t count, size_t size)
{
  const size_t frame = sizeof(entry) + LINE;
  const bool fits = !size || count <= (SIZE_MAX - frame) / size;
  entry *e = stf_allocate(pool->ctx, fits ? count * size + frame : SIZE_MAX, 1);
  if (!e) return NULL;
  link_in(pool, e, NULL, NULL);
  return (char *)(e + 1) + (LINE - (uintptr_t)(e + 1) % LINE);
}

int stf_claim_owner(stf_pool *pool, void *object, void (*destroy)(void *object))
{
  entry *e = stf_allocate(pool->ctx, 1, sizeof *e);
  if (!e) {
    destroy(object);
    return STEIF_NO_MEMORY;
  }
  link_in(pool, e, object, destroy);
  return STEIF_OK;
}

static void destroy_vector(void *v) { N_VDestroy(v); }

N_Vector stf_claim_vector(stf_pool *pool, N_Vector like)
{
  N_Vector v = like->ops->nvclone(like); /* N_VClone writes through a null result */
  if (v) v->sunctx = like->sunctx;
  if (!v) {
    STEIF_FAIL(pool->ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld components",
               (long long)N_VGetLength(like));
    return NULL;
  }
  N_VConst(0, v);
  return stf_claim_owner(pool, v, destroy_vector) ? NULL : v;
}

N_Vector *stf_claim_vectors(stf_pool *pool, int count, N_Vector like)
{
  N_Vector *v = stf_claim(pool, (size_t)count, sizeof *v);
  for (int i = 0; v && i < count; i++)
    if (!(v[i] = stf_claim_vector(pool, like))) return NULL;
  return v;
}

void stf_pool_free(stf_pool **pool)
{
  if (!pool || !*pool) return;
  steif_context *ctx = (*pool)->ctx;
  for (entry *e = (*pool)->first, *next; e; e = next) {
    next = e->next;
    if (e->destroy) e->destroy(e->object);
    stf_release(ctx, e);
  }
  stf_release(ctx, *pool);
  *pool = NULL;
}
