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

/* Points whose factors are alive at a time, at most, and whose solutions are. */
enum { SLOTS = 4, KEPT = 8, PAIRS = KEPT / 2 };

/* Sums of powers -1 .. STF_INDEX_MOST. */
enum { SUMS = STF_INDEX_MOST + 2 };

/* Unknowns that are summed over together, in the first cache. */
enum { BLOCK = 128 };

/* The backward error of a plain solve, by rows, that is let pass. Where rounding fills zero blocks
 * it is larger by orders of magnitude. */
#define GOOD (256 * STF_EPS)

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
  STEIF_CHECK(a->index_most >= 1 && a->index_most <= STF_INDEX_MOST &&
                a->index_most <= a->points - ALIAS,
              ctx, STEIF_BAD_INPUT,
              "indices up to %d are to be looked for with %d points: give 1 to %d and at most "
              "%d less than points, or 0",
              a->index_most, a->points, (int)STF_INDEX_MOST, (int)ALIAS);
  STEIF_CHECK(a->radius >= 0 && isfinite(a->radius), ctx, STEIF_BAD_INPUT,
              "the radius %g must be positive, or 0 to be looked for", a->radius);
  return STEIF_OK;
}

static int fill(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *a,
                stf_circle *c)
{
  stf_scaled *s = &c->scaled;
  STEIF_TRY(stf_scaled_open(ctx, E, F, s));
  const size_t n = (size_t)s->n, size = sizeof(sunrealtype);
  const int half = a->points / 2, threads = stf_threads(ctx);
  c->slots = threads >= SLOTS ? SLOTS : threads > 1 ? 2 : 1;
  c->x = stf_claim(s->pool, 2 * n * (size_t)(half < KEPT ? half : KEPT), size);
  c->sum = stf_claim(s->pool, n * (size_t)c->room, size);
  c->size = stf_claim(s->pool, n, size);
  c->r = stf_claim(s->pool, 2 * n, size);
  c->square = stf_claim(s->pool, (size_t)c->room, size);
  return c->x && c->sum && c->size && c->r && c->square ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_circle_open(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, int room, stf_circle **circle)
{
  const steif_analysis a = stf_analysis_filled(analysis);
  STEIF_TRY(check(ctx, &a));
  stf_circle *c = *circle = stf_allocate(ctx, 1, sizeof *c);
  if (!c) return STEIF_NO_MEMORY;
  c->points = a.points, c->refinements = a.refinements;
  c->room = c->count = room > 2 ? room : 2;
  c->careful = !c->refinements;
  const int code = fill(ctx, E, F, &a, c);
  if (code) stf_circle_close(ctx, circle);
  return code;
}

void stf_circle_close(steif_context *ctx, stf_circle **circle)
{
  if (!*circle) return;
  stf_scaled_close(&(*circle)->scaled);
  stf_release(ctx, *circle);
  *circle = NULL;
}

bool stf_circle_adopt(stf_circle *c, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                      int room)
{
  const steif_analysis a = stf_analysis_filled(analysis);
  if (!c || room > c->room || a.points != c->points || a.refinements != c->refinements)
    return false;
  if (!stf_scaled_adopt(&c->scaled, E, F)) return false;
  c->count = room > 2 ? room : 2;
  return true;
}

/* ---- sums over the nodes ------------------------------------------------------------------ */

/* Nodes are visited in pairs that mirror each other in the imaginary axis, theta and pi - theta:
 * e^{-i k theta} of both differ by signs alone. Without a partner: i R. */
static sunrealtype angle_of(const stf_circle *c, int visit)
{
  const int half = c->points / 2, j = visit % 2 ? half - 1 - visit / 2 : visit / 2;
  return 2 * pi * (j + 0.5) / c->points;
}

/* Of solutions a, b at a pair of nodes, for even and odd powers of s: real parts a +- b and
 * imaginary parts a -+ b; b NULL: none. */
typedef struct fold {
  sunrealtype re[2][BLOCK], im[2][BLOCK];
} fold;

static void fold_pair(const sunrealtype *restrict a, const sunrealtype *restrict b, int n,
                      fold *restrict f)
{
  for (int i = 0; i < n; i++) {
    const sunrealtype re = b ? b[2 * i] : 0, im = b ? b[2 * i + 1] : 0;
    f->re[0][i] = a[2 * i] + re, f->im[0][i] = a[2 * i + 1] - im;
    f->re[1][i] = a[2 * i] - re, f->im[1][i] = a[2 * i + 1] + im;
  }
}

/* What visits contribute to the sum of one power: the first to come set it, with the last it is
 * complete. */
typedef struct weights {
  int pairs;
  bool odd, first, last;
  sunrealtype c[PAIRS], s[PAIRS];
} weights;

static weights weights_of(const stf_circle *c, int from, int visits, int power)
{
  weights w = {.pairs = (visits + 1) / 2, .odd = power & 1};
  w.first = from == 0, w.last = from + visits == c->points / 2;
  for (int k = 0; k < w.pairs; k++) {
    const sunrealtype turn = power * angle_of(c, from + 2 * k), weight = 2.0 / c->points;
    w.c[k] = weight * cos(turn), w.s[k] = weight * sin(turn);
  }
  return w;
}

static void add_power(const weights *w, const fold *f, int n, sunrealtype *restrict sum)
{
  for (int i = 0; w->first && i < n; i++) sum[i] = 0;
  for (int k = 0; k < w->pairs; k++) {
    const sunrealtype *restrict re = f[k].re[w->odd], *restrict im = f[k].im[w->odd];
    const sunrealtype cosine = w->c[k], sine = w->s[k];
    for (int i = 0; i < n; i++) sum[i] += cosine * re[i] + sine * im[i];
  }
}

/* Sizes and the squared norm of a sum that is complete. */
static sunrealtype measure(const sunrealtype *restrict sum, bool first, int n,
                           sunrealtype *restrict size)
{
  sunrealtype square = 0;
  for (int i = 0; i < n; i++) {
    size[i] = (first ? 0 : size[i]) + fabs(sum[i]);
    square += sum[i] * sum[i];
  }
  return square;
}

/* The solutions of visits from .. from + visits - 1 join the sums. */
static void add(stf_circle *c, int from, int visits)
{
  const sunindextype n = c->scaled.n;
  fold f[PAIRS];
  weights w[SUMS];
  for (int k = 0; k < c->count; k++)
    c->square[k] = 0, w[k] = weights_of(c, from, visits, k - 1);
  for (sunindextype at = 0; at < n; at += BLOCK) {
    const int now = n - at < BLOCK ? (int)(n - at) : BLOCK;
    for (int k = 0; k < visits; k += 2) {
      const sunrealtype *a = c->x + 2 * (k * n + at);
      fold_pair(a, k + 1 < visits ? a + 2 * n : NULL, now, &f[k / 2]);
    }
    for (int k = 0; k < c->count; k++) {
      sunrealtype *sum = c->sum + k * n + at;
      add_power(&w[k], f, now, sum);
      if (w[k].last) c->square[k] += measure(sum, k == 0, now, c->size + at);
    }
  }
}

/* ---- around the circle -------------------------------------------------------------------- */

/* The solution at a node that is factored in `slot`. False: the first is not steady, and nobody
 * has been careful. */
static bool visit(stf_circle *c, int slot, int number, steif_shift z, stf_circle_source *source,
                  void *user)
{
  stf_scaled *s = &c->scaled;
  sunrealtype *x = c->x + 2 * s->n * (number % KEPT);
  source(s, z, user, x);
  stf_scaled_direct(s, slot, x);
  for (int sweep = 0; c->careful && sweep < c->refinements; sweep++) {
    source(s, z, user, c->r);
    if (!stf_scaled_refine(s, slot, sweep == 0, x, c->r)) break;
  }
  if (c->careful || number > 0) return true;
  source(s, z, user, c->r);
  return stf_sparse_residual(s->pencil, slot, x, c->r, s->most) <= GOOD;
}

/* Of (1/m) sum_j (s_j E + F) x(s_j) the sums are to leave the constant part of the source: the
 * residuals of all nodes in one. */
static bool steady(stf_circle *c, stf_circle_source *source, void *user)
{
  stf_scaled *s = &c->scaled;
  source(s, (steif_shift){0, 0}, user, c->r);
  for (sunindextype i = 0; i < s->n; i++) c->r[i] = c->r[2 * i];
  return stf_sparse_balance(s->pencil, c->radius, c->sum, c->sum + s->n, c->size, c->r,
                            s->most) <= GOOD;
}

static int determinant(stf_circle *c, int slot)
{
  sunrealtype log_det;
  STEIF_TRY(stf_pencil_logdet(c->scaled.pencil, slot, &log_det));
  c->log_det += 2 * (log_det - c->scaled.log_scale) / c->points;
  return STEIF_OK;
}

/* `good`: as far as one can see. */
static int around(stf_circle *c, stf_circle_source *source, void *user, bool *good)
{
  const int half = c->points / 2;
  const sunrealtype R = c->radius;
  steif_shift s[SLOTS];
  c->log_det = 0;
  *good = false;
  c->scaled.pencil->trusted = !c->careful;
  for (int done = 0; done < half; done += c->slots) {
    const int now = half - done < c->slots ? half - done : c->slots;
    for (int k = 0; k < now; k++) {
      const sunrealtype angle = angle_of(c, done + k);
      s[k] = (steif_shift){R * cos(angle), R * sin(angle)};
    }
    STEIF_TRY(steif_pencil_factor(c->scaled.pencil, now, s));
    for (int k = 0; k < now; k++) {
      const steif_shift z = {s[k].re / R / R, -s[k].im / R / R};
      if (c->counts) STEIF_TRY(determinant(c, k));
      if (source && !visit(c, k, done + k, z, source, user)) return STEIF_OK;
    }
    const int end = done + now, kept = end % KEPT ? end % KEPT : KEPT;
    if (source && (end == half || kept == KEPT)) add(c, end - kept, kept);
  }
  *good = !source || c->careful || steady(c, source, user);
  return STEIF_OK;
}

int stf_circle_care(stf_circle *c)
{
  c->careful = true;
  return steif_pencil_update(c->scaled.pencil);
}

int stf_circle_run(stf_circle *c, sunrealtype R, stf_circle_source *source, void *user)
{
  bool good;
  c->radius = R;
  STEIF_TRY(stf_scaled_set(&c->scaled, R));
  STEIF_TRY(around(c, source, user, &good));
  if (good) return STEIF_OK;
  STEIF_TRY(stf_circle_care(c));
  return around(c, source, user, &good);
}
