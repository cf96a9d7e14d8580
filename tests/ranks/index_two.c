/* index_two.c: linear systems of index 2 over ranks, from models.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

/* q = cos t, and 1 more after t = 0.5, and t - 1 more after t = 1; x = q, u' = x, y = x' + x of index 2, whose x jumps with
 * an impulse of y, and then y alone; all of them are right where they are shown: at the jump the values after it. */
static const char breaks_model[] = "state x = 1, y = 1, u = 0\nx' = -x + y\n"
                                   "0 = x - cos(t) - step(t - 0.5) - ramp(t - 1)\nu' = x\n"
                                   "time 0 to 2\n";

static void after(double t, double *x)
{
  const double later = t < 1 ? 0 : t - 1, jump = t < 0.5 ? 0 : 1;
  x[0] = cos(t) + jump + later, x[1] = x[0] - sin(t) + (t < 1 ? 0 : 1);
  x[2] = sin(t) + jump * (t - 0.5) + later * later / 2;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The largest error of a vector of three, in any order. */
static double error_of(N_Vector v, double t)
{
  double all[3] = {0, 0, 0}, right[3], worst = 0;
  const sunindextype first = steif_mpi_first(v);
  for (sunindextype i = 0; i < NV_LOCLENGTH_P(v); i++)
    all[first + i] = N_VGetArrayPointer(v)[i];
  MPI_Allreduce(MPI_IN_PLACE, all, 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  after(t, right);
  qsort(all, 3, sizeof *all, ascending), qsort(right, 3, sizeof *right, ascending);
  for (int i = 0; i < 3; i++) worst = fmax(worst, fabs(all[i] - right[i]));
  return worst;
}

static double worst_observed;

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)user;
  if (t > 0 && t != 0.5 && t != 1) worst_observed = fmax(worst_observed, error_of(y, t));
  return 0;
}

/* steps: at most; 0: the method is rejected. */
static void breaks(const char *method, double rtol, double h, long steps)
{
  static const double times[] = {1e-3, 0.5, 0.5003, 0.7, 1, 1.0001, 2};
  steif_context *ctx = steif_context_new(NULL);
  N_Vector like = NULL;
  steif_problem *p = steif_mpi_problem_new(ctx, "breaks.steif", MPI_COMM_WORLD, &like);
  steif_mpi *m = p ? steif_mpi_open(ctx, p, "mumps", like) : NULL;
  steif_options o = steif_defaults();
  o.rtol = rtol, o.h = h, o.like = like, o.observe = observe;
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  ALL(s ? steps > 0 : !steps && steif_status(ctx) == STEIF_UNSUPPORTED && same(ctx));
  worst_observed = 0;
  for (size_t k = 0; s && k < sizeof times / sizeof *times; k++) {
    ALL(steif_solve_to(s, times[k]) == STEIF_OK);
    const double error = error_of(steif_solution(s), times[k]);
    if (!ALL(error <= 10 * rtol) && !rank)
      printf("  %s, rtol %g, t = %g: error %.3g\n", method, rtol, times[k], error);
  }
  const long made[] = {s ? steif_statistics(s)->steps : 0, s ? -steif_statistics(s)->steps : 0};
  long most[2];
  MPI_Allreduce(made, most, 2, MPI_LONG, MPI_MAX, MPI_COMM_WORLD);
  if (!ALL(most[0] == -most[1] && most[0] <= steps && worst_observed <= 10 * rtol) && !rank)
    printf("  %s: %ld steps, observed %.3g\n", method, most[0], worst_observed);
  steif_solver_free(&s), steif_mpi_free(&m);
  if (p) steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

static void test_breaks(void)
{
  FILE *file = rank == 0 ? fopen("breaks.steif", "w") : NULL;
  if (file) fputs(breaks_model, file), fclose(file);
  MPI_Barrier(MPI_COMM_WORLD);
  breaks("radau:s=3", 1e-6, 0, 200), breaks("radau:s=5", 1e-8, 0, 100);
  breaks("bdf", 1e-6, 0, 400), breaks("auto", 1e-5, 0, 200);
  breaks("radau:s=2", 1e-8, 0, 4000);
  breaks("ida", 1e-5, 0, 0), breaks("cvode", 1e-5, 0, 0), breaks("radau:s=3", 1e-5, 0.01, 0);
}

void test_index_two(void)
{
  test_breaks();
  for (int k = 0; k < 2; k++) {
    index_two(1 - k, "radau:s=3", 1), index_two(1 - k, "bdf", 1), index_two(1 - k, "auto", 1);
    index_two(1 - k, "dirk:hw43", 0), index_two(1 - k, "gauss:s=2", 0);
  }
}
