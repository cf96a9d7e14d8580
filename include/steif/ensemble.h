/* steif/ensemble.h: many runs of one problem, side by side.
 *
 *   static int member(steif_context *ctx, long long i, steif_problem *p, steif_options *o, void *user)
 *   {
 *     p->parameters->value[0] = 0.01 + 1e-6 * i;         // of this worker's own problem
 *     return STEIF_OK;
 *   }
 *   static int done(steif_context *ctx, long long i, const steif_problem *p, steif_solver *s, int code,
 *                   void *record, void *user)
 *   {
 *     *(double *)record = code ? NAN : N_VGetArrayPointer(steif_solution(s))[0];
 *     return STEIF_OK;
 *   }
 *   steif_ensemble_options e = {.problem = "rober", .record = sizeof(double), .row = write_row};
 *   int code = steif_ensemble(ctx, 40000, member, done, &e);
 *
 * Members are numbered 0 .. count - 1. Each worker is a thread with a context, a problem and a solver of its
 * own; contexts are made with setup.threads = 1, and with allocate, release and user of the setup of ctx: an
 * allocator of the caller is used by all workers at once, and has to bear that. A worker takes chunks of consecutive
 * members, max(1, min(64, count / (32 workers))) at a time, and fewer where they would take more than 0.1 s. What
 * becomes of a member depends on its number only, not on the worker: the records have the same bits for any number
 * of workers, and `row` gets them in the order of the numbers while the others run.
 *
 * Records wait for those before them in a window: 4 of these chunks for each worker or, where that is more, as many
 * records as fit into 16 MiB. Where it is full the workers wait for the member at its head. A process that is killed
 * loses the records that wait: put long members last, or give them max_seconds.
 *
 * A member that fails does not stop the others: `done` gets its code, the context the sentence. One that runs away
 * is ended by options.max_seconds, its own clock.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_ENSEMBLE_H
#define STEIF_ENSEMBLE_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Prepare member i: change *problem, but for `build` and `destroy`, and *options, or replace *problem by one of
 * steif_problem_find, steif_problem_vary or steif_model_parse in this context, which is cleared afterwards. Both arrive as they were
 * before the first member; only what pointers lead to keeps the changes of earlier members of this worker: set
 * all of that every time. Called by several threads at once, with contexts of their own. A code other than 0 is the
 * member's own failure, `done` hears of it. */
typedef int (*steif_member)(steif_context *ctx, long long i, steif_problem *problem,
                            steif_options *options, void *user);
/* After the run of member i, in the same thread: fill its record, zeroed before. code: what steif_solve_to
 * returned, with the sentence in ctx; s is NULL where there is no solver. A code other than 0 ends the ensemble. */
typedef int (*steif_member_done)(steif_context *ctx, long long i, const steif_problem *problem,
                                 steif_solver *s, int code, void *record, void *user);
/* At point j of options.points of member i, on the way: the solver shows the solution there. The record is
 * zeroed before the first of them. A code other than 0 ends the ensemble. */
typedef int (*steif_member_at)(steif_context *ctx, long long i, int j,
                               const steif_problem *problem, steif_solver *s, void *record,
                               void *user);
/* Records in ascending order, one at a time, in any of the threads. Nonzero ends the ensemble. */
typedef int (*steif_member_row)(long long i, const void *record, void *user);

typedef struct steif_ensemble_options {
  /* The problem of a worker, one of these; none: zero, and `member` fills it. */
  const char *problem; /* as steif_problem_find takes it, found once by every worker */
  int (*open)(steif_context *ctx, steif_problem *problem,
              void *user);      /* the same by the caller, by one
                                thread at a time; cleared at the end by steif_problem_clear */
  const steif_problem *like;    /* one whose callbacks may run in several threads at once */
  const char *method;           /* NULL: "auto" */
  const steif_options *options; /* of every run, NULL: defaults */
  int threads;                  /* workers; 0: the threads of ctx. At most 64 */
  size_t record;                /* bytes of a record */
  steif_member_row row;         /* NULL: records go nowhere */
  void *user;                   /* handed to all */
  /* Set to nonzero it ends the ensemble: members at work are given up after the step at hand,
   * finished ones still reach `row`, with gaps in the numbers. */
  const volatile int *stop;
  /* For workers elsewhere that share the members, as ranks: the first of the next `chunk` numbers that nobody
   * has taken, ascending from call to call; beyond count: there are none. chunk differs from call to call. Called by
   * one thread at a time.
   * NULL: 0, chunk, 2 chunk ... */
  long long (*take)(long long chunk, void *queue);
  void *queue;
  int workers; /* with take: how many there are in all, for the size of chunks; 0: threads */
  int points;  /* `at` is called so many times in a run; the steps stay what they are */
  const sunrealtype
    *times;           /* points of them, ascending; NULL: equal distances from start to end */
  steif_member_at at; /* with points */
  void *reserved[6];  /* 0 */
} steif_ensemble_options;

/* STEIF_OK: every member was run, whatever came of it. STEIF_STOPPED: stop was set. STEIF_BAD_INPUT: no context,
 * no members, no callback, points without `at`; a time outside a member's interval is that member's failure; codes of
 * opening the problem; the code of `done` or `at`, STEIF_CALLBACK for `row`. Threads that cannot be had leave their
 * share to the others. */
STEIF_EXPORT int steif_ensemble(steif_context *ctx, long long count, steif_member member,
                                steif_member_done done, const steif_ensemble_options *options);

/* Number `counter` of a sequence of uniform numbers in (0, 1), from seed and counter alone (splitmix64: G. L. Steele,
 * D. Lea, C. H. Flood, OOPSLA 2014): member i takes numbers d i, ..., d i + d - 1 for d random parameters. */
STEIF_EXPORT sunrealtype steif_ensemble_uniform(unsigned long long seed,
                                                unsigned long long counter);

#ifdef __cplusplus
}
#endif
#endif
