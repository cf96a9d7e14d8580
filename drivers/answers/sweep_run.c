/* sweep_run.c: a sweep from its words to its end; sweep_members.c has the members.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "interruption.h"
#include "problem.h"
#include "sweep.h"
#include <stdlib.h>
#include <string.h>

/* Columns are those of the first member that can be made. */
static int find_first(struct sweep *s)
{
  enum { TRIES = 1000 };
  int code = STEIF_BAD_INPUT;
  s->first = *s->problem;
  for (long long i = 0; i < s->axes.members && i < TRIES && code; i++) {
    steif_problem varied = {0};
    code = sweep_vary(s->call->ctx, s, i, s->problem, &varied);
    if (code == STEIF_UNKNOWN_NAME || code == STEIF_NO_MEMORY) return code;
    if (code) continue;
    s->first = varied;
    s->made = true;
  }
  return STEIF_OK;
}

/* Is every name a parameter of the problem, and that of the method one? Values are a matter of the members. */
static int check_names(struct sweep *s)
{
  steif_context *ctx = s->call->ctx;
  int code = find_first(s);
  if (!code) {
    steif_forget(ctx);
    steif_solver *solver = steif_solver_new(ctx, &s->first, s->call->word[1], &s->options);
    code = solver ? STEIF_OK : steif_status(ctx);
    steif_solver_free(&solver);
  }
  s->n = s->collect == COLLECT_Y ? (size_t)s->first.n : 0;
  if (code == STEIF_UNKNOWN_NAME) return fail(s->call);
  steif_forget(ctx);
  return EXIT_OK;
}

/* What ended the sweep before all members were run: with --json the object that was begun says it, too. */
static int give_up(struct sweep *s, int code)
{
  const char *message = steif_message(s->call->ctx);
  s->failure = s->unwritten ? STEIF_IO : code;
  if (s->unwritten)
    snprintf(s->why, sizeof s->why, "cannot write \"%s\": %s; %lld of %lld members are written",
             s->unwritten, strerror(s->reason), s->done, s->axes.members);
  else
    snprintf(s->why, sizeof s->why, "%s", message);
  speak(s->why, sizeof s->why);
  say(s->call, "%s%s", s->why, s->unwritten ? " [STEIF_IO]" : "");
  if (s->call->json) sweep_json_foot(s);
  return s->unwritten ? EXIT_FAILED : exit_of_run(s->call, code, message);
}

static int conclude(struct sweep *s, int code)
{
  if (s->call->shares && !s->call->shares->first) return EXIT_OK;
  const bool stopped = code == STEIF_STOPPED;
  if (code && !stopped) return give_up(s, code);
  if (old_before(s, s->axes.members)) return give_up(s, STEIF_IO);
  s->complete = true;
  const int shown = sweep_foot(s, stopped);
  if (stopped) return interruption_exit();
  const long long failed = s->done - s->ok;
  if (!shown && failed && (given(s->call, "--strict") || !s->ok)) {
    say(s->call, "%lld of %lld members failed%s%s", failed, s->done,
        s->first_code ? "; the first of them: " : "", s->first_message);
    return EXIT_FAILED;
  }
  return shown;
}

static int run_members(struct sweep *s)
{
  const struct shares *shares = s->call->shares;
  const long long missing = old_missing(s);
  int code = sweep_head(s) ? STEIF_IO : STEIF_OK;
  if (!code && (!shares || shares->first) && sweep_clock_open(s, missing))
    code = STEIF_NO_MEMORY;
  if (!code && missing) code = sweep_members(s, missing);
  if (shares) code = shares->join(s, code, shares->of);
  sweep_clock_close(s);
  return conclude(s, code);
}

/* Where each member is shown. */
static int read_points(struct sweep *s)
{
  const size_t times = reals_of(s->call, "--at", s->at);
  s->points = times ? times : (size_t)whole_of(s->call, "--points");
  s->on_the_way = s->points > 0;
  if (!s->on_the_way) s->points = 1;
  for (size_t k = 1; k < times; k++)
    if (s->at[k] < s->at[k - 1])
      return bad_usage(s->call, "--at has %g after %g; times ascend", s->at[k], s->at[k - 1]);
  return s->on_the_way && s->collect != COLLECT_Y
           ? bad_usage(s->call, "--points and --at show the solution: leave --collect out")
           : EXIT_OK;
}

static bool shown_here(const struct sweep *s)
{
  return !s->call->shares || s->call->shares->first;
}

/* Nobody else writes the file meanwhile; ranks read rows to be kept once the first one knows that. */
static int lock_file(struct sweep *s)
{
  const struct shares *shares = s->call->shares;
  if (!given(s->call, "--resume") && !given(s->call, "--csv")) return EXIT_OK;
  const int code = shown_here(s) ? sweep_file_lock(s) : EXIT_OK;
  return shares ? shares->agree(code, shares->of) : code;
}

/* The rows to be kept: every rank has their numbers, and the first one looks at them closely. */
static int open_old(struct sweep *s)
{
  if (!given(s->call, "--resume")) return EXIT_OK;
  const int code = old_open(s);
  return code || !shown_here(s) ? code : old_check(s);
}

static int begin(struct sweep *s)
{
  int code = read_points(s);
  if (!code) code = axes_read(s->call, &s->axes);
  if (!code) code = check_names(s);
  if (code) return code;
  s->room = (size_t)1000 + (s->n + AXES) * (COLUMN + 2);
  s->line = malloc(s->room);
  if (!s->line) return no_memory(s->call, "a row", "collect digits or stats");
  code = lock_file(s);
  if (code) return code;
  code = open_old(s);
  if (!code) code = sweep_picture_open(s);
  if (s->call->shares) code = s->call->shares->agree(code, s->call->shares->of);
  if (code) return code;
  return s->call->csv ? sweep_file_write(s, s->call->csv, run_members) : run_members(s);
}

int sweep_run(struct call *call, const steif_problem *p)
{
  struct sweep *s = calloc(1, sizeof *s);
  if (!s) return no_memory(call, "the sweep", "give the process more");
  s->call = call;
  s->problem = p;
  s->options = options_of(call);
  s->options.recompute = 1;
  s->collect = (enum collect)choice_of(call, "--collect");
  s->lock = -1;
  if (shown_here(s) && !given(call, "--csv") && given(call, "--resume"))
    call->csv = word_of(call, "--resume");
  int words;
  s->sets.count = numbers_set(call, SETS, s->sets.text, s->sets.value, &words);
  const int code = begin(s);
  old_close(s);
  sweep_file_unlock(s);
  sweep_picture_close(s);
  if (s->made) steif_problem_clear(call->ctx, &s->first);
  free(s->line);
  free(s);
  return code;
}
