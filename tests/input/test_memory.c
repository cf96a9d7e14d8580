/* test_memory.c: every allocation fails once, of the context and, where the C library can be
 * replaced, of CHOLMOD, SUNDIALS and stdio too: a sentence, no leak, no crash; and nothing is
 * allocated by an evaluation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <errno.h>
#include <stdlib.h>

#if defined(__SANITIZE_ADDRESS__)
#define REPLACED 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define REPLACED 0
#endif
#endif
#if !defined(REPLACED) && defined(__GLIBC__)
#define REPLACED 1
#elif !defined(REPLACED)
#define REPLACED 0
#endif

#if REPLACED
static long asked, fail_at, live; /* fail_at > 0: that request to the C library fails */
/* Exported, so that the libraries find these too. */
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void __libc_free(void *);
static int granted(void)
{
  if (++asked != fail_at) return 1;
  errno = ENOMEM;
  return 0;
}
static void *counted(void *block)
{
  live += block != NULL;
  return block;
}
STEIF_EXPORT void *malloc(size_t size)
{
  return granted() ? counted(__libc_malloc(size)) : NULL;
}
STEIF_EXPORT void *calloc(size_t n, size_t size)
{
  return granted() ? counted(__libc_calloc(n, size)) : NULL;
}
STEIF_EXPORT void *realloc(void *p, size_t size)
{
  void *block = granted() ? __libc_realloc(p, size) : NULL;
  live += block && !p;
  return block;
}
STEIF_EXPORT void free(void *p)
{
  live -= p != NULL;
  __libc_free(p);
}
#endif

static const char head[] = "%%MatrixMarket matrix ";
static char sparse_path[400], dense_path[400], text_path[400], csv_path[400], out_path[400];

static void prepare(void)
{
  char text[512];
  snprintf(text, sizeof text,
           "%scoordinate real symmetric\n3 3 4\n1 1 2\n2 1 4\n3 3 1\n3 3 2\n", head);
  strcpy(sparse_path, put("sparse.mtx", text));
  snprintf(text, sizeof text, "%sarray real general\n3 3\n1\n2\n3\n4\n5\n6\n7\n8\n9\n", head);
  strcpy(dense_path, put("dense.mtx", text));
  strcpy(text_path, put("f.txt", "sin(t)\n2^(1/3)*t\nstep(t - 2)\n"));
  strcpy(csv_path, put("f.csv", "t,a,b,c\n0,1,2,3\n1,2,3,4\n2,5,4,3\n3,2,1,1\n"));
  strcpy(out_path, in_folder("out.mtx"));
}

/* Everything once; the code of the first failure. */
static int everything(steif_context *ctx)
{
  SUNMatrix E = NULL, F = NULL;
  double accuracy, time;
  int code = steif_system_read(ctx, sparse_path, dense_path, 0, &E, &F);
  steif_function *f = NULL, *g = NULL, *h = NULL;
  if (!code && !(at(E, 0, 1) == 4 && at(E, 2, 2) == 3 && at(F, 1, 2) == 8)) code = -98;
  if (!code) code = steif_matrix_write(ctx, E, out_path);
  if (!code) code = steif_matrix_write(ctx, F, out_path);
  if (!code && !(f = steif_function_read(ctx, text_path, 3, E))) code = steif_status(ctx);
  if (!code && !(g = steif_function_parse(ctx, "t; t; t^2.5", 3, F))) code = steif_status(ctx);
  if (!code && !(h = steif_function_samples(ctx, csv_path, 3, NULL, 3, &accuracy)))
    code = steif_status(ctx);
  if (!code && steif_function_breaks(f, 0, 9, 1, &time) != 1) code = -99;
  steif_function_free(&f), steif_function_free(&g), steif_function_free(&h);
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}

static void every_allocation_of_the_context_may_fail(void)
{
  failing c = {0};
  const steif_setup setup = failing_setup(&c);
  prepare();
  steif_context *ctx = steif_context_new(&setup);
  const long owned = c.alive;
  CHECK(!everything(ctx));
  const long most = c.served;
  CHECK(c.alive == owned && most > 20);
  for (long k = 1; k <= most - owned; k++) {
    steif_forget(ctx);
    c.served = 0, c.refuse_at = k;
    CHECK(everything(ctx) == STEIF_NO_MEMORY);
    SAYS(ctx, "no memory");
    CHECK(c.alive == owned);
  }
  c.refuse_at = 0;
  steif_context_free(&ctx);
  CHECK(c.alive == 0);
}

static void every_allocation_of_the_C_library_may_fail(void)
{
#if REPLACED
  prepare();
  steif_context *ctx = steif_context_new(NULL);
  CHECK(!everything(ctx));
  long failed = asked = fail_at = 0;
  CHECK(!everything(ctx));
  const long most = asked;
  CHECK(most == 0 || most > 40); /* 0: valgrind has replaced it before us */
  for (long k = 1; k <= most; k++) {
    steif_forget(ctx);
    const long before = live;
    asked = 0, fail_at = k;
    /* stdio does without a buffer, and CHOLMOD asks again for less: no failure then. */
    const int code = everything(ctx), left = (int)(live - before);
    fail_at = 0;
    if (code && code != STEIF_NO_MEMORY)
      printf("\n  %ld of %ld: %d, %s", k, most, code, steif_message(ctx));
    CHECK(!code || code == STEIF_NO_MEMORY);
    /* SUNDIALS 7 loses the header of a matrix whose content finds no memory. */
    CHECK(left == 0 || SUNDIALS_VERSION_MAJOR >= 7);
    failed += code != STEIF_OK;
  }
  CHECK(most == 0 || failed > 35);
  steif_context_free(&ctx);
#endif
}

static void an_evaluation_allocates_nothing(void)
{
#if REPLACED
  prepare();
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_read(ctx, text_path, 3, NULL),
                 *g = steif_function_samples(ctx, csv_path, 3, NULL, 3, NULL);
  N_Vector v = N_VNew_Serial(3, steif_sundials(ctx));
  const long before = asked;
  for (int k = 0; k <= 64; k++) {
    CHECK(!steif_function_value(1.5, k, v, f));
    CHECK(!steif_function_value(1.5, k % 3, v, g));
    CHECK(steif_function_value(9, k, v, g) > 0);
  }
  CHECK(asked == before);
  N_VDestroy(v);
  steif_function_free(&f), steif_function_free(&g);
  steif_context_free(&ctx);
#endif
}

CU_TestInfo tests_of_memory[] = {
  {"every allocation of the context may fail", every_allocation_of_the_context_may_fail},
  {"every allocation of the C library may fail", every_allocation_of_the_C_library_may_fail},
  {"an evaluation allocates nothing", an_evaluation_allocates_nothing},
  CU_TEST_INFO_NULL};
