/* ranks.c: a heat equation over ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int failures;

int everywhere(const rod *r, int condition, const char *text, const char *file, int line)
{
  int all = !!condition;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, r->comm);
  if (!all && r->rank == 0) printf("%s:%d: not on all ranks: %s\n", file, line, text);
  failures += !all;
  return all;
}

void rod_open(rod *r, MPI_Comm comm, sunindextype n, int uneven)
{
  *r = (rod){.comm = comm, .n = n, .alone = -1};
  MPI_Comm_rank(comm, &r->rank);
  MPI_Comm_size(comm, &r->size);
  r->owned = calloc((size_t)r->size, sizeof *r->owned);
  for (int k = 0; k < r->size; k++)
    r->owned[k] = (int)(n * (k + 1) / r->size - n * k / r->size);
  if (uneven && r->size > 1) {
    memset(r->owned, 0, (size_t)r->size * sizeof *r->owned);
    r->owned[0] = 1, r->owned[1] = (int)n - 1;
  }
  for (int k = 0; k < r->rank; k++) r->first += r->owned[k];
  r->rows = r->owned[r->rank];
}

void rod_close(rod *r) { free(r->owned); }

/* The nearest rank with rows in that direction, or none. */
static int neighbour(const rod *r, int way)
{
  for (int k = r->rank + way; k >= 0 && k < r->size; k += way)
    if (r->owned[k]) return k;
  return MPI_PROC_NULL;
}

int rod_f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  rod *r = user;
  const sunrealtype *u = N_VGetArrayPointer(y), d = (sunrealtype)((r->n + 1) * (r->n + 1));
  sunrealtype *du = N_VGetArrayPointer(out), left = 0, right = 0;
  const sunindextype m = r->rows;
  (void)t;
  if (m > 0) {
    const int below = neighbour(r, -1), above = neighbour(r, 1);
    MPI_Sendrecv(&u[0], 1, MPI_DOUBLE, below, 0, &right, 1, MPI_DOUBLE, above, 0, r->comm,
                 MPI_STATUS_IGNORE);
    MPI_Sendrecv(&u[m - 1], 1, MPI_DOUBLE, above, 1, &left, 1, MPI_DOUBLE, below, 1, r->comm,
                 MPI_STATUS_IGNORE);
  }
  for (sunindextype i = 0; i < m; i++)
    du[i] =
      d * ((i ? u[i - 1] : left) - 2 * u[i] + (i < m - 1 ? u[i + 1] : right)) - 5 * u[i] * u[i];
  r->calls++;
  if (r->rank != r->alone) return 0;
  if (r->wrong == NOT_A_NUMBER && r->calls > 20 && m > 0) du[0] = NAN;
  if (r->wrong == STOP && r->calls > 20) r->stop = 1;
  if (r->wrong == RECOVERABLE && r->calls % 37 == 20 && r->calls < 200) return 1;
  return r->wrong == FATAL && r->calls > 20 ? -1 : 0;
}

int rod_setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  (void)t, (void)y, (void)yp, (void)r;
  ((rod *)user)->c = c;
  return 0;
}

int rod_solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
              sunrealtype c, sunrealtype delta, void *user)
{
  const rod *k = user;
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta;
  N_VScale(1 / (k->c + 2. * (double)((k->n + 1) * (k->n + 1))), b, z);
  return 0;
}

steif_problem rod_problem(rod *r, sunrealtype *y0)
{
  for (sunindextype i = 0; i < r->rows; i++)
    y0[i] = sin(acos(-1) * (double)(r->first + i + 1) / (double)(r->n + 1));
  return (steif_problem){.name = "rod",
                         .n = r->n,
                         .t1 = 0.05,
                         .y0 = y0,
                         .f = rod_f,
                         .precsetup = rod_setup,
                         .precsolve = rod_solve,
                         .storage = STEIF_KRYLOV,
                         .user = r};
}

N_Vector rod_vector(rod *r, steif_context *ctx)
{
  return N_VNew_Parallel(r->comm, r->rows, r->n, steif_sundials(ctx));
}

int same_answer(const rod *r, steif_context *ctx, int code)
{
  char text[1100];
  int codes[2] = {code, -code};
  memset(text, 0, sizeof text);
  if (r->rank == 0) snprintf(text, sizeof text, "%s", steif_message(ctx));
  MPI_Bcast(text, sizeof text, MPI_CHAR, 0, r->comm);
  MPI_Allreduce(MPI_IN_PLACE, codes, 2, MPI_INT, MPI_MAX, r->comm);
  const int same = !strcmp(text, steif_message(ctx)) && codes[0] == -codes[1];
  if (!same) printf("rank %d: code %d, %s\n", r->rank, code, steif_message(ctx));
  return same;
}

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const char *part =
    argc > 1 ? argv[1] : "arrays limits runs reductions memory parts same constraints";
  if (strstr(part, "arrays")) test_arrays(MPI_COMM_WORLD);
  if (strstr(part, "limits")) test_limits(MPI_COMM_WORLD);
  if (strstr(part, "runs")) test_runs(MPI_COMM_WORLD);
  if (strstr(part, "reductions")) test_reductions(MPI_COMM_WORLD);
  if (strstr(part, "memory")) test_memory(MPI_COMM_WORLD);
  if (strstr(part, "parts")) test_parts(MPI_COMM_WORLD);
  if (strstr(part, "same")) test_same(MPI_COMM_WORLD);
  if (strstr(part, "constraints")) test_constraints(MPI_COMM_WORLD);
  MPI_Finalize();
  return failures != 0;
}
