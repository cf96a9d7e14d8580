/* mumps.c: factors of c E - A over ranks, real and complex, a slot for each shift; refinement of our own, since that
 * of MUMPS does not work on spread solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "factors.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 4, WORKSPACE = 20, MOST_WORKSPACE = 160 };

typedef struct slot {
  const factors_calls *with;
  void *m;
  sunrealtype re, im;
  bool ready;    /* for the values at hand */
  long revision; /* of the pattern that was analysed */
  long used;     /* when, for the choice of one to make anew */
  sunrealtype *value, *x;
  int *row_of_x, room;
  int *give, *give_at, *get, *get_at; /* how x returns to its owners ... */
  int *order, *place; /* ... own place of x sent as k-th; own row of the k-th that comes */
  sunrealtype *out, *in;
} slot;

typedef struct mumps {
  rows *r;
  factors_setting set;
  long revision, clock;
  slot slot[2 * SLOTS]; /* real ones, then complex ones */
  int *row_of_b;
  sunrealtype *b, *d, *xr, *xi; /* right-hand side as MUMPS reads it, residuals */
} mumps;

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
  void *const all[] = {t->value,  t->x,     t->row_of_x, t->give, t->give_at, t->get,
                       t->get_at, t->order, t->place,    t->out,  t->in};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(s->r->ctx, all[i]);
  *t = (slot){0};
}

static void forget(mumps *s)
{
  for (int i = 0; i < 2 * SLOTS; i++) drop(s, &s->slot[i]);
  void *const all[] = {s->set.row, s->set.column, s->set.place, s->row_of_b,
                       s->b,       s->d,          s->xr,        s->xi};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(s->r->ctx, all[i]);
  s->set.row = s->set.column = s->set.place = s->row_of_b = NULL;
  s->set.placed = false;
  s->b = s->d = s->xr = s->xi = NULL;
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
  if (r->own.rank == 0 &&
      !(s->set.place = steif_allocate(r->ctx, (size_t)r->own.n, sizeof(int))))
    return STEIF_NO_MEMORY;
  sunrealtype **const each[] = {&s->b, &s->d, &s->xr, &s->xi};
  for (int i = 0; i < 4; i++)
    if (!(*each[i] = steif_allocate(r->ctx, 2 * here, sizeof(sunrealtype))))
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
  return t->value && t->place && t->in ? STEIF_OK : STEIF_NO_MEMORY;
}

/* -- what MUMPS answers ----------------------------------------------------------------------- */

static int told(const mumps *s, const factors_answer *a, const char *what, const slot *t)
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
  if (memory)
    return steif_fail(
      ctx, STEIF_NO_MEMORY,
      "MUMPS has not memory enough to %s (INFOG(1) = %d, INFOG(2) = %d)%s: give "
      "more ranks or a larger memory=MB",
      what, a->code, a->detail, s->set.memory ? " within memory=" : "");
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
  for (sunindextype k = 0; k < r->entries; k++) {
    t->value[width * k] = t->re * r->e[k] - r->a[k];
    if (width == 2) t->value[width * k + 1] = t->im * r->e[k];
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
  return told(s, &a, "analyse the pattern", t);
}

/* Room of the solution; it may grow with the pivots. */
static int receive(mumps *s, slot *t, int count)
{
  rows *r = s->r;
  const size_t width = t->with->complex ? 2 : 1, need = (size_t)count + 1;
  if (t->room > count) return STEIF_OK;
  void *const old[] = {t->x, t->row_of_x, t->order, t->out};
  for (int i = 0; i < 4; i++) steif_release(r->ctx, old[i]);
  t->x = steif_allocate(r->ctx, width * need, sizeof *t->x);
  t->out = steif_allocate(r->ctx, width * need, sizeof *t->out);
  t->row_of_x = steif_allocate(r->ctx, need, sizeof(int));
  t->order = steif_allocate(r->ctx, need, sizeof(int));
  t->room = t->x && t->out && t->row_of_x && t->order ? (int)need : 0;
  return t->room ? STEIF_OK : STEIF_NO_MEMORY;
}

static int factor(mumps *s, slot *t)
{
  factors_answer a;
  rows *r = s->r;
  t->get_at[r->own.size] = -1; /* the way of the solution is found at the first solve */
  for (int extra = WORKSPACE; extra <= MOST_WORKSPACE; extra *= 2) {
    shifted(r, t);
    t->with->factor(t->m, t->value, extra, &a);
    if (a.code != -8 && a.code != -9) break;
  }
  r->stats.setups++;
  r->stats.memory = fmax(r->stats.memory, a.memory);
  MPI_TRY(told(s, &a, "factor", t));
  const int code = steif_agree(r->ctx, r->like, receive(s, t, a.rows));
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

/* Factors for the shift, or of one that differs by at most `part` of it. */
static int serve(mumps *s, sunrealtype re, sunrealtype im, sunrealtype part, slot **found)
{
  rows *r = s->r;
  if (!s->set.row || s->revision != r->revision) {
    forget(s);
    MPI_TRY(steif_agree(r->ctx, r->like, pattern(s)));
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

static int setup(void *state, sunrealtype re, sunrealtype im)
{
  slot *t;
  return serve(state, re, im, 0, &t);
}

/* -- solves ----------------------------------------------------------------------------------- */

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
static void give_back(mumps *s, slot *t, int count, sunrealtype *const *x)
{
  const owners *o = &s->r->own;
  const int width = t->with->complex ? 2 : 1;
  MPI_Datatype number = width == 2 ? MPI_C_DOUBLE_COMPLEX : MPI_DOUBLE;
  for (int k = 0; k < count; k++)
    for (int w = 0; w < width; w++) t->out[width * k + w] = t->x[width * t->order[k] + w];
  MPI_Alltoallv(t->out, t->give, t->give_at, number, t->in, t->get, t->get_at, number, o->comm);
  for (sunindextype k = 0; k < o->rows; k++)
    for (int w = 0; w < width; w++) x[w][t->place[k]] += t->in[width * k + w];
}

/* x += M^{-1} d, d the halves of the right-hand side. */
static int correct(mumps *s, slot *t, bool transposed, const sunrealtype *const *d,
                   sunrealtype *const *x)
{
  factors_answer a;
  const owners *o = &s->r->own;
  const int width = t->with->complex ? 2 : 1;
  for (sunindextype i = 0; i < o->rows; i++)
    for (int w = 0; w < width; w++) s->b[width * i + w] = d[w][i];
  t->with->solve(t->m, transposed, s->b, s->row_of_b, (int)o->rows, t->x, t->row_of_x, t->room,
                 &a);
  s->r->stats.solves++;
  MPI_TRY(told(s, &a, "solve", t));
  if (t->get_at[o->size] < 0) MPI_TRY(find_way(s, t, t->give_at[o->size] = a.rows));
  give_back(s, t, t->give_at[o->size], x);
  return STEIF_OK;
}

/* d = b - M x, and its size by that of M, x and b. */
static sunrealtype residual(mumps *s, const slot *t, const sunrealtype *const *b,
                            sunrealtype *const *x, sunrealtype *const *d)
{
  rows *r = s->r;
  const int width = t->with->complex ? 2 : 1;
  sunrealtype most[4] = {0}; /* d, M, x, b */
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
  MPI_Allreduce(MPI_IN_PLACE, most, 4, MPI_DOUBLE, MPI_MAX, r->own.comm);
  const sunrealtype all = most[1] * most[2] + most[3];
  return all > 0 ? most[0] / all : 0;
}

/* Sweeps of refinement while they at least halve the residual. */
static int solve(void *state, sunrealtype re, sunrealtype im, bool transposed,
                 const sunrealtype *const *b, sunrealtype *const *x)
{
  mumps *s = state;
  slot *t;
  const size_t bytes = (size_t)s->r->own.rows * sizeof(sunrealtype);
  MPI_TRY(serve(s, re, im, transposed ? 0 : 0.25, &t));
  sunrealtype *d[2] = {s->d, s->d + s->r->own.rows}, *own[2] = {s->xr, s->xi};
  for (int w = 0; w < 1 + t->with->complex; w++) memset(own[w], 0, bytes);
  MPI_TRY(correct(s, t, transposed, b, own));
  sunrealtype left = 0, before = INFINITY;
  for (int sweep = 0; !transposed && sweep <= s->set.refine; sweep++) {
    left = residual(s, t, b, own, d);
    if (sweep == s->set.refine || left <= 1e-15 || !(left < 0.5 * before)) break;
    before = left;
    MPI_TRY(correct(s, t, false, (const sunrealtype *const *)d, own));
  }
  s->r->stats.backward_error = fmax(s->r->stats.backward_error, left);
  for (int w = 0; w < 1 + t->with->complex; w++) memcpy(x[w], own[w], bytes);
  return STEIF_OK;
}

const back_end back_end_mumps = {
  .name = "mumps",
  .complex = true,
  .open = start,
  .changed = changed,
  .setup = setup,
  .solve = solve,
  .close = finish,
};
