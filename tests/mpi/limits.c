/* limits.c: what one rank alone does or sees: all ranks return, with the same code and sentence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static int slow(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  const rod *r = user;
  (void)s, (void)t, (void)y;
  if (r->wrong == LATE && r->rank == r->alone)
    nanosleep(&(struct timespec){.tv_nsec = 5000000}, NULL);
  return 0;
}

static int right(int wrong, int code)
{
  switch (wrong) {
  case NOTHING: return code == STEIF_OK;
  case RECOVERABLE: return 1; /* some methods give up: all ranks alike */
  case FATAL: return code == STEIF_CALLBACK;
  case STOP: return code == STEIF_STOPPED;
  case LATE: return code == STEIF_TIME_LIMIT;
  default: return code != STEIF_OK;
  }
}

static void run(rod *r, const char *method, int wrong, int alone)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype *y0 = malloc((size_t)(r->rows + 1) * sizeof *y0);
  steif_problem p = rod_problem(r, y0);
  steif_options o = steif_defaults();
  o.rtol = 1e-3, o.like = rod_vector(r, ctx), o.stop = &r->stop, o.observe = slow,
  o.observer = r;
  if (wrong == LATE) o.max_seconds = 0.004;
  r->calls = 0, r->stop = 0, r->wrong = wrong, r->alone = alone;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  EVERYWHERE(r, same_answer(r, ctx, code));
  if (!EVERYWHERE(r, right(wrong, code)) && r->rank == 0)
    printf("  %s, %d on rank %d: code %d, %s\n", method, wrong, alone, code,
           steif_message(ctx));
  char words[40];
  snprintf(words, sizeof words, "on rank %d", alone);
  EVERYWHERE(r, wrong != FATAL || strstr(steif_message(ctx), words));
  const long steps = s ? steif_statistics(s)->steps : 0;
  long all[] = {steps, -steps, r->calls, -r->calls};
  MPI_Allreduce(MPI_IN_PLACE, all, 4, MPI_LONG, MPI_MAX, r->comm);
  EVERYWHERE(r, all[0] == -all[1] && all[2] == -all[3]);
  steif_solver_free(&s);
  N_VDestroy(o.like);
  steif_context_free(&ctx);
  free(y0);
}

/* The first, the middle and the last rank misbehave; where ranks are in the other order than in MPI_COMM_WORLD,
 * the sentence has the number of the communicator. */
static void in_order(MPI_Comm comm, int least)
{
  static const char *const methods[] = {"be",    "bdf", "dirk:hw43", "radau:s=3",
                                        "cvode", "ida", "arkode"};
  rod r;
  rod_open(&r, comm, 40, 0);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
    for (int wrong = least; wrong <= LATE; wrong++)
      for (int rank = 0; rank < r.size; rank++)
        if (wrong == FATAL || rank == 0 || (wrong != NOTHING && rank == r.size - 1))
          run(&r, methods[k], wrong, rank);
  rod_close(&r);
}

void test_limits(MPI_Comm comm)
{
  MPI_Comm reversed;
  int rank;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_split(comm, 0, -rank, &reversed);
  in_order(comm, NOTHING), in_order(reversed, FATAL);
  MPI_Comm_free(&reversed);
}
