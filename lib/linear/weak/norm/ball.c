/* ball.c: order of a run in H^-m: the worst case over a ball of test functions.
 *
 * In the first layer the error is h^-(k-1) phi(t/h), and where the moments of phi below k - 1 + p are
 * those of the impulses, its m-fold integral is h^(m-k+1) on an interval of length h: a norm of order
 * min(p, m - k + 3/2). Distributions of one support converge weakly for every smooth g exactly if they
 * converge in some H^-m (L. Schwartz, Theorie des distributions, 1966).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "norm.h"
#include <steif/method.h>
#include "table.h"
#include <math.h>
#include <stdio.h>

#define USABLE 0.1 /* of a norm, the most that rounding may be */
/* Smooth values have errors of TRUTH of the size of the run. */
#define TRUTH 1e-15
#define MESHED 1e-9 /* of a break, its distance from a mesh that counts as none */
enum { LARGEST = 1 << 24, CELLS = 1 << 20 }; /* numbers of an array; B-splines */

typedef struct ball {
  stf_measure measure;
  stf_events events[3]; /* in double, long double, shaken */
  stf_panel *panel;     /* parts of steps between breaks of f, */
  size_t panels;
  sunrealtype
    *x; /* in each segment between breaks x at its beginning and smooth values at STF_NODES
                     points of its panels, rows of n; */
  sunrealtype *t; /* their times */
  size_t masses;  /* of a step; 0: densities */
  size_t steps;   /* of the last row */
  int most;
  sunrealtype inside, fitting; /* a break inside a step, NaN: none; a step without any */
  steif_weak_ball *result;
} ball;

/* ---- room ------------------------------------------------------------------------------------- */

/* Integrals of runs in many digits. */
static int claim_states(ball *b, size_t values)
{
  stf_measure *w = &b->measure;
  const size_t most = (size_t)b->most;
  if (!w->query->exact) return STEIF_OK;
  STEIF_CHECK(
    values * most <= LARGEST, w->ctx, STEIF_BAD_INPUT,
    "%zu values in %d spaces are too many for norms in many digits: ask for fewer rows", values,
    b->most);
  for (int i = 0; i < 2; i++) {
    b->events[i].most = b->most;
    b->events[i].state = stf_allocate(w->ctx, values * most, sizeof(long double));
    if (!b->events[i].state) return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

static int claim(ball *b)
{
  stf_measure *w = &b->measure;
  size_t rows = 1;
  for (size_t i = 0; i < w->mesh.count; i++)
    rows += stf_measure_segment(w, i).steps * (b->masses ? b->masses : 1) + 1;
  const size_t n = (size_t)w->subject.n, jumps = w->subject.jumps, panels = b->steps + jumps,
               nodes = panels * STF_NODES + jumps + 1;
  STEIF_CHECK(rows * n <= LARGEST && nodes * n <= LARGEST, w->ctx, STEIF_BAD_INPUT,
              "%zu steps of %zu unknowns are too many for a norm: ask for fewer rows", b->steps,
              n);
  for (int i = 0; i < 3; i++) {
    b->events[i].room = rows;
    b->events[i].at = stf_allocate(w->ctx, rows * (n + 1), sizeof(long double));
    if (!b->events[i].at) return STEIF_NO_MEMORY;
    b->events[i].value = b->events[i].at + rows;
  }
  STEIF_TRY(claim_states(b, rows * n));
  b->t = stf_allocate(w->ctx, nodes * (n + 1), sizeof *b->t);
  b->panel = stf_allocate(w->ctx, panels + 1, sizeof *b->panel);
  if (!b->t || !b->panel) return STEIF_NO_MEMORY;
  b->x = b->t + nodes;
  return STEIF_OK;
}

static void release(ball *b)
{
  for (int i = 0; i < 3; i++) {
    stf_release(b->measure.ctx, b->events[i].at);
    stf_release(b->measure.ctx, b->events[i].state);
    b->events[i].at = b->events[i].state = NULL;
  }
  stf_release(b->measure.ctx, b->t);
  stf_release(b->measure.ctx, b->panel);
  b->t = NULL, b->panel = NULL;
}

/* ---- one row ---------------------------------------------------------------------------------- */

/* Break `i` in steps, a whole number where it is one to rounding; after the last the end t1. */
static long double place(const ball *b, size_t i, sunrealtype h)
{
  const stf_subject *s = &b->measure.subject;
  if (i >= s->jumps) return fminl(s->weight.t1 / h, (long double)b->steps);
  const long double at = (long double)s->jump[i].t / h;
  return fabsl(at - roundl(at)) <= (long double)MESHED * fmaxl(1, at) ? roundl(at) : at;
}

/* The panels from break i - 1 to break i, in rows of b->x from `row` on; the next row. */
static size_t cut(ball *b, size_t i, sunrealtype h, size_t row)
{
  const stf_subject *s = &b->measure.subject;
  const size_t n = (size_t)s->n;
  const long double from = i ? place(b, i - 1, h) : 0, to = place(b, i, h);
  long double node[STF_NODES], weight[STF_NODES];
  stf_gauss(STF_NODES, node, weight);
  b->t[row++] = i ? s->jump[i - 1].t : 0;
  for (long double at = from; at < to; row += STF_NODES) {
    stf_panel *p = b->panel + b->panels++;
    *p = (stf_panel){.from = at, .to = fminl(floorl(at) + 1, to), .x = b->x + row * n};
    if (at <= from && i > 0) p->impulses = s->jump[i - 1].at.count, p->c = s->jump[i - 1].at.c;
    for (size_t k = 0; k < STF_NODES; k++)
      b->t[row + k] = (sunrealtype)(h * (at + (p->to - at) * node[k]));
    at = p->to;
  }
  return row;
}

/* Panels, the smooth solution at their nodes, and the impulses. */
static int truth(ball *b, sunrealtype h)
{
  stf_subject *s = &b->measure.subject;
  b->panels = 0;
  for (size_t i = 0, row = 0; i <= s->jumps; i++) {
    const size_t next = cut(b, i, h, row);
    STEIF_TRY(stf_subject_segment(s, i, next - row, b->t + row, b->x + row * (size_t)s->n));
    row = next;
  }
  b->panel->impulses = s->block.k ? s->block.k - 1 : s->impulse.count;
  b->panel->c = s->block.k ? s->block.c : s->impulse.c;
  return STEIF_OK;
}

/* a -= b */
static void subtract(const stf_events *a, const stf_events *b, int n)
{
  const size_t values = a->count * (size_t)n;
  for (size_t i = 0; i < values; i++) a->value[i] -= b->value[i];
  for (size_t i = 0; a->state && i < values * (size_t)a->most; i++) a->state[i] -= b->state[i];
}

/* Norms of all components together. */
static void norms(ball *b, const stf_events *events, const stf_panel *panel, sunrealtype h,
                  stf_cells *cells, long double *norm)
{
  const stf_measure *w = &b->measure;
  long double one[STF_SPACES];
  for (int m = 0; m < b->most; m++) norm[m] = 0;
  for (int j = w->first; j < w->first + w->count; j++) {
    stf_dual_norm(events, w->subject.n, j, panel, h, b->steps, w->subject.weight.t1, b->most,
                  cells, one);
    for (int m = 0; m < b->most; m++) norm[m] = hypotl(norm[m], one[m]);
  }
}

/* The sum of the norms in H^-m of delta, delta', .., `count` of them, each times t1^(its order):
 * ||t^j / j!|| on [0, 1] with j = m - 1 - i. */
static long double impulses_norm(int count, int m)
{
  long double sum = 0;
  for (int i = 0; i < count && i < m; i++) sum += 1 / (tgammal(m - i) * sqrtl(2 * (m - i) - 1));
  return sum;
}

/* The largest number of impulses that belong to one time. */
static int impulses_of(const ball *b)
{
  int most = 0;
  for (size_t i = 0; i < b->panels; i++)
    if (b->panel[i].impulses > most) most = b->panel[i].impulses;
  return most;
}

/* The run, and what tells its rounding: in double, long double and shaken, or twice in many digits. */
static int make_runs(ball *b)
{
  stf_measure *w = &b->measure;
  if (!w->query->exact) return stf_measure_run(w, (size_t)w->halvings);
  STEIF_TRY(stf_exact_events(w, false, b->events));
  return stf_exact_events(w, true, b->events + 1);
}

/* Norms of differences of the runs: made + 2 shaken. */
static void roundings(ball *b, sunrealtype h, long double *level)
{
  const int n = b->measure.subject.n;
  long double shaken[STF_SPACES];
  const bool exact = b->measure.query->exact;
  if (!exact) subtract(b->events + 2, b->events + 1, n);
  subtract(b->events + 1, b->events, n);
  norms(b, b->events + 1, NULL, h, NULL, level);
  if (!exact) norms(b, b->events + 2, NULL, h, NULL, shaken);
  for (int m = 0; m < b->most; m++) level[m] = exact ? 2 * level[m] : level[m] + 2 * shaken[m];
}

static int measure_row(ball *b, sunrealtype h, steif_ball_row *row)
{
  stf_measure *w = &b->measure;
  const stf_subject *s = &w->subject;
  const long double t1 = s->weight.t1;
  long double error[STF_SPACES], made[STF_SPACES], size[STF_SPACES];
  stf_cells cells = {.m = b->result->m, .count = w->query->cells};
  const sunrealtype known =
    stf_subject_rounding(s) * (sunrealtype)t1 * (sunrealtype)(s->jumps + 1);
  w->events = b->events;
  STEIF_TRY(make_runs(b));
  STEIF_TRY(truth(b, h));
  norms(b, b->events, b->panel, h, cells.count ? &cells : NULL, error);
  norms(b, b->events, NULL, h, NULL, size);
  roundings(b, h, made);
  for (int m = 0; m < b->most; m++) {
    const long double level =
      made[m] + TRUTH * size[m] + known * impulses_norm(impulses_of(b), m + 1);
    row[m] = (steif_ball_row){h, (sunrealtype)error[m], (sunrealtype)level, NAN, 0, NAN};
    row[m].usable = isfinite(error[m]) && level <= USABLE * error[m];
  }
  if (cells.count)
    row[cells.m - 1].splines = (sunrealtype)(powl(t1, 0.5L - cells.m) * sqrtl(cells.square));
  return STEIF_OK;
}

/* ---- verdicts --------------------------------------------------------------------------------- */

/* The last row is too long: for what. */
static void say_long(steif_weak_ball *r, sunrealtype h, sunrealtype longest,
                     const char *fastest)
{
  snprintf(r->verdict, sizeof r->verdict,
           "undecided: steps of %.3g do not resolve %s; take them below %.2g (.h), or another "
           "interval (.g->t1)",
           h, fastest, longest);
}

/* A break inside a step: how far in it lies changes from row to row, and errors with it. */
static void say_inside(ball *b)
{
  steif_weak_ball *r = b->result;
  const stf_judged j = {
    .inside = b->inside, .fitting = b->fitting, .able = b->measure.mesh.able};
  for (int i = 0; i < r->count; i++) r->space[i].converges = -1, r->space[i].order = NAN;
  r->converges = -1;
  stf_say_inside(&j, "norms", r->verdict, sizeof r->verdict);
}

/* ---- the measure ------------------------------------------------------------------------------ */

static int check(const stf_measure *w, int m)
{
  const steif_weak_query *q = w->query;
  const int k = w->subject.index;
  STEIF_CHECK(
    w->longer, w->ctx, STEIF_UNSUPPORTED,
    "norms take a second run in long double, which there is of be, bdf, glm and Runge-Kutta "
    "methods with regular A and at most 400 stage values, not of '%s' with %d unknowns",
    q->method, w->subject.n);
  STEIF_CHECK(!q->exact || !w->subject.apart.linear.E || w->as_given, w->ctx, STEIF_UNSUPPORTED,
              "E and F have this index to rounding only, not to the last bit: a run in many "
              "digits would be one on another system; leave .exact out");
  STEIF_CHECK(q->cells >= 0 && q->cells <= CELLS, w->ctx, STEIF_BAD_INPUT,
              "%d cells of B-splines were asked for: 1 to %d, or 0 for none", q->cells, CELLS);
  STEIF_CHECK(m == 0 || (m >= 1 && m >= k - 1 && m <= STF_SPACES), w->ctx, STEIF_BAD_INPUT,
              "H^-%d does not hold the impulses of index %d: m is %d to %d", m, k,
              k > 2 ? k - 1 : 1, STF_SPACES);
  return STEIF_OK;
}

static int measure(ball *b, steif_ball_row *row)
{
  stf_measure *w = &b->measure;
  const steif_weak_query *q = w->query;
  steif_weak_ball *r = b->result;
  steif_ball_row all[STF_SPACES], *rows;
  sunrealtype longest;
  const char *fastest;
  STEIF_TRY(stf_measure_components(w));
  STEIF_TRY(stf_measure_longest(w, &longest, &fastest));
  if (!(rows = stf_allocate(w->ctx, q->rows * STF_SPACES, sizeof *rows)))
    return STEIF_NO_MEMORY;
  int code = STEIF_OK;
  for (size_t i = 0; i < q->rows && !code; i++) {
    w->halvings = (int)i;
    const sunrealtype h = stf_measure_step(w);
    b->steps = stf_measure_steps(w);
    code = claim(b);
    if (!code) code = measure_row(b, h, all);
    release(b);
    for (int m = 0; m < b->most && !code; m++) {
      steif_ball_row *to = rows + i * STF_SPACES + m;
      *to = all[m];
      if (i > 0 && isnan(b->inside)) to->order = log2((to - STF_SPACES)->norm / to->norm);
      if (m + 1 == r->m) row[i] = *to;
    }
    if (!code) code = stf_measure_tell(w, i);
  }
  for (int j = 0; j < r->count && !code; j++)
    stf_ball_judge(rows + r->space[j].m - 1, q->rows, STF_SPACES, longest, r->space + j);
  if (!code && isnan(b->inside)) stf_ball_say(r, q->rows, !q->exact);
  const sunrealtype last = ldexp(w->h, 1 - (int)q->rows);
  if (!code && last > longest) say_long(r, last, longest, fastest);
  if (!code && !isnan(b->inside)) say_inside(b);
  stf_release(w->ctx, rows);
  return code;
}

/* What happens at breaks of f, and whether they are on the mesh. */
static int find_breaks(ball *b)
{
  stf_measure *w = &b->measure;
  const steif_weak_query *q = w->query;
  const sunrealtype t1 = (sunrealtype)w->subject.weight.t1;
  sunrealtype accuracy;
  char how[160];
  b->inside = NAN, b->fitting = NAN;
  if (!q->break_count) return STEIF_OK;
  STEIF_TRY(stf_subject_pair(&w->subject, w->exact, &accuracy, how, sizeof how));
  const size_t inside = stf_break_inside(q->break_count, q->breaks, t1, w->h);
  if (inside == q->break_count || w->mesh.anew) return STEIF_OK;
  b->inside = q->breaks[inside];
  b->fitting = stf_break_step(q->break_count, q->breaks, t1, w->h);
  return STEIF_OK;
}

static int open(ball *b, int m)
{
  stf_measure *w = &b->measure;
  steif_weak_ball *r = b->result;
  steif_method_info info;
  const int k = w->subject.index, least = k > 2 ? k - 1 : 1;
  STEIF_TRY(steif_method_find(w->ctx, w->query->method, &info));
  STEIF_TRY(check(w, m));
  b->masses =
    w->query->convention == STEIF_STAGE ? (size_t)info.stages : w->query->convention == STEIF_C;
  r->index = k;
  stf_mesh_say(&w->mesh, r->mesh, sizeof r->mesh);
  r->m = m ? m : (int)fmin(fmax(k + info.order - 1, least), STF_SPACES);
  b->most = (int)fmin(fmax(k + info.order + 1, r->m), STF_SPACES);
  r->count = b->most - least + 1;
  for (int i = 0; i < r->count; i++) r->space[i] = (steif_ball_space){.m = least + i};
  for (int i = 0; i < 3; i++) b->events[i].masses = b->masses > 0;
  return STEIF_OK;
}

int steif_weak_measure_ball(steif_context *ctx, const steif_weak_query *query, int m,
                            steif_ball_row *row, steif_weak_ball *result)
{
  STEIF_CHECK(query && row && result, ctx, STEIF_BAD_INPUT,
              "a query and places for rows and result are needed, got NULL");
  ball b = {.result = result};
  *result = (steif_weak_ball){.converges = -1};
  STEIF_TRY(stf_measure_check(ctx, query));
  int code = stf_measure_open(ctx, query, &b.measure);
  if (!code) code = open(&b, m);
  if (!code) code = find_breaks(&b);
  if (!code) code = measure(&b, row);
  stf_measure_close(&b.measure);
  return code;
}
