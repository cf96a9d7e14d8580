/* reductions.c: sums over the ranks, as MPI sees them: what steps and iterations may make.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <stdio.h>
#include <stdlib.h>

long allreduces;

/* The profiling interface of MPI: every call of the library and of its vectors comes here. */
int MPI_Allreduce(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op,
                  MPI_Comm comm)
{
  allreduces++;
  return PMPI_Allreduce(from, to, count, type, op, comm);
}

static int Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  rod r = *(rod *)user;
  sunrealtype *z = N_VGetArrayPointer(out);
  const sunrealtype *u = N_VGetArrayPointer(y), *v = N_VGetArrayPointer(x);
  (void)yp;
  r.alone = -1;
  const int code = rod_f(t, x, out, &r); /* and - 10 u v in place of - 5 v^2 */
  for (sunindextype i = 0; i < r.rows; i++) z[i] += 5 * v[i] * v[i] - 10 * u[i] * v[i];
  return code;
}

/* Steps of multistep methods ask for more norms, of other orders; steps made anew for one more, by radau:s=2 of all. */
static void run(rod *r, const char *method, int most)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype *y0 = malloc((size_t)(r->rows + 1) * sizeof *y0);
  steif_problem p = rod_problem(r, y0);
  steif_options o = steif_defaults();
  p.Av = Av, o.rtol = 1e-4, o.like = rod_vector(r, ctx);
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  for (int k = 0; s && k < 5; k++) steif_solve_step(s);
  const steif_krylov_stats before = *steif_krylov_statistics(s);
  const long steps = steif_statistics(s)->steps, refused = steif_statistics(s)->rejected;
  const long from = allreduces;
  EVERYWHERE(r, s && steif_solve_to(s, p.t1) == STEIF_OK);
  const long made = allreduces - from;
  const steif_krylov_stats after = *steif_krylov_statistics(s);
  const long counted = after.reductions - before.reductions;
  const long iterations = after.iterations - before.iterations;
  const long tried =
    steif_statistics(s)->steps - steps + steif_statistics(s)->rejected - refused;
  const int few = made <= 2 * iterations + most * tried, same = labs(made - counted) <= 10;
  if ((!few || !same || getenv("STEIF_TEST_TELL")) && r->rank == 0)
    printf("  %s: %ld sums, %ld counted; %ld iterations, %ld steps\n", method, made, counted,
           iterations, tried);
  EVERYWHERE(r, iterations > 0 && few && same);
  steif_solver_free(&s);
  N_VDestroy(o.like);
  steif_context_free(&ctx);
  free(y0);
}

void test_reductions(MPI_Comm comm)
{
  static const char *const methods[] = {"be",        "bdf",       "dirk:hw43",
                                        "radau:s=2", "radau:s=3", "radau:s=5"};
  rod r;
  rod_open(&r, comm, 40, 0);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
    run(&r, methods[k], k < 2 ? 6 : k == 3 ? 5 : 4);
  rod_close(&r);
}
