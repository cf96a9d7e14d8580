/* circle.c: Laurent coefficients by the trapezoidal rule on |s| = R,
 *   R^i x_i = (1/m) sum_j e^{-i theta_j} x(s_j),  s_j = R e^{i theta_j}, theta_j = 2 pi (j+1/2)/m,
 * which is exact up to x_{i +- m}, x_{i +- 2m}, ...; the mean of log |det(s_j E + F)| comes
 * along. L. N. Trefethen and J. A. C. Weideman, SIAM Review 56 (2014).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"
#include "pencil.h"
#include <math.h>
#include <string.h>

enum { POINTS = 16, MOST = 1024, REFINEMENTS = 2, INDEX_MOST = 8, SEED = 1 };

/* Coefficient i also collects that of i - points, which has to be of order -ALIAS or less. */
enum { ALIAS = 3 };

/* Unknowns from which on threads gain more than they cost. */
enum { THREADS_FROM = 2000 };

/* Sums of powers -1 .. STF_INDEX_MOST. */
enum { SUMS = STF_INDEX_MOST + 2 };

/* Unknowns that are summed over together, in the first cache. */
enum { BLOCK = 128 };

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
  return e > 0 && f > 0 ? STF_GUESS * f / e : 1;
}

static int check(steif_context *ctx, const steif_analysis *a)
{
  STEIF_CHECK(a->points >= 4 && a->points <= MOST && a->points % 2 == 0, ctx, STEIF_BAD_INPUT,
              "%d points on the circle: give an even number from 4 to %d, or 0 for %d",
              a->points, (int)MOST, (int)POINTS);
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

/* Batches of so many lanes that all nodes are in one. */
static int most(const stf_circle *c) { return (c->points / 2 + STF_LANES - 1) / STF_LANES; }

static int fill(steif_context *ctx, SUNMatrix E, SUNMatrix F, stf_circle *c)
{
  stf_scaled *s = &c->scaled;
  STEIF_TRY(stf_scaled_open(ctx, E, F, s));
  s->pencil->many_shifts = true;
  const size_t n = (size_t)s->n, size = sizeof(sunrealtype);
  c->threads = s->n >= THREADS_FROM ? stf_threads(ctx) : 1;
  c->batches = most(c) < c->threads ? most(c) : c->threads;
  c->batch = stf_pool_array(s->pool, (size_t)c->batches, sizeof *c->batch);
  c->sum = stf_pool_array(s->pool, n * (size_t)c->room, size);
  c->square = stf_pool_array(s->pool, (size_t)c->room, size);
  return c->batch && c->sum && c->square ? STEIF_OK : STEIF_NO_MEMORY;
}

/* The pivots, and what goes with them. */
static void forget(stf_circle *c)
{
  for (int k = 0; c->batch && k < c->batches; k++) stf_multishift_close(&c->batch[k]);
  stf_sequence_close(&c->sequence);
}

static void free_kept(steif_context *ctx, struct stf_kept *kept)
{
  stf_circle *circle = (stf_circle *)kept;
  stf_circle_close(ctx, &circle);
}

int stf_circle_open(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, int room, stf_circle **circle)
{
  const steif_analysis a = stf_analysis_filled(analysis);
  STEIF_TRY(check(ctx, &a));
  stf_circle *c = *circle = stf_allocate(ctx, 1, sizeof *c);
  if (!c) return STEIF_NO_MEMORY;
  c->kept_by.free = free_kept;
  c->points = a.points;
  c->refinements = a.refinements;
  c->room = c->count = room > 2 ? room : 2;
  c->careful = !c->refinements;
  const int code = fill(ctx, E, F, c);
  if (code) stf_circle_close(ctx, circle);
  return code;
}

void stf_circle_close(steif_context *ctx, stf_circle **circle)
{
  if (!*circle) return;
  forget(*circle);
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

/* ---- sums over the nodes ----------------------------------------------------------------- */

/* Nodes are visited in pairs that mirror each other in the imaginary axis, theta and pi -
 * theta: e^{-i k theta} of both differ by signs alone. Without a partner: i R. */
static sunrealtype angle_of(const stf_circle *c, int visit)
{
  const int half = c->points / 2, j = visit % 2 ? half - 1 - visit / 2 : visit / 2;
  return 2 * pi * (j + 0.5) / c->points;
}

/* Of solutions a, b at a pair of nodes, for even and odd powers of s: real parts a +- b and
 * imaginary parts a -+ b; without a partner b = 0. */
typedef struct fold {
  sunrealtype re[2][BLOCK], im[2][BLOCK];
} fold;

static void fold_lanes(const stf_multishift *batch, int lane, bool pair, sunindextype at, int n,
                       fold *restrict f)
{
  enum { WIDE = STF_LANES };
  const sunrealtype *restrict a = batch->x + 2 * WIDE * at + lane;
  for (int i = 0; i < n; i++, a += 2 * WIDE) {
    const sunrealtype re = pair ? a[1] : 0, im = pair ? a[WIDE + 1] : 0;
    f->re[0][i] = a[0] + re;
    f->im[0][i] = a[WIDE] - im;
    f->re[1][i] = a[0] - re;
    f->im[1][i] = a[WIDE] + im;
  }
}

/* What folds contribute to the sum of one power. */
typedef struct weights {
  int folds;
  bool odd, first;
  sunrealtype c[STF_LANES], s[STF_LANES];
} weights;

/* visit[k]: a node of fold k; first: there is no sum yet. */
static weights weights_of(const stf_circle *c, int folds, const int *visit, bool first,
                          int power)
{
  weights w = {.folds = folds, .odd = power & 1, .first = first};
  for (int k = 0; k < folds; k++) {
    const sunrealtype turn = power * angle_of(c, visit[k]), weight = 2.0 / c->points;
    w.c[k] = weight * cos(turn);
    w.s[k] = weight * sin(turn);
  }
  return w;
}

static void add_power(const weights *w, const fold *f, int n, sunrealtype *restrict sum)
{
  for (int i = 0; w->first && i < n; i++) sum[i] = 0;
  for (int k = 0; k < w->folds; k++) {
    const sunrealtype *restrict re = f[k].re[w->odd], *restrict im = f[k].im[w->odd];
    const sunrealtype cosine = w->c[k], sine = w->s[k];
    for (int i = 0; i < n; i++) sum[i] += cosine * re[i] + sine * im[i];
  }
}

/* The good lanes of a batch at `visits` join the sums; partners together. */
static void add(stf_circle *c, const stf_multishift *b, const int *visits, int count,
                bool first)
{
  const sunindextype n = c->scaled.n;
  fold f[STF_LANES];
  weights w[SUMS];
  int folds = 0, lane[STF_LANES], visit[STF_LANES];
  bool pair[STF_LANES];
  for (int q = 0; q < count; q++) {
    if (!b->good[q]) continue;
    lane[folds] = q;
    visit[folds] = visits[q];
    pair[folds] =
      visits[q] % 2 == 0 && q + 1 < count && b->good[q + 1] && visits[q + 1] == visits[q] + 1;
    q += pair[folds]; /* a partner is in this fold already */
    folds++;
  }
  for (int k = 0; k < c->count; k++) w[k] = weights_of(c, folds, visit, first, k - 1);
  for (sunindextype at = 0; at < n; at += BLOCK) {
    const int now = n - at < BLOCK ? (int)(n - at) : BLOCK;
    for (int k = 0; k < folds; k++) fold_lanes(b, lane[k], pair[k], at, now, &f[k]);
    for (int k = 0; k < c->count; k++) add_power(&w[k], f, now, c->sum + k * n + at);
  }
}

static void measure(stf_circle *c)
{
  const sunindextype n = c->scaled.n;
  for (int k = 0; k < c->count; k++) {
    const sunrealtype *sum = c->sum + k * n;
    sunrealtype square[4] = {0};
    sunindextype i = 0;
    for (; i + 4 <= n; i += 4)
      for (int m = 0; m < 4; m++) square[m] += sum[i + m] * sum[i + m];
    for (; i < n; i++) square[0] += sum[i] * sum[i];
    c->square[k] = square[0] + square[1] + square[2] + square[3];
  }
}

/* ---- pivots ------------------------------------------------------------------------------ */

static int fill_batches(stf_circle *c)
{
  STEIF_TRY(stf_sequence_open(c->scaled.pencil, 0, &c->sequence));
  for (int k = 0; k < c->batches; k++)
    STEIF_TRY(stf_multishift_open(c->sequence, &c->batch[k]));
  return STEIF_OK;
}

static steif_shift node(const stf_circle *c, int visit)
{
  const sunrealtype angle = angle_of(c, visit);
  return (steif_shift){c->radius * cos(angle), c->radius * sin(angle)};
}

/* Pivots by KLU at a node, for all batches. The order of the unknowns is that of its analysis
 * and stays. */
static int pivot(stf_circle *c, int visit)
{
  steif_pencil *p = c->scaled.pencil;
  const steif_shift s = node(c, visit);
  forget(c);
  STEIF_TRY(steif_pencil_factor(p, 1, &s));
  p->stats.refactors--; /* a lane repeats this matrix, which counts once */
  const int code = fill_batches(c);
  if (code) forget(c);
  stf_sparse_drop(p, 0);
  c->filled = c->scaled.size;
  return code;
}

/* The values of this circle. */
static int prepare(stf_circle *c)
{
  if (!c->sequence) return pivot(c, 0);
  if (c->filled != c->scaled.size) stf_sequence_fill(c->scaled.pencil, c->sequence);
  c->filled = c->scaled.size;
  return STEIF_OK;
}

/* ---- around the circle ------------------------------------------------------------------- */

/* Nodes for one pass, and what becomes of them. */
typedef struct pass {
  stf_circle *c;
  const stf_polynomial *g;
  int done, count, *visit; /* of them, batch by batch */
  int bad;                 /* those that are left, in front of `visit` */
  sunrealtype error;       /* the largest */
} pass;

static void work(void *task, int i)
{
  const pass *now = task;
  stf_circle *c = now->c;
  stf_multishift *b = &c->batch[i];
  const int from = now->done + i * STF_LANES;
  for (int q = 0; q < STF_LANES; q++) /* lanes that are left over repeat the last node */
    b->s[q] = node(c, now->visit[from + q < now->count ? from + q : now->count - 1]);
  stf_multishift_factor(b, c->careful ? c->sequence->growth : 0, now->g);
  if (now->g) stf_multishift_refine(b, now->g, c->careful ? c->refinements : 0, STF_STEADY);
}

static void join(pass *now, const stf_multishift *b, int from, bool first)
{
  stf_circle *c = now->c;
  steif_pencil_stats *stats = &c->scaled.pencil->stats;
  const int left = now->count - from, count = left < STF_LANES ? left : STF_LANES;
  if (now->g) add(c, b, now->visit + from, count, first);
  for (int q = 0; q < count; q++) {
    if (!b->good[q]) {
      now->visit[now->bad++] = now->visit[from + q];
      continue;
    }
    c->log_det += 2 * (b->log_det[q] - c->scaled.log_scale) / c->points;
    stats->refactors++;
    stats->solves += now->g ? b->solves[q] : 0;
    if (now->g) now->error = fmax(now->error, b->error[q]);
  }
}

/* With the pivots that there are, those of the first node if `own`. */
static void go(pass *now, bool own)
{
  stf_circle *c = now->c;
  now->bad = 0;
  for (now->done = 0; now->done < now->count; now->done += c->batches * STF_LANES) {
    const int left = (now->count - now->done + STF_LANES - 1) / STF_LANES;
    const int batches = left < c->batches ? left : c->batches;
    stf_parallel(c->threads, batches, work, now);
    if (own && !now->done) c->batch->good[0] = c->batch->growth[0] > 0;
    for (int k = 0; k < batches; k++)
      join(now, &c->batch[k], now->done + k * STF_LANES, !own && !now->done && !k);
  }
  now->count = now->bad;
}

/* Nodes with bad pivots go again with those of the first of them. Returns the largest error. */
static int around(stf_circle *c, const stf_polynomial *g, sunrealtype *error)
{
  int visit[MOST / 2];
  pass now = {.c = c, .g = g, .count = c->points / 2, .visit = visit};
  for (int k = 0; k < now.count; k++) visit[k] = k;
  c->log_det = 0;
  go(&now, false);
  c->complete = !now.count && c->batches * STF_LANES >= c->points / 2;
  while (now.count) {
    const int first = visit[0];
    const steif_shift s = node(c, first);
    STEIF_TRY(pivot(c, first));
    c->scaled.pencil->stats.fallbacks++;
    go(&now, true);
    STEIF_CHECK(!now.count || visit[0] != first, c->scaled.ctx, STEIF_SINGULAR,
                "pivots at s = %g%+gi are out of range: scale the equations", s.re, s.im);
  }
  if (g) measure(c);
  *error = now.error;
  return STEIF_OK;
}

int stf_circle_run(stf_circle *c, sunrealtype R, const stf_polynomial *g)
{
  sunrealtype error;
  c->radius = R;
  STEIF_TRY(stf_scaled_set(&c->scaled, R));
  STEIF_TRY(prepare(c));
  STEIF_TRY(around(c, g, &error));
  if (c->careful || error <= STF_PLAIN_SOLVE) return STEIF_OK;
  c->careful = true;
  return around(c, g, &error);
}

/* ---- the same circle again --------------------------------------------------------------- */

int stf_circle_widen(stf_circle *c)
{
  c->batches = most(c);
  c->batch = stf_pool_array(c->scaled.pool, (size_t)c->batches, sizeof *c->batch);
  return c->batch ? STEIF_OK : STEIF_NO_MEMORY;
}

static void solve(void *task, int i)
{
  const pass *now = task;
  stf_multishift *b = &now->c->batch[i];
  stf_multishift_solve(b, now->g);
  if (now->c->careful) stf_multishift_refine(b, now->g, now->c->refinements, STF_STEADY);
}

int stf_circle_again(stf_circle *c, const stf_polynomial *g)
{
  int visit[MOST / 2];
  pass now = {.c = c, .g = g, .count = c->points / 2, .visit = visit};
  if (!c->complete) return stf_circle_run(c, c->radius, g);
  for (int k = 0; k < now.count; k++) visit[k] = k;
  stf_parallel(c->threads, c->batches, solve, &now);
  for (int k = 0; k < c->batches; k++) {
    const int from = k * STF_LANES, left = now.count - from;
    add(c, &c->batch[k], visit + from, left < STF_LANES ? left : STF_LANES, !k);
  }
  return STEIF_OK;
}
