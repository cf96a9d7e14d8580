/* pairing.c: two independent algorithms on one dense pencil, staircase and generalised Schur
 * form with equally many infinite eigenvalues. The result is certified when N^k of the Schur
 * form is rounding at the same k and both give the same x(0+) and impulses, from a random
 * x(0-) when only the structure is asked for.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pairing.h"
#include "dense.h"
#include "field.h"
#include "scales.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

typedef struct pairing {
  steif_context *ctx;
  stf_pool *pool;
  const steif_analysis *analysis;
  int n;
  sunrealtype *E, *F, *row, *column; /* diag(row) (s E + F) diag(column) */
  sunrealtype *x0, *difference;      /* of the scaled unknowns */
  stf_sources sources;
  steif_structure stairs, schur;
  steif_impulse one, two;
  int torn; /* the smaller index of two in different units; -1: the same */
  sunrealtype resolution;
  sunindextype carried; /* finite eigenvalues in entries that are rounding */
  SUNMatrix given[2];
} pairing;

static const sunrealtype agreement = 1e-3; /* relative, of x(0+) and of impulses */
static const sunrealtype negligible =
  1e-6; /* impulses so small beside E (x(0+) - x(0-)) are 0 */

static int open(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                pairing *p)
{
  const bool dense = SUNMatGetID(E) == SUNMATRIX_DENSE;
  const int n = (int)(dense ? SM_COLUMNS_D(E) : SM_COLUMNS_S(E));
  const size_t size = sizeof(sunrealtype);
  *p =
    (pairing){.ctx = ctx, .analysis = analysis, .n = n, .pool = stf_pool_new(ctx), .torn = -1};
  p->given[0] = E, p->given[1] = F;
  if (!p->pool) return STEIF_NO_MEMORY;
  p->E = stf_claim_square(p->pool, n);
  p->F = stf_claim_square(p->pool, n);
  p->row = stf_claim(p->pool, (size_t)n, size);
  p->column = stf_claim(p->pool, (size_t)n, size);
  p->x0 = stf_claim(p->pool, (size_t)n, size);
  p->difference = stf_claim(p->pool, (size_t)n, size);
  if (!p->E || !p->F || !p->row || !p->column || !p->x0 || !p->difference)
    return STEIF_NO_MEMORY;
  return stf_scales_choose(ctx, p->pool, analysis, E, F, n, p->E, p->F, p->row, p->column,
                           &p->torn);
}

static void close(pairing *p)
{
  stf_pool_free(&p->pool);
  steif_structure_clear(p->ctx, &p->stairs);
  steif_structure_clear(p->ctx, &p->schur);
  steif_impulse_clear(p->ctx, &p->one);
  steif_impulse_clear(p->ctx, &p->two);
}

/* A random x(0-) without forcing. */
static int probe(pairing *p)
{
  uint64_t state = p->analysis->seed ? p->analysis->seed : 1;
  sunrealtype *Ex0 = stf_claim(p->pool, (size_t)p->n, sizeof *Ex0);
  if (!Ex0) return STEIF_NO_MEMORY;
  for (int i = 0; i < p->n; i++) p->x0[i] = stf_draw(&state);
  stf_gemm('N', 'N', p->n, 1, p->n, 1, p->E, p->n, p->x0, p->n, 0, Ex0, p->n);
  p->sources = (stf_sources){p->n, -1, Ex0, NULL};
  return STEIF_OK;
}

static int scale_sources(pairing *p, const sunrealtype *x0, const stf_sources *sources)
{
  const size_t n = (size_t)p->n, rows = sources->f ? (size_t)sources->derivatives + 1 : 0;
  sunrealtype *all = stf_claim(p->pool, n * (rows + 1), sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < n; i++) {
    p->x0[i] = x0[i] / p->column[i];
    all[i] = sources->Ex0[i] * p->row[i];
    for (size_t j = 0; j < rows; j++) all[(j + 1) * n + i] = sources->f[j * n + i] * p->row[i];
  }
  p->sources = (stf_sources){p->n, sources->derivatives, all, rows ? all + n : NULL};
  return STEIF_OK;
}

static int staircase(pairing *p, bool answers)
{
  return stf_staircase(p->ctx, p->n, p->E, p->F, p->analysis, p->x0,
                       answers ? &p->sources : NULL, &p->stairs, &p->one, NULL);
}

static int schur(pairing *p)
{
  sunindextype m = 0;
  for (int i = 0; i < p->stairs.weyr_count; i++) m += p->stairs.weyr[i];
  return stf_qz(p->ctx, p->n, p->E, p->F, p->analysis, m, p->x0, &p->sources, &p->schur,
                &p->two);
}

static int second(pairing *p)
{
  sunindextype degree;
  STEIF_TRY(schur(p));
  STEIF_TRY(stf_scales_carried(p->ctx, p->n, p->E, p->F, &p->carried));
  STEIF_TRY(stf_scales_degree(p->ctx, p->n, p->E, p->F, &degree));
  p->resolution = fmin(p->stairs.resolution, p->schur.resolution);
  if (p->stairs.finite == degree) p->resolution = INFINITY;
  p->stairs.count = NAN;
  if (p->schur.index < 0) return STEIF_OK;
  return stf_jensen(p->pool, p->n, p->E, p->F, p->schur.radius, p->schur.resolution,
                    &p->stairs.count);
}

static sunrealtype distance(pairing *p, const sunrealtype *a, const sunrealtype *b)
{
  for (int i = 0; i < p->n; i++) p->difference[i] = a[i] - b[i];
  return stf_length(p->n, p->difference);
}

/* Relative difference of x(0+). */
static sunrealtype apart(pairing *p)
{
  const sunrealtype size = stf_length(p->n, p->one.x_plus);
  const sunrealtype d = distance(p, p->one.x_plus, p->two.x_plus);
  return d > 0 ? d / size : 0;
}

/* Both x(0+) and all c_i: nearly equal, or negligible in F c_0 = -E (x(0+) - x(0-)) and
 * F c_i = -E c_{i-1}. */
static bool agree(pairing *p)
{
  const int n = p->n;
  const sunrealtype plus = stf_length(n, p->one.x_plus), before = stf_length(n, p->x0);
  const sunrealtype E = stf_frobenius(n, n, p->E, n), F = stf_frobenius(n, n, p->F, n);
  sunrealtype scale = E * (plus + before);
  if (!(distance(p, p->one.x_plus, p->two.x_plus) <= agreement * (plus + agreement * before)))
    return false;
  for (int i = 0; i < p->one.count && i < p->two.count; i++) {
    const sunrealtype *a = p->one.c + (size_t)i * (size_t)n, size = stf_length(n, a);
    const sunrealtype d = distance(p, a, p->two.c + (size_t)i * (size_t)n);
    if (!(d <= agreement * size || F * d <= negligible * scale)) return false;
    scale = fmax(E * size, scale * E / F);
  }
  return true;
}

/* Why the pair is not certified; NULL when it is. */
static const char *verdict(pairing *p, char *room, size_t length)
{
  const steif_structure *a = &p->stairs, *b = &p->schur;
  if (p->torn >= 0)
    return "small entries decide, in other units of equations and unknowns the index is "
           "another one: set those to 0 that are rounding";
  if (b->index < 0 && a->index > 1)
    snprintf(
      room, length,
      "%.80s; rounding of the entries alone brings eigenvalues of a chain of %d from infinity "
      "down to some eps^(-1/%d) = %.1e",
      b->message, a->index, a->index, pow(STF_EPS, -1.0 / a->index));
  if (b->index < 0) return a->index > 1 ? room : b->message;
  if (p->carried > 0) {
    snprintf(
      room, length,
      "entries that are rounding beside the largest carry %lld more finite eigenvalue%s: "
      "set those to 0 that are rounding",
      (long long)p->carried, p->carried == 1 ? "" : "s");
    return room;
  }
  if (a->index < 0) return "the singular values of the staircase leave the index open";
  if (a->index != b->index)
    snprintf(room, length, "the staircase finds index %d, the generalised Schur form %d",
             a->index, b->index);
  else if (fabs(a->count - (sunrealtype)a->finite) > 0.5)
    snprintf(room, length,
             "%lld finite eigenvalues by staircase and generalised Schur form, but %.3f by "
             "Jensen's formula",
             (long long)a->finite, a->count);
  else if (!(p->resolution >= b->radius))
    snprintf(
      room, length,
      "rounding of the entries hides finite eigenvalues beyond |s| = %.1e, and there are "
      "some up to %.1e",
      p->resolution, b->radius);
  else if (!agree(p))
    snprintf(room, length,
             "staircase and generalised Schur form give x(0+) apart by %.1e or other impulses",
             apart(p));
  else
    return NULL;
  return room;
}

/* What two algorithms, or two units, see differently is not decided. */
static void doubt(steif_structure *s, int other, int torn)
{
  int least = other >= 0 && other < s->index ? other : s->index;
  if (torn >= 0 && torn < least) least = torn;
  if (s->index < 0 || (torn < 0 && (other < 0 || other == s->index))) return;
  s->index_least = least;
  s->index = -1, s->finite = s->infinite = -1;
}

static int judge(pairing *p)
{
  char room[240];
  steif_structure *s = &p->stairs;
  STEIF_TRY(second(p));
  const char *reason = verdict(p, room, sizeof room);
  s->certified = !reason;
  s->radius = p->schur.radius;
  s->resolution = p->resolution;
  if (p->analysis->algorithm == STEIF_QZ) {
    s->method = "qz";
    if (p->schur.index >= 0) s->gap = p->schur.gap;
  }
  doubt(s, p->schur.index, p->torn);
  stf_announce(s, reason,
               p->analysis->algorithm == STEIF_QZ ? "staircase" : "generalised Schur form");
  return STEIF_OK;
}

static int structure_of(pairing *p, bool both)
{
  if (both) STEIF_TRY(probe(p));
  STEIF_TRY(staircase(p, both));
  if (p->stairs.regular || !both) return both ? judge(p) : STEIF_OK;
  bool exactly;
  STEIF_TRY(stf_field_singular(p->ctx, p->given[0], p->given[1], &exactly));
  p->stairs.certified = exactly;
  stf_announce(&p->stairs, NULL, NULL);
  return STEIF_OK;
}

int stf_dense_structure(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                        const steif_analysis *analysis, bool both, steif_structure *structure)
{
  pairing p;
  int code = open(ctx, E, F, analysis, &p);
  if (code == STEIF_OK) code = structure_of(&p, both);
  if (code == STEIF_OK) {
    *structure = p.stairs;
    p.stairs = (steif_structure){0};
  }
  close(&p);
  return code;
}

/* Back to the unknowns as they were given. */
static void unscale(const pairing *p, steif_impulse *impulse)
{
  for (int j = 0; j < p->n; j++) {
    impulse->x_plus[j] *= p->column[j];
    for (int i = 0; i < impulse->count; i++)
      impulse->c[(size_t)i * (size_t)p->n + (size_t)j] *= p->column[j];
  }
}

static int impulse_of(pairing *p, steif_impulse *impulse)
{
  char room[240];
  STEIF_TRY(staircase(p, true));
  STEIF_CHECK(
    p->stairs.regular, p->ctx, STEIF_SINGULAR,
    "the pencil is singular (reciprocal condition %.1e at best): x(0+) does not exist "
    "or is not unique; see the structure for the equations",
    p->stairs.rcond);
  STEIF_TRY(second(p));
  const char *reason = verdict(p, room, sizeof room);
  const bool both = p->schur.index >= 0, qz = both && p->analysis->algorithm == STEIF_QZ;
  steif_impulse *from = qz ? &p->two : &p->one;
  if (both) unscale(p, &p->two);
  unscale(p, &p->one);
  *impulse = *from;
  impulse->estimate = both ? apart(p) : INFINITY;
  impulse->method = qz ? "qz" : "staircase";
  impulse->certified = !reason;
  impulse->resolution = p->resolution;
  char from_on[64] = "";
  if (!reason && isfinite(p->resolution))
    snprintf(from_on, sizeof from_on, " for time scales from %.1e on", 1 / p->resolution);
  snprintf(impulse->message, sizeof impulse->message,
           "index %d, %d impulse coefficient%s by the %s; %s%s%s", impulse->index,
           impulse->count, impulse->count == 1 ? "" : "s",
           qz ? "generalised Schur form" : "staircase",
           reason ? "not certified: " : "certified by the other algorithm",
           reason ? reason : "", from_on);
  *from = (steif_impulse){0};
  return STEIF_OK;
}

int stf_dense_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                      const steif_analysis *analysis, const sunrealtype *x0,
                      const stf_sources *sources, steif_impulse *impulse)
{
  pairing p;
  int code = open(ctx, E, F, analysis, &p);
  if (code == STEIF_OK) code = scale_sources(&p, x0, sources);
  if (code == STEIF_OK) code = impulse_of(&p, impulse);
  close(&p);
  return code;
}

/* A := diag(left) A diag(right); NULL: I. */
static void stretch(int n, const sunrealtype *left, const sunrealtype *right, bool over,
                    sunrealtype *A)
{
  const size_t m = (size_t)n;
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < m; i++)
      A[j * m + i] *= (left ? left[i] : 1) * (right ? over ? 1 / right[j] : right[j] : 1);
}

/* Back to the unknowns and the right-hand sides as they were given. */
static void restore(const pairing *p, const stf_pieces *parts)
{
  const stf_reduction *r = parts->reduction;
  const stf_decoupling *d = parts->decoupling;
  const size_t size = (size_t)p->n * (size_t)p->n;
  if (parts->slow) stretch(p->n, p->column, p->column, true, parts->slow);
  if (r) stretch(p->n, NULL, p->column, true, r->E), stretch(p->n, NULL, p->column, true, r->F);
  for (int k = 0; r && k < r->terms; k++)
    stretch(p->n, NULL, p->row, false, r->G + (size_t)k * size);
  if (!d) return;
  stretch(p->n, NULL, p->row, false, d->G);
  stretch(p->n, NULL, p->column, true, d->to);
  stretch(p->n, p->column, NULL, false, d->back);
}

int stf_dense_parts(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, const stf_pieces *parts)
{
  pairing p;
  int code = open(ctx, E, F, analysis, &p);
  if (code == STEIF_OK)
    code = stf_staircase(ctx, p.n, p.E, p.F, analysis, p.x0, NULL, &p.stairs, &p.one, parts);
  if (code == STEIF_OK && p.stairs.regular) restore(&p, parts);
  const int regular = p.stairs.regular, index = p.stairs.index;
  const sunrealtype rcond = p.stairs.rcond, gap = p.stairs.gap;
  close(&p);
  STEIF_TRY(code);
  STEIF_CHECK(regular, ctx, STEIF_SINGULAR,
              "the pencil is singular (reciprocal condition %.1e at best): it has no slow "
              "projector",
              rcond);
  STEIF_CHECK(index >= 0, ctx, STEIF_NOT_CERTIFIED,
              "the index is undecided (gap %.0e, 1e3 is needed), and so is the slow projector: "
              "scale the equations",
              gap);
  return STEIF_OK;
}
