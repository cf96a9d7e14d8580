/* index_two.c: a linear system of index 2 over ranks, from a model.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <math.h>
#include <stdio.h>

/* x' = -x + y, 0 = x - cos t, y = cos t - sin t of index 2: both are right to the tolerance, by starts that are consistent
 * or not, or the method is rejected. */
static void index_two(double y0, const char *method, int serves)
{
  FILE *file = rank == 0 ? fopen("index_two.steif", "w") : NULL;
  if (file)
    fprintf(file, "state x = 1, y = %g\nx' = -x + y\n0 = x - cos(t)\ntime 0 to 2\n", y0);
  if (file) fclose(file);
  MPI_Barrier(MPI_COMM_WORLD);
  steif_context *ctx = steif_context_new(NULL);
  N_Vector like = NULL;
  steif_problem *p = steif_mpi_problem_new(ctx, "index_two.steif", MPI_COMM_WORLD, &like);
  steif_mpi *m = p ? steif_mpi_open(ctx, p, "mumps", like) : NULL;
  steif_options o = steif_defaults();
  o.rtol = 1e-5, o.like = like;
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  const int code = s ? steif_solve_to(s, 2) : steif_status(ctx);
  ALL(code == (serves ? STEIF_OK : STEIF_UNSUPPORTED));
  ALL(p && (y0 == 1) == !*steif_mpi_start(p));
  /* The numbering is steif's own: both values in any order. */
  double value[2] = {0, 0};
  if (!code) {
    const double exact[2] = {cos(2), cos(2) - sin(2)},
                 *y = N_VGetArrayPointer(steif_solution(s));
    for (sunindextype i = 0; i < NV_LOCLENGTH_P(like); i++)
      for (int k = 0; k < 2; k++) value[k] += fabs(y[i] - exact[k]) < 0.1 ? y[i] : 0;
    MPI_Allreduce(MPI_IN_PLACE, value, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    if (!ALL(fabs(value[0] - exact[0]) <= 5e-5 && fabs(value[1] - exact[1]) <= 5e-5) && !rank)
      printf("  %s from %g: %.8g %.8g\n", method, y0, value[0], value[1]);
  }
  steif_solver_free(&s), steif_mpi_free(&m);
  if (p) steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

void test_index_two(void)
{
  for (int k = 0; k < 2; k++) {
    index_two(1 - k, "radau:s=3", 1), index_two(1 - k, "bdf", 1), index_two(1 - k, "auto", 1);
    index_two(1 - k, "dirk:hw43", 0), index_two(1 - k, "gauss:s=2", 0);
  }
}
