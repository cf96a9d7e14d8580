/* sweep_clock.c: how many members of a sweep are done, and the time that the others will take.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <pthread.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#define EVERY 0.5 /* seconds */

struct sweep_clock {
  pthread_mutex_t lock;
  long long missing, done;
  double begun, shown;
};

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void say_left(char *text, size_t room, double left)
{
  if (left < 100)
    snprintf(text, room, ", about %.0f s left", left);
  else if (left < 6000)
    snprintf(text, room, ", about %.0f min left", left / 60);
  else
    snprintf(text, room, ", about %.1f h left", left / 3600);
}

static void show_line(const struct sweep *s, const struct sweep_clock *c, double now)
{
  char left[64] = "";
  const double each = c->done ? (now - c->begun) / (double)c->done : 0;
  if (c->done) say_left(left, sizeof left, each * (double)(c->missing - c->done));
  progress(s->call, "%lld of %lld members%s", s->axes.members - c->missing + c->done,
           s->axes.members, left);
}

/* Rows on a terminal are progress enough. */
int sweep_clock_open(struct sweep *s, long long missing)
{
  if (!s->call->csv && isatty(STDOUT_FILENO)) return EXIT_OK;
  struct sweep_clock *c = s->clock = calloc(1, sizeof *c);
  if (!c) return no_memory(s->call, "the progress line", "give the process more");
  pthread_mutex_init(&c->lock, NULL);
  c->missing = missing;
  c->begun = c->shown = seconds();
  show_line(s, c, c->begun);
  return EXIT_OK;
}

void sweep_clock_tick(struct sweep *s)
{
  struct sweep_clock *c = s->clock;
  if (!c) return;
  pthread_mutex_lock(&c->lock);
  const double now = seconds();
  c->done++;
  if (now > c->shown + EVERY) {
    c->shown = now;
    show_line(s, c, now);
  }
  pthread_mutex_unlock(&c->lock);
}

void sweep_clock_close(struct sweep *s)
{
  if (!s->clock) return;
  progress(s->call, NULL);
  pthread_mutex_destroy(&s->clock->lock);
  free(s->clock);
  s->clock = NULL;
}
