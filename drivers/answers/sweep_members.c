/* sweep_members.c: a member of a sweep, and the record of what becomes of it: the callbacks of the ensemble.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "interruption.h"
#include "problem.h"
#include "sweep.h"
#include <math.h>
#include <string.h>

static int open_problem(steif_context *ctx, steif_problem *problem, void *user)
{
  const struct sweep *s = user;
  return steif_problem_vary(ctx, s->problem, 0, NULL, NULL, problem);
}

int sweep_vary(steif_context *ctx, const struct sweep *s, long long i,
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
  const int code = sweep_vary(ctx, s, number_of(s, k), problem, &varied);
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
