/* law_memory.c: thrift: nothing is allocated while stepping; hunger: the k-th allocation fails, for
 * every k, through the context's allocator and, where the C library can be replaced, in SUNDIALS and
 * KLU too.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "laws.h"
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
static long asked, fail_at; /* fail_at > 0: that allocation of the C library fails */
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
static int granted(void) { return ++asked != fail_at; }
STEIF_EXPORT void *malloc(size_t size) { return granted() ? __libc_malloc(size) : NULL; }
STEIF_EXPORT void *calloc(size_t n, size_t size)
{
  return granted() ? __libc_calloc(n, size) : NULL;
}
STEIF_EXPORT void *realloc(void *p, size_t size)
{
  return granted() ? __libc_realloc(p, size) : NULL;
}
#endif

#if REPLACED
static const char *const problems[] = {"hires", "transamp", "heat:n=40", "medakzo",
                                       "jordan:k=3"};
#endif

static void stepping_allocates_nothing(void)
{
#if REPLACED
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = 1});
  for (int i = 0; i < 5; i++)
    for (int m = 0; m < law_implicit_count; m++) {
      steif_problem p;
      steif_options o = steif_defaults();
      CU_ASSERT_FATAL(!steif_problem_find(ctx, problems[i], &p));
      o.h = 1e-3 * p.t1 / 128, o.t1 = 1e-3 * p.t1;
      steif_solver *s = steif_solver_new(ctx, &p, law_methods[m], &o);
      for (int k = 0; s && k < 8; k++)
        CHECK(!steif_solve_step(s)); /* factors of all orders made */
      const long before = asked;
      int code = 0;
      for (int k = 0; s && k < 20 && !code; k++) code = steif_solve_step(s);
      if (asked != before)
        printf("\n  %s %s: %ld", problems[i], law_methods[m], asked - before);
      CHECK(asked == before);
      steif_solver_free(&s);
      steif_problem_clear(ctx, &p);
    }
  steif_context_free(&ctx);
#endif
}

/* Events found, reacted to and begun anew from are part of stepping. */
static void events_allocate_nothing(void)
{
#if REPLACED
  static const char *const methods[] = {"radau:s=3", "bdf", "rodas4", "dirk:hw43"};
  static const char *const watched[] = {"rectifier", "swing", "bounce"};
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = 1});
  for (int i = 0; i < 3; i++)
    for (int m = 0; m < 4; m++) {
      steif_problem p;
      CU_ASSERT_FATAL(!steif_problem_find(ctx, watched[i], &p));
      steif_solver *s = steif_solver_new(ctx, &p, methods[m], NULL);
      int code = 0;
      for (int k = 0; s && k < 8 && !code; k++) code = steif_solve_step(s);
      const long before = asked;
      if (s && !code) code = steif_solve_to(s, p.t1);
      if (asked != before) printf("\n  %s %s: %ld", watched[i], methods[m], asked - before);
      CHECK(s && !code && asked == before);
      steif_solver_free(&s);
      steif_problem_clear(ctx, &p);
    }
  steif_context_free(&ctx);
#endif
}

/* Find, open, run and close; the code of the first failure. */
static int life(steif_context *ctx, const char *problem, const char *method)
{
  steif_problem p;
  int code = steif_problem_find(ctx, problem, &p);
  if (code) return code;
  steif_options o = steif_defaults();
  o.h = p.t1 / 100000, o.t1 = 3 * o.h;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  code = s ? steif_solve_to(s, o.t1) : steif_status(ctx);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  return code;
}

/* Splitting methods and compensated sums on problems of their own. */
static void splitting_allocates_nothing(void)
{
#if REPLACED
  static const char *const methods[] = {"verlet:compensated=1", "verlet:first=drift",
                                        "symeuler", "kahanli8:compensated=0",
                                        "gauss:s=2,compensated=1"};
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = 1});
  for (int m = 0; m < 5; m++) {
    steif_problem p;
    steif_options o = steif_defaults();
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "fpu:n=37", &p));
    o.h = 0.07, o.t1 = 7;
    steif_solver *s = steif_solver_new(ctx, &p, methods[m], &o);
    CU_ASSERT_FATAL(s != NULL);
    for (int k = 0; k < 3; k++) CHECK(!steif_solve_step(s));
    const long before = asked;
    CHECK(!steif_solve_to(s, 6.99));
    CU_ASSERT_EQUAL(asked, before);
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
#endif
}

static const char *const lives[][2] = {{"hires", "radau:s=3"},
                                       {"transamp", "bdf:p=3"},
                                       {"heat:n=30", "gauss:s=2"},
                                       {"bruss2d:n=4", "radau:s=2"},
                                       {"jordan:k=3", "dirk:alexander2"},
                                       {"parabolic:n=9", "hochost4"},
                                       {"bruss2d:n=4", "exprb43"},
                                       {"swing", "radau:s=2"},
                                       {"fpu:n=3", "yoshida4:compensated=1"},
                                       {"pendulum", "gauss:s=2,compensated=1"},
                                       {"hires", "glm:irks,p=2"},
                                       {"harmonic", "glm:ab,p=3"}};
enum { LIVES = sizeof lives / sizeof *lives };

static void the_allocator_may_fail_anywhere(void)
{
  for (int i = 0; i < LIVES; i++)
    for (long k = 1;; k++) {
      failing memory = {.refuse_at = k};
      steif_setup setup = failing_setup(&memory);
      setup.threads = 1;
      steif_context *ctx = steif_context_new(&setup);
      const int code = ctx ? life(ctx, lives[i][0], lives[i][1]) : STEIF_NO_MEMORY;
      steif_context_free(&ctx);
      CHECK(memory.alive == 0);
      if (memory.served < k) {
        if (code) printf("\n  %s %s: %d after %ld", lives[i][0], lives[i][1], code, k);
        CHECK(code == STEIF_OK && k > 20);
        break;
      }
      if (code != STEIF_NO_MEMORY)
        printf("\n  %s %s k = %ld: %d", lives[i][0], lives[i][1], k, code);
      CHECK(code == STEIF_NO_MEMORY);
    }
}

static void the_c_library_may_fail_anywhere(void)
{
#if REPLACED
  for (int i = 0; i < LIVES; i++)
    for (long k = 1;; k++) {
      steif_context *ctx = steif_context_new(&(steif_setup){.threads = 1});
      asked = 0, fail_at = k;
      const int code = life(ctx, lives[i][0], lives[i][1]);
      const int reached = asked >= k;
      fail_at = 0;
      steif_context_free(&ctx);
      if (!reached) {
        if (code) printf("\n  %s %s: %d after %ld", lives[i][0], lives[i][1], code, k);
        CHECK(code == STEIF_OK && k > 8);
        break;
      }
      if (code != STEIF_NO_MEMORY && code != STEIF_OK)
        printf("\n  %s %s k = %ld: %d", lives[i][0], lives[i][1], k, code);
      CHECK(code == STEIF_NO_MEMORY || code == STEIF_OK);
    }
#endif
}

CU_TestInfo tests_of_law_memory[] = {
  {"stepping allocates nothing", stepping_allocates_nothing},
  {"events allocate nothing", events_allocate_nothing},
  {"splitting methods allocate nothing while stepping", splitting_allocates_nothing},
  {"the allocator may fail anywhere", the_allocator_may_fail_anywhere},
  {"the C library may fail anywhere", the_c_library_may_fail_anywhere},
  CU_TEST_INFO_NULL};
