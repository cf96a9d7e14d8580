/* heat3d_ranks.c: u_t = Laplace u + 20 u (1 - u) in the unit cube over the ranks of MPI, u = 0 on the boundary, m^3
 * inner points, whole planes to a rank. AMG preconditions GMRES.
 *   mpirun -np 4 ./heat3d_ranks [m] [method]
 * The known number is that of one process for m = 12: the classical Runge-Kutta method, 500 and 1000 steps agree.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <steif/mpi.h>
#include <sunmatrix/sunmatrix_sparse.h>
typedef struct cube { /* planes low .. high - 1 are here; those beside them are copies */
  int rank, size, m, low, high;
  double *below, *above;
} cube;
/* The planes beside own ones. */
static void exchange(cube *c, const double *u)
{
  const int plane = c->m * c->m, last = (c->high - c->low - 1) * plane;
  const int down = c->low > 0 ? c->rank - 1 : MPI_PROC_NULL,
            up = c->high < c->m ? c->rank + 1 : MPI_PROC_NULL;
  MPI_Sendrecv(u + last, plane, MPI_DOUBLE, up, 0, c->below, plane, MPI_DOUBLE, down, 0,
               MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  MPI_Sendrecv(u, plane, MPI_DOUBLE, down, 1, c->above, plane, MPI_DOUBLE, up, 1,
               MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}
static int f(double t, N_Vector y, N_Vector ydot, void *user)
{
  cube *c = user;
  const int m = c->m, plane = m * m, rows = (c->high - c->low) * plane;
  const double *u = N_VGetArrayPointer(y), scale = (m + 1.) * (m + 1.);
  double *du = ((void)t, N_VGetArrayPointer(ydot));
  exchange(c, u);
  for (int k = 0; k < rows; k++) {
    const int i = k % m, j = k / m % m, p = k % plane;
    const double sum = (i ? u[k - 1] : 0) + (i < m - 1 ? u[k + 1] : 0) + (j ? u[k - m] : 0) +
                       (j < m - 1 ? u[k + m] : 0) + (k >= plane ? u[k - plane] : c->below[p]) +
                       (k < rows - plane ? u[k + plane] : c->above[p]);
    du[k] = scale * (sum - 6 * u[k]) + 20 * u[k] * (1 - u[k]);
  }
  return 0;
}
/* Own rows of df/dy, the columns of all ranks. */
static int A(double t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const cube *c = user;
  const long m = c->m, step[] = {1, m, m * m, m * m * m}, first = c->low * step[2];
  sunindextype *row = SM_INDEXPTRS_S(M), *column = SM_INDEXVALS_S(M), used = row[0] = 0;
  const double *u = N_VGetArrayPointer(y), scale = (c->m + 1.) * (c->m + 1.);
  double *a = ((void)t, (void)yp, SM_DATA_S(M));
  for (long k = first; k < c->high * step[2]; k++) {
    for (int d = 0; d < 3; d++) {
      const long at = k % step[d + 1] / step[d];
      if (at > 0) column[used] = k - step[d], a[used++] = scale;
      if (at < m - 1) column[used] = k + step[d], a[used++] = scale;
    }
    column[used] = k, a[used++] = -6 * scale + 20 * (1 - 2 * u[k - first]);
    row[k - first + 1] = used;
  }
  return 0;
}
int main(int argc, char **argv)
{
  cube c = {.m = argc > 1 ? atoi(argv[1]) : 12}; /* at least as many planes as ranks */
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &c.rank), MPI_Comm_size(MPI_COMM_WORLD, &c.size);
  c.low = c.m * c.rank / c.size, c.high = c.m * (c.rank + 1) / c.size;
  const int m = c.m, plane = m * m, rows = (c.high - c.low) * plane;
  double *y0 = malloc(sizeof *y0 * (size_t)rows), h = acos(-1) / (m + 1);
  c.below = calloc(2 * (size_t)plane, sizeof *y0), c.above = c.below + plane;
  for (int k = 0, z = c.low; k < rows; k++, z = c.low + k / plane)
    y0[k] = 0.5 * sin(h * (k % m + 1)) * sin(h * (k / m % m + 1)) * sin(h * (z + 1));
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.rtol = 1e-7, o.like = steif_mpi_vector(ctx, MPI_COMM_WORLD, rows);
  steif_problem p = {.name = "fisher", .t1 = 0.1, .y0 = y0, .f = f, .A = A, .user = &c};
  p.n = N_VGetLength(o.like), p.nnz = 7 * rows, p.storage = STEIF_SPARSE;
  steif_mpi *spread = steif_mpi_open(ctx, &p, "amg", o.like);
  const char *method = argc > 2 ? argv[2] : "radau:s=3";
  steif_solver *s =
    spread ? steif_solver_new(ctx, steif_mpi_problem(spread), method, &o) : NULL;
  int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  const double known = 0.13433708251, most = s ? N_VMaxNorm(steif_solution(s)) : 0; /* of all */
  if (c.rank == 0)
    printf("%d ranks: %s, u <= %.10f (m = 12: %.10f)\n", c.size, steif_message(ctx), most,
           known);
  code = code || (m == 12 && fabs(most - known) > 1e-7);
  steif_solver_free(&s), steif_mpi_free(&spread), N_VDestroy(o.like), steif_context_free(&ctx);
  free(y0), free(c.below);
  return MPI_Finalize() || code;
}
