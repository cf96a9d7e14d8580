/* circle.c: Laurent coefficients by the trapezoidal rule on |s| = R,
 *   R^i x_i = (1/m) sum_j e^{-i theta_j} x(s_j),  s_j = R e^{i theta_j}, theta_j = 2 pi (j+1/2)/m,
 * which is exact up to x_{i +- m}, x_{i +- 2m}, ...; the mean of log |det(s_j E + F)| comes
 * along. L. N. Trefethen and J. A. C. Weideman, SIAM Review 56 (2014).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle_parts.h"
#include "pencil.h"
#include <math.h>
#include <string.h>

enum { POINTS = 16, REFINEMENTS = 2, INDEX_MOST = 8, SEED = 1 };

/* Coefficient i also collects that of i - points, which has to be of order -ALIAS or less. */
enum { ALIAS = 3 };

/* Unknowns from which on threads gain more than they cost. */
enum { THREADS_FROM = 2000 };

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
  STEIF_CHECK(a->points >= 4 && a->points <= STF_CIRCLE_MOST && a->points % 2 == 0, ctx,
              STEIF_BAD_INPUT,
              "%d points on the circle: give an even number from 4 to %d, or 0 for %d",
              a->points, (int)STF_CIRCLE_MOST, (int)POINTS);
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

/* That of one process. */
static int share(const stf_circle *c)
{
  const int processes = stf_circle_processes(c);
  return (most(c) + processes - 1) / processes;
}

static int fill(steif_context *ctx, SUNMatrix E, SUNMatrix F, stf_circle *c)
{
  stf_scaled *s = &c->scaled;
  STEIF_TRY(stf_scaled_open(ctx, E, F, s));
  s->pencil->many_shifts = true;
  const size_t n = (size_t)s->n, size = sizeof(sunrealtype);
  c->threads = s->n >= THREADS_FROM ? stf_threads(ctx) : 1;
  c->team = stf_team(ctx, &c->team_number);
  c->batches = share(c) < c->threads ? share(c) : c->threads;
  c->batch = stf_pool_array(s->pool, (size_t)c->batches, sizeof *c->batch);
  c->sum = stf_pool_array(s->pool, n * (size_t)c->room, size);
  c->square = stf_pool_array(s->pool, (size_t)c->room, size);
  return c->batch && c->sum && c->square ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Is the team the one that the circle was opened with? */
static bool same_team(stf_circle *c)
{
  long long number;
  stf_team(c->scaled.ctx, &number);
  if (c->team && number != c->team_number) c->team = NULL, c->complete = false;
  return c->team != NULL;
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
  if (same_team(*circle)) stf_circle_leave(*circle);
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
  const sunrealtype angle = stf_circle_angle(c, visit);
  return (steif_shift){c->radius * cos(angle), c->radius * sin(angle)};
}

/* The order of the unknowns is that of KLU's analysis and stays. */
int stf_circle_pivot(stf_circle *c, int visit)
{
  steif_pencil *p = c->scaled.pencil;
  const steif_shift s = node(c, visit);
  forget(c);
  c->pivots++;
  c->from_visit = visit, c->from_radius = c->radius, c->from_at = c->scaled.size;
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
  if (!c->sequence) return stf_circle_pivot(c, 0);
  if (c->filled != c->scaled.size) stf_sequence_fill(c->scaled.pencil, c->sequence);
  c->filled = c->scaled.size;
  return STEIF_OK;
}

/* ---- around the circle ------------------------------------------------------------------- */

void stf_circle_work(void *pass, int i)
{
  const stf_pass *now = pass;
  stf_circle *c = now->c;
  stf_multishift *b = &c->batch[i];
  const int from = now->done + i * STF_LANES;
  for (int q = 0; q < STF_LANES; q++) /* lanes that are left over repeat the last node */
    b->s[q] = node(c, now->visit[from + q < now->count ? from + q : now->count - 1]);
  stf_multishift_factor(b, c->careful ? c->sequence->growth : 0, now->g);
  if (now->g) stf_multishift_refine(b, now->g, c->careful ? c->refinements : 0, STF_STEADY);
}

static void join(stf_pass *now, const stf_multishift *b, int from, bool first)
{
  stf_circle *c = now->c;
  steif_pencil_stats *stats = &c->scaled.pencil->stats;
  const int left = now->count - from, count = left < STF_LANES ? left : STF_LANES;
  if (now->g) stf_circle_add(c, b, now->visit + from, count, first);
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

/* Those of the next round: ours, then those of the others. */
static int round_of(stf_pass *now, bool own)
{
  stf_circle *c = now->c;
  const int left = (now->count - now->done + STF_LANES - 1) / STF_LANES,
            room = c->batches * stf_circle_processes(c), batches = left < room ? left : room,
            ours = stf_circle_first(c, batches, 1);
  int code = stf_circle_hand_out(now, batches, true);
  if (code) return code;
  stf_parallel(c->threads, ours, stf_circle_work, now);
  if (own && !now->done) c->batch->good[0] = c->batch->growth[0] > 0;
  for (int k = 0; k < ours; k++)
    join(now, &c->batch[k], now->done + k * STF_LANES, !own && !now->done && !k);
  for (int k = ours; k < batches; k++) {
    stf_multishift b;
    const int taken = stf_circle_take(now, batches, k, &b);
    if (!code && !taken) join(now, &b, now->done + k * STF_LANES, false);
    if (!code) code = taken;
  }
  return code;
}

/* With the pivots that there are, those of the first node if `own`. */
static int go(stf_pass *now, bool own)
{
  const int room = now->c->batches * stf_circle_processes(now->c);
  now->bad = 0;
  for (now->done = 0; now->done < now->count; now->done += room * STF_LANES)
    STEIF_TRY(round_of(now, own));
  now->count = now->bad;
  return STEIF_OK;
}

/* Nodes with bad pivots go again with those of the first of them. Returns the largest error. */
static int around(stf_circle *c, const stf_polynomial *g, sunrealtype *error)
{
  int visit[STF_CIRCLE_MOST / 2];
  stf_pass now = {.c = c, .g = g, .count = c->points / 2, .visit = visit};
  for (int k = 0; k < now.count; k++) visit[k] = k;
  c->log_det = 0;
  STEIF_TRY(go(&now, false));
  c->complete = !now.count && c->batches * stf_circle_processes(c) >= most(c);
  while (now.count) {
    const int first = visit[0];
    const steif_shift s = node(c, first);
    STEIF_TRY(stf_circle_pivot(c, first));
    c->scaled.pencil->stats.fallbacks++;
    STEIF_TRY(go(&now, true));
    STEIF_CHECK(!now.count || visit[0] != first, c->scaled.ctx, STEIF_SINGULAR,
                "pivots at s = %g%+gi are out of range: scale the equations", s.re, s.im);
  }
  if (g) stf_circle_measure(c);
  *error = now.error;
  return STEIF_OK;
}

int stf_circle_run(stf_circle *c, sunrealtype R, const stf_polynomial *g)
{
  sunrealtype error;
  same_team(c);
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
  c->batches = share(c);
  c->batch = stf_pool_array(c->scaled.pool, (size_t)c->batches, sizeof *c->batch);
  return c->batch ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_circle_solve(void *pass, int i)
{
  const stf_pass *now = pass;
  stf_multishift *b = &now->c->batch[i];
  stf_multishift_solve(b, now->g);
  if (now->c->careful) stf_multishift_refine(b, now->g, now->c->refinements, STF_STEADY);
}

static void add(const stf_pass *now, int k, const stf_multishift *b)
{
  const int from = k * STF_LANES, left = now->count - from;
  stf_circle_add(now->c, b, now->visit + from, left < STF_LANES ? left : STF_LANES, !k);
}

int stf_circle_again(stf_circle *c, const stf_polynomial *g)
{
  int visit[STF_CIRCLE_MOST / 2];
  stf_pass now = {.c = c, .g = g, .count = c->points / 2, .visit = visit};
  same_team(c);
  if (!c->complete) return stf_circle_run(c, c->radius, g);
  for (int k = 0; k < now.count; k++) visit[k] = k;
  const int ours = stf_circle_first(c, most(c), 1);
  int code = stf_circle_hand_out(&now, most(c), false);
  if (code) return code;
  stf_parallel(c->threads, ours, stf_circle_solve, &now);
  for (int k = 0; k < ours; k++) add(&now, k, &c->batch[k]);
  for (int k = ours; k < most(c); k++) {
    stf_multishift b;
    const int taken = stf_circle_take(&now, most(c), k, &b);
    if (!code && !taken) add(&now, k, &b);
    if (!code) code = taken;
  }
  return code;
}
