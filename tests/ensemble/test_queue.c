/* test_queue.c: the window of records and the size of chunks, by members that take long.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <stdatomic.h>
#include <steif/ensemble.h>
#include <time.h>

/* A slow member at the head does not stop the others: with two workers all of them have run when it ends. */
typedef struct waiting {
  atomic_int run;
  int seen;
} waiting;

static int slow_head(steif_context *ctx, long long i, steif_problem *p, steif_options *o,
                     void *user)
{
  waiting *w = user;
  (void)ctx, (void)p, (void)o;
  for (int k = 0; i == 0 && k < 10000 && w->run < 1999; k++)
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
  if (i == 0) w->seen = w->run;
  atomic_fetch_add(&w->run, 1);
  return -1;
}

static int nothing(steif_context *ctx, long long i, const steif_problem *p, steif_solver *s,
                   int code, void *record, void *user)
{
  (void)ctx, (void)i, (void)p, (void)s, (void)code, (void)record, (void)user;
  return 0;
}

static void slow_members_wait_alone(void)
{
  waiting w = {0};
  steif_context *ctx = steif_context_new(NULL);
  const steif_ensemble_options e = {.problem = "rober", .threads = 2, .record = 8, .user = &w};
  CHECK(steif_ensemble(ctx, 2000, slow_head, nothing, &e) == STEIF_OK);
  CHECK(w.seen == 1999);
  steif_context_free(&ctx);
}

/* Members of 25 ms are taken in chunks of 3 at most, the first alone. */
enum { MANY = 6400, CALLS = 6 };
typedef struct portions {
  long long next, first, largest;
  int calls;
} portions;

static long long take_portion(long long chunk, void *queue)
{
  portions *p = queue;
  if (!p->first) p->first = chunk;
  if (chunk > p->largest) p->largest = chunk;
  p->next += chunk;
  return ++p->calls > CALLS ? MANY : p->next - chunk;
}

static int sleeps(steif_context *ctx, long long i, steif_problem *p, steif_options *o,
                  void *user)
{
  (void)ctx, (void)i, (void)p, (void)o, (void)user;
  nanosleep(&(struct timespec){.tv_nsec = 25000000}, NULL);
  return -1;
}

static void chunks_by_time(void)
{
  portions p = {0};
  steif_context *ctx = steif_context_new(NULL);
  const steif_ensemble_options e = {
    .problem = "rober", .threads = 1, .take = take_portion, .queue = &p};
  CHECK(steif_ensemble(ctx, MANY, sleeps, nothing, &e) == STEIF_OK);
  CHECK(p.first == 1 && p.largest <= 3);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_queue[] = {{"slow members wait alone", slow_members_wait_alone},
                                {"chunks by time", chunks_by_time},
                                CU_TEST_INFO_NULL};
