/* rank.c: the number of this rank in the communicator of a vector, for sentences.
 *
 * Sums are the same for any order of the ranks and cannot tell it, and nothing here is linked to MPI. But the operations
 * of a vector of N_VNew_Parallel are: the library that they are in knows MPI_Comm_rank. What this takes differs between
 * implementations: a pointer (Open MPI), or a number (MPICH and its relatives). With others, with other vectors, or
 * in programs that have all of it inside, the launcher tells a number, whose order may be another one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#define _GNU_SOURCE /* dladdr */
#include "rank.h"
#include "space.h"
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

/* The number of this rank as the usual launchers of MPI tell it; -1: not told. */
static int of_launcher(void)
{
  static const char *const told[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK",
                                     "SLURM_PROCID"};
  for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
    const char *text = getenv(told[i]);
    if (text && *text >= '0' && *text <= '9') return atoi(text);
  }
  return -1;
}

/* The library with the operations of a vector of N_VNew_Parallel, whose communicator is one of MPI; that of others may
 * be anything. NULL: not found. */
static void *library_of(N_Vector like)
{
  Dl_info where;
  void *at;
  if (N_VGetVectorID(like) != SUNDIALS_NVEC_PARALLEL) return NULL;
  memcpy(&at, &like->ops->nvdotprodmultiallreduce, sizeof at);
  const bool known = dladdr(at, &where) && where.dli_fname && where.dli_sname &&
                     !strcmp(where.dli_sname, "N_VDotProdMultiAllReduce_Parallel");
  return known ? dlopen(where.dli_fname, RTLD_NOLOAD | RTLD_LAZY) : NULL;
}

#if SUNDIALS_VERSION_MAJOR >= 7

static int asked(void *function, void *library, N_Vector like, int *rank)
{
  int (*ask)(SUNComm, int *);
  (void)library;
  memcpy(&ask, &function, sizeof ask);
  return ask(N_VGetCommunicator(like), rank);
}

#else

static int asked(void *function, void *library, N_Vector like, int *rank)
{
  const void *comm = N_VGetCommunicator(like); /* where it is */
  int (*ask_pointer)(void *, int *), (*ask_number)(int, int *);
  if (dlsym(library, "ompi_mpi_comm_world")) {
    void *pointer;
    memcpy(&pointer, comm, sizeof pointer), memcpy(&ask_pointer, &function, sizeof function);
    return ask_pointer(pointer, rank);
  }
  if (!dlsym(library, "MPIR_Dup_fn")) return -1;
  int number;
  memcpy(&number, comm, sizeof number), memcpy(&ask_number, &function, sizeof function);
  return ask_number(number, rank);
}

#endif

int stf_own_rank(N_Vector like)
{
  int rank = -1;
  void *library = library_of(like);
  void *function = library ? dlsym(library, "MPI_Comm_rank") : NULL;
  if (!function || asked(function, library, like, &rank)) rank = -1;
  if (library) dlclose(library);
  return rank >= 0 ? rank : of_launcher();
}
