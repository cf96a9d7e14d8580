/* failing.h: an allocator that counts, and refuses the k-th request.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FAILING_H
#define FAILING_H

#include <stdlib.h>
#include <steif/base.h>

typedef struct failing {
  long served, refuse_at; /* refuse request number refuse_at, counted from 1; 0: none */
  long alive;
} failing;

static inline void *failing_allocate(size_t bytes, void *user)
{
  failing *f = user;
  if (++f->served == f->refuse_at) return NULL;
  void *block = malloc(bytes);
  if (block) f->alive++;
  return block;
}

static inline void failing_release(void *block, void *user)
{
  failing *f = user;
  if (block) f->alive--;
  free(block);
}

static inline steif_setup failing_setup(failing *f)
{
  return (steif_setup){.allocate = failing_allocate, .release = failing_release, .user = f};
}

#endif
