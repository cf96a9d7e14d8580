/* time.c: least processor time of a repeated piece of work.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bench.h"
#include <time.h>

sunrealtype stf_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (sunrealtype)t.tv_sec + 1e-9 * (sunrealtype)t.tv_nsec;
}

static sunrealtype batch(void (*work)(void *), void *data, long count)
{
  const sunrealtype from = stf_now();
  for (long i = 0; i < count; i++) work(data);
  return stf_now() - from;
}

sunrealtype stf_time(void (*work)(void *data), void *data)
{
  const sunrealtype enough = 4e-3;
  enum { BATCHES = 9 };
  long count = 1;
  sunrealtype took;
  while ((took = batch(work, data, count)) < enough && count < 1L << 40) count *= 2;
  sunrealtype least = took;
  for (int i = 0; i < BATCHES; i++) {
    took = batch(work, data, count);
    if (took < least) least = took;
  }
  return least / (sunrealtype)count;
}
