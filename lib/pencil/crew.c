/* crew.c: factors the slots of one call side by side on the cores that the context allows. Each
 * slot is independent of the others, so the factors do not depend on the number of threads.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include <pthread.h>
#include <stdatomic.h>

typedef struct crew {
  steif_pencil *p;
  int count;
  const int *slots;
  const steif_shift *s;
  stf_outcome *out;
  atomic_int next;
} crew;

static void *work(void *argument)
{
  crew *c = argument;
  for (int i; (i = atomic_fetch_add(&c->next, 1)) < c->count;)
    c->p->backend->factor(c->p, c->slots[i], c->s[c->slots[i]], &c->out[i]);
  return NULL;
}

/* A thread that cannot be had leaves its share to the others. */
static void together(crew *c, int threads)
{
  pthread_t id[STEIF_PENCIL_SLOTS];
  int started = 0;
  while (started < threads - 1 && !pthread_create(&id[started], NULL, work, c)) started++;
  work(c);
  while (started) pthread_join(id[--started], NULL);
}

void stf_crew_factor(steif_pencil *p, int count, const int *slots, const steif_shift *s,
                     stf_outcome *out)
{
  const stf_backend *b = p->backend;
  const int cores = stf_threads(p->ctx), threads = cores < count ? cores : count;
  if (threads > 1 && b->crowd && p->n >= b->crowd) {
    crew c = {.p = p, .count = count, .slots = slots, .s = s, .out = out};
    atomic_init(&c.next, 0);
    together(&c, threads);
  } else
    for (int i = 0; i < count; i++) b->factor(p, slots[i], s[slots[i]], &out[i]);
}
