/* circle.c: Laurent coefficients by the trapezoidal rule on |s| = R,
 *   R^i x_i = (1/m) sum_j e^{-i theta_j} x(s_j),  s_j = R e^{i theta_j}, theta_j = 2 pi (j+1/2)/m,
 * which is exact up to x_{i +- m}, x_{i +- 2m}, ...; the mean of log |det(s_j E + F)| comes along.
 * L. N. Trefethen and J. A. C. Weideman, SIAM Review 56 (2014).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include "pencil.h"
#include <math.h>
#include <string.h>

enum { POINTS = 16, REFINEMENTS = 2, INDEX_MOST = 8, SEED = 1 };

/* Coefficient i also collects that of i - points, which has to be of order -ALIAS or less. */
enum { ALIAS = 3 };

/* Points whose factors are alive at a time: few for large systems. */
enum { LARGE = 100000, SLOTS = 4, SLOTS_LARGE = 2 };

/* A radius over max |F| / max |E| where nothing is known. */
#define GUESS 10.0

static const sunrealtype pi = 3.14159265358979323846;

steif_analysis stf_analysis_filled(const steif_analysis *analysis)
{
  steif_analysis a = {0};
  if (analysis) a = *analysis;
  if (!a.points) a.points = POINTS;
  if (!a.refinements) a.refinements = REFINEMENTS;
  if (a.refinements < 0) a.refinements = 0;
  if (!a.index_most)
    a.index_most = a.points - ALIAS < INDEX_MOST ? a.points - ALIAS : INDEX_MOST;
  if (!a.seed) a.seed = SEED;
  return a;
}

sunrealtype stf_radius(SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                       const steif_structure *structure)
{
  if (analysis && analysis->radius > 0) return analysis->radius;
  if (structure->radius > 0 && isfinite(structure->radius)) return structure->radius;
  const sunrealtype e = stf_largest(E), f = stf_largest(F);
  return e > 0 && f > 0 ? GUESS * f / e : 1;
}

static int check(steif_context *ctx, const steif_analysis *a)
{
  STEIF_CHECK(a->points >= 4 && a->points <= 1024 && a->points % 2 == 0, ctx, STEIF_BAD_INPUT,
              "%d points on the circle: give an even number from 4 to 1024, or 0 for %d",
              a->points, (int)POINTS);
  STEIF_CHECK(a->index_most >= 1 && a->index_most <= 64 && a->index_most <= a->points - ALIAS,
              ctx, STEIF_BAD_INPUT,
              "indices up to %d are to be looked for with %d points: give 1 to 64 and at most "
              "%d less than points, or 0",
              a->index_most, a->points, (int)ALIAS);
  STEIF_CHECK(a->radius >= 0 && isfinite(a->radius), ctx, STEIF_BAD_INPUT,
              "the radius %g must be positive, or 0 to be looked for", a->radius);
  return STEIF_OK;
}

static int claim(stf_circle *c)
{
  stf_scaled *s = &c->scaled;
  for (int k = 0; k < 2; k++) {
    c->b[k] = stf_claim_vector(s->pool, s->like);
    c->x[k] = stf_claim_vector(s->pool, s->like);
    c->r[k] = stf_claim_vector(s->pool, s->like);
    if (!c->b[k] || !c->x[k] || !c->r[k]) return STEIF_NO_MEMORY;
  }
  c->sum = stf_claim_vectors(s->pool, c->count, s->like);
  return c->sum ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_circle_open(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, int lowest, int count, stf_circle *c)
{
  const steif_analysis a = stf_analysis_filled(analysis);
  STEIF_TRY(check(ctx, &a));
  *c = (stf_circle){
    .points = a.points, .refinements = a.refinements, .lowest = lowest, .count = count};
  STEIF_TRY(stf_scaled_open(ctx, E, F, &c->scaled));
  c->slots = c->scaled.n > LARGE ? SLOTS_LARGE : SLOTS;
  const int code = claim(c);
  if (code) stf_circle_close(c);
  return code;
}

void stf_circle_close(stf_circle *c) { stf_scaled_close(&c->scaled); }

static sunrealtype norm(sunindextype n, N_Vector const v[2])
{
  sunrealtype sum = 0;
  for (int c = 0; c < 2; c++)
    for (sunindextype i = 0; i < n; i++) sum += NV_Ith_S(v[c], i) * NV_Ith_S(v[c], i);
  return sqrt(sum);
}

static void add(stf_circle *c, sunrealtype angle)
{
  const sunrealtype *restrict re = NV_DATA_S(c->x[0]), *restrict im = NV_DATA_S(c->x[1]);
  for (int k = 0; k < c->count; k++) {
    const sunrealtype turn = (c->lowest + k) * angle, weight = 2.0 / c->points;
    const sunrealtype C = weight * cos(turn), S = weight * sin(turn);
    sunrealtype *restrict sum = NV_DATA_S(c->sum[k]);
    for (sunindextype i = 0; i < c->scaled.n; i++) sum[i] += C * re[i] + S * im[i];
  }
}

static int visit(stf_circle *c, int slot, sunrealtype angle, steif_shift s,
                 stf_circle_source *source, void *user)
{
  sunrealtype log_det;
  STEIF_TRY(stf_pencil_logdet(c->scaled.pencil, slot, &log_det));
  c->log_det += 2 * (log_det - c->scaled.log_scale) / c->points;
  if (!source) return STEIF_OK;
  source(&c->scaled, s, user, NV_DATA_S(c->b[0]), NV_DATA_S(c->b[1]));
  STEIF_TRY(stf_scaled_solve(&c->scaled, slot, s, c->refinements, c->b, c->x, c->r));
  add(c, angle);
  const sunrealtype amplified = norm(c->scaled.n, c->x) / norm(c->scaled.n, c->b);
  if (isfinite(amplified)) c->amplified = fmin(c->amplified, amplified);
  return STEIF_OK;
}

int stf_circle_run(stf_circle *c, sunrealtype R, stf_circle_source *source, void *user)
{
  const int half = c->points / 2;
  steif_shift s[SLOTS];
  sunrealtype angle[SLOTS];
  c->radius = R;
  c->log_det = 0;
  c->amplified = INFINITY;
  STEIF_TRY(stf_scaled_set(&c->scaled, R));
  for (int k = 0; source && k < c->count; k++)
    memset(NV_DATA_S(c->sum[k]), 0, (size_t)c->scaled.n * sizeof(sunrealtype));
  for (int done = 0; done < half; done += c->slots) {
    const int now = half - done < c->slots ? half - done : c->slots;
    for (int k = 0; k < now; k++) {
      angle[k] = 2 * pi * (done + k + 0.5) / c->points;
      s[k] = (steif_shift){R * cos(angle[k]), R * sin(angle[k])};
    }
    STEIF_TRY(steif_pencil_factor(c->scaled.pencil, now, s));
    for (int k = 0; k < now; k++) STEIF_TRY(visit(c, k, angle[k], s[k], source, user));
  }
  return STEIF_OK;
}
