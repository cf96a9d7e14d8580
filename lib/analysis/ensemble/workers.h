/* workers.h: what the workers of an ensemble share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_WORKERS_H
#define STF_WORKERS_H

#include "base.h"
#include <pthread.h>
#include <steif/ensemble.h>

/* A place of the window: a member taken but not delivered. */
typedef struct stf_place {
  long long index;
  bool ready, run; /* finished; with a record */
} stf_place;

/* Members taken here get places p = 0, 1, ... in the order of their numbers; place p stands in slot p mod room, from
 * when it is taken until all places up to it are delivered. A worker whose next place has no slot waits;
 * that of the first place never does, hence the queue cannot stop. */
typedef struct stf_queue {
  const steif_ensemble_options *e;
  steif_member member;
  steif_member_done done;
  long long count, chunk, next; /* chunk: the largest */
  long long taken, delivered;   /* places */
  long long room;
  stf_place *place;
  char *record;
  int code; /* that ended the ensemble */
  char message[1200];
  bool delivering, refused; /* a thread is in e->row; that has returned a failure */
  pthread_mutex_t lock;
  pthread_cond_t moved;
} stf_queue;

/* The numbers first .. first + count - 1 with places from `place`; count 0: there are none any more. */
typedef struct stf_share {
  long long first, count, place;
} stf_share;

int stf_queue_open(steif_context *ctx, stf_queue *q, int threads);
void stf_queue_close(steif_context *ctx, stf_queue *q);
stf_share stf_queue_take(stf_queue *q, long long chunk);
/* How many members are the next chunk of a worker whose last `members` have taken these seconds: q->chunk, and fewer
 * where they take long. */
long long stf_queue_fit(const stf_queue *q, long long members, double seconds);
/* The record of a place, zeroed; waits for a slot. NULL: the ensemble has ended. */
void *stf_queue_slot(stf_queue *q, long long place, long long index);
/* The member of a place has been run, or given up; what can be delivered is. */
void stf_queue_ready(stf_queue *q, long long place, bool run);
/* The first failure stays. */
void stf_queue_end(stf_queue *q, int code, const char *message);
bool stf_queue_ended(stf_queue *q);

#endif
