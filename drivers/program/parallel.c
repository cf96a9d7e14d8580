/* parallel.c: --parallel: the program steif-mpi does the work; this one is not linked to MPI.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parallel.h"
#include <string.h>
#include <unistd.h>

bool parallel_asked(int argc, char **argv)
{
  for (int i = 1; i < argc; i++)
    if (!strcmp(argv[i], "--parallel")) return true;
  return false;
}

int parallel_become(struct call *call, char **argv)
{
  char path[4096] = "";
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 8);
  const char *slash = length > 0 ? strrchr(path, '/') : NULL;
  if (slash && slash - path < (ssize_t)sizeof path - 16) {
    strcpy(path + (slash - path) + 1, "steif-mpi");
    execv(path, argv);
  }
  return refuse(call, STEIF_UNSUPPORTED, "STEIF_UNSUPPORTED",
                "--parallel needs the program steif-mpi beside this one: './bootstrap mpi' "
                "installs MPI, MUMPS and hypre and builds it (-DSTEIF_MPI=ON)");
}
