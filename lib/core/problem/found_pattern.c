/* found_pattern.c: the pattern of a Jacobian, from which values of f or F each unknown moves, at several points:
 * one of them may be a zero of an entry, or lie on one side of a switch.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

typedef struct found {
  steif_pattern pattern; /* first: what users see */
  sunindextype *column, *row;
} found;

typedef struct search {
  steif_context *ctx;
  const steif_problem *problem;
  int form;
  size_t n, room;
  sunindextype *row; /* entries so far, by columns */
  size_t count;
  N_Vector y, yp, base, moved, out;
  N_Vector y0, yp0; /* the start */
} search;

/* Points: how far from the start, in parts of each component, and which way at random. */
static const struct {
  sunrealtype part;
  unsigned seed;
  bool outwards; /* away from 0 */
} points[] = {{1e-2, 271828, true}, {1e-1, 314159, false}, {0.5, 141421, false}};
enum { POINTS = sizeof points / sizeof *points };

static int evaluate(const search *s, N_Vector y, N_Vector yp, N_Vector out)
{
  const steif_problem *p = s->problem;
  const int returned =
    s->form == STEIF_IMPLICIT ? p->F(p->t0, y, yp, out, p->user) : p->f(p->t0, y, out, p->user);
  STEIF_CHECK(returned >= 0, s->ctx, STEIF_CALLBACK,
              "%s of problem '%s' returned %d near the start, t = %g",
              s->form == STEIF_IMPLICIT ? "F" : "f", p->name, returned, p->t0);
  return returned > 0 ? STEIF_RETRY : STEIF_OK;
}

/* Entry `row` of the column that begins at `from`; rows ascend. */
static int mark(search *s, size_t from, sunindextype row)
{
  size_t at = s->count;
  while (at > from && s->row[at - 1] > row) at--;
  if (at > from && s->row[at - 1] == row) return STEIF_OK;
  if (s->count == s->room) {
    sunindextype *more = stf_allocate(s->ctx, 2 * s->room, sizeof *more);
    if (!more) return STEIF_NO_MEMORY;
    memcpy(more, s->row, s->count * sizeof *more);
    stf_release(s->ctx, s->row);
    s->row = more, s->room *= 2;
  }
  memmove(s->row + at + 1, s->row + at, (s->count - at) * sizeof *s->row);
  s->row[at] = row, s->count++;
  return STEIF_OK;
}

/* Rows that change when unknown j of `point` moves, `other` being the second argument of F. A value that
 * cannot be had says nothing. */
static int column(search *s, size_t j, size_t from, bool slope)
{
  const sunrealtype scale = s->problem->rtol_scale > 0 ? s->problem->rtol_scale : 1;
  const sunrealtype *b = NV_DATA_S(s->base), *d = NV_DATA_S(s->out);
  N_Vector point = slope ? s->yp : s->y;
  sunrealtype *m = NV_DATA_S(s->moved);
  memcpy(m, NV_DATA_S(point), s->n * sizeof *m);
  m[j] += 1e-3 * fmax(fabs(m[j]), scale);
  const int code =
    slope ? evaluate(s, s->y, s->moved, s->out) : evaluate(s, s->moved, s->yp, s->out);
  if (code) return code < 0 ? code : STEIF_OK;
  for (size_t i = 0; i < s->n; i++)
    if (!(d[i] == b[i])) STEIF_TRY(mark(s, from, (sunindextype)i));
  return STEIF_OK;
}

/* Away from zeros and symmetries of the start, or nearer where f has no value. > 0: it has none. */
static int leave_start(search *s, int k)
{
  const sunrealtype scale = s->problem->rtol_scale > 0 ? s->problem->rtol_scale : 1;
  const sunrealtype *y0 = NV_DATA_S(s->y0), *yp0 = NV_DATA_S(s->yp0);
  sunrealtype *y = NV_DATA_S(s->y), *yp = NV_DATA_S(s->yp);
  int code = STEIF_RETRY;
  for (sunrealtype part = points[k].part; code > 0 && part > 1e-9; part /= 100) {
    unsigned state = points[k].seed;
    for (size_t j = 0; j < s->n; j++) {
      state = state * 1103515245u + 12345u;
      const sunrealtype by = part * (0.5 + (sunrealtype)(state >> 16 & 1023) / 2048);
      const bool down = points[k].outwards ? y0[j] < 0 : (state >> 27 & 1) != 0;
      y[j] = y0[j] + (down ? -by : by) * fmax(fabs(y0[j]), scale);
      yp[j] = yp0[j] + (s->form == STEIF_IMPLICIT ? by * (fabs(yp0[j]) + scale) : 0);
    }
    code = evaluate(s, s->y, s->yp, s->base);
    if (!code && stf_not_finite(s->base) >= 0) code = STEIF_RETRY;
  }
  return code;
}

/* The columns of all points so far: *start, s->row. Those of one more join them. */
static int look(search *s, sunindextype *start, const sunindextype *old)
{
  s->count = 0;
  s->room = 8 * s->n + 8 + (old ? (size_t)start[s->n] : 0);
  s->row = stf_allocate(s->ctx, s->room, sizeof *s->row);
  if (!s->row) return STEIF_NO_MEMORY;
  sunindextype first = 0;
  for (size_t j = 0; j < s->n; j++) {
    const size_t from = s->count;
    const sunindextype last = start[j + 1];
    STEIF_TRY(mark(s, from, (sunindextype)j));
    for (sunindextype k = first; old && k < last; k++) STEIF_TRY(mark(s, from, old[k]));
    STEIF_TRY(column(s, j, from, false));
    if (s->form == STEIF_IMPLICIT) STEIF_TRY(column(s, j, from, true));
    first = last;
    start[j] = (sunindextype)from;
  }
  start[s->n] = (sunindextype)s->count;
  return STEIF_OK;
}

static int fill(search *s, sunindextype *start)
{
  int seen = 0;
  for (int k = 0; k < POINTS; k++) {
    int code = leave_start(s, k);
    if (code < 0) return code;
    if (code) continue;
    sunindextype *old = seen++ ? s->row : NULL;
    code = look(s, start, old);
    stf_release(s->ctx, old);
    STEIF_TRY(code);
  }
  STEIF_CHECK(seen > 0, s->ctx, STEIF_NOT_FINITE,
              "'%s' has no finite values near its start, t = %g: give the pattern by hand",
              s->problem->name, s->problem->t0);
  return STEIF_OK;
}

static int open(search *s, stf_pool *pool)
{
  stf_space space;
  bool known;
  N_Vector like = N_VNew_Serial(s->problem->n, steif_sundials(s->ctx));
  STEIF_CHECK(like, s->ctx, STEIF_NO_MEMORY, "no memory for a vector of %zu components", s->n);
  N_Vector *const claimed[] = {&s->y, &s->yp, &s->base, &s->moved, &s->out, &s->y0, &s->yp0};
  for (int i = 0; i < 7; i++) *claimed[i] = stf_pool_vector(pool, like);
  N_VDestroy(like);
  for (int i = 0; i < 7; i++)
    if (!*claimed[i]) return STEIF_NO_MEMORY;
  stf_space_open(&space, s->y0);
  return stf_system_start(s->ctx, s->problem, s->form, &space, s->y0, s->yp0, &known);
}

int steif_pattern_find(steif_context *ctx, const steif_problem *problem,
                       steif_pattern **pattern)
{
  STF_NAMED(problem);
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_CHECK(pattern, ctx, STEIF_BAD_INPUT, "a place for the pattern is needed, got NULL");
  *pattern = NULL;
  STEIF_CHECK(problem, ctx, STEIF_BAD_INPUT, "a problem is needed, got NULL");
  steif_problem bare = *problem; /* sparse storage would ask for the pattern */
  bare.storage = STEIF_DENSE;
  const int form = steif_problem_form(ctx, &bare);
  if (!form) return steif_status(ctx);
  STEIF_CHECK(form != STEIF_DESCRIPTOR, ctx, STEIF_UNSUPPORTED,
              "problem '%s' of form descriptor has the pattern of its own matrices",
              problem->name);
  search s = {.ctx = ctx, .problem = &bare, .form = form, .n = (size_t)problem->n};
  stf_pool *pool = stf_pool_new(ctx);
  found *f = stf_allocate(ctx, 1, sizeof *f);
  sunindextype *start = stf_allocate(ctx, s.n + 1, sizeof *start);
  int code = pool && f && start ? open(&s, pool) : STEIF_NO_MEMORY;
  if (!code) code = fill(&s, start);
  stf_pool_free(&pool);
  if (code) {
    stf_release(ctx, f), stf_release(ctx, start), stf_release(ctx, s.row);
    return code;
  }
  *f = (found){{start, s.row}, start, s.row};
  *pattern = &f->pattern;
  return STEIF_OK;
}

void steif_pattern_free(steif_context *ctx, steif_pattern **pattern)
{
  if (!ctx || !pattern || !*pattern) return;
  found *f = (found *)(void *)*pattern;
  stf_release(ctx, f->column), stf_release(ctx, f->row), stf_release(ctx, f);
  *pattern = NULL;
}
