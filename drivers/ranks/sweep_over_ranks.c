/* sweep_over_ranks.c: `steif sweep ... --parallel`: ranks take members from a counter on rank 0, which gets what they
 * leave and shows it in the order of the members.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include "parcels.h"
#include "sweep.h"
#include "verbs.h"
#include <steif/extension.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern const struct verb verb_sweep;

typedef struct queue {
  struct call *call;
  int rank, ranks;
  MPI_Win window;
  long long *next; /* on rank 0: the first member that nobody has taken */
  parcels records;
  FILE *unsaid; /* what ranks other than 0 would say */
  bool agreed, proceed, joined;
} queue;

/* -- what is shared --------------------------------------------------------------------------- */

static long long take(long long chunk, void *of)
{
  queue *q = of;
  long long first = 0;
  MPI_Fetch_and_op(&chunk, &first, MPI_LONG_LONG, 0, 0, MPI_SUM, q->window);
  MPI_Win_flush(0, q->window);
  return first;
}

/* The lowest rank that failed, its code, and on rank 0 what it says. `ranks`: none did. */
static int first_failure(queue *q, int *code, char *text, int room)
{
  int first = *code ? q->rank : q->ranks;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == q->ranks) return first;
  MPI_Bcast(code, 1, MPI_INT, first, MPI_COMM_WORLD);
  MPI_Bcast(text, room, MPI_CHAR, first, MPI_COMM_WORLD);
  return first;
}

static int agree(int code, void *of)
{
  queue *q = of;
  char text[2000] = "";
  q->agreed = true;
  if (code && q->unsaid) {
    rewind(q->unsaid);
    text[fread(text, 1, sizeof text - 1, q->unsaid)] = 0;
  }
  const int first = first_failure(q, &code, text, sizeof text);
  if (first > 0 && first < q->ranks && q->rank == 0)
    fprintf(stderr, "rank %d: %s", first, text);
  q->proceed = !code;
  return code;
}

static int show_member(long long k, const void *record, void *sweep)
{
  return sweep_show(sweep, k, record);
}

static int keep(struct sweep *s, long long k, const struct member_record *r, size_t bytes,
                void *of)
{
  queue *q = of;
  q->records.show = show_member, q->records.user = s;
  return parcels_put(&q->records, k, r, bytes);
}

static int join(struct sweep *s, int code, void *of)
{
  queue *q = of;
  char text[1200] = "";
  q->joined = true;
  q->records.show = s ? show_member : NULL, q->records.user = s;
  if (parcels_end(&q->records) && !code)
    code = steif_fail(q->call->ctx, STEIF_IO, "rows of the sweep could not be kept or written");
  snprintf(text, sizeof text, "%s", steif_message(q->call->ctx));
  const int first = first_failure(q, &code, text, sizeof text);
  if (first < q->ranks && first != q->rank)
    steif_fail(q->call->ctx, code, "rank %d: %s", first, text);
  return code;
}

/* -- the program ------------------------------------------------------------------------------ */

/* Ranks other than 0 show nothing, and keep what they would say. */
static void keep_quiet(queue *q)
{
  q->unsaid = tmpfile();
  if (!freopen("/dev/null", "w", stdout)) fclose(stdout);
  if (q->unsaid) dup2(fileno(q->unsaid), STDERR_FILENO);
  struct call *call = q->call;
  call->csv = call->plot = call->npz = call->h5 = call->mtx = NULL;
}

static void open_queue(queue *q)
{
  MPI_Comm_rank(MPI_COMM_WORLD, &q->rank), MPI_Comm_size(MPI_COMM_WORLD, &q->ranks);
  q->records.rank = q->rank, q->records.ranks = q->ranks;
  MPI_Win_allocate(q->rank ? 0 : sizeof *q->next, sizeof *q->next, MPI_INFO_NULL,
                   MPI_COMM_WORLD, &q->next, &q->window);
  if (q->rank == 0) *q->next = 0;
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Win_lock_all(MPI_MODE_NOCHECK, q->window);
}

/* Every rank comes to `agree` and, where that was 0 for all, to `join`, whatever it met before. */
static int run(queue *q)
{
  int code = verb_sweep.run(q->call);
  if (!q->agreed)
    code = agree(code, q);
  else if (q->proceed && !q->joined)
    join(NULL, STEIF_IO, q);
  return code;
}

int sweep_over_ranks(int argc, char **argv)
{
  queue q = {0};
  struct call call = {.verb = &verb_sweep, .json = call_wants_json(argc - 2, argv + 2)};
  q.call = &call;
  open_queue(&q);
  const struct shares shares = {.first = q.rank == 0,
                                .processes = q.ranks,
                                .take = take,
                                .agree = agree,
                                .keep = keep,
                                .join = join,
                                .of = &q};
  call.shares = &shares, call.ctx = steif_context_new(NULL);
  if (q.rank) keep_quiet(&q);
  int code = call.ctx ? call_parse(&call, argc - 2, argv + 2) : EXIT_FAILED;
  if (q.rank) keep_quiet(&q);
  if (!code && call.help && q.rank == 0) call_help(call.verb);
  if (!code && !call.help) {
    interruption_open("sweep");
    code = run(&q);
  }
  steif_context_free(&call.ctx);
  MPI_Win_unlock_all(q.window), MPI_Win_free(&q.window);
  MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return code;
}
