/* crew.c: independent pieces of work side by side on the cores that the context allows: what
 * comes out does not depend on the number of threads.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include <pthread.h>
#include <stdatomic.h>

enum { THREADS = 64 };

typedef struct crew {
  void (*work)(void *task, int i);
  void *task;
  int count;
  atomic_int next;
} crew;

static void *work(void *argument)
{
  crew *c = argument;
  for (int i; (i = atomic_fetch_add(&c->next, 1)) < c->count;) c->work(c->task, i);
  return NULL;
}

/* A thread that cannot be had leaves its share to the others. */
void stf_crew(int threads, int count, void (*piece)(void *task, int i), void *task)
{
  crew c = {.work = piece, .task = task, .count = count};
  pthread_t id[THREADS];
  int started = 0;
  const int most = threads < count ? threads : count;
  atomic_init(&c.next, 0);
  while (started < most - 1 && started < THREADS &&
         !pthread_create(&id[started], NULL, work, &c))
    started++;
  work(&c);
  while (started) pthread_join(id[--started], NULL);
}

typedef struct factoring {
  steif_pencil *p;
  const int *slots;
  const steif_shift *s;
  stf_outcome *out;
} factoring;

static void factor(void *task, int i)
{
  const factoring *f = task;
  f->p->backend->factor(f->p, f->slots[i], f->s[f->slots[i]], &f->out[i]);
}

void stf_crew_factor(steif_pencil *p, int count, const int *slots, const steif_shift *s,
                     stf_outcome *out)
{
  const stf_backend *b = p->backend;
  const bool crowd = b->crowd && p->n >= b->crowd;
  stf_crew(crowd ? stf_threads(p->ctx) : 1, count, factor,
           &(factoring){.p = p, .slots = slots, .s = s, .out = out});
}
