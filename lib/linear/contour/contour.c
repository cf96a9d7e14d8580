/* contour.c: structure of a sparse pencil from circles |s| = R. The Laurent coefficients of
 * (s E + F)^{-1} v, v random, end with the index; Jensen's formula counts the finite eigenvalues
 * inside,
 *   n_f = (mean log |det(s E + F)| over |s| = bR - the same over |s| = aR) / log(b / a)
 * where none lies between. The circle grows until the count is the structural degree: then no
 * finite eigenvalue is outside, which no other check can tell from an algebraic equation.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "contour.h"
#include "circle.h"
#include "random.h"
#include "sentences.h"
#include "structural.h"
#include <math.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { CIRCLES = 32, UPWARDS = 24, MOMENTS = 65 };

/* What one circle showed. */
typedef struct sample {
  sunrealtype radius, log_det, gap, rcond; /* gap 0: no moments */
  sunrealtype above, count; /* with the larger circle of radius `above`; NaN: none */
  int index, last;          /* by the largest gap, by the last that is wide enough */
  bool singular;
} sample;

typedef struct search {
  steif_context *ctx;
  steif_analysis analysis;
  steif_structure *structure;
  stf_circle *circle;
  sunrealtype *v, size; /* random, and its norm */
  sunindextype pattern; /* index expected: structural, or by ranks */
  sunindextype target;  /* eigenvalues expected: structural degree, or by ranks */
  const stf_field *field;
  int ranked; /* index by ranks; -1: not computed */
  sunindextype weyr[STF_INDEX_MOST + 2];
  sunrealtype start, end;
  int circles;
  sample of[CIRCLES];
} search;

/* m_i = ||R^i Phi_i v||, i = -1 .. most; the index is one more than the last i with m_i > 0. The
 * root of sum m_i^2 is the mean size of (s E + F)^{-1} v. */
static void judge(search *w, sample *now)
{
  const stf_circle *c = w->circle;
  sunrealtype m[MOMENTS + 1], largest = 0, tail = 0, square = 0;
  for (int k = 0; k < c->count; k++) {
    m[k] = sqrt(c->square[k]);
    largest = fmax(largest, m[k]);
    square += c->square[k];
  }
  const sunrealtype norm = c->radius * c->scaled.norm[0] + c->scaled.norm[1];
  now->rcond = w->size / (norm * sqrt((sunrealtype)c->scaled.n * square));
  now->index = now->last = -1;
  for (int k = c->count - 1; k > 0; k--) {
    tail = fmax(tail, m[k]);
    const sunrealtype gap = m[k - 1] / fmax(tail, STF_EPS * largest);
    if (gap >= STF_GAP && now->last < 0) now->last = k - 1;
    if (gap > now->gap) now->gap = gap, now->index = k - 1;
  }
}

/* One circle, with moments or for its determinant; a singular matrix at one of its points is
 * noted and no failure. */
static int draw(search *w, sunrealtype radius, bool moments)
{
  sample *now = &w->of[w->circles++];
  *now = (sample){.radius = radius, .count = NAN};
  const stf_polynomial v = {.constant = w->v};
  const int code = stf_circle_run(w->circle, radius, moments ? &v : NULL);
  now->singular = code == STEIF_SINGULAR;
  if (now->singular) steif_forget(w->ctx);
  if (code) return now->singular ? STEIF_OK : code;
  now->log_det = w->circle->log_det;
  if (moments) judge(w, now);
  return STEIF_OK;
}

static void count(sample *smaller, const sample *larger)
{
  if (larger->singular || smaller->singular) return;
  smaller->above = larger->radius;
  smaller->count = (larger->log_det - smaller->log_det) / log(larger->radius / smaller->radius);
}

/* More eigenvalues than the pattern allows are rounding. */
static bool whole(const search *w, const sample *s)
{
  const sunrealtype nearest = round(s->count);
  return fabs(s->count - nearest) <= STF_WHOLE && nearest >= 0 &&
         nearest <= (sunrealtype)w->structure->degree;
}

static bool complete(const search *w, const sample *s)
{
  return whole(w, s) && round(s->count) == (sunrealtype)w->target;
}

/* The largest |F| / |E| of a column or row: a bound of the eigenvalues that is rough, and right
 * in size where equations are scaled badly. */
static sunrealtype bound(search *w)
{
  const stf_scaled *s = &w->circle->scaled;
  const sunindextype n = s->n;
  sunrealtype *e = s->most, *f = s->row, most = w->start;
  for (int across = 0; across < 2; across++) {
    for (sunindextype i = 0; i < n; i++) e[i] = f[i] = 0;
    for (int which = 0; which < 2; which++) {
      SUNMatrix M = which ? s->givenF : s->givenE;
      sunrealtype *to = which ? f : e;
      for (sunindextype j = 0; j < n; j++)
        for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++) {
          const sunindextype i = across ? SM_INDEXVALS_S(M)[k] : j;
          to[i] = fmax(to[i], fabs(SM_DATA_S(M)[k]));
        }
    }
    for (sunindextype i = 0; i < n; i++)
      if (e[i] > 0) most = fmax(most, f[i] / e[i]);
  }
  return most;
}

static bool clear(const search *w, const sample *s)
{
  return s->gap >= STF_WIDE_GAP || (s->gap >= STF_CLEAR_GAP && s->last == w->pattern);
}

/* Up until all finite eigenvalues are inside, and the moments decide or part no further, or the radius
 * `limit` is reached. Where they decide, all that is asked of the next circle is its determinant; more,
 * if the count does not agree. */
static int grow(search *w, sunrealtype limit)
{
  if (!w->circles) STEIF_TRY(draw(w, w->end, true));
  for (int k = w->circles; k < UPWARDS && w->of[k - 1].radius < limit; k++) {
    sample *last = &w->of[k - 1], *now = last + 1;
    const sunrealtype radius = STF_GROW * last->radius;
    STEIF_TRY(draw(w, radius, !clear(w, last)));
    count(last, now);
    if (complete(w, last) && clear(w, last)) break;
    if (clear(w, last)) {
      w->circles--;
      STEIF_TRY(draw(w, radius, true));
    }
    if (complete(w, last) && last->gap >= STF_GAP && now->gap < STF_GROW * last->gap) break;
  }
  return STEIF_OK;
}

static bool any_complete(const search *w)
{
  bool any = false;
  for (int k = 0; k < w->circles; k++) any = any || complete(w, &w->of[k]);
  return any;
}

/* All inside of a circle whose moments decide. */
static bool decided(const search *w)
{
  bool any = false;
  for (int k = 0; k < w->circles; k++)
    any = any || (complete(w, &w->of[k]) && w->of[k].gap >= STF_GAP);
  return any;
}

/* What entries cancel exactly the pattern cannot know: how many eigenvalues are finite, and the index,
 * by ranks. */
static int rank(search *w)
{
  steif_structure *s = w->structure;
  sunindextype infinite = 0;
  int count;
  if (w->ranked >= 0) return STEIF_OK;
  STEIF_TRY(stf_field_chains(w->ctx, w->field, w->analysis.index_most + 1, w->weyr, &count));
  if (count < 0) return STEIF_OK;
  for (int k = 0; k < count; k++) infinite += w->weyr[k];
  w->ranked = count;
  w->pattern = count;
  w->target = s->exact = s->n - infinite;
  s->doubt = stf_field_doubt(w->field, count + 1);
  return STEIF_OK;
}

/* Down from the first circle: while all eigenvalues stay inside, when they are inside of it
 * already, since rounding grows with R; or through the radii left out, when they never are. */
static int shrink(search *w)
{
  const bool inside = (w->circles == 2 || w->ranked >= 0) && complete(w, &w->of[0]);
  const bool sure = inside && clear(w, &w->of[0]), outside = !any_complete(w);
  const sunrealtype factor = inside ? STF_SHRINK : STF_GROW,
                    least = outside ? w->start / STF_GROW : 0;
  if (!(inside && w->structure->degree > 0) && !outside) return STEIF_OK;
  sample *lowest = &w->of[0];
  while (w->circles < CIRCLES && lowest->radius / factor >= least) {
    STEIF_TRY(draw(w, lowest->radius / factor, !sure));
    sample *now = &w->of[w->circles - 1];
    count(now, lowest);
    if (inside && !complete(w, now)) break;
    lowest = now;
  }
  return STEIF_OK;
}

static int explore(search *w)
{
  const sunrealtype given = w->analysis.radius;
  if (given > 0) {
    STEIF_TRY(draw(w, given, true));
    STEIF_TRY(draw(w, 2 * given, false));
    count(&w->of[0], &w->of[1]);
    w->circles = 1;
    return complete(w, &w->of[0]) ? STEIF_OK : rank(w);
  }
  STEIF_TRY(grow(w, w->end * STF_BEYOND));
  if (!any_complete(w)) STEIF_TRY(rank(w));
  if (!decided(w) && (any_complete(w) || w->ranked >= 0)) STEIF_TRY(grow(w, w->end * STF_FAR));
  return shrink(w);
}

static int class_of(const search *w, const sample *s)
{
  if (complete(w, s)) return clear(w, s) ? 3 : 2;
  return whole(w, s) ? 1 : 0;
}

/* The circle to believe: the smallest with all eigenvalues inside and a clear index; else one with
 * all inside, with a whole count, any, the widest gap first. */
static sample choose(const search *w)
{
  sample best = {.singular = true, .count = NAN};
  for (int k = 0; k < w->circles; k++) {
    const sample *s = &w->of[k];
    if (s->singular) continue;
    const int class = class_of(w, s), before = best.singular ? -1 : class_of(w, &best);
    const bool better = class == 3 ? s->radius < best.radius : s->gap > best.gap;
    if (class > before || (class == before && better)) best = *s;
  }
  return best;
}

/* The radius at which aliasing, (rho / R)^points, is at rounding level, by the smallest circle with
 * all eigenvalues inside. From Jensen's mean an eigenvalue at rho is missed by (rho / R)^points /
 * points: the distance of the count from a whole number tells rho on the smaller circle of the
 * pair. */
static sunrealtype final_radius(const search *w, const sample *chosen)
{
  if (w->analysis.radius > 0 || !complete(w, chosen)) return chosen->radius;
  for (int k = 0; k < w->circles; k++)
    if (complete(w, &w->of[k]) && w->of[k].radius < chosen->radius) chosen = &w->of[k];
  const sunrealtype m = w->analysis.points, ratio = chosen->above / chosen->radius;
  const sunrealtype off = fmax(fabs(chosen->count - round(chosen->count)), 1e-12);
  return chosen->radius * pow(off * m * log(ratio) / STF_EPS, 1 / m);
}

/* A chain as long as the index is made of infinite eigenvalues. */
static bool possible(int index, sunindextype infinite)
{
  return index > 0 ? index <= infinite : infinite == 0;
}

/* Moments and ranks must agree. Ranks alone would not do: a chain of 8 that rounding has spoilt is an
 * index of 0 for the entries as given, with eigenvalues as small as eps^(-1/8). */
static void compare(steif_structure *s, int ranked)
{
  if (s->index == ranked) return;
  if (ranked < s->index_least) s->index_least = ranked;
  s->index = -1;
}

/* What one circle decides: with all eigenvalues inside, the last gap ends the moments; else a mode
 * outside lets them fall evenly, and only gaps that agree count. */
static void decide(search *w, const sample *chosen)
{
  steif_structure *s = w->structure;
  const bool all = complete(w, chosen), counted = whole(w, chosen);
  const int least = chosen->index < chosen->last ? chosen->index : chosen->last;
  const bool agreed = all || (counted && chosen->index == chosen->last);
  s->index_least = chosen->last < 0 ? 0 : all ? chosen->last : least;
  if (counted) {
    s->finite = (sunindextype)llround(chosen->count);
    s->infinite = s->n - s->finite;
  }
  if (agreed && chosen->last >= 0) s->index = s->index_least;
  if (s->index >= 0 && counted && !possible(s->index, s->infinite)) {
    s->index = -1;
    s->index_least = s->infinite > 0;
  }
  if (all && w->ranked >= 0) compare(s, w->ranked);
  s->resolution = all ? INFINITY : chosen->radius;
  s->radius = final_radius(w, chosen);
  if (s->index == 0 || s->index == 1) s->equations_count = s->unknowns_count = 0;
}

/* Is it regular, and if this is in doubt, by ranks? */
static int judge_regular(search *w, bool found)
{
  steif_structure *s = w->structure;
  bool singular = false;
  s->regular = found && s->rcond >= fmin((sunrealtype)s->n * STF_EPS, 1e-11);
  if (s->regular && s->rcond < STF_SUSPECT)
    STEIF_TRY(stf_field_singular(w->ctx, w->field, &singular));
  if (singular) s->regular = 0;
  return STEIF_OK;
}

static int take_ranks(search *w)
{
  steif_structure *s = w->structure;
  if (w->ranked < 0) return STEIF_OK;
  s->rank_E = s->n - (w->ranked ? w->weyr[0] : 0);
  if (s->index != w->ranked || s->finite != s->exact || !w->ranked) return STEIF_OK;
  STEIF_TRY(stf_structure_list(w->ctx, w->ranked, &s->weyr));
  s->weyr_count = w->ranked;
  for (int k = 0; k < w->ranked; k++) s->weyr[k] = w->weyr[k];
  return STEIF_OK;
}

static int conclude(search *w, stf_contour_circle *circle)
{
  steif_structure *s = w->structure;
  sample chosen = choose(w);
  if (!chosen.singular && chosen.last < 0 && complete(w, &chosen)) STEIF_TRY(rank(w));
  s->count = chosen.count;
  s->gap = chosen.gap;
  s->finite = s->infinite = s->index = -1;
  for (int k = 0; k < w->circles; k++) s->rcond = fmax(s->rcond, w->of[k].rcond);
  STEIF_TRY(judge_regular(w, !chosen.singular));
  if (s->regular) decide(w, &chosen);
  circle->radius = chosen.radius;
  circle->given = w->analysis.radius > 0;
  circle->complete = complete(w, &chosen);
  circle->ranked = w->ranked;
  circle->moments = chosen.last;
  return s->regular ? take_ranks(w) : STEIF_OK;
}

static int analyse(search *w, SUNMatrix E, SUNMatrix F, stf_contour_circle *circle)
{
  const sunrealtype e = stf_largest(E), f = stf_largest(F);
  const sunindextype n = w->circle->scaled.n;
  sunrealtype square = 0;
  w->v = stf_pool_array(w->circle->scaled.pool, (size_t)n, sizeof *w->v);
  if (!w->v) return STEIF_NO_MEMORY;
  stf_random random = {w->analysis.seed};
  for (sunindextype i = 0; i < n; i++) {
    w->v[i] = stf_random_in(&random, -1, 1);
    square += w->v[i] * w->v[i];
  }
  w->size = sqrt(square);
  w->start = e > 0 && f > 0 ? f / e : 1;
  w->end = fmin(bound(w), STF_SPREAD * w->start);
  STEIF_TRY(explore(w));
  return conclude(w, circle);
}

int stf_contour_find(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                     const steif_analysis *analysis, steif_structure *structure,
                     stf_contour_circle *circle)
{
  sunindextype rank;
  search w = {.ctx = ctx,
              .analysis = stf_analysis_filled(analysis),
              .structure = structure,
              .field = &circle->field,
              .ranked = -1};
  structure->n = SM_COLUMNS_S(F);
  structure->rank_E = -1;
  structure->method = "contour";
  STEIF_TRY(stf_structural_index(ctx, E, F, &rank, &w.pattern, structure));
  if (rank < structure->n)
    return stf_say_singular_pattern(ctx, E, F, analysis ? analysis->names : NULL, rank,
                                    structure);
  w.target = structure->degree;
  const stf_field as = circle->field;
  STEIF_TRY(stf_field_open(ctx, as.E, as.F, as.snap, &circle->field));
  stf_circle *kept = stf_circle_kept(structure);
  stf_circle_close(ctx, &kept);
  structure->kept = NULL;
  STEIF_TRY(stf_circle_open(ctx, E, F, analysis, w.analysis.index_most + 2, &w.circle));
  const int code = analyse(&w, E, F, circle);
  structure->cost = *steif_pencil_statistics(w.circle->scaled.pencil);
  structure->kept = &w.circle->kept_by;
  return code;
}
