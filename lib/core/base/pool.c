/* pool.c: blocks, vectors and owned objects that live until one free.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agree.h"
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <string.h>

typedef struct entry {
  struct entry *next;
  void *object;
  void (*destroy)(void *object);
} entry;

/* Blocks begin on a cache line, so that stage arrays do. Small ones share a chunk, since a solver of few
 * unknowns would spend a tenth of its run in malloc and free; an allocator of the caller sees every
 * block. */
enum { LINE = 64, CHUNK = 16384, SMALL = CHUNK / 4 };

struct stf_pool {
  steif_context *ctx;
  entry *blocks, *objects; /* objects are destroyed first */
  char *at;                /* rest of the last chunk */
  size_t left;
  N_Vector_Ops from, ops; /* operations of the vectors cloned so far, and our copy */
};

stf_pool *stf_pool_new(steif_context *ctx)
{
  stf_pool *pool = stf_allocate(ctx, 1, sizeof *pool);
  if (pool) pool->ctx = ctx;
  return pool;
}

/* A block of its own: whole lines. */
static char *block(stf_pool *pool, size_t size)
{
  const size_t frame = sizeof(entry) + LINE;
  entry *e = stf_allocate(pool->ctx, size <= SIZE_MAX - frame ? size + frame : SIZE_MAX, 1);
  if (!e) return NULL;
  e->next = pool->blocks, pool->blocks = e;
  return (char *)(e + 1) + (LINE - (uintptr_t)(e + 1) % LINE);
}

static bool refill(stf_pool *pool)
{
  char *chunk = block(pool, CHUNK);
  if (chunk) pool->at = chunk, pool->left = CHUNK;
  return chunk;
}

void *stf_pool_array(stf_pool *pool, size_t count, size_t size)
{
  const bool fits = !size || count <= (SIZE_MAX - LINE) / size;
  const size_t bytes = fits && count * size > 0 ? count * size : 1;
  const size_t whole = fits ? (bytes + LINE - 1) / LINE * LINE : SIZE_MAX;
  if (whole > SMALL || stf_foreign_memory(pool->ctx)) return block(pool, whole);
  if (pool->left < whole && !refill(pool)) return NULL;
  char *at = pool->at;
  pool->at += whole, pool->left -= whole;
  return at;
}

int stf_pool_adopt(stf_pool *pool, void *object, void (*destroy)(void *object))
{
  entry *e = stf_pool_array(pool, 1, sizeof *e);
  if (!e) {
    destroy(object);
    return STEIF_NO_MEMORY;
  }
  *e = (entry){pool->objects, object, destroy};
  pool->objects = e;
  return STEIF_OK;
}

static void destroy_vector(void *v) { N_VDestroy(v); }

static N_Vector_Ops operations(stf_pool *pool, N_Vector like)
{
  if (like->ops == pool->from || like->ops == pool->ops) return pool->ops;
  N_Vector_Ops ops = stf_pool_array(pool, 1, sizeof *ops);
  if (ops) *ops = *like->ops, pool->from = like->ops, pool->ops = ops;
  return ops;
}

N_Vector stf_pool_view(stf_pool *pool, N_Vector like, sunrealtype *data)
{
  typedef struct vector {
    struct _generic_N_Vector head;
    struct _N_VectorContent_Serial content;
  } vector;
  N_Vector_Ops ops = operations(pool, like);
  vector *v = ops ? stf_pool_array(pool, 1, sizeof *v) : NULL;
  if (!v) return NULL;
  v->content = (struct _N_VectorContent_Serial){.length = NV_LENGTH_S(like), .data = data};
  v->head.content = &v->content, v->head.ops = ops, v->head.sunctx = like->sunctx;
  return &v->head;
}

N_Vector stf_pool_vector(stf_pool *pool, N_Vector like)
{
  if (like->ops->nvclone == N_VClone_Serial) {
    sunrealtype *data = stf_pool_array(pool, (size_t)NV_LENGTH_S(like), sizeof *data);
    return data ? stf_pool_view(pool, like, data) : NULL;
  }
  if (stf_clone_gate(pool->ctx, like)) return NULL;
  N_Vector v = like->ops->nvclone(like); /* N_VClone writes through a null result */
  if (v) v->sunctx = like->sunctx;
  if (!v) {
    STEIF_FAIL(pool->ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld components",
               (long long)N_VGetLength(like));
    return NULL;
  }
  N_VConst(0, v);
  return stf_pool_adopt(pool, v, destroy_vector) ? NULL : v;
}

N_Vector *stf_pool_vectors(stf_pool *pool, int count, N_Vector like)
{
  N_Vector *v = stf_pool_array(pool, (size_t)count, sizeof *v);
  for (int i = 0; v && i < count; i++)
    if (!(v[i] = stf_pool_vector(pool, like))) return NULL;
  return v;
}

stf_pool_mark stf_pool_here(const stf_pool *pool)
{
  return (stf_pool_mark){pool->blocks, pool->objects, pool->at, pool->left};
}

/* Newest first, down to the marked ones. The rest of the chunk of the mark is as new: zeroed. */
void stf_pool_release(stf_pool *pool, stf_pool_mark mark)
{
  for (entry *e = pool->objects; e != mark.objects; e = e->next) e->destroy(e->object);
  for (entry *e = pool->blocks, *next; e != mark.blocks; e = next) {
    next = e->next;
    stf_release(pool->ctx, e);
  }
  pool->objects = mark.objects, pool->blocks = mark.blocks;
  pool->at = mark.at, pool->left = mark.left;
  if (mark.left) memset(mark.at, 0, mark.left);
  pool->from = pool->ops = NULL; /* operations of vectors may have gone, too */
}

void stf_pool_free(stf_pool **pool)
{
  if (!pool || !*pool) return;
  steif_context *ctx = (*pool)->ctx;
  stf_pool_release(*pool, (stf_pool_mark){NULL, NULL, NULL, 0});
  stf_release(ctx, *pool);
  *pool = NULL;
}
