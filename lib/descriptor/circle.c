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

/* Unknowns from which on threads pay. */
enum { CROWD = 2000, PAIRS = STF_LANES / 2 };

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
  c->threads = s->n >= CROWD ? stf_threads(ctx) : 1;
  const int most = (a->points / 2 + STF_LANES - 1) / STF_LANES;
  c->batches = most < c->threads ? most : c->threads;
  c->batch = stf_claim(s->pool, (size_t)c->batches, sizeof *c->batch);
  c->sum = stf_claim(s->pool, n * (size_t)c->room, size);
  c->square = stf_claim(s->pool, (size_t)c->room, size);
  return c->batch && c->sum && c->square ? STEIF_OK : STEIF_NO_MEMORY;
}

/* The pivots, and what goes with them. */
static void forget(stf_circle *c)
{
  for (int k = 0; c->batch && k < c->batches; k++) stf_batch_close(&c->batch[k]);
  stf_sequence_close(&c->sequence);
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

/* ---- sums over the nodes ------------------------------------------------------------------ */

/* Nodes are visited in pairs that mirror each other in the imaginary axis, theta and pi - theta:
 * e^{-i k theta} of both differ by signs alone. Without a partner: i R. */
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

static void fold_pair(const stf_batch *batch, int lane, bool pair, sunindextype at, int n,
                      fold *restrict f)
{
  enum { WIDE = STF_LANES };
  const sunrealtype *restrict a = batch->x + 2 * WIDE * at + lane;
  for (int i = 0; i < n; i++, a += 2 * WIDE) {
    const sunrealtype re = pair ? a[1] : 0, im = pair ? a[WIDE + 1] : 0;
    f->re[0][i] = a[0] + re, f->im[0][i] = a[WIDE] - im;
    f->re[1][i] = a[0] - re, f->im[1][i] = a[WIDE] + im;
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

static sunrealtype squares(const sunrealtype *restrict sum, int n)
{
  sunrealtype square = 0;
  for (int i = 0; i < n; i++) square += sum[i] * sum[i];
  return square;
}

/* The solutions of visits from .. from + visits - 1, which are in a batch, join the sums. */
static void add(stf_circle *c, const stf_batch *batch, int from, int visits)
{
  const sunindextype n = c->scaled.n;
  fold f[PAIRS];
  weights w[SUMS];
  for (int k = 0; k < c->count; k++)
    c->square[k] = 0, w[k] = weights_of(c, from, visits, k - 1);
  for (sunindextype at = 0; at < n; at += BLOCK) {
    const int now = n - at < BLOCK ? (int)(n - at) : BLOCK;
    for (int k = 0; k < visits; k += 2) fold_pair(batch, k, k + 1 < visits, at, now, &f[k / 2]);
    for (int k = 0; k < c->count; k++) {
      sunrealtype *sum = c->sum + k * n + at;
      add_power(&w[k], f, now, sum);
      if (w[k].last) c->square[k] += squares(sum, now);
    }
  }
}

/* ---- pivots -------------------------------------------------------------------------------- */

static int fill_batches(stf_circle *c)
{
  STEIF_TRY(stf_sequence_open(c->scaled.pencil, 0, &c->sequence));
  for (int k = 0; k < c->batches; k++) STEIF_TRY(stf_batch_open(c->sequence, &c->batch[k]));
  return STEIF_OK;
}

/* The pivots that the pencil has in use become those of all batches. The order of the unknowns is that
 * of its analysis and stays. */
static int adopt(stf_circle *c)
{
  forget(c);
  c->replaced = false;
  c->filled = c->scaled.size;
  const int code = fill_batches(c);
  if (code) forget(c);
  return code;
}

/* ---- a node by itself ------------------------------------------------------------------------ */

/* The solution in one lane, by the factors of the pencil. */
static int solve_alone(stf_circle *c, stf_batch *b, int lane, const stf_polynomial *g)
{
  stf_scaled *s = &c->scaled;
  const stf_sequence *q = c->sequence;
  enum { WIDE = STF_LANES };
  if (!c->r) c->r = stf_claim(s->pool, 4 * (size_t)s->n, sizeof *c->r);
  if (!c->r) return STEIF_NO_MEMORY;
  sunrealtype *x = c->r, *r = c->r + 2 * s->n;
  stf_batch_load(b, g, b->r);
  const sunrealtype *from = b->r + lane;
  for (int sweep = 0; sweep <= c->refinements; sweep++) {
    sunrealtype *to = sweep ? r : x;
    for (int k = 0; k < q->n; k++) {
      to[2 * q->equation[k]] = from[2 * WIDE * (sunindextype)k];
      to[2 * q->equation[k] + 1] = from[2 * WIDE * (sunindextype)k + WIDE];
    }
    if (!sweep)
      stf_scaled_direct(s, 0, x);
    else if (!stf_scaled_refine(s, 0, sweep == 1, x, r))
      break;
  }
  for (int k = 0; k < q->n; k++) {
    b->x[2 * WIDE * (sunindextype)k + lane] = x[2 * q->unknown[k]];
    b->x[2 * WIDE * (sunindextype)k + WIDE + lane] = x[2 * q->unknown[k] + 1];
  }
  b->error[lane] = 0;
  return STEIF_OK;
}

/* A lane with bad pivots: KLU looks for better ones, which serve from the next circle on. */
static int alone(stf_circle *c, stf_batch *b, int lane, const stf_polynomial *g)
{
  steif_pencil *p = c->scaled.pencil;
  p->trusted = false;
  STEIF_TRY(steif_pencil_factor(p, 1, &b->s[lane]));
  if (c->counts) STEIF_TRY(stf_pencil_logdet(p, 0, &b->log_det[lane]));
  c->replaced = true;
  return g ? solve_alone(c, b, lane, g) : STEIF_OK;
}

/* ---- around the circle ------------------------------------------------------------------------- */

/* What a thread does for one batch. */
typedef struct round_ {
  stf_circle *c;
  const stf_polynomial *g;
} round_;

static void work(void *task, int i)
{
  const round_ *now = task;
  stf_circle *c = now->c;
  stf_batch_factor(&c->batch[i], c->careful ? c->sequence->growth : 0);
  if (now->g)
    stf_batch_solve(&c->batch[i], now->g, c->careful ? c->refinements : 0, STF_STEADY);
}

static steif_shift node(const stf_circle *c, int visit)
{
  const sunrealtype angle = angle_of(c, visit);
  return (steif_shift){c->radius * cos(angle), c->radius * sin(angle)};
}

/* The pivots of the first node, and the values of this circle. */
static int prepare(stf_circle *c)
{
  steif_pencil *p = c->scaled.pencil;
  if (c->sequence) {
    if (c->filled != c->scaled.size) stf_sequence_fill(p, c->sequence);
    c->filled = c->scaled.size;
    return STEIF_OK;
  }
  const steif_shift first = node(c, 0);
  p->trusted = !c->careful;
  STEIF_TRY(steif_pencil_factor(p, 1, &first));
  p->stats.refactors--; /* a lane repeats this matrix, which counts once */
  return adopt(c);
}

/* Lanes that are left over repeat the last node. */
static void place(stf_circle *c, int from, int batches)
{
  const int half = c->points / 2;
  for (int k = 0; k < batches * STF_LANES; k++)
    c->batch[k / STF_LANES].s[k % STF_LANES] = node(c, from + k < half ? from + k : half - 1);
}

/* The visits from .. of one batch join; false: a solution is not steady, and nobody has been
 * careful. */
static int join(stf_circle *c, stf_batch *b, int from, const stf_polynomial *g, bool *good)
{
  const int half = c->points / 2, visits = half - from < STF_LANES ? half - from : STF_LANES;
  steif_pencil_stats *stats = &c->scaled.pencil->stats;
  for (int k = 0; k < visits; k++) {
    if (!b->good[k]) STEIF_TRY(alone(c, b, k, g));
    c->log_det += 2 * (b->log_det[k] - c->scaled.log_scale) / c->points;
    stats->refactors += b->good[k];
    stats->solves += g && b->good[k] ? b->solves[k] : 0;
    *good &= !g || c->careful || b->error[k] <= GOOD;
  }
  if (g) add(c, b, from, visits);
  return STEIF_OK;
}

/* `good`: as far as one can see. */
static int around(stf_circle *c, const stf_polynomial *g, bool *good)
{
  const int half = c->points / 2;
  c->log_det = 0;
  *good = true;
  for (int done = 0; done < half; done += c->batches * STF_LANES) {
    const int left = (half - done + STF_LANES - 1) / STF_LANES;
    const int now = left < c->batches ? left : c->batches;
    place(c, done, now);
    stf_crew(c->threads, now, work, &(round_){c, g});
    for (int k = 0; k < now; k++)
      STEIF_TRY(join(c, &c->batch[k], done + k * STF_LANES, g, good));
  }
  return c->replaced ? adopt(c) : STEIF_OK;
}

int stf_circle_run(stf_circle *c, sunrealtype R, const stf_polynomial *g)
{
  bool good;
  c->radius = R;
  STEIF_TRY(stf_scaled_set(&c->scaled, R));
  STEIF_TRY(prepare(c));
  STEIF_TRY(around(c, g, &good));
  if (good) return STEIF_OK;
  c->careful = true;
  return around(c, g, &good);
}
