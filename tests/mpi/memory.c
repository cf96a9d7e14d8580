/* memory.c: one rank alone is refused the k-th piece of memory: all return, with the same code and sentence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "ranks.h"
#include <stdlib.h>

/* Refusals that this run has met, 0: it came to its end. */
static int refused(const rod *where, const char *method, long k, int alone, int kept)
{
  static const int strict[40] = {2, 1, 1, [39] = 2};
  static sunrealtype atols[40];
  rod r;
  failing fails = {.refuse_at = where->rank == alone ? k : 0};
  const steif_setup given = failing_setup(&fails);
  rod_open(&r, where->comm, 40, 0);
  sunrealtype *y0 = malloc((size_t)(r.rows + 1) * sizeof *y0);
  steif_context *ctx = steif_context_new(&given);
  int there = ctx != NULL, code = STEIF_NO_MEMORY;
  MPI_Allreduce(MPI_IN_PLACE, &there, 1, MPI_INT, MPI_MIN, r.comm);
  for (int i = 0; i < 40; i++) atols[i] = 1e-6;
  if (there) {
    steif_problem p = rod_problem(&r, y0);
    steif_options o = steif_defaults();
    o.rtol = 1e-3, o.like = rod_vector(&r, ctx);
    if (kept) p.constraint = strict + r.first, o.atols = atols + r.first;
    steif_solver *s = steif_solver_new(ctx, &p, method, &o);
    code = s ? steif_solve_step(s) : steif_status(ctx);
    EVERYWHERE(&r, same_answer(&r, ctx, code));
    EVERYWHERE(&r, code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_solver_free(&s);
    N_VDestroy(o.like);
  }
  steif_context_free(&ctx);
  EVERYWHERE(&r, fails.alive == 0);
  free(y0), rod_close(&r);
  return code != STEIF_OK;
}

void test_memory(MPI_Comm comm)
{
  static const char *const methods[] = {"bdf",   "radau:s=3", "dirk:hw43", "rodas4",
                                        "be",    "gauss:s=3", "exprb32",   "auto",
                                        "cvode", "ida",       "arkode"};
  rod r;
  rod_open(&r, comm, 40, 0);
  for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
    for (int kept = 0; kept < 2; kept++) {
      long k = 1;
      while (k < 2000 && refused(&r, methods[m], k, m % 2 ? 0 : r.size - 1, kept)) k++;
      EVERYWHERE(&r, k > 10 && k < 2000);
    }
  rod_close(&r);
}
