/* impulse_slope.c: derivatives of x(0+) and of impulses, and whether they exist.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_nearby.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Unlike sizes of x(0+) and its derivative, as powers of 2, that ask for another step. */
enum { UNLIKE = 4, INDEX_MOST = 8, NOISE = 64 };

typedef struct search {
  steif_context *ctx;
  const steif_linear *system;
  const sunrealtype *x0;
  sunrealtype t;
  steif_analysis analysis; /* of pencils other than the system's */
  const steif_structure *structure;
  const steif_impulse_direction *direction;
  steif_impulse_slope *slope;
  steif_impulse base; /* of the system */
  stf_neighbours nearby;
} search;

/* ---- checks ----------------------------------------------------------------------------------- */

static int check_slope(steif_context *ctx, const char *what, SUNMatrix slope, sunindextype n)
{
  sunindextype i, j;
  sunrealtype value;
  if (!slope) return STEIF_OK;
  STEIF_CHECK(SUNMatGetID(slope) == SUNMATRIX_DENSE || SUNMatGetID(slope) == SUNMATRIX_SPARSE,
              ctx, STEIF_BAD_INPUT, "%s must be a dense matrix or a sparse one by columns",
              what);
  STEIF_CHECK(stf_matrix_order(slope) == n, ctx, STEIF_BAD_INPUT,
              "%s has %lld columns, the system has %lld unknowns", what,
              (long long)stf_matrix_order(slope), (long long)n);
  for (stf_entries at = {slope, 0, 0, 0}; stf_entries_next(&at, &i, &j, &value);)
    STEIF_CHECK(isfinite(value), ctx, STEIF_NOT_FINITE, "%s has %g in row %lld, column %lld",
                what, value, (long long)i + 1, (long long)j + 1);
  return STEIF_OK;
}

static int check(const search *w)
{
  const steif_impulse_direction *d = w->direction;
  const sunindextype n = w->base.n;
  STEIF_TRY(check_slope(w->ctx, "dE/dp", d->E, n));
  STEIF_TRY(check_slope(w->ctx, "dF/dp", d->F, n));
  for (sunindextype i = 0; d->x0 && i < n; i++)
    STEIF_CHECK(isfinite(d->x0[i]), w->ctx, STEIF_NOT_FINITE, "dx(0-)/dp has %g in row %lld",
                d->x0[i], (long long)i + 1);
  return STEIF_OK;
}

/* ---- steps of p -------------------------------------------------------------------------------- */

static sunrealtype at(SUNMatrix M, sunindextype row, sunindextype column)
{
  stf_entries look = {M, column, 0, column + 1};
  sunindextype i, j;
  sunrealtype value, sum = 0;
  while (stf_entries_next(&look, &i, &j, &value))
    if (i == row) sum += value;
  return sum;
}

/* The largest entry of each row, and behind them of each column. */
static void largest(SUNMatrix M, sunindextype n, sunrealtype *most)
{
  sunindextype i, j;
  sunrealtype value;
  for (i = 0; i < 2 * n; i++) most[i] = 0;
  for (stf_entries look = {M, 0, 0, 0}; stf_entries_next(&look, &i, &j, &value);) {
    most[i] = fmax(most[i], fabs(value));
    most[n + j] = fmax(most[n + j], fabs(value));
  }
}

/* What an entry that is 0 may be as its row and column are scaled. */
static sunrealtype room_of(const sunrealtype *most, sunindextype n, sunindextype i,
                           sunindextype j)
{
  const sunrealtype row = most[i], column = most[n + j];
  return row > 0 && column > 0 ? fmin(row, column) : fmax(row, column);
}

/* *least: the step that moves the entry that is moved most by its own size, or entries that are 0 by that of the
 * row or the column, or of the matrix. */
static int step_of(const search *w, SUNMatrix M, SUNMatrix slope, sunrealtype *least)
{
  sunindextype i, j;
  sunrealtype value, all = 0;
  const sunindextype n = w->base.n;
  *least = INFINITY;
  if (!slope) return STEIF_OK;
  sunrealtype *most = stf_allocate(w->ctx, 2 * (size_t)n, sizeof *most);
  if (!most) return STEIF_NO_MEMORY;
  largest(M, n, most);
  for (i = 0; i < n; i++) all = fmax(all, most[i]);
  for (stf_entries look = {slope, 0, 0, 0}; stf_entries_next(&look, &i, &j, &value);) {
    if (value == 0) continue;
    sunrealtype own = fabs(at(M, i, j));
    if (own == 0) own = room_of(most, n, i, j);
    if (own == 0) own = all;
    if (own > 0) *least = fmin(*least, own / fabs(value));
  }
  stf_release(w->ctx, most);
  return STEIF_OK;
}

static sunrealtype power_of_2(sunrealtype x)
{
  int e;
  if (!isfinite(x) || x <= 0) return 1;
  frexp(x, &e);
  return ldexp(1, e - 1);
}

static int natural_step(const search *w, sunrealtype *step)
{
  const steif_impulse_direction *d = w->direction;
  sunrealtype of_E, of_F;
  STEIF_TRY(step_of(w, w->system->E, d->E, &of_E));
  STEIF_TRY(step_of(w, w->system->F, d->F, &of_F));
  *step = power_of_2(fmin(of_E, of_F));
  return STEIF_OK;
}

/* ---- numbers ----------------------------------------------------------------------------------- */

static sunrealtype norm(sunindextype n, const sunrealtype *x)
{
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < n; i++) sum = hypot(sum, x[i]);
  return sum;
}

static void keep(steif_impulse_slope *s, const steif_impulse *from, sunindextype first,
                 sunrealtype unit)
{
  const sunindextype n = s->n, wide = from->n;
  for (sunindextype i = 0; i < n; i++) s->x_plus[i] = from->x_plus[first + i] / unit;
  for (int q = 0; q < s->count; q++)
    for (sunindextype i = 0; i < n; i++)
      s->c[q * n + i] = q < from->count ? from->c[q * wide + first + i] / unit : 0;
  s->estimate = from->estimate;
  s->certified = from->certified;
  s->unit = unit;
}

static void keep_nothing(steif_impulse_slope *s)
{
  for (sunindextype i = 0; i < s->n; i++) s->x_plus[i] = NAN;
  for (sunindextype i = 0; i < s->count * s->n; i++) s->c[i] = NAN;
}

/* ---- the structure ----------------------------------------------------------------------------- */

static int look_nearby(search *w, sunrealtype unit)
{
  steif_impulse_slope *s = w->slope;
  const stf_approach a = {.ctx = w->ctx,
                          .system = w->system,
                          .direction = w->direction,
                          .analysis = &w->analysis,
                          .index = s->index,
                          .finite = s->finite,
                          .unit = unit};
  stf_neighbour found;
  STEIF_TRY(stf_approach_look(&a, &found));
  w->nearby = found.verdict;
  s->index_near = found.index, s->finite_near = found.finite;
  return STEIF_OK;
}

static void sentence(const search *w, const steif_structure *twice)
{
  steif_impulse_slope *s = w->slope;
  char *text = s->message;
  const size_t room = sizeof s->message;
  const long long here = (long long)s->finite, there = (long long)s->finite_near;
  if (!s->certified)
    snprintf(text, room, "undecided: the analysis %s is not certified: %.300s",
             w->base.certified ? "of the system beside its derivative" : "of the system",
             w->base.certified ? twice->message : w->base.message);
  else if (s->exists == 0 && twice->index > s->index)
    snprintf(
      text, room,
      "p changes the index %d or the number %lld of finite eigenvalues: x(0+) and the impulses "
      "are not differentiable in p (singular perturbation; the expansion of the derivative at "
      "infinity ends with s^%d instead of s^%d)",
      s->index, here, twice->index - 1, s->index - 1);
  else if (s->exists == 0)
    snprintf(
      text, room,
      "p changes the structure: index %d and %lld finite eigenvalues here, %d and %lld nearby; "
      "x(0+) and the impulses are not differentiable in p (singular perturbation)",
      s->index, here, s->index_near, there);
  else if (s->exists < 0 && s->index_near < 0)
    snprintf(
      text, room,
      "undecided: first order keeps index %d and %lld finite eigenvalues, but on one side "
      "no pencil at a p nearby tells whether they stay: it has no certificate, or fewer "
      "of them",
      s->index, here);
  else if (s->exists < 0)
    snprintf(
      text, room,
      "undecided: the derivative is that along a curve that keeps index %d and %lld finite "
      "eigenvalues, as first order does; the straight line in this direction leads to %d and "
      "%lld: say how E and F are at values of p nearby",
      s->index, here, s->index_near, there);
  else
    snprintf(text, room, "the derivative exists: index %d and %lld finite eigenvalues stay",
             s->index, here);
}

static void decide(search *w, const steif_structure *twice)
{
  steif_impulse_slope *s = w->slope;
  const bool certified = s->certified && twice->certified && twice->index >= 0;
  const bool as_far = twice->index == s->index && twice->finite == 2 * s->finite;
  const bool known = w->direction->nearby || w->direction->straight;
  s->certified = certified;
  if (!certified || s->index < 0)
    s->exists = -1;
  else if (!as_far)
    s->exists = twice->index > s->index ? 0 : -1;
  else if (w->nearby == STF_STAYS)
    s->exists = 1;
  else
    s->exists = w->nearby == STF_GROWS && known ? 0 : -1;
  if (s->exists == 0) keep_nothing(s);
  sentence(w, twice);
}

/* E and F move, and not in first order. */
static int of_other_order(search *w)
{
  steif_impulse_slope *s = w->slope;
  const steif_structure same = {
    .index = s->index, .finite = 2 * s->finite, .certified = s->certified};
  STEIF_TRY(look_nearby(w, 1));
  decide(w, &same);
  return STEIF_OK;
}

/* E and F stay in first order: X_p = R b_p. */
static int of_data(search *w)
{
  const steif_impulse_direction *d = w->direction;
  steif_impulse own;
  sunrealtype *zero = d->x0 ? NULL : stf_allocate(w->ctx, (size_t)w->base.n, sizeof *zero);
  if (!d->x0 && !zero) return STEIF_NO_MEMORY;
  const int code = steif_impulse_find(w->ctx, w->system->E, w->system->F, d->x0 ? d->x0 : zero,
                                      w->t, d->f, d->user, NULL, w->structure, &own);
  stf_release(w->ctx, zero);
  if (code) return code;
  keep(w->slope, &own, 0, 1);
  w->slope->exists = 1;
  w->slope->certified = own.certified && w->base.certified;
  snprintf(w->slope->message, sizeof w->slope->message,
           "x(0+) and the impulses are linear in x(0-) and f");
  steif_impulse_clear(w->ctx, &own);
  return d->nearby ? of_other_order(w) : STEIF_OK;
}

/* ---- the system of twice the size ---------------------------------------------------------------- */

/* *next: a step of p that would make x(0+) and its derivative of one size. */
static int solve_twice(search *w, sunrealtype unit, sunrealtype *next)
{
  steif_impulse_slope *s = w->slope;
  const sunindextype n = s->n;
  stf_doubled d = {.ctx = w->ctx, .system = w->system, .direction = w->direction, .n = n};
  steif_structure twice = {0};
  steif_impulse both;
  const bool forced = w->system->f || w->direction->f;
  int code = stf_doubled_open(&d, w->x0, unit);
  if (!code) code = steif_structure_find(w->ctx, d.E, d.F, &w->analysis, &twice);
  if (!code) {
    code = steif_impulse_find(w->ctx, d.E, d.F, d.x0, w->t, forced ? stf_doubled_force : NULL,
                              &d, &w->analysis, &twice, &both);
    if (!code) {
      keep(s, &both, n, unit);
      s->certified = s->certified && w->base.certified;
      decide(w, &twice);
      const sunrealtype own = norm(n, both.x_plus), slope = norm(n, both.x_plus + n);
      /* A derivative that is rounding of x(0+) has no size. */
      const bool sized = own > 0 && slope > NOISE * both.estimate * own;
      *next = sized ? unit * power_of_2(own / slope) : unit;
      steif_impulse_clear(w->ctx, &both);
    }
    steif_structure_clear(w->ctx, &twice);
  }
  stf_doubled_close(&d);
  return code;
}

static int of_pencil(search *w)
{
  sunrealtype next, unit;
  STEIF_TRY(natural_step(w, &unit));
  STEIF_TRY(look_nearby(w, unit));
  STEIF_TRY(solve_twice(w, unit, &next));
  const sunrealtype ratio = next / unit;
  return w->slope->exists && (ratio > ldexp(1, UNLIKE) || ratio < ldexp(1, -UNLIKE))
           ? solve_twice(w, next, &next)
           : STEIF_OK;
}

/* ---- the whole ----------------------------------------------------------------------------------- */

static int allocate(search *w)
{
  steif_impulse_slope *s = w->slope;
  s->n = w->base.n, s->index = w->base.index, s->count = w->base.count;
  s->finite = w->structure->finite;
  s->index_near = s->index, s->finite_near = s->finite;
  s->x_plus = stf_allocate(w->ctx, (size_t)s->n, sizeof *s->x_plus);
  s->c = stf_allocate(w->ctx, (size_t)s->n * (size_t)s->count + 1, sizeof *s->c);
  return s->x_plus && s->c ? STEIF_OK : STEIF_NO_MEMORY;
}

static int find(search *w, const steif_analysis *analysis)
{
  const steif_linear *l = w->system;
  STEIF_TRY(steif_impulse_find(w->ctx, l->E, l->F, w->x0, w->t, l->f, l->user, analysis,
                               w->structure, &w->base));
  int code = check(w);
  if (!code) code = allocate(w);
  w->analysis = analysis ? *analysis : (steif_analysis){0};
  const int most = w->analysis.index_most ? w->analysis.index_most : INDEX_MOST;
  w->analysis.index_most = most > 2 * w->base.index + 1 ? most : 2 * w->base.index + 1;
  w->analysis.names = NULL;
  w->analysis.radius = 0;
  if (!code) code = w->direction->E || w->direction->F ? of_pencil(w) : of_data(w);
  steif_impulse_clear(w->ctx, &w->base);
  return code;
}

int steif_impulse_slope_find(steif_context *ctx, const steif_linear *system,
                             const sunrealtype *x0, sunrealtype t,
                             const steif_analysis *analysis, const steif_structure *structure,
                             const steif_impulse_direction *direction,
                             steif_impulse_slope *slope)
{
  STEIF_CHECK(slope, ctx, STEIF_BAD_INPUT, "no place for the derivatives: it is NULL");
  *slope = (steif_impulse_slope){0};
  STEIF_CHECK(system && x0 && direction, ctx, STEIF_BAD_INPUT,
              "a system, x(0-) and a direction are needed, one is NULL");
  steif_structure own = {0};
  if (!structure) STEIF_TRY(steif_structure_find(ctx, system->E, system->F, analysis, &own));
  search w = {.ctx = ctx,
              .system = system,
              .x0 = x0,
              .t = t,
              .structure = structure ? structure : &own,
              .direction = direction,
              .slope = slope};
  const int code = find(&w, analysis);
  if (!structure) steif_structure_clear(ctx, &own);
  if (code) steif_impulse_slope_clear(ctx, slope);
  return code;
}

void steif_impulse_slope_clear(steif_context *ctx, steif_impulse_slope *slope)
{
  if (!slope) return;
  stf_release(ctx, slope->x_plus);
  stf_release(ctx, slope->c);
  *slope = (steif_impulse_slope){0};
}
