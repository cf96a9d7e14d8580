/* checks.c: what holds on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <stdio.h>
#include <string.h>

int failures, rank, ranks;

int everywhere(int condition, const char *text, const char *file, int line)
{
  int all = !!condition;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (!all && rank == 0) printf("%s:%d: not on all ranks: %s\n", file, line, text);
  failures += !all;
  return all;
}

int same(steif_context *ctx)
{
  char own[1100], first[1100] = "";
  snprintf(first, sizeof first, "%d %s", steif_status(ctx), steif_message(ctx));
  memcpy(own, first, sizeof own);
  MPI_Bcast(first, sizeof first, MPI_CHAR, 0, MPI_COMM_WORLD);
  if (strcmp(own, first)) printf("rank %d: %s\n", rank, own);
  return !strcmp(own, first);
}
