/* sweep_run.c: the members of a sweep, and what becomes of it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "interruption.h"
#include "problem.h"
#include "sweep.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- callbacks of the ensemble ---------------------------------------------------------------- */

static int open_problem(steif_context *ctx, steif_problem *problem, void *user)
{
  const struct sweep *s = user;
  return steif_problem_vary(ctx, s->problem, 0, NULL, NULL, problem);
}

static int vary(steif_context *ctx, const struct sweep *s, long long i,
                const steif_problem *like, steif_problem *to)
{
  double value[SETS + AXES];
  const char *name[SETS + AXES];
  const int sets = s->sets.count, axes = s->axes.count;
  for (int k = 0; k < sets; k++) name[k] = s->sets.text[k], value[k] = s->sets.value[k];
  for (int k = 0; k < axes; k++) name[sets + k] = s->axes.name[k];
  axes_at(&s->axes, i, value + sets);
  return steif_problem_vary(ctx, like, sets + axes, name, value, to);
}

static long long number_of(const struct sweep *s, long long k)
{
  return s->checking ? old_checked(s, k) : old_number(s, k);
}

static int member(steif_context *ctx, long long k, steif_problem *problem, steif_options *o,
                  void *user)
{
  const struct sweep *s = user;
  steif_problem varied;
  (void)o;
  const int code = vary(ctx, s, number_of(s, k), problem, &varied);
  if (!code) *problem = varied;
  return code;
}

/* One line; the ensemble numbers members among those that are run. */
static void take_message(struct member_record *r, const char *text, long long k, long long i)
{
  char theirs[48];
  const int length = snprintf(theirs, sizeof theirs, " member %lld ", k);
  const char *place = strstr(text, theirs);
  if (place && k != i)
    snprintf(r->message, sizeof r->message, "%.*s member %lld %s", (int)(place - text), text, i,
             place + length);
  else
    snprintf(r->message, sizeof r->message, "%s", text);
  speak(r->message, sizeof r->message);
  for (char *at = r->message; *at; at++)
    if (*at == '\n' || *at == '\r') *at = ' ';
}

/* The solution shown, or none, as the next row. */
static void take_row(const struct sweep *s, struct member_record *r, steif_solver *solver)
{
  double *row = r->row + r->rows++ * (s->n + 1);
  row[0] = solver ? steif_time(solver) : NAN;
  for (size_t j = 0; j < s->n && !solver; j++) row[1 + j] = NAN;
  if (solver && s->n)
    memcpy(row + 1, N_VGetArrayPointer(steif_solution(solver)), s->n * sizeof *row);
}

size_t sweep_record_size(const struct sweep *s)
{
  const size_t rows = s->points + s->on_the_way; /* one more where a run ends early */
  return sizeof(struct member_record) + rows * (s->n + 1) * sizeof(double);
}

static bool fits(const struct sweep *s, const steif_problem *p)
{
  return s->collect != COLLECT_Y || p->n == (sunindextype)s->n;
}

static int at(steif_context *ctx, long long k, int j, const steif_problem *p,
              steif_solver *solver, void *record, void *user)
{
  (void)ctx, (void)k, (void)j;
  if (fits(user, p)) take_row(user, record, solver);
  return 0;
}

static int done(steif_context *ctx, long long k, const steif_problem *p, steif_solver *solver,
                int code, void *record, void *user)
{
  struct sweep *s = user;
  struct member_record *r = record;
  r->code = code;
  r->scd = r->mescd = NAN;
  if (code < 0) take_message(r, steif_message(ctx), k, number_of(s, k));
  if (solver) r->stats = *steif_statistics(solver);
  if (!fits(s, p) && code < 0) {
    take_row(s, r, NULL);
  } else if (!fits(s, p)) {
    r->code = STEIF_UNSUPPORTED;
    snprintf(r->message, sizeof r->message,
             "%ld unknowns where the columns are for %zu; "
             "--collect digits or stats takes members of any size [STEIF_UNSUPPORTED]",
             (long)p->n, s->n);
    take_row(s, r, NULL);
  } else if (code || !s->on_the_way) {
    take_row(s, r, solver);
  }
  if (solver && s->collect == COLLECT_DIGITS && code >= 0)
    steif_problem_digits(ctx, p, steif_time(solver), steif_solution(solver),
                         tolerance_ratio(p, &s->options), &r->scd, &r->mescd);
  if (!s->checking && !s->call->shares) sweep_clock_tick(s);
  return STEIF_OK;
}

int sweep_show(struct sweep *s, long long k, const struct member_record *r)
{
  const long long i = old_number(s, k);
  if (s->call->shares) sweep_clock_tick(s);
  if (old_before(s, i) || sweep_rows(s, i, r)) return 1;
  s->fresh++;
  return 0;
}

static int row(long long k, const void *record, void *user)
{
  struct sweep *s = user;
  const struct shares *shares = s->call->shares;
  if (s->checking) return old_compare(s, k, record);
  if (shares) return shares->keep(s, k, record, sweep_record_size(s), shares->of);
  return sweep_show(s, k, record);
}

int sweep_members(struct sweep *s, long long count)
{
  const struct shares *shares = s->checking ? NULL : s->call->shares;
  const bool alone = s->call->shares != NULL;
  const steif_ensemble_options e = {.open = open_problem,
                                    .method = s->call->word[1],
                                    .options = &s->options,
                                    .threads = alone ? 1 : (int)whole_of(s->call, "--threads"),
                                    .take = shares ? shares->take : NULL,
                                    .queue = shares ? shares->of : NULL,
                                    .workers = shares ? shares->processes : 0,
                                    .record = sweep_record_size(s),
                                    .points = s->on_the_way ? (int)s->points : 0,
                                    .times = given(s->call, "--at") ? s->at : NULL,
                                    .at = at,
                                    .row = row,
                                    .user = s,
                                    .stop = interruption_poll()};
  return steif_ensemble(s->call->ctx, count, member, done, &e);
}

/* ---- the whole --------------------------------------------------------------------------------- */

/* Columns are those of the first member that can be made. */
static int find_first(struct sweep *s)
{
  enum { TRIES = 1000 };
  int code = STEIF_BAD_INPUT;
  s->first = *s->problem;
  for (long long i = 0; i < s->axes.members && i < TRIES && code; i++) {
    steif_problem varied = {0};
    code = vary(s->call->ctx, s, i, s->problem, &varied);
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

/* Ranks read rows to be kept once the first one knows that nobody adds to them. */
static int lock_old(struct sweep *s)
{
  const struct shares *shares = s->call->shares;
  if (!given(s->call, "--resume")) return EXIT_OK;
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
  code = lock_old(s);
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
