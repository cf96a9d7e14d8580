/* arrays.c: host arrays of a rank are its own rows; what needs all of them is refused, the same on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  N_VScale(1, x, out);
  return 0;
}

static int local(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y;
  g[0] = t - 0.01 - 0.001 * ((rod *)user)->rank;
  return 0;
}

enum { PLAIN, ATOLS, INDEX, CONSTRAINT, DENSE, BAND, SPARSE, SENSITIVE, CHECKED, EVENT, CASES };

static int expected(int which, const char *method, const rod *r)
{
  (void)method;
  switch (which) {
  case DENSE:
  case BAND:
  case SPARSE:
  case CHECKED:
  case SENSITIVE: return STEIF_UNSUPPORTED;
  case EVENT: return r->size > 1 ? STEIF_BAD_INPUT : STEIF_OK;
  default: return STEIF_OK;
  }
}

/* Arrays are as long as the rows, so that valgrind and sanitizers see one more read or written. */
static void run(rod *r, const char *method, int which)
{
  const size_t rows = (size_t)r->rows;
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype *y0 = malloc((rows + !rows) * sizeof *y0),
              *atols = malloc((rows + !rows) * sizeof *y0);
  int *whole = malloc((rows + !rows) * sizeof *whole);
  for (size_t i = 0; i < rows; i++) atols[i] = 1e-6, whole[i] = 1;
  steif_problem p = rod_problem(r, y0);
  steif_options o = steif_defaults();
  o.rtol = 1e-3, o.like = rod_vector(r, ctx);
  if (which == ATOLS) o.atols = atols;
  if (which == INDEX) p.index = whole, p.Ev = Ev;
  if (which == INDEX && rows) whole[0] = 2;
  if (which == CONSTRAINT) p.constraint = whole;
  if (which == DENSE) p.storage = STEIF_DENSE;
  if (which == BAND) p.storage = STEIF_BAND, p.lower = p.upper = 1;
  if (which == SPARSE) p.storage = STEIF_SPARSE, p.nnz = 3 * r->n;
  if (which == SENSITIVE) o.sensitivities = 1;
  if (which == CHECKED) p.Ev = Ev, o.initial = STEIF_CHECK;
  if (which == EVENT) p.events = 1, p.event = local;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  EVERYWHERE(r, same_answer(r, ctx, code));
  EVERYWHERE(r,
             which != CHECKED || strstr(steif_message(ctx), "check the start in one process"));
  if (!EVERYWHERE(r, (code == STEIF_OK) == (expected(which, method, r) == STEIF_OK)) &&
      r->rank == 0)
    fprintf(stdout, "  %s, case %d: %s\n", method, which, steif_message(ctx));
  steif_solver_free(&s);
  N_VDestroy(o.like);
  steif_context_free(&ctx);
  free(y0), free(atols), free(whole);
}

void test_arrays(MPI_Comm comm)
{
  static const char *const methods[] = {"bdf",  "radau:s=3", "dirk:hw43", "dopri87",
                                        "auto", "cvode",     "ida",       "arkode"};
  rod r;
  rod_open(&r, comm, 40, 0);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
    for (int which = PLAIN; which < CASES; which++) {
      const int package = k > 4;
      if ((which == INDEX || which == CHECKED) && k > 1) continue; /* need the mass form */
      if (which == SENSITIVE && package) continue;
      run(&r, methods[k], which);
    }
  rod_close(&r);
}
