/* threads.c: independent pieces of work side by side on the cores that the context allows: what
 * comes out does not depend on the number of threads.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include <pthread.h>
#include <stdatomic.h>

enum { THREADS = 64 };

typedef struct task_pool {
  void (*work)(void *task, int i);
  void *task;
  int count;
  atomic_int next;
} task_pool;

static void *work(void *argument)
{
  task_pool *c = argument;
  for (int i; (i = atomic_fetch_add(&c->next, 1)) < c->count;) c->work(c->task, i);
  return NULL;
}

/* A thread that cannot be had leaves its share to the others. */
void stf_parallel(int threads, int count, void (*piece)(void *task, int i), void *task)
{
  task_pool c = {.work = piece, .task = task, .count = count};
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

void stf_parallel_factor(steif_pencil *p, int count, const int *slots, const steif_shift *s,
                         stf_outcome *out)
{
  const stf_backend *b = p->backend;
  const bool crowd = b->crowd && p->n >= b->crowd;
  stf_parallel(crowd ? stf_threads(p->ctx) : 1, count, factor,
               &(factoring){.p = p, .slots = slots, .s = s, .out = out});
}

/* WIDTH: complex columns that p->work holds. A solve is shorter than a factorisation: threads pay later. */
enum { WIDTH = STF_COLUMNS / 2, LATER = 4 };

typedef struct solving {
  steif_pencil *p;
  int count, slots[WIDTH]; /* complex ones; the real ones together are one piece more */
  int shifts, code[WIDTH + 1];
  N_Vector *re, *im;
} solving;

static int solve_real(solving *s)
{
  for (int k = 0; k < s->shifts; k++)
    if (!stf_is_complex(s->p->shift[k]))
      STEIF_TRY(s->p->backend->solve(s->p, k, 1, &s->re[k], NULL));
  return STEIF_OK;
}

static void solve(void *task, int i)
{
  solving *s = task;
  steif_pencil *p = s->p;
  const size_t n = (size_t)p->n;
  if (i == s->count) {
    s->code[i] = solve_real(s);
    return;
  }
  const int k = s->slots[i];
  double *re = stf_array(s->re[k]), *im = stf_array(s->im[k]), *w = p->work + 2 * n * (size_t)i;
  stf_columns_join(n, re, im, w);
  s->code[i] = p->backend->columns(p, k, 1, w, p->n);
  stf_columns_part(n, w, re, im);
}

int stf_parallel_solve(steif_pencil *p, int count, N_Vector *re, N_Vector *im)
{
  const stf_backend *b = p->backend;
  const int threads = stf_threads(p->ctx);
  int complex = 0;
  for (int k = 0; k < count; k++) complex += stf_is_complex(p->shift[k]);
  if (!b->columns || !b->crowd || p->n < LATER * b->crowd || threads < 2 || complex > WIDTH ||
      count < 2) {
    for (int k = 0; k < count; k++)
      STEIF_TRY(steif_pencil_solve(p, k, 1, re + k, im[k] ? im + k : NULL));
    return STEIF_OK;
  }
  solving s = {.p = p, .shifts = count, .re = re, .im = im};
  for (int k = 0; k < count; k++)
    if (stf_is_complex(p->shift[k])) s.slots[s.count++] = k;
  p->stats.solves += count;
  stf_parallel(threads, s.count + (s.count < count), solve, &s);
  for (int i = 0; i <= s.count; i++) STEIF_TRY(s.code[i]);
  return STEIF_OK;
}
