/* dissection.c: places of all unknowns among the pivots by nested dissection of the graph of A + A^T, by METIS through
 * CHOLMOD, on rank 0, to which all rows come.
 * G. Karypis, V. Kumar, SIAM J. Sci. Comput. 20 (1998) 359-392.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "factors.h"
#include <cholmod.h>
#include <limits.h>

/* The pattern as MUMPS numbers it, from 1, of all ranks. */
typedef struct whole {
  int *count, *at; /* of each rank */
  int *row, *column, entries;
} whole;

static void release(steif_context *ctx, whole *w)
{
  void *const all[] = {w->count, w->at, w->row, w->column};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(ctx, all[i]);
}

static int room(const rows *r, whole *w)
{
  long long sum = 0;
  for (int k = 0; k < r->own.size; k++) w->at[k] = (int)sum, sum += w->count[k];
  if (sum > INT_MAX)
    return steif_fail(
      r->ctx, STEIF_UNSUPPORTED,
      "the pattern has %lld entries, more than one message holds: take order=amf", sum);
  const size_t entries = (size_t)(w->entries = (int)sum) + 1;
  w->row = steif_allocate(r->ctx, entries, sizeof *w->row);
  w->column = steif_allocate(r->ctx, entries, sizeof *w->column);
  return w->row && w->column ? STEIF_OK : STEIF_NO_MEMORY;
}

static int gather(const rows *r, const factors_setting *set, whole *w)
{
  const owners *o = &r->own;
  const int mine = (int)r->entries;
  int code = STEIF_OK;
  w->count = steif_allocate(r->ctx, (size_t)o->size, sizeof *w->count);
  w->at = steif_allocate(r->ctx, (size_t)o->size, sizeof *w->at);
  MPI_TRY(steif_agree(r->ctx, r->like, w->count && w->at ? STEIF_OK : STEIF_NO_MEMORY));
  MPI_Gather(&mine, 1, MPI_INT, w->count, 1, MPI_INT, 0, o->comm);
  if (o->rank == 0) code = room(r, w);
  MPI_TRY(steif_agree(r->ctx, r->like, code));
  MPI_Gatherv(set->row, mine, MPI_INT, w->row, w->count, w->at, MPI_INT, 0, o->comm);
  MPI_Gatherv(set->column, mine, MPI_INT, w->column, w->count, w->at, MPI_INT, 0, o->comm);
  return STEIF_OK;
}

/* The lower half of the pattern of A + A^T. */
static cholmod_sparse *lower(const whole *w, size_t n, cholmod_common *c)
{
  cholmod_triplet *T =
    cholmod_l_allocate_triplet(n, n, (size_t)w->entries + 1, -1, CHOLMOD_PATTERN, c);
  if (!T) return NULL;
  SuiteSparse_long *i = T->i, *j = T->j;
  for (int k = 0; k < w->entries; k++) {
    const int a = w->row[k] - 1, b = w->column[k] - 1;
    i[k] = a > b ? a : b, j[k] = a > b ? b : a;
  }
  T->nnz = (size_t)w->entries;
  cholmod_sparse *A = cholmod_l_triplet_to_sparse(T, 0, c);
  cholmod_l_free_triplet(&T, c);
  return A;
}

static int dissect(const rows *r, const whole *w, int *place)
{
  cholmod_common c;
  const size_t n = (size_t)r->own.n;
  SuiteSparse_long *order = steif_allocate(r->ctx, n, sizeof *order);
  if (!order) return STEIF_NO_MEMORY;
  cholmod_l_start(&c);
  c.print = 0;
  cholmod_sparse *A = lower(w, n, &c);
  const int done = A && cholmod_l_metis(A, NULL, 0, 1, order, &c);
  for (size_t k = 0; done && k < n; k++) place[order[k]] = (int)k + 1;
  cholmod_l_free_sparse(&A, &c);
  cholmod_l_finish(&c);
  steif_release(r->ctx, order);
  if (done) return STEIF_OK;
  return steif_fail(
    r->ctx, STEIF_NO_MEMORY,
    "nested dissection of %zu unknowns by METIS failed (CHOLMOD says %d), which "
    "happens when memory is short: take order=amf",
    n, c.status);
}

int factors_dissect(const rows *r, const factors_setting *set, int *place)
{
  whole w = {0};
  int code = gather(r, set, &w);
  if (!code)
    code = steif_agree(r->ctx, r->like, r->own.rank ? STEIF_OK : dissect(r, &w, place));
  release(r->ctx, &w);
  return code;
}
