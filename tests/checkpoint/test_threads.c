/* test_threads.c: an ensemble in one process, a context for each thread: every run has the bits that it has
 * alone, and failures stay in their context.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"
#include <pthread.h>
#include <string.h>

enum { THREADS = 8, RUNS = 6 };

static const char *const methods[] = {"radau:s=3", "bdf",  "dirk:hw43",
                                      "rodas4",    "auto", "gauss:s=2"};

typedef struct member {
  int number;
  sunrealtype mu[RUNS], end[RUNS][2];
  long steps[RUNS];
  int failures;
} member;

/* Runs with parameters of their own, saved and loaded on the way, and one that fails. */
static void *work(void *data)
{
  member *m = data;
  char path[64];
  steif_context *ctx = steif_context_new(&(steif_setup){.threads = 1});
  snprintf(path, sizeof path, "ensemble_%d.%ld.ck", m->number, (long)getpid());
  for (int k = 0; ctx && k < RUNS; k++) {
    steif_problem p = oscillator();
    m->mu[k] = 20 + 7 * m->number + k;
    p.user = &m->mu[k];
    steif_solver *a = under_way(ctx, &p, methods[k], NULL);
    if (!a || steif_checkpoint_save(a, path, NULL, 0)) m->failures++;
    steif_solver *b = steif_checkpoint_load(ctx, path, &p, NULL);
    if (!b || steif_solve_to(b, 3)) m->failures++;
    if (b) memcpy(m->end[k], NV_DATA_S(steif_solution(b)), sizeof m->end[k]);
    if (b) m->steps[k] = steif_statistics(b)->steps;
    steif_solver_free(&a), steif_solver_free(&b);
    p.name = methods[k], p.y0 = NULL;
    a = steif_solver_new(ctx, &p, "bdf", NULL);
    if (a || !strstr(steif_message(ctx), methods[k])) m->failures++;
  }
  remove(path);
  steif_context_free(&ctx);
  return NULL;
}

static void ensembles_have_the_bits_of_single_runs(void)
{
  static member together[THREADS], alone[THREADS];
  pthread_t thread[THREADS];
  for (int i = 0; i < THREADS; i++) {
    together[i].number = alone[i].number = i;
    CU_ASSERT_FATAL(!pthread_create(&thread[i], NULL, work, &together[i]));
  }
  for (int i = 0; i < THREADS; i++) pthread_join(thread[i], NULL);
  for (int i = 0; i < THREADS; i++) {
    work(&alone[i]);
    CHECK(!together[i].failures && !alone[i].failures);
    CHECK(!memcmp(together[i].end, alone[i].end, sizeof alone[i].end));
    CHECK(!memcmp(together[i].steps, alone[i].steps, sizeof alone[i].steps));
  }
}

CU_TestInfo tests_of_threads[] = {
  {"ensembles have the bits of single runs", ensembles_have_the_bits_of_single_runs},
  CU_TEST_INFO_NULL};
