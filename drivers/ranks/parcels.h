/* parcels.h: numbered records of all ranks come to rank 0, which shows them in order. Ranks send some at a time and
 * do not wait; rank 0 looks for them whenever it has one of its own.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PARCELS_H
#define PARCELS_H

#include <stdbool.h>
#include <stddef.h>

typedef int parcel_shown(long long k, const void *record, void *user);
typedef struct parcels {
  int rank, ranks;
  parcel_shown *show; /* on rank 0; NULL: nothing is shown */
  void *user;
  /* To be sent. */
  size_t bytes; /* of a record */
  char *batch;
  long long held;
  double since;
  struct flying *flying;
  /* On rank 0: a heap, the smallest number first. */
  struct kept **heap;
  size_t count, room;
  long long next; /* to be shown */
  int ended;      /* ranks that have no more */
  bool failed;    /* no memory, or a record could not be shown */
} parcels;

/* Nonzero: it could not be kept, sent or shown. */
int parcels_put(parcels *p, long long k, const void *record, size_t bytes);
/* On all ranks: what is left, with gaps; frees all. Nonzero: something was lost. */
int parcels_end(parcels *p);

#endif
