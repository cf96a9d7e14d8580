/* setting.c: what a spec such as mumps:order=amf,memory=500 asks for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "factors.h"
#include <stdlib.h>
#include <string.h>

/* Up to so many unknowns any ordering will do. */
enum { SMALL = 200 };

/* ICNTL(7), but for what all ranks find. */
enum { AMD = 0, AMF = 2, PARALLEL = -1 };

static bool read_order(factors_setting *s, const char *value)
{
  static const struct {
    const char *name;
    int order;
  } all[] = {{"metis", FACTORS_METIS}, {"amf", AMF}, {"amd", AMD}, {"ptscotch", PARALLEL}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (!strcmp(value, all[i].name)) return s->order = all[i].order, true;
  return false;
}

/* PT-Scotch calls MPI from threads of its own, unless it is told to have one. */
static int threads_allowed(const rows *r)
{
  const char *threads = getenv("SCOTCH_PTHREAD_NUMBER");
  int level = MPI_THREAD_SINGLE;
  MPI_Query_thread(&level);
  if (level >= MPI_THREAD_MULTIPLE || (threads && !strcmp(threads, "1"))) return STEIF_OK;
  return steif_fail(r->ctx, STEIF_UNSUPPORTED,
                    "mumps: order=ptscotch calls MPI from several threads: set "
                    "SCOTCH_PTHREAD_NUMBER=1 in the environment, start MPI by MPI_Init_thread "
                    "with MPI_THREAD_MULTIPLE, or take order=metis");
}

int factors_read(const rows *r, const steif_spec *spec, factors_setting *s)
{
  s->order = r->own.n > SMALL ? FACTORS_METIS : AMF, s->refine = 2;
  for (int k = 0; k < spec->count; k++) {
    const char *key = spec->param[k].key, *value = spec->param[k].value;
    char *end;
    const long number = strtol(value, &end, 10);
    if (!strcmp(key, "order") && read_order(s, value)) continue;
    if (!strcmp(key, "memory") && *end == 0 && number > 0 && number < 1 << 30)
      s->memory = (int)number;
    else if (!strcmp(key, "refine") && *end == 0 && number >= 0 && number <= 10)
      s->refine = (int)number;
    else
      return steif_fail(r->ctx, STEIF_BAD_INPUT,
                        "mumps: '%s=%s' is none of order=metis, order=amf, order=amd, "
                        "order=ptscotch, memory=MB, refine=0 .. 10",
                        key, value);
  }
  return s->order == PARALLEL && r->own.size > 1 ? threads_allowed(r) : STEIF_OK;
}
