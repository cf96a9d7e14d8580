/* colouring.c: columns that share no row get the same colour: the first one free, column by column (A. R. Curtis,
 * M. J. D. Powell, J. K. Reid, J. Inst. Maths Applics 13, 1974), on rank 0, to which the patterns of all rows come:
 * the colours are the same for any number of ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "row_differences.h"
#include <limits.h>

/* Rows of all ranks, and the same entries by columns; colours. */
typedef struct whole {
  int *count, *at;           /* of each rank: entries or rows */
  int *row_at, *column;      /* n + 1; entries */
  int *column_at, *row;      /* the same */
  int *colour, *mark, *here; /* n; n + 1; colours of own columns */
  int entries, colours;
} whole;

static void release(steif_context *ctx, whole *w)
{
  void *const all[] = {w->count, w->at,     w->row_at, w->column, w->column_at,
                       w->row,   w->colour, w->mark,   w->here};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(ctx, all[i]);
}

static int *integers(const rows *r, size_t count)
{
  return steif_allocate(r->ctx, count + 1, sizeof(int));
}

/* Counts of all ranks to rank 0, and where each begins. */
static long long spread(const rows *r, whole *w, int mine)
{
  long long sum = 0;
  MPI_Gather(&mine, 1, MPI_INT, w->count, 1, MPI_INT, 0, r->own.comm);
  for (int k = 0; k < r->own.size && r->own.rank == 0; k++)
    w->at[k] = (int)sum, sum += w->count[k];
  return sum;
}

static int room(const rows *r, whole *w, long long entries)
{
  const size_t n = (size_t)r->own.n;
  if (r->own.rank) return STEIF_OK;
  if (entries > INT_MAX)
    return steif_fail(r->ctx, STEIF_UNSUPPORTED,
                      "the pattern has %lld entries, more than can be coloured in one place: "
                      "give .A, own rows of the Jacobian",
                      entries);
  const size_t all = (size_t)(w->entries = (int)entries);
  w->row_at = integers(r, n + 1), w->column = integers(r, all);
  w->column_at = integers(r, n + 1), w->row = integers(r, all);
  w->colour = integers(r, n), w->mark = integers(r, n);
  return w->row_at && w->column && w->column_at && w->row && w->colour && w->mark
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

/* Lengths of rows come to row_at + 1, columns to column. `here` has room for both of own rows. */
static void gather(const rows *r, whole *w)
{
  const sunindextype *at = SM_INDEXPTRS_S(r->A), *column = SM_INDEXVALS_S(r->A);
  const int own = (int)r->own.rows, entries = own ? (int)at[own] : 0;
  for (int k = 0; k < entries; k++) w->here[k] = (int)column[k];
  MPI_Gatherv(w->here, entries, MPI_INT, w->column, w->count, w->at, MPI_INT, 0, r->own.comm);
  for (int i = 0; i < own; i++) w->here[i] = (int)(at[i + 1] - at[i]);
  spread(r, w, own);
  MPI_Gatherv(w->here, own, MPI_INT, r->own.rank ? NULL : w->row_at + 1, w->count, w->at,
              MPI_INT, 0, r->own.comm);
}

static void by_columns(whole *w, int n)
{
  for (int i = 0; i < n; i++) w->row_at[i + 1] += w->row_at[i];
  for (int k = 0; k < w->entries; k++) w->column_at[w->column[k] + 1]++;
  for (int j = 0; j < n; j++) w->column_at[j + 1] += w->column_at[j];
  for (int i = 0; i < n; i++)
    for (int k = w->row_at[i]; k < w->row_at[i + 1]; k++)
      w->row[w->column_at[w->column[k]]++] = i;
  for (int j = n; j > 0; j--) w->column_at[j] = w->column_at[j - 1];
  w->column_at[0] = 0;
}

/* The first colour that no earlier column has with which column j shares a row. */
static void choose(whole *w, int n)
{
  for (int j = 0; j < n; j++) {
    for (int k = w->column_at[j]; k < w->column_at[j + 1]; k++)
      for (int l = w->row_at[w->row[k]]; l < w->row_at[w->row[k] + 1]; l++)
        if (w->column[l] < j) w->mark[w->colour[w->column[l]]] = j + 1;
    int c = 0;
    while (w->mark[c] == j + 1) c++;
    w->colour[j] = c;
    if (c >= w->colours) w->colours = c + 1;
  }
}

static int distribute(const rows *r, whole *w, int *colours, sunrealtype *colour)
{
  const int own = (int)r->own.rows;
  MPI_Scatterv(w->colour, w->count, w->at, MPI_INT, w->here, own, MPI_INT, 0, r->own.comm);
  MPI_Bcast(&w->colours, 1, MPI_INT, 0, r->own.comm);
  for (int i = 0; i < own; i++) colour[i] = w->here[i];
  *colours = w->colours;
  return STEIF_OK;
}

static int run(const rows *r, whole *w, int *colours, sunrealtype *colour)
{
  const sunindextype own = r->own.rows, mine = own ? SM_INDEXPTRS_S(r->A)[own] : 0;
  w->count = integers(r, (size_t)r->own.size), w->at = integers(r, (size_t)r->own.size);
  w->here = integers(r, (size_t)(mine > own ? mine : own));
  MPI_TRY(
    steif_agree(r->ctx, r->like, w->count && w->at && w->here ? STEIF_OK : STEIF_NO_MEMORY));
  const long long entries = spread(r, w, (int)mine);
  MPI_TRY(steif_agree(r->ctx, r->like, room(r, w, entries)));
  gather(r, w);
  if (r->own.rank == 0) by_columns(w, (int)r->own.n), choose(w, (int)r->own.n);
  return distribute(r, w, colours, colour);
}

int rows_colour(const rows *r, int *colours, sunrealtype *colour)
{
  whole w = {0};
  const int code = run(r, &w, colours, colour);
  release(r->ctx, &w);
  return code;
}
