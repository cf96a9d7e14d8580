/* one_rank_short.c: MUMPS finds no memory on one rank alone, whose process may take no more: all ranks return
 * STEIF_NO_MEMORY with the same sentence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <stdio.h>
#include <sys/resource.h>

/* Bytes of the address space of this process now; 0: not known. */
static size_t address_space(void)
{
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (file && fscanf(file, "%ld", &pages) != 1) pages = 0;
  if (file) fclose(file);
  return (size_t)pages * 4096;
}

/* The factors of this problem take 40 MB a rank or more on up to 4 ranks; `more` bytes are left on the last one. */
static void try_with(size_t more)
{
  N_Vector like;
  struct rlimit old, limit;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, "heat3d:n=30", MPI_COMM_WORLD, &like);
  N_Vector b = N_VClone(like);
  N_VConst(1, b);
  steif_mpi *m = steif_mpi_open(ctx, p, "mumps:order=amf", like);
  getrlimit(RLIMIT_AS, &old);
  limit = old, limit.rlim_cur = address_space() + more;
  if (rank == ranks - 1) setrlimit(RLIMIT_AS, &limit);
  const int code =
    m ? steif_mpi_solve(m, 0, like, like, 1, 0, 0, 1, &b, &b) : steif_status(ctx);
  setrlimit(RLIMIT_AS, &old);
  if (!ALL(code == STEIF_NO_MEMORY) && rank == 0)
    printf("  %zu MB: %d, %s\n", more >> 20, code, steif_message(ctx));
  ALL(same(ctx));
  steif_mpi_free(&m);
  N_VDestroy(b);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

void test_one_rank_short(void)
{
  const size_t terabyte = (size_t)1 << 40, space = address_space();
  if (space == 0 || space > terabyte) return; /* not Linux, or a tool that takes it all */
  try_with((size_t)16 << 20);
  try_with((size_t)24 << 20);
}
