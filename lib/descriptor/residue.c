/* residue.c: x(0+) and the impulses of a sparse system by circles. With
 *   X(s) = (s E + F)^{-1} (E x(0-) + sum_j f^(j)(0+) s^{-j-1})
 * the coefficient of s^i at infinity is c_i for i >= 0 and x(0+) for i = -1: one complex solve for
 * each point. A second circle of twice the radius gives the error: too small a circle shows
 * aliasing, too large a one rounding of the size eps (R nu)^{k-1}, and the pair that agrees best
 * is taken.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Agreement that needs no further circle; that is certified, the same as of two dense algorithms (the
 * estimate follows the error up to 1e-2); how far the radius may go down and up, in factors of
 * two. */
#define AGREED 1e-12
#define CERTIFIED 1e-3
enum { DOWN = 3, UP = 3 };

typedef struct answer {
  sunrealtype *x; /* x(0+), c_0, c_1, ..., n each */
} answer;

typedef struct residue {
  steif_context *ctx;
  const stf_sources *sources;
  steif_impulse *impulse;
  stf_circle *circle;
  int terms; /* of the forcing */
  answer at[3];
} residue;

static int claim(residue *w, answer *out)
{
  const size_t size = (size_t)w->impulse->n * (size_t)(w->impulse->count + 1);
  if (!out->x) out->x = stf_allocate(w->ctx, size, sizeof *out->x);
  return out->x ? STEIF_OK : STEIF_NO_MEMORY;
}

static int draw(residue *w, sunrealtype R, answer *out)
{
  const stf_circle *c = w->circle;
  const sunindextype n = c->scaled.n;
  STEIF_TRY(claim(w, out));
  const stf_polynomial g = {w->terms, w->sources->Ex0, w->sources->f, c->scaled.row};
  STEIF_TRY(stf_circle_run(w->circle, R, &g));
  const int *unknown = c->sequence->unknown;
  for (int k = 0; k <= w->impulse->count; k++) {
    const sunrealtype power = pow(R, 1 - k), *sum = c->sum + k * n;
    for (sunindextype i = 0; i < n; i++)
      out->x[k * n + unknown[i]] = power * c->scaled.column[unknown[i]] * sum[i];
  }
  return STEIF_OK;
}

static sunrealtype difference(const residue *w, const answer *a, const answer *b)
{
  sunrealtype off = 0, size = 0;
  for (sunindextype i = 0; i < w->impulse->n; i++) {
    const sunrealtype d = a->x[i] - b->x[i];
    off += d * d;
    size += a->x[i] * a->x[i];
  }
  if (off == 0) return 0;
  return isfinite(off) && size > 0 ? sqrt(off / size) : INFINITY;
}

static void swap(answer *a, answer *b)
{
  const answer keep = *a;
  *a = *b;
  *b = keep;
}

/* at[0] and at[1] belong to *R and 2 *R and differ by `estimate`. Go on in factors of two, down or
 * up, while neighbours agree better. */
static int walk(residue *w, bool up, sunrealtype *R, sunrealtype *estimate)
{
  answer *at = w->at;
  for (int step = 0; step < (up ? UP : DOWN); step++) {
    STEIF_TRY(draw(w, up ? 4 * *R : *R / 2, &at[2]));
    const sunrealtype next = up ? difference(w, &at[1], &at[2]) : difference(w, &at[2], &at[0]);
    if (!(next < *estimate)) break;
    *estimate = next;
    *R *= up ? 2 : 0.5;
    if (up) {
      swap(&at[0], &at[1]);
      swap(&at[1], &at[2]);
    } else {
      swap(&at[1], &at[0]);
      swap(&at[0], &at[2]);
    }
    if (next <= AGREED) break;
  }
  return STEIF_OK;
}

static int pair(residue *w, sunrealtype R)
{
  STEIF_TRY(draw(w, R, &w->at[0]));
  STEIF_TRY(draw(w, 2 * R, &w->at[1]));
  w->impulse->estimate = difference(w, &w->at[0], &w->at[1]);
  return STEIF_OK;
}

/* Where plain solves do not agree, refined ones may. */
static int find(residue *w, bool fixed, sunrealtype *R)
{
  sunrealtype *estimate = &w->impulse->estimate;
  const sunrealtype first = *R;
  STEIF_TRY(pair(w, *R));
  if (*estimate > AGREED && !w->circle->careful) {
    w->circle->careful = true;
    STEIF_TRY(pair(w, *R));
  }
  if (fixed || *estimate <= AGREED) return STEIF_OK;
  STEIF_TRY(walk(w, false, R, estimate));
  return *R < first || *estimate <= AGREED ? STEIF_OK : walk(w, true, R, estimate);
}

static void say(const residue *w, const steif_structure *s, sunrealtype R)
{
  steif_impulse *out = w->impulse;
  const size_t room = sizeof out->message;
  const long long relaxed = s->degree - s->finite;
  if (out->certified)
    snprintf(
      out->message, room,
      "%d impulse coefficients with R = %.3g: circles of R and 2R differ by %.1e, and the "
      "count of finite eigenvalues equals the structural degree",
      out->count, R, out->estimate);
  else if (s->certified)
    snprintf(
      out->message, room,
      "not certified: circles of R = %.3g and 2R differ by %.1e, above %.0e; fast and slow "
      "parts lie too far apart for this radius: scale time, or use a dense algorithm",
      R, out->estimate, CERTIFIED);
  else if (s->finite >= 0 && relaxed > 0)
    snprintf(out->message, room,
             "not certified: x(0+), c_i valid for time scales >= 1/R = %.3g; up to %lld faster "
             "modes relaxed (circles of R = %.3g and 2R differ by %.1e)",
             1 / R, relaxed, R, out->estimate);
  else
    snprintf(out->message, room,
             "not certified, as the structure is not (index %d%s): circles of R = %.3g and 2R "
             "differ by %.1e",
             out->index, s->index < 0 ? " assumed" : "", R, out->estimate);
}

static int analyse(residue *w, sunrealtype R, bool fixed, const steif_structure *structure)
{
  steif_impulse *out = w->impulse;
  const size_t n = (size_t)out->n, count = (size_t)out->count;
  STEIF_TRY(find(w, fixed, &R));
  memcpy(out->x_plus, w->at[0].x, n * sizeof *out->x_plus);
  if (count) memcpy(out->c, w->at[0].x + n, n * count * sizeof *out->c);
  out->radius = R;
  out->certified = structure->certified && out->estimate <= CERTIFIED;
  say(w, structure, R);
  return STEIF_OK;
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

/* The circles of the structure serve again if they are of these matrices. */
static int prepare(residue *w, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                   steif_structure *structure)
{
  const int room = w->impulse->count + 1;
  if (stf_circle_adopt(structure->circle, E, F, analysis, room)) {
    w->circle = structure->circle;
    return STEIF_OK;
  }
  return stf_circle_open(w->ctx, E, F, analysis, room, &w->circle);
}

int stf_contour_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                        const steif_analysis *analysis, const sunrealtype *x0,
                        const stf_sources *sources, steif_structure *structure,
                        steif_impulse *impulse)
{
  const int index = structure->index < 0 ? structure->index_least : structure->index;
  const int terms = sources->f ? index : 0;
  const bool fixed = analysis && analysis->radius > 0;
  residue w = {.ctx = ctx, .sources = sources, .impulse = impulse, .terms = terms};
  (void)x0; /* only E x(0-) enters */
  STEIF_CHECK(terms <= sources->derivatives + 1, ctx, STEIF_BAD_INPUT,
              "index %d asks for derivatives of the forcing up to order %d, %d is known: give "
              "them in the forcing function",
              index, index - 1, sources->derivatives);
  STEIF_CHECK(index <= STF_INDEX_MOST, ctx, STEIF_UNSUPPORTED,
              "index %d: circles give impulses up to index %d", index, (int)STF_INDEX_MOST);
  STEIF_TRY(stf_impulse_claim(ctx, sources->n, index, impulse));
  impulse->method = "contour";
  STEIF_TRY(prepare(&w, E, F, analysis, structure));
  const steif_pencil_stats before = *steif_pencil_statistics(w.circle->scaled.pencil);
  const int code = analyse(&w, stf_radius(E, F, analysis, structure), fixed, structure);
  impulse->cost = spent(&before, steif_pencil_statistics(w.circle->scaled.pencil));
  for (int k = 0; k < 3; k++) stf_release(ctx, w.at[k].x);
  if (w.circle != structure->circle) stf_circle_close(ctx, &w.circle);
  return code;
}
