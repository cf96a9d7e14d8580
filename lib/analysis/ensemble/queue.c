/* queue.c: members to the workers in chunks, their records back in order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "workers.h"
#include <stdio.h>
#include <string.h>

enum { LARGEST_CHUNK = 64, SHARES = 32, CHUNKS_KEPT = 4, WINDOW = 16 << 20 };
static const double chunk_seconds = 0.1;

/* Places of the window: some chunks of every worker, and as many as fit into WINDOW bytes, so that a slow member at the
 * head does not stop the others. */
static long long room_of(const stf_queue *q, int threads)
{
  const size_t record = q->e->record;
  const long long least = CHUNKS_KEPT * q->chunk * threads;
  const long long fit = record < WINDOW ? WINDOW / (long long)(record + sizeof *q->place) : 0;
  const long long room = fit > least ? fit : least;
  return room < q->count ? room : q->count;
}

int stf_queue_open(steif_context *ctx, stf_queue *q, int threads)
{
  const int workers = q->e->take && q->e->workers > threads ? q->e->workers : threads;
  const long long fair = q->count / ((long long)SHARES * workers);
  q->chunk = fair < 1 ? 1 : fair > LARGEST_CHUNK ? LARGEST_CHUNK : fair;
  q->room = room_of(q, threads);
  q->place = stf_allocate(ctx, (size_t)q->room, sizeof *q->place);
  q->record = stf_allocate(ctx, (size_t)q->room, q->e->record ? q->e->record : 1);
  if (!q->place || !q->record) {
    stf_release(ctx, q->place);
    stf_release(ctx, q->record);
    return STEIF_NO_MEMORY;
  }
  pthread_mutex_init(&q->lock, NULL);
  pthread_cond_init(&q->moved, NULL);
  return STEIF_OK;
}

void stf_queue_close(steif_context *ctx, stf_queue *q)
{
  pthread_cond_destroy(&q->moved);
  pthread_mutex_destroy(&q->lock);
  stf_release(ctx, q->place);
  stf_release(ctx, q->record);
}

static void end(stf_queue *q, int code, const char *message)
{
  if (q->code) return;
  q->code = code;
  snprintf(q->message, sizeof q->message, "%s", message);
  pthread_cond_broadcast(&q->moved);
}

static bool ended(stf_queue *q)
{
  if (!q->code && q->e->stop && *q->e->stop)
    end(q, STEIF_STOPPED, "the ensemble was stopped; members that were finished are kept");
  return q->code;
}

long long stf_queue_fit(const stf_queue *q, long long members, double seconds)
{
  const double fit = chunk_seconds * (double)members;
  return fit >= seconds * (double)q->chunk ? q->chunk
         : fit > seconds                   ? (long long)(fit / seconds)
                                           : 1;
}

stf_share stf_queue_take(stf_queue *q, long long chunk)
{
  stf_share share = {0};
  pthread_mutex_lock(&q->lock);
  if (!ended(q)) {
    share.first = q->e->take ? q->e->take(chunk, q->e->queue) : q->next;
    const long long left = q->count - share.first;
    share.count = left < 0 ? 0 : left < chunk ? left : chunk;
    share.place = q->taken;
    q->next = share.first + share.count;
    q->taken += share.count;
  }
  pthread_mutex_unlock(&q->lock);
  return share;
}

void *stf_queue_slot(stf_queue *q, long long place, long long index)
{
  char *record = NULL;
  pthread_mutex_lock(&q->lock);
  while (!ended(q) && place >= q->delivered + q->room) pthread_cond_wait(&q->moved, &q->lock);
  if (!ended(q)) {
    const long long slot = place % q->room;
    q->place[slot] = (stf_place){.index = index};
    record = q->record + (size_t)slot * q->e->record;
    memset(record, 0, q->e->record);
  }
  pthread_mutex_unlock(&q->lock);
  return record;
}

/* Records ready at the head of the window. Only one thread is in here; e->row runs without the lock. */
static void deliver(stf_queue *q, bool gaps)
{
  q->delivering = true;
  while (q->delivered < q->taken) {
    const long long slot = q->delivered % q->room;
    const stf_place at = q->place[slot];
    if (!at.ready && !gaps) break;
    if (at.ready && at.run && q->e->row) {
      pthread_mutex_unlock(&q->lock);
      const int code = q->e->row(at.index, q->record + (size_t)slot * q->e->record, q->e->user);
      pthread_mutex_lock(&q->lock);
      if (code) {
        char text[96];
        snprintf(text, sizeof text, "'row' returned %d for member %lld", code, at.index);
        end(q, STEIF_CALLBACK, text);
        q->refused = true;
        break;
      }
    }
    q->place[slot] = (stf_place){0};
    q->delivered++;
    pthread_cond_broadcast(&q->moved);
  }
  q->delivering = false;
}

void stf_queue_ready(stf_queue *q, long long place, bool run)
{
  stf_place *at = &q->place[place % q->room];
  pthread_mutex_lock(&q->lock);
  at->run = run;
  at->ready = true;
  if (!q->delivering && !q->refused && place == q->delivered) deliver(q, false);
  pthread_mutex_unlock(&q->lock);
}

void stf_queue_end(stf_queue *q, int code, const char *message)
{
  pthread_mutex_lock(&q->lock);
  if (code)
    end(q, code, message);
  else if (!q->refused) /* all workers have left: gaps are members given up */
    deliver(q, true);
  pthread_mutex_unlock(&q->lock);
}

bool stf_queue_ended(stf_queue *q)
{
  pthread_mutex_lock(&q->lock);
  const bool yes = ended(q);
  pthread_mutex_unlock(&q->lock);
  return yes;
}
