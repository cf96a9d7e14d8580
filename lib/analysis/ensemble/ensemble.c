/* ensemble.c: workers, each with a context, a problem and one solver at a time.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "workers.h"
#include <stdint.h>
#include <stdio.h>
#include <steif/collection.h>
#include <time.h>

enum { WORKERS = 64 };

typedef struct worker {
  stf_queue *queue;
  steif_context *ctx;
  steif_problem like; /* as every member finds it */
  bool found;         /* by this worker */
  bool started;
  pthread_t thread;
} worker;

/* Stands in `build` of the problem that a member gets: what has another one there was put in its place, whatever else
 * the member has changed. */
static int lent(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  (void)spec;
  return STEIF_FAIL(ctx, STEIF_UNSUPPORTED, "problem '%s' is made already", self->name);
}

static steif_problem lend(const steif_problem *like)
{
  steif_problem p = *like;
  if (p.build) p.build = lent;
  return p;
}

static void clear_own(steif_context *ctx, const steif_problem *like, steif_problem *p)
{
  if (p->build && p->build != lent && p->name != like->name) steif_problem_clear(ctx, p);
}

static void end_by(stf_queue *q, int code, const char *callback, long long i)
{
  char text[96];
  snprintf(text, sizeof text, "'%s' returned %d for member %lld", callback, code, i);
  stf_queue_end(q, code, text);
}

static int no_time(worker *w, sunrealtype t, long long i, sunrealtype t0, sunrealtype t1)
{
  return STEIF_FAIL(w->ctx, STEIF_BAD_INPUT,
                    "time %g of member %lld is out of order or outside its interval [%g, %g]",
                    t, i, t0, t1);
}

/* To the end, by way of the points. */
static int go(worker *w, long long i, const steif_problem *p, steif_solver *s, sunrealtype t1,
              void *record)
{
  const steif_ensemble_options *e = w->queue->e;
  sunrealtype before = p->t0;
  for (int j = 0; j < e->points; j++) {
    const sunrealtype part = e->points > 1 ? (sunrealtype)j / (e->points - 1) : 1;
    const sunrealtype t = e->times ? e->times[j] : part < 1 ? p->t0 + part * (t1 - p->t0) : t1;
    if (!(t >= before && t <= t1)) return no_time(w, t, i, p->t0, t1);
    before = t;
    const int code = t > p->t0 ? steif_solve_to(s, t) : STEIF_OK;
    if (code) return code;
    const int told = e->at(w->ctx, i, j, p, s, record, e->user);
    if (told) end_by(w->queue, told, "at", i);
    if (told) return STEIF_STOPPED;
  }
  return steif_solve_to(s, t1);
}

static int integrate(worker *w, long long i, steif_problem *p, steif_solver **s, void *record)
{
  const stf_queue *q = w->queue;
  steif_options options = q->e->options ? *q->e->options : steif_defaults();
  if (!options.stop) options.stop = q->e->stop;
  steif_forget(w->ctx);
  const int code = q->member(w->ctx, i, p, &options, q->e->user);
  if (code) {
    if (steif_status(w->ctx)) return code;
    return STEIF_FAIL(w->ctx, code, "'member' returned %d for member %lld", code, i);
  }
  *s = steif_solver_new(w->ctx, p, q->e->method ? q->e->method : "auto", &options);
  if (!*s) return steif_status(w->ctx);
  return go(w, i, p, *s, options.t1 > 0 ? options.t1 : p->t1, record);
}

static void run_member(worker *w, long long i, long long place)
{
  stf_queue *q = w->queue;
  void *record = stf_queue_slot(q, place, i);
  if (!record) return;
  steif_problem p = lend(&w->like);
  steif_solver *s = NULL;
  const int code = integrate(w, i, &p, &s, record);
  const bool given_up =
    code == STEIF_STOPPED && (stf_queue_ended(q) || (q->e->stop && *q->e->stop));
  const int told = given_up ? STEIF_OK : q->done(w->ctx, i, &p, s, code, record, q->e->user);
  if (told) end_by(q, told, "done", i);
  steif_solver_free(&s);
  clear_own(w->ctx, &w->like, &p);
  stf_queue_ready(q, place, !given_up && !told);
}

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void *work(void *argument)
{
  worker *w = argument;
  long long chunk = 1;
  for (stf_share share; (share = stf_queue_take(w->queue, chunk)).count > 0;) {
    const double before = now();
    for (long long k = 0; k < share.count && !stf_queue_ended(w->queue); k++)
      run_member(w, share.first + k, share.place + k);
    chunk = stf_queue_fit(w->queue, share.count, now() - before);
  }
  return NULL;
}

static int worker_open(steif_context *ctx, worker *w)
{
  const steif_ensemble_options *e = w->queue->e;
  const steif_setup alone = stf_setup_alone(ctx);
  w->ctx = steif_context_new(&alone);
  if (!w->ctx) return STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for the context of a worker");
  if (e->like) w->like = *e->like;
  if (e->like || !(e->problem || e->open)) return STEIF_OK;
  const int code = e->open ? e->open(w->ctx, &w->like, e->user)
                           : steif_problem_find(w->ctx, e->problem, &w->like);
  w->found = !code;
  return code ? STEIF_FAIL(ctx, code, "%s", steif_message(w->ctx)) : STEIF_OK;
}

static void worker_close(worker *w)
{
  if (w->found) steif_problem_clear(w->ctx, &w->like);
  steif_context_free(&w->ctx);
}

static int run_all(steif_context *ctx, stf_queue *q, worker *w, int threads)
{
  int code = STEIF_OK;
  for (int k = 0; k < threads && !code; k++) {
    w[k].queue = q;
    code = worker_open(ctx, &w[k]);
  }
  for (int k = 1; k < threads && !code; k++)
    w[k].started = !pthread_create(&w[k].thread, NULL, work, &w[k]);
  if (!code) work(&w[0]);
  for (int k = 1; k < threads; k++)
    if (w[k].started) pthread_join(w[k].thread, NULL);
  if (!code) stf_queue_end(q, STEIF_OK, "");
  for (int k = 0; k < threads; k++) worker_close(&w[k]);
  if (!code && q->code) code = STEIF_FAIL(ctx, q->code, "%s", q->message);
  return code;
}

int steif_ensemble(steif_context *ctx, long long count, steif_member member,
                   steif_member_done done, const steif_ensemble_options *e)
{
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_CHECK(member && done && e, ctx, STEIF_BAD_INPUT,
              "an ensemble needs callbacks for its members and what they give, and options");
  STEIF_CHECK(count > 0, ctx, STEIF_BAD_INPUT, "an ensemble has %lld members; 1 is the least",
              count);
  STEIF_CHECK(e->points == 0 || (e->points > 0 && e->at), ctx, STEIF_BAD_INPUT,
              "%d points of an ensemble without the callback 'at'", e->points);
  STEIF_CHECK(e->threads >= 0 && e->threads <= WORKERS, ctx, STEIF_BAD_INPUT,
              "%d workers; choose 1 to %d, or 0 for all cores", e->threads, WORKERS);
  int threads = e->threads ? e->threads : stf_threads(ctx);
  if (threads > WORKERS) threads = WORKERS;
  if (threads > count) threads = (int)count;
  stf_queue q = {.e = e, .member = member, .done = done, .count = count};
  STEIF_TRY(stf_queue_open(ctx, &q, threads));
  worker *w = stf_allocate(ctx, (size_t)threads, sizeof *w);
  const int code = w ? run_all(ctx, &q, w, threads) : STEIF_NO_MEMORY;
  stf_release(ctx, w);
  stf_queue_close(ctx, &q);
  return code;
}

/* The number after state seed' + counter gamma, seed' scrambled, so that sequences of neighbouring seeds share
 * nothing. */
static uint64_t scramble(uint64_t z)
{
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

sunrealtype steif_ensemble_uniform(unsigned long long seed, unsigned long long counter)
{
  const uint64_t gamma = UINT64_C(0x9e3779b97f4a7c15);
  const uint64_t z = scramble(scramble(seed + gamma) + (counter + 1) * gamma);
  const sunrealtype u = ((sunrealtype)(z >> 11) + 0.5) / 9007199254740992.0;
  return u < 1 ? u : 1 - 1 / 9007199254740992.0; /* the largest of them rounds to 1 */
}
