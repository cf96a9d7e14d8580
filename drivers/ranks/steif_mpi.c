/* steif_mpi.c: the program steif-mpi: a verb of steif over ranks. Rank 0 prints; exit codes are those of steif, the
 * same on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
  request r = {.linear = "amg"};
  int level;
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 0); /* its threads would call MPI */
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &r.rank), MPI_Comm_size(MPI_COMM_WORLD, &r.ranks);
  int code = FINE;
  if (argc > 1 && !strcmp(argv[1], "sweep"))
    code = sweep_over_ranks(argc, argv);
  else if (argc > 1 && team_verb(argv[1]))
    code = team_over_ranks(&r, argc, argv);
  else if (!(code = request_read(&r, argc, argv)))
    code = strcmp(r.verb, "solve") ? compare_over_ranks(&r) : solve_over_ranks(&r);
  MPI_Finalize();
  return code;
}
