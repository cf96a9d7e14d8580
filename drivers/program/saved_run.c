/* saved_run.c: when the program saves a run, and how it goes on.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saved_run.h"
#include "saved_note.h"
#include <stdlib.h>
#include <time.h>

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A code of steif; STEIF_BAD_INPUT: not here. */
static int save(trajectory *tr, steif_solver *s)
{
  size_t bytes;
  char *note = note_write(tr, &bytes);
  const int code =
    note ? steif_checkpoint_save(s, tr->checkpoint, note, bytes) : STEIF_NO_MEMORY;
  free(note);
  if (code == STEIF_OK) tr->saved = true;
  tr->saved_at = now();
  return code;
}

int saved_run_tick(trajectory *tr, steif_solver *s)
{
  if (!tr->checkpoint) return 0;
  if (tr->saved && now() - tr->saved_at < tr->every) return 0;
  const int code = save(tr, s);
  if (code && code != STEIF_BAD_INPUT && !tr->saved) return -1;
  if (code && code != STEIF_BAD_INPUT) say(tr->call, "%s", steif_message(tr->call->ctx));
  steif_forget(tr->call->ctx);
  return 0;
}

void saved_run_end(trajectory *tr, steif_solver *s, const outcome *o)
{
  const bool kept = o->code == STEIF_OK || o->code == STEIF_EVENT || o->code == STEIF_STOPPED ||
                    o->code == STEIF_TIME_LIMIT;
  if (!tr->checkpoint || !s || !kept) return;
  if (save(tr, s) != STEIF_OK) say(tr->call, "%s", steif_message(tr->call->ctx));
  steif_forget(tr->call->ctx);
}

/* The end of the call is another than that of the file. */
static int extend(struct call *call, steif_solver *s, double t1, double before)
{
  if (!given(call, "--t1") || t1 == before) return EXIT_OK;
  if (given(call, "--points"))
    return bad_usage(call, "--points are those of the interval that was saved: leave --t1 out");
  return steif_solver_extend(s, t1) ? fail(call) : EXIT_OK;
}

static int changed(const struct call *call)
{
  say(
    call,
    "\"%s\" was saved before %s, or a file that it reads, changed: bring the files of that run "
    "back, or solve anew "
    "[STEIF_BAD_INPUT]",
    call->continues, call->word[0]);
  return EXIT_FILE;
}

int saved_run_load(struct call *call, const steif_problem *p, const steif_options *options,
                   trajectory *tr, steif_solver **s)
{
  steif_checkpoint *c = steif_checkpoint_read(call->ctx, call->continues);
  if (!c) return fail_file(call);
  const double before = c->t1;
  if (c->repeats)
    say(call, "%s keeps its history to itself: its %ld steps to t = %.6g are repeated, %.3g s",
        c->method, c->steps, c->t, c->cpu_s);
  const int code = note_read(tr, c->note, c->note_bytes);
  steif_checkpoint_free(call->ctx, &c);
  if (code > 0) return changed(call);
  if (code) return no_memory(call, "the rows of the run", "give the process more");
  *s = steif_checkpoint_load(call->ctx, call->continues, p, options);
  tr->saved = true;
  tr->saved_at = now();
  /* The first row of a run whose steps until here were not kept. */
  if (*s && !tr->count && !tr->asked && options->observe)
    options->observe(*s, steif_time(*s), steif_solution(*s), options->observer);
  return *s ? extend(call, *s, real_of(call, "--t1"), before) : fail_file(call);
}
