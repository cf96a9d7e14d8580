/* parcels.c: records of all ranks, shown in order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parcels.h"
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 64, TAG = 17 };
#define PATIENCE 0.2 /* seconds that a record waits for others */

/* A message: how many records and their bytes, then number and record of each. */
typedef struct head {
  long long count, bytes;
} head;
typedef struct kept {
  long long k;
  char record[];
} kept;
typedef struct flying {
  MPI_Request request;
  struct flying *next;
  char *message;
} flying;

/* -- rank 0 ----------------------------------------------------------------------------------- */

static void swap(parcels *p, size_t a, size_t b)
{
  kept *x = p->heap[a];
  p->heap[a] = p->heap[b], p->heap[b] = x;
}

static int insert(parcels *p, long long k, const void *record, size_t bytes)
{
  if (p->count == p->room) {
    const size_t room = p->room ? 2 * p->room : 256;
    kept **more = realloc(p->heap, room * sizeof *more);
    if (!more) return 1;
    p->heap = more, p->room = room;
  }
  kept *x = malloc(sizeof *x + bytes);
  if (!x) return 1;
  x->k = k;
  memcpy(x->record, record, bytes);
  size_t at = p->count++;
  p->heap[at] = x;
  for (; at && p->heap[(at - 1) / 2]->k > p->heap[at]->k; at = (at - 1) / 2)
    swap(p, at, (at - 1) / 2);
  return 0;
}

static kept *remove_first(parcels *p)
{
  kept *x = p->heap[0];
  p->heap[0] = p->heap[--p->count];
  for (size_t at = 0, low; (low = 2 * at + 1) < p->count; at = low) {
    if (low + 1 < p->count && p->heap[low + 1]->k < p->heap[low]->k) low++;
    if (p->heap[at]->k <= p->heap[low]->k) break;
    swap(p, at, low);
  }
  return x;
}

static void show_next(parcels *p, bool gaps)
{
  while (p->count && (gaps || p->heap[0]->k == p->next)) {
    kept *x = remove_first(p);
    p->next = x->k + 1;
    if (!p->failed && p->show) p->failed = p->show(x->k, x->record, p->user);
    free(x);
  }
}

static void receive(parcels *p, const MPI_Status *status)
{
  int size = 0;
  MPI_Get_count(status, MPI_BYTE, &size);
  char *message = malloc((size_t)size);
  if (!message) MPI_Abort(MPI_COMM_WORLD, 1); /* it would come again and again */
  MPI_Recv(message, size, MPI_BYTE, status->MPI_SOURCE, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  head h;
  memcpy(&h, message, sizeof h);
  p->ended += h.count == 0;
  const char *at = message + sizeof h;
  for (long long i = 0; i < h.count; i++, at += (size_t)h.bytes + sizeof(long long)) {
    long long k;
    memcpy(&k, at, sizeof k);
    p->failed |= insert(p, k, at + sizeof k, (size_t)h.bytes);
  }
  free(message);
  show_next(p, false);
}

static void look(parcels *p)
{
  int there = 1;
  while (there) {
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &there, &status);
    if (there) receive(p, &status);
  }
}

/* -- the others ------------------------------------------------------------------------------- */

/* Messages that have arrived, or all. */
static void forget(parcels *p, bool all)
{
  for (flying **at = &p->flying; *at;) {
    flying *f = *at;
    int gone = 1;
    if (all)
      MPI_Wait(&f->request, MPI_STATUS_IGNORE);
    else
      MPI_Test(&f->request, &gone, MPI_STATUS_IGNORE);
    if (gone) {
      *at = f->next;
      free(f->message);
      free(f);
    } else
      at = &f->next;
  }
}

/* What is held; nothing is held: the end. */
static int send(parcels *p)
{
  const size_t each = sizeof(long long) + p->bytes;
  const size_t size = sizeof(head) + (size_t)p->held * each;
  flying *f = malloc(sizeof *f);
  if (f) f->message = p->batch;
  if (f && !p->batch) f->message = malloc(size);
  if (!f || !f->message) return free(f), 1;
  const head h = {p->held, (long long)p->bytes};
  memcpy(f->message, &h, sizeof h);
  MPI_Isend(f->message, (int)size, MPI_BYTE, 0, TAG, MPI_COMM_WORLD, &f->request);
  f->next = p->flying, p->flying = f;
  p->batch = NULL, p->held = 0;
  forget(p, false);
  return 0;
}

static int hold(parcels *p, long long k, const void *record)
{
  const size_t each = sizeof k + p->bytes;
  if (!p->batch && !(p->batch = malloc(sizeof(head) + BATCH * each))) return 1;
  if (!p->held) p->since = MPI_Wtime();
  char *at = p->batch + sizeof(head) + (size_t)p->held * each;
  memcpy(at, &k, sizeof k);
  memcpy(at + sizeof k, record, p->bytes);
  return ++p->held == BATCH || MPI_Wtime() - p->since > PATIENCE ? send(p) : 0;
}

/* -- both ------------------------------------------------------------------------------------- */

int parcels_put(parcels *p, long long k, const void *record, size_t bytes)
{
  p->bytes = bytes;
  if (p->rank) {
    p->failed |= hold(p, k, record);
  } else {
    p->failed |= insert(p, k, record, bytes);
    show_next(p, false);
    look(p);
  }
  return p->failed;
}

int parcels_end(parcels *p)
{
  if (p->rank) {
    if (p->held) p->failed |= send(p);
    free(p->batch);
    p->batch = NULL, p->held = 0;
    if (send(p)) MPI_Abort(MPI_COMM_WORLD, 1); /* rank 0 would wait for ever */
    forget(p, true);
  } else {
    while (p->ended < p->ranks - 1) {
      MPI_Status status;
      MPI_Probe(MPI_ANY_SOURCE, TAG, MPI_COMM_WORLD, &status);
      receive(p, &status);
    }
    show_next(p, true);
    free(p->heap);
    p->heap = NULL, p->count = p->room = 0;
  }
  return p->failed;
}
