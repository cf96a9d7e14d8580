/* solution_over_ranks.c: the solution in the order of one process.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include <math.h>
#include <mpi.h>
#include <nvector/nvector_parallel.h>
#include <stdio.h>
#include <string.h>

enum { SHOWN = 12, BLOCK = 4096 }; /* unknowns in a table; at a time */

/* Unknowns first .. first + count - 1, for rank 0: a sum of one number and zeros. */
static void gather(const steif_problem *p, N_Vector y, sunindextype first, int count,
                   double *out)
{
  double own[BLOCK] = {0};
  const double *of = N_VGetArrayPointer(y);
  for (sunindextype k = 0; k < NV_LOCLENGTH_P(y); k++) {
    const sunindextype i = steif_mpi_number(p, k) - first;
    if (i >= 0 && i < count) own[i] = of[k];
  }
  MPI_Reduce(own, out, count, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
}

static void table(const request *r, const steif_problem *p, N_Vector y)
{
  double value[BLOCK];
  const int count = p->n < SHOWN ? (int)p->n : SHOWN;
  gather(p, y, 0, count, value);
  for (int i = 0; r->rank == 0 && i < count; i++)
    printf("%s%.12g", i == 0 ? "y          " : i % 4 ? " " : "\n           ", value[i]);
  if (r->rank == 0 && p->n > count) printf(" ... (%lld in all)", (long long)p->n);
  if (r->rank == 0) printf("\n");
}

void show_solution(const request *r, const steif_problem *p, N_Vector y)
{
  double value[BLOCK];
  if (!r->json) {
    table(r, p, y);
    return;
  }
  for (sunindextype first = 0; first < p->n; first += BLOCK) {
    const int count = p->n - first < BLOCK ? (int)(p->n - first) : BLOCK;
    gather(p, y, first, count, value);
    for (int i = 0; r->rank == 0 && i < count; i++) {
      char text[32];
      snprintf(text, sizeof text, isfinite(value[i]) ? "%.17g" : "null", value[i]);
      printf("%s%s", first + i ? ", " : "\"y\": [", text);
    }
  }
  if (r->rank == 0) printf("], ");
}
