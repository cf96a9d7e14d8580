/* team_of_ranks.c: the bytes of a team by messages of MPI.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "own_rows.h"

enum { TAG = 7 };

typedef struct team_of_ranks {
  steif_team face;
  MPI_Comm comm;
  steif_context *ctx;
} team_of_ranks;

/* Parts of 65536 bytes at most. */
static int send(int to, const void *data, size_t bytes, void *user)
{
  const team_of_ranks *t = user;
  return MPI_Send(data, (int)bytes, MPI_BYTE, to, TAG, t->comm) != MPI_SUCCESS;
}

static int receive(int from, void *data, size_t bytes, void *user)
{
  const team_of_ranks *t = user;
  return MPI_Recv(data, (int)bytes, MPI_BYTE, from, TAG, t->comm, MPI_STATUS_IGNORE) !=
         MPI_SUCCESS;
}

steif_team *steif_mpi_team_new(steif_context *ctx, MPI_Comm comm)
{
  int ranks;
  if (!ctx || own_rows_initialised(ctx)) return NULL;
  MPI_Comm_size(comm, &ranks);
  team_of_ranks *t = ranks > 1 ? steif_allocate(ctx, 1, sizeof *t) : NULL;
  int made = t != NULL;
  MPI_Allreduce(MPI_IN_PLACE, &made, 1, MPI_INT, MPI_MIN, comm);
  if (made && MPI_Comm_dup(comm, &t->comm) == MPI_SUCCESS) {
    t->ctx = ctx;
    t->face = (steif_team){ranks - 1, send, receive, t};
    return &t->face;
  }
  if (t) steif_release(ctx, t);
  if (ranks > 1)
    steif_fail(ctx, STEIF_NO_MEMORY, "no memory for a team of %d ranks", ranks);
  else
    steif_fail(ctx, STEIF_BAD_INPUT, "a team needs two ranks or more, and there is one");
  return NULL;
}

void steif_mpi_team_free(steif_team **team)
{
  if (!team || !*team) return;
  team_of_ranks *t = (*team)->user;
  MPI_Comm_free(&t->comm);
  steif_release(t->ctx, t);
  *team = NULL;
}
