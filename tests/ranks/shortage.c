/* shortage.c: the k-th allocation fails on one rank: all return the same, and nothing is left.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "shortage.h"
#include "checks.h"
#include <stdlib.h>
#include <steif/extension.h>
#include <steif/mpi.h>

typedef struct heap {
  int armed, until, live, failed;
} heap;

static void *allocate(size_t bytes, void *user)
{
  heap *h = user;
  if (h->armed && h->until-- == 0) return h->failed = 1, NULL;
  void *block = malloc(bytes);
  h->live += block != NULL;
  return block;
}

static void release(void *block, void *user)
{
  ((heap *)user)->live -= block != NULL;
  free(block);
}

/* Own rows of a dense pattern, in place of A. */
static void take_A_away(steif_problem *p, sunindextype rows)
{
  static sunindextype at[17], column[256];
  static const steif_pattern dense = {at, column};
  for (sunindextype k = 0; k < rows * p->n; k++) column[k] = k % p->n;
  for (sunindextype i = 0; i <= rows; i++) at[i] = i * p->n;
  p->A = NULL, p->pattern = &dense;
}

/* A factorisation and a real and a complex solve. */
static int work(steif_context *ctx, const char *name, const char *spec, int differences)
{
  N_Vector like = NULL;
  steif_problem *p = steif_mpi_problem_new(ctx, name, MPI_COMM_WORLD, &like);
  if (p && differences) take_A_away(p, NV_LOCLENGTH_P(like));
  steif_mpi *m = p ? steif_mpi_open(ctx, p, spec, like) : NULL;
  int code = m ? STEIF_OK : steif_status(ctx);
  if (m) {
    const steif_problem *q = steif_mpi_problem(m);
    N_Vector b[] = {N_VClone(like), N_VClone(like)}, x[] = {N_VClone(like), N_VClone(like)};
    N_VConst(1, b[0]), N_VConst(1, b[1]);
    code = q->precsetup(0, like, like, like, 2, q->user);
    if (code == STEIF_NO_MEMORY) { /* there is enough the next time */
      int again = q->Ev ? q->Ev(0, like, like, b[0], x[0], q->user) : 0;
      if (!again) again = q->precsetup(0, like, like, like, 2, q->user);
      if (!again) again = q->precsolve(0, like, like, like, b[0], x[0], 2, 0, q->user);
      if (again) code = again - 100;
      if (!again) steif_fail(ctx, code, "not the first time");
    }
    if (!code) code = q->precsolve(0, like, like, like, b[0], x[0], 2, 0, q->user);
    if (!code && q->precsolve_pair)
      code = q->precsolve_pair(0, like, like, like, b, x, 1, 2, 0, q->user);
    for (int i = 0; i < 2; i++) N_VDestroy(b[i]), N_VDestroy(x[i]);
  }
  steif_mpi_free(&m);
  steif_mpi_problem_free(ctx, &p, &like);
  return code;
}

int shortage_at(const char *name, const char *spec, int differences, int k, int here, int *code)
{
  heap h = {0};
  steif_context *ctx =
    steif_context_new(&(steif_setup){.allocate = allocate, .release = release, .user = &h});
  h.armed = here, h.until = k;
  *code = work(ctx, name, spec, differences);
  h.armed = 0;
  int all[] = {same(ctx), h.failed};
  MPI_Allreduce(MPI_IN_PLACE, &all[1], 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  steif_context_free(&ctx);
  const int right = all[0] && h.live == 0 && *code == (all[1] ? STEIF_NO_MEMORY : STEIF_OK);
  return right ? all[1] : -1;
}
