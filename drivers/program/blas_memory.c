/* blas_memory.c: is there memory for the buffers of OpenBLAS, a few of 32 to 128 MB?
 * SPDX-License-Identifier: BSD-3-Clause */
#define _DEFAULT_SOURCE /* MAP_ANON */
#include "blas_memory.h"
#include "message.h"
#include <sys/mman.h>
#include <unistd.h>

static bool roomy(void)
{
  const size_t enough = (size_t)256 << 20;
  void *room = mmap(NULL, enough, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANON, -1, 0);
  return room != MAP_FAILED && !munmap(room, enough);
}

/* At exit OpenBLAS would wait for its threads, and these for that memory. */
void need_blas_memory(const struct call *call)
{
  if (roomy()) return;
  const int code = no_memory(call, "the buffers of BLAS, 256 MB", "raise 'ulimit -v'");
  fflush(stdout);
  _exit(code);
}
