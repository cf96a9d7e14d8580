/* test_pool.c: blocks, vectors and owned objects of a pool, and memory that runs out.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <string.h>

static void blocks_start_on_a_cache_line_and_are_zero(void)
{
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  for (size_t count = 1; count < 300; count += 23) {
    unsigned char *block = stf_pool_array(pool, count, 3);
    CHECK(block && (uintptr_t)block % 64 == 0);
    int zeroed = 1;
    for (size_t i = 0; i < 3 * count; i++) zeroed &= block[i] == 0;
    CHECK(zeroed);
    memset(block, 0xa5, 3 * count);
  }
  CHECK(stf_pool_array(pool, 0, sizeof(double)) != NULL);
  stf_pool_free(&pool);
  CHECK(pool == NULL);
  stf_pool_free(&pool);
  stf_pool_free(NULL);
  steif_context_free(&ctx);
}

static void vectors_are_zeroed_clones(void)
{
  steif_context *ctx = steif_context_new(NULL);
  N_Vector like = N_VNew_Serial(29, steif_sundials(ctx));
  N_VConst(4.25, like);
  stf_pool *pool = stf_pool_new(ctx);
  N_Vector *v = stf_pool_vectors(pool, 5, like);
  CHECK(v != NULL);
  for (int i = 0; v && i < 5; i++) {
    CHECK(N_VGetLength(v[i]) == 29);
    CHECK(N_VMaxNorm(v[i]) == 0);
    for (int j = 0; j < i; j++) CHECK(N_VGetArrayPointer(v[i]) != N_VGetArrayPointer(v[j]));
  }
  stf_pool_free(&pool);
  N_VDestroy(like);
  steif_context_free(&ctx);
}

/* Their operations are the pool's own: the vector cloned from may go first. */
static void views_lie_on_their_array(void)
{
  steif_context *ctx = steif_context_new(NULL);
  N_Vector like = N_VNew_Serial(3, steif_sundials(ctx));
  stf_pool *pool = stf_pool_new(ctx);
  sunrealtype data[] = {1.25, -7.5, 3.75};
  N_Vector view = stf_pool_view(pool, like, data), copy = stf_pool_vector(pool, view);
  N_VDestroy(like);
  CHECK(view && copy && N_VGetLength(view) == 3 && N_VGetArrayPointer(view) == data);
  N_VScale(2, view, copy);
  CHECK(data[1] == -7.5 && N_VGetArrayPointer(copy)[1] == -15 && N_VMaxNorm(copy) == 15);
  N_Vector clone = N_VClone(view);
  CHECK(clone && N_VGetArrayPointer(clone) != data && N_VGetLength(clone) == 3);
  N_VDestroy(clone);
  stf_pool_free(&pool);
  steif_context_free(&ctx);
}

/* Small blocks share chunks: none reaches into the next one, and each begins on a line. */
static void blocks_do_not_overlap(void)
{
  enum { COUNT = 300 };
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  unsigned char *block[COUNT];
  long touched = 0;
  for (size_t i = 0; i < COUNT; i++) {
    block[i] = stf_pool_array(pool, i * 37 % 5003, 1);
    CHECK(block[i] && (uintptr_t)block[i] % 64 == 0);
    for (size_t k = 0; k < i * 37 % 5003; k++)
      touched += block[i][k] != 0, block[i][k] = (unsigned char)(1 + i % 251);
  }
  CHECK(touched == 0);
  for (size_t i = 0; i < COUNT; i++)
    for (size_t k = 0; k < i * 37 % 5003; k++) touched += block[i][k] != 1 + i % 251;
  CHECK(touched == 0);
  stf_pool_free(&pool);
  steif_context_free(&ctx);
}

static void count_down(void *object) { --*(int *)object; }

static void owned_objects_are_destroyed_once(void)
{
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  int left = 7;
  CHECK(stf_pool_adopt(pool, &left, count_down) == STEIF_OK);
  CHECK(stf_pool_adopt(pool, &left, count_down) == STEIF_OK);
  CHECK(left == 7);
  stf_pool_free(&pool);
  CHECK(left == 5);
  steif_context_free(&ctx);
}

static void impossible_sizes_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  stf_pool *pool = stf_pool_new(ctx);
  const size_t half = SIZE_MAX / 2 + 3;
  CHECK(stf_pool_array(pool, half, 2) == NULL);
  CHECK(stf_pool_array(pool, 2, half) == NULL);
  CHECK(stf_pool_array(pool, SIZE_MAX - 5, 1) == NULL);
  CHECK(stf_allocate(ctx, SIZE_MAX - 5, 1) == NULL);
  CHECK(stf_allocate(ctx, half, 2) == NULL);
  CHECK(steif_status(ctx) == STEIF_NO_MEMORY);
  CHECK(strstr(steif_message(ctx), "make the problem smaller"));
  stf_pool_free(&pool);
  steif_context_free(&ctx);
}

/* A life of a pool: 1 when everything was served. */
static int live(steif_context *ctx, N_Vector like, int *owned)
{
  stf_pool *pool = stf_pool_new(ctx);
  int whole = pool != NULL;
  whole = whole && stf_pool_array(pool, 11, sizeof(double));
  whole = whole && stf_pool_vectors(pool, 3, like);
  if (whole) {
    ++*owned;
    whole = stf_pool_adopt(pool, owned, count_down) == STEIF_OK;
  }
  whole = whole && stf_pool_array(pool, 13, 1);
  stf_pool_free(&pool);
  return whole;
}

static void any_allocation_may_fail(void)
{
  failing f = {0};
  const steif_setup setup = failing_setup(&f);
  steif_context *ctx = steif_context_new(&setup);
  N_Vector like = N_VNew_Serial(17, steif_sundials(ctx));
  const long at_rest = f.alive;
  int owned = 0, refused = 0;
  for (int whole = 0; !whole && refused < 100; refused += !whole) {
    steif_forget(ctx);
    f.served = 0, f.refuse_at = refused + 1;
    whole = live(ctx, like, &owned);
    CHECK(whole == (steif_status(ctx) == STEIF_OK));
    CHECK(whole || steif_status(ctx) == STEIF_NO_MEMORY);
    CHECK(f.alive == at_rest && owned == 0);
  }
  /* pool, block, array, operations, two blocks for each of three vectors, owner, block */
  CHECK(refused == 12);
  N_VDestroy(like);
  steif_context_free(&ctx);
  CHECK(f.alive == 0);
}

CU_TestInfo tests_of_pool[] = {
  {"blocks start on a cache line and are zero", blocks_start_on_a_cache_line_and_are_zero},
  {"vectors are zeroed clones", vectors_are_zeroed_clones},
  {"views lie on their array", views_lie_on_their_array},
  {"blocks do not overlap", blocks_do_not_overlap},
  {"owned objects are destroyed once", owned_objects_are_destroyed_once},
  {"impossible sizes are refused", impossible_sizes_are_refused},
  {"any allocation may fail", any_allocation_may_fail},
  CU_TEST_INFO_NULL,
};
