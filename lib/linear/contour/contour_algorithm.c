/* contour_algorithm.c: structure, x(0+) and impulses of a sparse system by circles. With
 *   X(s) = (s E + F)^{-1} (E x(0-) + sum_j f^(j)(0+) s^{-j-1})
 * the coefficient of s^i at infinity is c_i for i >= 0 and x(0+) for i = -1: one complex solve for
 * each point. A second circle of twice the radius gives the error: too small a circle shows aliasing,
 * too large a one rounding of the size eps (R nu)^{k-1}, and the pair that agrees best is taken.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include "contour.h"
#include "prime_field.h"
#include "structural.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct answer {
  sunrealtype *x; /* x(0+), c_0, c_1, ..., n each */
} answer;

typedef struct residue {
  steif_context *ctx;
  stf_units units;
  stf_contour_circle found; /* of the structure */
  const sunrealtype *x0;    /* in these units */
  stf_sources sources;
  steif_impulse *impulse;
  stf_circle *circle;
  bool borrowed; /* it is the structure's */
  steif_pencil_stats before;
  sunrealtype R;       /* of at[0]; 2 R of at[1] */
  sunrealtype gap;     /* between at[0] and at[1] */
  sunrealtype norm[2]; /* of E and F, Frobenius */
  answer at[3];
} residue;

/* -- structure ------------------------------------------------------------------------------ */

static int scale(stf_descriptor *d)
{
  residue *w = d->state = stf_pool_array(d->pool, 1, sizeof *w);
  if (!w) return STEIF_NO_MEMORY;
  w->ctx = d->ctx;
  return stf_units_open(d->ctx, d->pool, d->E, d->F, &w->units);
}

static int structure(stf_descriptor *d)
{
  residue *w = d->state;
  w->found.field = (stf_field){.E = d->E, .F = d->F, .snap = d->options.snap};
  return stf_contour_find(d->ctx, w->units.E, w->units.F, &d->options, d->structure, &w->found);
}

/* Circles find no s where s E + F is regular: is there none, for the numbers as given? What the
 * pattern alone raises the index by is not to blame. */
static int singular(stf_descriptor *d)
{
  residue *w = d->state;
  steif_structure *s = d->structure;
  bool exactly = s->degree < 0;
  if (s->degree >= 0) {
    s->equations_count = s->unknowns_count = 0;
    STEIF_TRY(stf_field_singular(d->ctx, &w->found.field, &exactly));
    if (exactly) STEIF_TRY(stf_structural_dependent(d->ctx, w->units.E, w->units.F, s));
    snprintf(s->message, sizeof s->message,
             exactly
               ? "singular pencil: det(s E + F) = 0 for all s exactly (reciprocal condition "
                 "%.1e at best) although its pattern is not; look for an equation that "
                 "follows from others"
               : "singular to rounding: s E + F is so at every s tried (reciprocal "
                 "condition %.1e at best), though det(s E + F) is not 0 for all s exactly as "
                 "given; undecided: scale the equations, give them more exactly, or use a "
                 "dense algorithm",
             s->rcond);
  }
  s->certified = exactly;
  return STEIF_OK;
}

/* -- one circle ----------------------------------------------------------------------------- */

static int draw(residue *w, sunrealtype R, answer *out)
{
  const stf_circle *c = w->circle;
  const sunindextype n = c->scaled.n;
  const size_t size = (size_t)n * (size_t)(w->impulse->count + 1);
  if (!out->x && !(out->x = stf_allocate(w->ctx, size, sizeof *out->x))) return STEIF_NO_MEMORY;
  const int terms = w->sources.f ? w->impulse->index : 0;
  const stf_polynomial g = {terms, w->sources.Ex0, w->sources.f, c->scaled.row};
  STEIF_TRY(stf_circle_run(w->circle, R, &g));
  const int *unknown = c->sequence->unknown;
  for (int k = 0; k <= w->impulse->count; k++) {
    const sunrealtype power = pow(R, 1 - k), *sum = c->sum + k * n;
    for (sunindextype i = 0; i < n; i++)
      out->x[k * n + unknown[i]] = power * c->scaled.column[unknown[i]] * sum[i];
  }
  return STEIF_OK;
}

static sunrealtype distance(sunindextype n, const sunrealtype *a, const sunrealtype *b)
{
  sunrealtype square = 0;
  for (sunindextype i = 0; i < n; i++) square += (a[i] - b[i]) * (a[i] - b[i]);
  return isfinite(square) ? sqrt(square) : INFINITY;
}

/* Of x(0+). */
static sunrealtype difference(const residue *w, const answer *a, const answer *b)
{
  const sunindextype n = w->impulse->n;
  const sunrealtype off = distance(n, a->x, b->x);
  if (off == 0) return 0;
  const sunrealtype by =
    stf_sources_measure(&w->sources, stf_sources_length(n, a->x), w->norm[0], w->norm[1]);
  return by > 0 ? off / by : INFINITY;
}

/* Of the coefficients c_i, the largest, each relative to itself or, where that is larger, to a
 * STF_IMPULSE_PART of what c_{i-1}, for c_0 the jump, could make of it: |E| / |F| times as much. */
static sunrealtype impulses_apart(const residue *w, const answer *a, const answer *b)
{
  const sunindextype n = w->impulse->n;
  const sunrealtype E = w->norm[0], F = w->norm[1];
  sunrealtype most = 0, before = stf_sources_length(n, a->x);
  if (E > 0) before += stf_sources_length(n, w->sources.Ex0) / E;
  for (int k = 1; k <= w->impulse->count; k++) {
    const sunrealtype size = stf_sources_length(n, a->x + k * n),
                      off = distance(n, a->x + k * n, b->x + k * n);
    const sunrealtype could = before * E / F;
    if (off > 0) most = fmax(most, off / fmax(size, STF_IMPULSE_PART * could));
    before = fmax(size, could);
  }
  return isfinite(most) ? most : INFINITY;
}

/* Two neighbours: x(0+), and the impulses where they are far apart. */
static sunrealtype disagreement(const residue *w, const answer *a, const answer *b)
{
  const sunrealtype x = difference(w, a, b), c = impulses_apart(w, a, b);
  return c > STF_IMPULSES_AGREE ? fmax(x, c) : x;
}

static void swap(answer *a, answer *b)
{
  const answer keep = *a;
  *a = *b;
  *b = keep;
}

/* The circles of the structure serve again if they are of these matrices. */
static int open_circle(stf_descriptor *d, residue *w)
{
  stf_circle *kept = stf_circle_kept(d->structure);
  const int room = d->impulse->count + 1;
  w->borrowed = stf_circle_adopt(kept, w->units.E, w->units.F, &d->options, room);
  if (w->borrowed)
    w->circle = kept;
  else
    STEIF_TRY(stf_circle_open(d->ctx, w->units.E, w->units.F, &d->options, room, &w->circle));
  w->before = *steif_pencil_statistics(w->circle->scaled.pencil);
  return STEIF_OK;
}

static int open_start(stf_descriptor *d, residue *w)
{
  const steif_structure *s = d->structure;
  const int index = s->index < 0 ? s->index_least : s->index;
  STEIF_CHECK(index <= STF_INDEX_MOST, d->ctx, STEIF_UNSUPPORTED,
              "index %d: circles give impulses up to index %d", index, (int)STF_INDEX_MOST);
  w->impulse = d->impulse;
  w->x0 = d->x0;
  w->sources = d->sources;
  STEIF_TRY(stf_units_enter(d->pool, &w->units, &w->x0, &w->sources));
  STEIF_TRY(stf_impulse_allocate(d->ctx, w->sources.n, index, w->impulse));
  w->impulse->method = "contour";
  w->norm[0] = stf_sources_frobenius(w->units.E);
  w->norm[1] = stf_sources_frobenius(w->units.F);
  w->R = stf_radius(w->units.E, w->units.F, &d->options, s);
  if (!(d->options.radius > 0) && w->norm[0] > 0)
    w->R = fmax(w->R, STF_LEAST_RADIUS * w->norm[1] / w->norm[0]);
  return open_circle(d, w);
}

/* The structure is certified by circles already: without x(0-) nothing is solved. */
static int solve(stf_descriptor *d, int way)
{
  residue *w = d->state;
  if (!d->x0) return STEIF_OK;
  if (!way) STEIF_TRY(open_start(d, w));
  return draw(w, way ? 2 * w->R : w->R, &w->at[way]);
}

/* -- comparison ----------------------------------------------------------------------------- */

/* at[0] and at[1] belong to R and 2 R and differ by `gap`. Go on in factors of two, down or up, while
 * neighbours agree better. */
static int walk(residue *w, bool up)
{
  answer *at = w->at;
  for (int step = 0; step < (up ? STF_RADIUS_UP : STF_RADIUS_DOWN); step++) {
    STEIF_TRY(draw(w, up ? 4 * w->R : w->R / 2, &at[2]));
    const sunrealtype next =
      up ? disagreement(w, &at[1], &at[2]) : disagreement(w, &at[2], &at[0]);
    if (!(next < w->gap)) break;
    w->gap = next;
    w->R *= up ? 2 : 0.5;
    if (up) {
      swap(&at[0], &at[1]);
      swap(&at[1], &at[2]);
    } else {
      swap(&at[1], &at[0]);
      swap(&at[0], &at[2]);
    }
    if (next <= STF_CIRCLES_AGREE) break;
  }
  return STEIF_OK;
}

static int pair(residue *w, sunrealtype R)
{
  w->R = R;
  STEIF_TRY(draw(w, R, &w->at[0]));
  STEIF_TRY(draw(w, 2 * R, &w->at[1]));
  w->gap = disagreement(w, &w->at[0], &w->at[1]);
  return STEIF_OK;
}

/* Rounding of c_i is that of x(0+) over R^{i+1}: circles that are small because eigenvalues are small
 * or 0 lose the impulses. Any larger one serves: the best pair on the way up. */
static int widen(residue *w)
{
  const sunrealtype from = w->R;
  sunrealtype best = from, least = w->gap, R = from;
  for (int k = 0; k < STF_RADII_MORE && least > STF_IMPULSES_AGREE; k++) {
    R *= STF_RADIUS_STRIDE;
    STEIF_TRY(pair(w, R));
    if (!(w->gap < least)) continue;
    best = R;
    least = w->gap;
  }
  return w->R == best ? STEIF_OK : pair(w, best);
}

static int agree(residue *w, bool fixed)
{
  const sunrealtype first = w->R;
  w->gap = disagreement(w, &w->at[0], &w->at[1]);
  if (w->gap > STF_CIRCLES_AGREE && !w->circle->careful) { /* refined solves may agree */
    w->circle->careful = true;
    STEIF_TRY(pair(w, w->R));
  }
  if (fixed || w->gap <= STF_CIRCLES_AGREE) return STEIF_OK;
  if (w->gap > STF_IMPULSES_AGREE) STEIF_TRY(widen(w));
  STEIF_TRY(walk(w, false));
  return w->R < first || w->gap <= STF_CIRCLES_AGREE ? STEIF_OK : walk(w, true);
}

static steif_pencil_stats spent(const steif_pencil_stats *before, const steif_pencil_stats *now)
{
  return (steif_pencil_stats){.analyses = now->analyses - before->analyses,
                              .factors = now->factors - before->factors,
                              .refactors = now->refactors - before->refactors,
                              .fallbacks = now->fallbacks - before->fallbacks,
                              .solves = now->solves - before->solves,
                              .fill = now->fill};
}

static int compare(stf_descriptor *d)
{
  residue *w = d->state;
  steif_impulse *out = w->impulse;
  if (!d->x0) return STEIF_OK;
  STEIF_TRY(agree(w, d->options.radius > 0));
  out->estimate = difference(w, &w->at[0], &w->at[1]);
  const size_t n = (size_t)out->n, count = (size_t)out->count;
  memcpy(out->x_plus, w->at[0].x, n * sizeof *out->x_plus);
  if (count) memcpy(out->c, w->at[0].x + n, n * count * sizeof *out->c);
  for (size_t i = 0; i < n; i++) d->apart[i] = fabs(w->at[0].x[i] - w->at[1].x[i]);
  stf_units_leave(&w->units, out, d->apart);
  out->radius = w->R;
  out->resolution = d->structure->resolution;
  out->cost = spent(&w->before, steif_pencil_statistics(w->circle->scaled.pencil));
  return STEIF_OK;
}

/* -- certificate and sentence --------------------------------------------------------------- */

/* Rows whose diagonals are the negative sums of the others but for rounding. */
static int count_rounded(stf_descriptor *d, stf_contour_circle *c)
{
  const sunindextype n = d->structure->n;
  unsigned char *row = stf_pool_array(d->pool, 2 * (size_t)n, 1);
  if (!row) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_field_rounded_rows(d->ctx, d->E, row));
  STEIF_TRY(stf_field_rounded_rows(d->ctx, d->F, row + n));
  for (sunindextype i = n - 1; i >= 0; i--) {
    if (!row[i] && !row[n + i]) continue;
    c->rounded++;
    c->rounded_row = i;
  }
  return STEIF_OK;
}

/* Is it their rounding that brings eigenvalues from infinity to beyond the circle? */
static int find_rounded(stf_descriptor *d, stf_contour_circle *c)
{
  const steif_structure *s = d->structure;
  sunindextype weyr[STF_INDEX_MOST + 1], finite = s->n;
  stf_field snapped;
  int count;
  c->rounded = 0;
  if (d->structure_known || s->exact < 0) return STEIF_OK;
  STEIF_TRY(count_rounded(d, c));
  if (d->options.snap || !c->rounded || s->exact <= s->finite) return STEIF_OK;
  STEIF_TRY(stf_field_open(d->ctx, d->E, d->F, true, &snapped));
  STEIF_TRY(stf_field_chains(d->ctx, &snapped, STF_INDEX_MOST, weyr, &count));
  for (int k = 0; k < count; k++) finite -= weyr[k];
  if (count < 0 || finite != s->finite) c->rounded = 0;
  return STEIF_OK;
}

static int certify(stf_descriptor *d)
{
  residue *w = d->state;
  steif_structure *s = d->structure;
  if (!d->structure_known) s->certified = w->found.complete && s->index >= 0;
  STEIF_TRY(find_rounded(d, &w->found));
  if (d->x0) d->impulse->certified = s->certified && w->gap <= STF_CIRCLES_CERTIFY;
  return STEIF_OK;
}

static int say(stf_descriptor *d)
{
  const residue *w = d->state;
  if (d->x0)
    stf_contour_say_start(d->structure, w->gap, d->impulse);
  else
    stf_contour_say(&w->found, d->structure);
  return STEIF_OK;
}

static void close(stf_descriptor *d)
{
  residue *w = d->state;
  if (!w) return;
  for (int k = 0; k < 3; k++) stf_release(d->ctx, w->at[k].x);
  if (!w->borrowed) stf_circle_close(d->ctx, &w->circle);
}

const stf_algorithm stf_contour_algorithm = {.scale = scale,
                                             .structure = structure,
                                             .singular = singular,
                                             .solve = solve,
                                             .compare = compare,
                                             .certify = certify,
                                             .say = say,
                                             .close = close};
