/* mumps_solve.c: solves with factors over ranks, and refinement of our own, since that of MUMPS does not work on spread
 * solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "mumps.h"
#include <math.h>
#include <string.h>

/* Room for `count` right-hand sides. */
static int widen(mumps *s, int count)
{
  sunrealtype **const each[] = {&s->b, &s->d, &s->own};
  if (count <= s->columns) return STEIF_OK;
  for (int i = 0; i < 3; i++) {
    steif_release(s->r->ctx, *each[i]);
    *each[i] = steif_allocate(s->r->ctx, 2 * (size_t)count * ((size_t)s->r->own.rows + 1),
                              sizeof(sunrealtype));
  }
  s->columns = s->b && s->d && s->own ? count : 0;
  return s->columns ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Who gets which entries of the solution as MUMPS spreads it: once for each factorisation. */
static int find_way(mumps *s, slot *t, int count)
{
  const owners *o = &s->r->own;
  int *wanted = steif_allocate(s->r->ctx, (size_t)count + 1, sizeof *wanted);
  const int code = steif_agree(s->r->ctx, s->r->like, wanted ? STEIF_OK : STEIF_NO_MEMORY);
  if (code) return steif_release(s->r->ctx, wanted), code;
  memset(t->give, 0, (size_t)o->size * sizeof(int));
  for (int k = 0; k < count; k++) t->give[rows_owner(o, t->row_of_x[k] - 1)]++;
  MPI_Alltoall(t->give, 1, MPI_INT, t->get, 1, MPI_INT, o->comm);
  t->give_at[0] = t->get_at[0] = 0;
  for (int k = 0; k < o->size; k++) {
    t->give_at[k + 1] = t->give_at[k] + t->give[k];
    t->get_at[k + 1] = t->get_at[k] + t->get[k];
  }
  for (int k = 0; k < count; k++) {
    const int to = (int)rows_owner(o, t->row_of_x[k] - 1), at = t->give_at[to]++;
    t->order[at] = k;
    wanted[at] = (int)(t->row_of_x[k] - 1 - o->start[to]);
  }
  for (int k = o->size; k > 0; k--) t->give_at[k] = t->give_at[k - 1];
  t->give_at[0] = 0;
  MPI_Alltoallv(wanted, t->give, t->give_at, MPI_INT, t->place, t->get, t->get_at, MPI_INT,
                o->comm);
  steif_release(s->r->ctx, wanted);
  return STEIF_OK;
}

/* x += the correction, to its owners. */
static void give_back(mumps *s, slot *t, const sunrealtype *from, int count,
                      sunrealtype *const *x)
{
  const owners *o = &s->r->own;
  const int width = t->with->complex ? 2 : 1;
  MPI_Datatype number = width == 2 ? MPI_C_DOUBLE_COMPLEX : MPI_DOUBLE;
  for (int k = 0; k < count; k++)
    for (int w = 0; w < width; w++) t->out[width * k + w] = from[width * t->order[k] + w];
  MPI_Alltoallv(t->out, t->give, t->give_at, number, t->in, t->get, t->get_at, number, o->comm);
  for (sunindextype k = 0; k < o->rows; k++)
    for (int w = 0; w < width; w++) x[w][t->place[k]] += t->in[width * k + w];
}

/* x += M^{-1} d for `count` columns, d and x the halves of each. */
static int correct(mumps *s, slot *t, bool transposed, int count, sunrealtype *const *d,
                   sunrealtype *const *x)
{
  factors_answer a;
  const owners *o = &s->r->own;
  const int width = t->with->complex ? 2 : 1;
  sunrealtype *b = s->b;
  for (int k = 0; k < count; k++)
    for (sunindextype i = 0; i < o->rows; i++)
      for (int w = 0; w < width; w++) *b++ = d[width * k + w][i];
  t->with->solve(t->m, transposed, count, s->b, s->row_of_b, (int)o->rows, t->x, t->row_of_x,
                 t->room, &a);
  s->r->stats.solves += count;
  MPI_TRY(mumps_told(s, &a, "solve", t));
  if (t->get_at[o->size] < 0) MPI_TRY(find_way(s, t, t->give_at[o->size] = a.rows));
  for (int k = 0; k < count; k++)
    give_back(s, t, t->x + (size_t)(width * k) * (size_t)t->room, t->give_at[o->size],
              x + width * k);
  return STEIF_OK;
}

/* d = b - M x of one column, and what its size is measured by: d, M, x, b. */
static void column_residual(mumps *s, const slot *t, const sunrealtype *const *b,
                            sunrealtype *const *x, sunrealtype *const *d, sunrealtype most[4])
{
  rows *r = s->r;
  const int width = t->with->complex ? 2 : 1;
  halo_exchange(r, width, (const sunrealtype *const *)x);
  for (sunindextype i = 0; i < r->own.rows; i++) {
    sunrealtype re = b[0][i], im = width == 2 ? b[1][i] : 0, size = 0;
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunrealtype m = t->re * r->e[k] - r->a[k], n = t->im * r->e[k];
      const sunrealtype u = r->one[r->local[k]], v = width == 2 ? r->two[r->local[k]] : 0;
      re -= m * u - n * v, im -= m * v + n * u, size += hypot(m, n);
    }
    d[0][i] = re;
    if (width == 2) d[1][i] = im;
    most[0] = fmax(most[0], hypot(re, im)), most[1] = fmax(most[1], size);
    most[2] = fmax(most[2], hypot(x[0][i], width == 2 ? x[1][i] : 0));
    most[3] = fmax(most[3], hypot(b[0][i], width == 2 ? b[1][i] : 0));
  }
}

/* The largest of the columns, over all ranks. */
static sunrealtype residual(mumps *s, const slot *t, int count, const sunrealtype *const *b,
                            sunrealtype *const *x, sunrealtype *const *d)
{
  sunrealtype most[4 * COLUMNS] = {0}, largest = 0;
  const int width = t->with->complex ? 2 : 1;
  for (int k = 0; k < count; k++)
    column_residual(s, t, b + width * k, x + width * k, d + width * k, most + 4 * k);
  MPI_Allreduce(MPI_IN_PLACE, most, 4 * count, MPI_DOUBLE, MPI_MAX, s->r->own.comm);
  for (int k = 0; k < count; k++) {
    const sunrealtype *m = most + 4 * k, all = m[1] * m[2] + m[3];
    if (all > 0) largest = fmax(largest, m[0] / all);
  }
  return largest;
}

/* At most COLUMNS of them. Sweeps of refinement while they at least halve the residual. */
static int block(mumps *s, slot *t, bool transposed, int count, const sunrealtype *const *b,
                 sunrealtype *const *x)
{
  sunrealtype *d[2 * COLUMNS], *own[2 * COLUMNS];
  const size_t here = (size_t)s->r->own.rows;
  const int halves = count * (t->with->complex ? 2 : 1);
  int code = widen(s, count);
  if (!code) code = mumps_receive(s, t, t->room - 1, count);
  MPI_TRY(steif_agree(s->r->ctx, s->r->like, code));
  for (int k = 0; k < halves; k++) {
    d[k] = s->d + (size_t)k * here, own[k] = s->own + (size_t)k * here;
    memcpy(d[k], b[k], here * sizeof(sunrealtype));
    memset(own[k], 0, here * sizeof(sunrealtype));
  }
  MPI_TRY(correct(s, t, transposed, count, d, own));
  sunrealtype left = 0, before = INFINITY;
  for (int sweep = 0; !transposed && sweep <= s->set.refine; sweep++) {
    left = residual(s, t, count, b, own, d);
    if (sweep == s->set.refine || left <= 1e-15 || !(left < 0.5 * before)) break;
    before = left;
    MPI_TRY(correct(s, t, false, count, d, own));
  }
  s->r->stats.backward_error = fmax(s->r->stats.backward_error, left);
  for (int k = 0; k < halves; k++) memcpy(x[k], own[k], here * sizeof(sunrealtype));
  return STEIF_OK;
}

int mumps_solve(void *state, sunrealtype re, sunrealtype im, bool transposed, int count,
                const sunrealtype *const *b, sunrealtype *const *x)
{
  mumps *s = state;
  slot *t;
  MPI_TRY(mumps_serve(s, re, im, transposed ? 0 : 0.25, &t));
  const int width = t->with->complex ? 2 : 1;
  for (int k = 0; k < count; k += COLUMNS)
    MPI_TRY(block(s, t, transposed, count - k < COLUMNS ? count - k : COLUMNS, b + width * k,
                  x + width * k));
  return STEIF_OK;
}
