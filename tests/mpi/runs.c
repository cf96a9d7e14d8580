/* runs.c: the steps and the solution of one address space, for even and uneven rows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Steps, and own rows of the end into y. */
static long end(rod *r, const char *method, int serial, sunrealtype *y)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype *y0 = malloc((size_t)(r->rows + 1) * sizeof *y0);
  steif_problem p = rod_problem(r, y0);
  steif_options o = steif_defaults();
  o.rtol = 1e-4, o.like = serial ? NULL : rod_vector(r, ctx);
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  const long steps = code ? -1 : steif_statistics(s)->steps;
  if (code) printf("rank %d, %s: %s\n", r->rank, method, steif_message(ctx));
  for (sunindextype i = 0; !code && i < r->rows; i++)
    y[i] = N_VGetArrayPointer(steif_solution(s))[i];
  steif_solver_free(&s);
  if (!serial) N_VDestroy(o.like);
  steif_context_free(&ctx);
  free(y0);
  return steps;
}

/* One rank has the same loops and sums as a serial vector: steif's own methods, the same bits. */
static void compare(rod *many, rod *one, const char *method, int own)
{
  sunrealtype here[64], all[64], worst = 0;
  const long steps = end(many, method, 0, here), alone = end(one, method, 1, all);
  EVERYWHERE(many, steps > 0 && steps == alone);
  for (sunindextype i = 0; i < many->rows; i++)
    worst = fmax(worst, fabs(here[i] - all[many->first + i]));
  if (own && many->size == 1) EVERYWHERE(many, worst == 0);
  if (!EVERYWHERE(many, worst <= 0.1 * 1e-4) && many->rank == 0)
    printf("  %s: %.2e, %ld and %ld steps\n", method, worst, steps, alone);
}

void test_runs(MPI_Comm comm)
{
  enum { OWN = 9 };
  static const char *const methods[] = {"be",        "bdf",       "dirk:hw43", "radau:s=2",
                                        "radau:s=3", "gauss:s=3", "rodas4",    "exprb32",
                                        "auto",      "cvode",     "ida",       "arkode"};
  for (int uneven = 0; uneven < 2; uneven++) {
    rod many, one;
    rod_open(&many, comm, 40, uneven);
    rod_open(&one, MPI_COMM_SELF, 40, 0);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
      compare(&many, &one, methods[k], k < OWN);
    rod_close(&many), rod_close(&one);
  }
}
