/* mumps.c: factors of c E - A over ranks, real and complex, a slot for each shift.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "mumps.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORKSPACE = 20, MOST_WORKSPACE = 1280 };

static int start(rows *r, const steif_spec *spec, void **state)
{
  mumps *s = *state = steif_allocate(r->ctx, 1, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  s->r = r;
  return factors_read(r, spec, &s->set);
}

/* -- memory ----------------------------------------------------------------------------------- */

static void drop(mumps *s, slot *t)
{
  if (t->m) t->with->close(t->m, s->r);
  void *const all[] = {t->value, t->x,      t->row_of_x, t->give,  t->give_at,
                       t->get,   t->get_at, t->order,    t->place, t->out,
                       t->in,    t->row,    t->column};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(s->r->ctx, all[i]);
  *t = (slot){0};
}

static void forget(mumps *s)
{
  for (int i = 0; i < 2 * SLOTS; i++) drop(s, &s->slot[i]);
  void *const all[] = {s->set.row, s->set.column, s->set.place, s->row_of_b, s->b,
                       s->d,       s->own,        s->part[0],   s->part[1],  s->part[2]};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(s->r->ctx, all[i]);
  s->set.row = s->set.column = s->set.place = s->row_of_b = NULL;
  s->set.placed = false;
  s->b = s->d = s->own = s->part[0] = s->part[1] = s->part[2] = NULL;
  s->columns = 0;
  s->regular = false;
}

static void finish(void *state)
{
  mumps *s = state;
  forget(s);
  steif_release(s->r->ctx, s);
}

static int pattern(mumps *s)
{
  const rows *r = s->r;
  const size_t here = (size_t)r->own.rows + 1, entries = (size_t)r->entries + 1;
  s->set.row = steif_allocate(r->ctx, entries, sizeof(int));
  s->set.column = steif_allocate(r->ctx, entries, sizeof(int));
  s->row_of_b = steif_allocate(r->ctx, here, sizeof(int));
  for (int k = 0; k < 3; k++) {
    s->part[k] = steif_allocate(r->ctx, here + (size_t)r->halo.count, sizeof *s->part[k]);
    if (!s->part[k]) return STEIF_NO_MEMORY;
  }
  if (r->own.rank == 0 &&
      !(s->set.place = steif_allocate(r->ctx, (size_t)r->own.n, sizeof(int))))
    return STEIF_NO_MEMORY;
  if (!s->set.row || !s->set.column || !s->row_of_b) return STEIF_NO_MEMORY;
  for (sunindextype i = 0; i < r->own.rows; i++) {
    s->row_of_b[i] = (int)(r->own.first + i + 1);
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      s->set.row[k] = s->row_of_b[i];
      s->set.column[k] = (int)(r->column[k] + 1);
    }
  }
  s->revision = r->revision;
  return STEIF_OK;
}

static int claim(mumps *s, slot *t)
{
  const rows *r = s->r;
  const size_t size = (size_t)r->own.size + 1, width = t->with->complex ? 2 : 1;
  t->value = steif_allocate(r->ctx, width * ((size_t)r->entries + 1), sizeof *t->value);
  int **const each[] = {&t->give, &t->give_at, &t->get, &t->get_at};
  for (int i = 0; i < 4; i++)
    if (!(*each[i] = steif_allocate(r->ctx, size, sizeof(int)))) return STEIF_NO_MEMORY;
  t->place = steif_allocate(r->ctx, (size_t)r->own.rows + 1, sizeof(int));
  t->in = steif_allocate(r->ctx, width * ((size_t)r->own.rows + 1), sizeof *t->in);
  t->row = steif_allocate(r->ctx, (size_t)r->own.rows + 1, sizeof *t->row);
  t->column = steif_allocate(r->ctx, (size_t)(r->own.rows + r->halo.count) + 1, sizeof *t->row);
  return t->value && t->place && t->in && t->row && t->column ? STEIF_OK : STEIF_NO_MEMORY;
}

/* -- what MUMPS answers ----------------------------------------------------------------------- */

static int short_of_memory(const mumps *s, const factors_answer *a, const char *what)
{
  const owners *o = &s->r->own;
  char limit[60] = "";
  int rank = a->here ? o->rank : o->size;
  MPI_Allreduce(MPI_IN_PLACE, &rank, 1, MPI_INT, MPI_MIN, o->comm);
  if (s->set.memory) snprintf(limit, sizeof limit, " within memory=%d MB", s->set.memory);
  return steif_fail(
    s->r->ctx, STEIF_NO_MEMORY,
    "MUMPS has not memory enough to %s%s on rank %d (it expects %d MB of the rank that takes "
    "most; INFOG(1) = %d, INFOG(2) = %d): give more ranks%s",
    what, limit, rank, a->estimate, a->code, a->detail,
    !s->set.memory   ? ""
    : a->code == -13 ? " or a smaller memory=MB, which is taken at once"
                     : " or a larger memory=MB");
}

int mumps_told(const mumps *s, const factors_answer *a, const char *what, const slot *t)
{
  steif_context *ctx = s->r->ctx;
  if (a->code == -10 || a->code == -6 || (a->code >= 0 && a->null_pivots > 0))
    return steif_fail(ctx, STEIF_SINGULAR,
                      "c E - A is singular at c = %.10g%+.10gi: MUMPS found %d pivots that are "
                      "none; is the pencil regular, or is this an eigenvalue?",
                      t->re, t->im, a->null_pivots > 0 ? a->null_pivots : 1);
  if (a->code >= 0) return STEIF_OK;
  static const int short_of[] = {-5, -7, -8, -9, -11, -13, -14, -17, -19, -20};
  bool memory = false;
  for (size_t i = 0; i < sizeof short_of / sizeof *short_of; i++)
    memory |= a->code == short_of[i];
  if (memory) return short_of_memory(s, a, what);
  if (a->code == -38)
    return steif_fail(ctx, STEIF_UNSUPPORTED,
                      "MUMPS was built without parallel ordering: install "
                      "libmumps-ptscotch-dev, or take order=metis");
  return steif_fail(ctx, STEIF_BASELINE, "MUMPS could not %s: INFOG(1) = %d, INFOG(2) = %d",
                    what, a->code, a->detail);
}

/* -- factors ---------------------------------------------------------------------------------- */

static void shifted(const rows *r, slot *t)
{
  const int width = t->with->complex ? 2 : 1;
  for (sunindextype i = 0; i < r->own.rows; i++)
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunrealtype column = t->column[r->local[k]];
      t->value[width * k] = (t->re * r->e[k] - r->a[k]) * t->row[i] * column;
      if (width == 2) t->value[width * k + 1] = t->im * r->e[k] * t->row[i] * column;
    }
}

static int analyse(mumps *s, slot *t)
{
  factors_answer a;
  if (!(t->m = t->with->open(s->r))) return STEIF_NO_MEMORY;
  MPI_TRY(steif_agree(s->r->ctx, s->r->like, claim(s, t)));
  if (s->set.order == FACTORS_METIS && !s->set.placed) {
    MPI_TRY(factors_dissect(s->r, &s->set, s->set.place));
    s->set.placed = true;
  }
  t->with->analyse(t->m, s->r, &s->set, &a);
  s->r->stats.analyses++;
  t->revision = s->r->revision;
  return mumps_told(s, &a, "analyse the pattern", t);
}

int mumps_receive(mumps *s, slot *t, int count, int columns)
{
  rows *r = s->r;
  const size_t width = t->with->complex ? 2 : 1;
  if (t->room > count && t->columns >= columns) return STEIF_OK;
  const size_t need = t->room > count ? (size_t)t->room : (size_t)count + 1;
  void *const old[] = {t->x, t->row_of_x, t->order, t->out};
  for (int i = 0; i < 4; i++) steif_release(r->ctx, old[i]);
  t->x = steif_allocate(r->ctx, width * need * (size_t)columns, sizeof *t->x);
  t->out = steif_allocate(r->ctx, width * need, sizeof *t->out);
  t->row_of_x = steif_allocate(r->ctx, need, sizeof(int));
  t->order = steif_allocate(r->ctx, need, sizeof(int));
  t->room = (int)need; /* what is asked for next time, too */
  t->columns = t->x && t->out && t->row_of_x && t->order ? columns : 0;
  t->get_at[r->own.size] = -1;
  return t->columns ? STEIF_OK : STEIF_NO_MEMORY;
}

static int factor(mumps *s, slot *t)
{
  factors_answer a;
  rows *r = s->r;
  t->get_at[r->own.size] = -1; /* the way of the solution is found at the first solve */
  t->sound = false;
  mumps_scale(s, t);
  for (int extra = WORKSPACE; extra <= MOST_WORKSPACE; extra *= 2) {
    shifted(r, t);
    t->with->factor(t->m, t->value, extra, &a);
    if (a.code != -8 && a.code != -9) break;
  }
  r->stats.setups++;
  r->stats.memory = fmax(r->stats.memory, a.memory);
  MPI_TRY(mumps_told(s, &a, "factor", t));
  const int code =
    steif_agree(r->ctx, r->like, mumps_receive(s, t, a.rows, t->columns > 0 ? t->columns : 1));
  t->ready = !code;
  return code;
}

static bool close_to(const slot *t, sunrealtype re, sunrealtype im, sunrealtype part)
{
  return hypot(t->re - re, t->im - im) <= part * hypot(re, im);
}

/* The slot for a shift: one that is near enough, else one that is free, else the one that has waited longest. */
static slot *choose(mumps *s, sunrealtype re, sunrealtype im, sunrealtype part)
{
  slot *of = s->slot + (im != 0 ? SLOTS : 0), *best = of;
  slot *near = NULL;
  for (int i = 0; i < SLOTS; i++)
    if (of[i].m && of[i].ready && close_to(&of[i], re, im, part) &&
        (!near || hypot(of[i].re - re, of[i].im - im) < hypot(near->re - re, near->im - im)))
      near = &of[i];
  if (near) return near;
  for (int i = 0; i < SLOTS; i++) {
    if (!of[i].m || !of[i].ready) return &of[i];
    if (of[i].used < best->used) best = &of[i];
  }
  return best;
}

int mumps_serve(mumps *s, sunrealtype re, sunrealtype im, sunrealtype part, slot **found)
{
  rows *r = s->r;
  if (!s->set.row || s->revision != r->revision) {
    forget(s);
    const int code = steif_agree(r->ctx, r->like, pattern(s));
    if (code) forget(s); /* on all ranks, or some would make it anew alone */
    MPI_TRY(code);
  }
  slot *t = *found = choose(s, re, im, part);
  t->used = ++s->clock;
  if (t->m && t->ready && close_to(t, re, im, part)) return STEIF_OK;
  t->re = re, t->im = im, t->ready = false;
  t->with = im != 0 ? &factors_complex : &factors_real;
  if (!t->m) {
    const int code = analyse(s, t);
    if (code) {
      drop(s, t);
      return code;
    }
  }
  return factor(s, t);
}

static int changed(void *state)
{
  mumps *s = state;
  for (int i = 0; i < 2 * SLOTS; i++) s->slot[i].ready = false;
  return STEIF_OK;
}

/* A pencil that is singular is so at every c, and MUMPS factors it where rounding hides it: the first matrix of a pattern
 * is looked at closely. */
static int setup(void *state, sunrealtype re, sunrealtype im)
{
  mumps *s = state;
  slot *t;
  MPI_TRY(mumps_serve(s, re, im, 0, &t));
  if (s->regular) return STEIF_OK;
  MPI_TRY(mumps_sound(s, re, im));
  s->regular = true;
  return STEIF_OK;
}

const back_end back_end_mumps = {
  .name = "mumps",
  .complex = true,
  .open = start,
  .changed = changed,
  .setup = setup,
  .solve = mumps_solve,
  .close = finish,
};
