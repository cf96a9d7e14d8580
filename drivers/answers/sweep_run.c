/* sweep_run.c: the members of a sweep, and what becomes of it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <errno.h>
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
  double value[AXES];
  axes_at(&s->axes, i, value);
  return steif_problem_vary(ctx, like, s->axes.count, s->axes.name, value, to);
}

static int member(steif_context *ctx, long long k, steif_problem *problem, steif_options *o,
                  void *user)
{
  const struct sweep *s = user;
  steif_problem varied;
  (void)o;
  const int code = vary(ctx, s, old_number(s, k), problem, &varied);
  if (!code) *problem = varied;
  return code;
}

/* One line. */
static void take_message(struct member_record *r, const char *text)
{
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

static size_t record_size(const struct sweep *s)
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
  const struct sweep *s = user;
  struct member_record *r = record;
  (void)k;
  r->code = code;
  r->scd = r->mescd = NAN;
  if (code < 0) take_message(r, steif_message(ctx));
  if (solver) r->stats = *steif_statistics(solver);
  if (!fits(s, p)) {
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
  return STEIF_OK;
}

int sweep_show(struct sweep *s, long long k, const struct member_record *r)
{
  const long long i = old_number(s, k);
  return old_before(s, i) || sweep_rows(s, i, r);
}

static int row(long long k, const void *record, void *user)
{
  struct sweep *s = user;
  const struct shares *shares = s->call->shares;
  if (shares) return shares->keep(s, k, record, record_size(s), shares->of);
  return sweep_show(s, k, record);
}

/* ---- the whole --------------------------------------------------------------------------------- */

/* Is every name a parameter of the problem, and that of the method one? Values are a matter of the members. */
static int check_names(struct sweep *s)
{
  steif_context *ctx = s->call->ctx;
  steif_problem varied = {0};
  int code = vary(ctx, s, 0, s->problem, &varied);
  const steif_problem *first = code ? s->problem : &varied;
  if (code != STEIF_UNKNOWN_NAME) {
    steif_forget(ctx);
    steif_solver *solver = steif_solver_new(ctx, first, s->call->word[1], &s->options);
    code = solver ? STEIF_OK : steif_status(ctx);
    steif_solver_free(&solver);
  }
  s->n = s->collect == COLLECT_Y ? (size_t)first->n : 0;
  steif_problem_clear(ctx, &varied);
  if (code == STEIF_UNKNOWN_NAME) return fail(s->call);
  steif_forget(ctx);
  return EXIT_OK;
}

static int conclude(struct sweep *s, int code)
{
  if (s->call->shares && !s->call->shares->first) return EXIT_OK;
  const bool stopped = code == STEIF_STOPPED;
  if (code && !stopped) return fail(s->call);
  int shown = old_before(s, s->axes.members) ? EXIT_FAILED : sweep_foot(s, stopped);
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
  const steif_ensemble_options e = {.open = open_problem,
                                    .method = s->call->word[1],
                                    .options = &s->options,
                                    .threads = shares ? 1 : (int)whole_of(s->call, "--threads"),
                                    .take = shares ? shares->take : NULL,
                                    .queue = shares ? shares->of : NULL,
                                    .workers = shares ? shares->processes : 0,
                                    .record = record_size(s),
                                    .points = s->on_the_way ? (int)s->points : 0,
                                    .times = given(s->call, "--at") ? s->at : NULL,
                                    .at = at,
                                    .row = row,
                                    .user = s,
                                    .stop = interruption_poll()};
  const long long missing = old_missing(s);
  int code = sweep_head(s) ? STEIF_IO : STEIF_OK;
  if (!code && missing) code = steif_ensemble(s->call->ctx, missing, member, done, &e);
  return shares ? shares->join(s, code, shares->of) : code;
}

/* Over the rows that are kept goes a new file, by renaming, when all is written. */
static int write_file(struct sweep *s, const char *path)
{
  char part[4096];
  const int length = snprintf(part, sizeof part, "%s%s", path, s->old ? ".part" : "");
  s->csv = length > 0 && (size_t)length < sizeof part ? fopen(part, "w") : NULL;
  if (!s->csv) {
    say(s->call, "cannot write \"%s\": %s [STEIF_IO]", part, strerror(errno));
    return EXIT_FAILED;
  }
  int code = conclude(s, run_members(s));
  const bool closed = !fclose(s->csv);
  if (!closed || (s->old && rename(part, path))) {
    say(s->call, "cannot write \"%s\": %s [STEIF_IO]", path, strerror(errno));
    code = code ? code : EXIT_FAILED;
  }
  return code;
}

/* Where each member is shown. */
static int read_points(struct sweep *s)
{
  const size_t times = reals_of(s->call, "--at", s->at);
  s->points = times ? times : (size_t)whole_of(s->call, "--points");
  s->on_the_way = s->points > 0;
  if (!s->on_the_way) s->points = 1;
  return s->on_the_way && s->collect != COLLECT_Y
           ? bad_usage(s->call, "--points and --at show the solution: leave --collect out")
           : EXIT_OK;
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
  const char *old = word_of(s->call, "--resume");
  if (old) code = old_open(s, old);
  if (!code) code = sweep_picture_open(s);
  if (s->call->shares) code = s->call->shares->agree(code, s->call->shares->of);
  if (code) return code;
  return s->call->csv ? write_file(s, s->call->csv) : conclude(s, run_members(s));
}

int sweep_run(struct call *call, const steif_problem *p)
{
  struct sweep *s = calloc(1, sizeof *s);
  if (!s) return no_memory(call, "the sweep", "give the process more");
  s->call = call;
  s->problem = p;
  s->options = options_of(call);
  s->collect = (enum collect)choice_of(call, "--collect");
  const bool shown = !call->shares || call->shares->first;
  if (shown && !given(call, "--csv") && given(call, "--resume"))
    call->csv = word_of(call, "--resume");
  const int code = begin(s);
  old_close(s);
  sweep_picture_close(s);
  free(s->line);
  free(s);
  return code;
}
