/* halo.c: entries of neighbours for products by rows; one message for a neighbour and product, both halves of a
 * pair in it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "own_rows.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The last rank that begins at or before the row and has rows. */
sunindextype rows_owner(const owners *o, sunindextype row)
{
  int low = 0, high = o->size;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (o->start[middle] <= row)
      low = middle;
    else
      high = middle;
  }
  return low;
}

static int ascending(const void *a, const void *b)
{
  const sunindextype x = *(const sunindextype *)a, y = *(const sunindextype *)b;
  return (x > y) - (x < y);
}

/* The columns of other ranks, each once. */
static int collect(rows *r)
{
  halo *h = &r->halo;
  sunindextype found = 0;
  if (!(h->column = steif_allocate(r->ctx, (size_t)r->entries + 1, sizeof *h->column)))
    return STEIF_NO_MEMORY;
  for (sunindextype k = 0; k < r->entries; k++) {
    const sunindextype c = r->column[k] - r->own.first;
    if (c < 0 || c >= r->own.rows) h->column[found++] = r->column[k];
  }
  qsort(h->column, (size_t)found, sizeof *h->column, ascending);
  for (sunindextype k = 0; k < found; k++)
    if (k == 0 || h->column[k] != h->column[k - 1]) h->column[h->count++] = h->column[k];
  return STEIF_OK;
}

/* Where each entry of the rows finds its factor. */
static void locate(rows *r)
{
  const halo *h = &r->halo;
  for (sunindextype k = 0; k < r->entries; k++) {
    const sunindextype c = r->column[k] - r->own.first;
    r->local[k] = c;
    if (c >= 0 && c < r->own.rows) continue;
    const sunindextype *place =
      bsearch(&r->column[k], h->column, (size_t)h->count, sizeof *h->column, ascending);
    r->local[k] = r->own.rows + (sunindextype)(place - h->column);
  }
}

static int lists(rows *r)
{
  halo *h = &r->halo;
  const size_t size = (size_t)r->own.size;
  int **const each[] = {&h->get, &h->get_at, &h->give, &h->give_at};
  for (int i = 0; i < 4; i++)
    if (!(*each[i] = steif_allocate(r->ctx, size + 1, sizeof(int)))) return STEIF_NO_MEMORY;
  if (!(h->request = steif_allocate(r->ctx, 2 * size, sizeof *h->request)))
    return STEIF_NO_MEMORY;
  MPI_TRY(collect(r));
  for (sunindextype k = 0; k < h->count; k++) h->get[rows_owner(&r->own, h->column[k])]++;
  for (size_t k = 0; k < size; k++) h->get_at[k + 1] = h->get_at[k] + h->get[k];
  return STEIF_OK;
}

static int room(rows *r)
{
  halo *h = &r->halo;
  const size_t give = (size_t)h->give_at[r->own.size], all = (size_t)(r->own.rows + h->count);
  h->source = steif_allocate(r->ctx, give + 1, sizeof *h->source);
  h->out = steif_allocate(r->ctx, 2 * give + 1, sizeof *h->out);
  h->in = steif_allocate(r->ctx, 2 * (size_t)h->count + 1, sizeof *h->in);
  r->one = steif_allocate(r->ctx, all + 1, sizeof *r->one);
  r->two = steif_allocate(r->ctx, all + 1, sizeof *r->two);
  return h->source && h->out && h->in && r->one && r->two ? STEIF_OK : STEIF_NO_MEMORY;
}

static int ask(rows *r)
{
  halo *h = &r->halo;
  const owners *o = &r->own;
  int *wanted = steif_allocate(r->ctx, (size_t)h->count + 1, sizeof *wanted);
  const int code = steif_agree(r->ctx, r->like, wanted ? STEIF_OK : STEIF_NO_MEMORY);
  if (code) return steif_release(r->ctx, wanted), code;
  for (sunindextype k = 0; k < h->count; k++)
    wanted[k] = (int)(h->column[k] - o->start[rows_owner(o, h->column[k])]);
  MPI_Alltoallv(wanted, h->get, h->get_at, MPI_INT, h->source, h->give, h->give_at, MPI_INT,
                o->comm);
  steif_release(r->ctx, wanted);
  return STEIF_OK;
}

int halo_open(rows *r)
{
  halo *h = &r->halo;
  MPI_TRY(steif_agree(r->ctx, r->like, lists(r)));
  MPI_Alltoall(h->get, 1, MPI_INT, h->give, 1, MPI_INT, r->own.comm);
  for (int k = 0; k < r->own.size; k++) h->give_at[k + 1] = h->give_at[k] + h->give[k];
  MPI_TRY(steif_agree(r->ctx, r->like, room(r)));
  locate(r);
  return ask(r);
}

void halo_close(rows *r)
{
  halo *h = &r->halo;
  void *const all[] = {h->column, h->get, h->get_at,  h->give, h->give_at, h->source,
                       h->out,    h->in,  h->request, r->one,  r->two};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(r->ctx, all[i]);
  *h = (halo){0};
  r->one = r->two = NULL;
}

static int post(rows *r, int width, const sunrealtype *const *x)
{
  halo *h = &r->halo;
  int used = 0;
  for (int k = 0; k < r->own.size; k++)
    if (h->get[k])
      MPI_Irecv(h->in + width * h->get_at[k], width * h->get[k], MPI_DOUBLE, k, 0, r->own.comm,
                &h->request[used++]);
  for (int k = 0; k < r->own.size; k++) {
    if (!h->give[k]) continue;
    for (int i = h->give_at[k]; i < h->give_at[k + 1]; i++)
      for (int w = 0; w < width; w++) h->out[width * i + w] = x[w][h->source[i]];
    MPI_Isend(h->out + width * h->give_at[k], width * h->give[k], MPI_DOUBLE, k, 0, r->own.comm,
              &h->request[used++]);
    r->stats.sent += (long long)sizeof(sunrealtype) * width * h->give[k];
  }
  return used;
}

void halo_exchange(rows *r, int width, const sunrealtype *const *x)
{
  halo *h = &r->halo;
  sunrealtype *const to[] = {r->one, r->two};
  const int used = post(r, width, x);
  for (int w = 0; w < width; w++)
    memcpy(to[w], x[w], (size_t)r->own.rows * sizeof(sunrealtype));
  MPI_Waitall(used, h->request, MPI_STATUSES_IGNORE);
  for (sunindextype k = 0; k < h->count; k++)
    for (int w = 0; w < width; w++) to[w][r->own.rows + k] = h->in[width * k + w];
  r->stats.exchanges++;
}

/* From the halo to the owners: their values are added, or the largest kept. */
void halo_return(rows *r, int width, bool largest, const sunrealtype *const *from,
                 sunrealtype *const *to)
{
  halo *h = &r->halo;
  int used = 0;
  for (sunindextype k = 0; k < h->count; k++)
    for (int w = 0; w < width; w++) h->in[width * k + w] = from[w][r->own.rows + k];
  for (int k = 0; k < r->own.size; k++)
    if (h->give[k])
      MPI_Irecv(h->out + width * h->give_at[k], width * h->give[k], MPI_DOUBLE, k, 0,
                r->own.comm, &h->request[used++]);
  for (int k = 0; k < r->own.size; k++)
    if (h->get[k]) {
      MPI_Isend(h->in + width * h->get_at[k], width * h->get[k], MPI_DOUBLE, k, 0, r->own.comm,
                &h->request[used++]);
      r->stats.sent += (long long)sizeof(sunrealtype) * width * h->get[k];
    }
  MPI_Waitall(used, h->request, MPI_STATUSES_IGNORE);
  for (int i = 0; i < h->give_at[r->own.size]; i++)
    for (int w = 0; w < width; w++) {
      sunrealtype *at = &to[w][h->source[i]];
      *at = !largest ? *at + h->out[width * i + w] : fmax(*at, h->out[width * i + w]);
    }
  r->stats.exchanges++;
}

void rows_product(rows *r, sunrealtype w_e, sunrealtype w_a, const sunrealtype *x,
                  sunrealtype *out)
{
  halo_exchange(r, 1, &x);
  for (sunindextype i = 0; i < r->own.rows; i++) {
    sunrealtype sum = 0;
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++)
      sum += (w_e * r->e[k] + w_a * r->a[k]) * r->one[r->local[k]];
    out[i] = sum;
  }
}
