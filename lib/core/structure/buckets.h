/* buckets.h: items in doubly linked lists by a small key, for shortest paths of whole lengths.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BUCKETS_H
#define STF_BUCKETS_H

#include <sundials/sundials_types.h>

enum { FREE = -1 }; /* no item, no key, no partner */

/* Items 0 .. n-1; key FREE: in no list yet. */
typedef struct buckets {
  sunindextype *key, *next, *previous, *head; /* head: of each key from 0 on */
} buckets;

static inline void bucket_leave(buckets *b, sunindextype item)
{
  if (b->previous[item] == FREE)
    b->head[b->key[item]] = b->next[item];
  else
    b->next[b->previous[item]] = b->next[item];
  if (b->next[item] != FREE) b->previous[b->next[item]] = b->previous[item];
}

/* Into the list of `key`, out of the one it was in. */
static inline void bucket_move(buckets *b, sunindextype item, sunindextype key)
{
  if (b->key[item] != FREE) bucket_leave(b, item);
  b->key[item] = key;
  b->previous[item] = FREE;
  b->next[item] = b->head[key];
  if (b->head[key] != FREE) b->previous[b->head[key]] = item;
  b->head[key] = item;
}

/* The first item of a list leaves it and keeps its key; FREE: none. */
static inline sunindextype bucket_take(buckets *b, sunindextype key)
{
  const sunindextype item = b->head[key];
  if (item != FREE) bucket_leave(b, item);
  return item;
}

#endif
