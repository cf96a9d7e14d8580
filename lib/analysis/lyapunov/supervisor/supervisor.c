/* supervisor.c: windows that are made again with shorter steps while the numbers grow and the
 * problem decays.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "region.h"
#include "tangent.h"
#include <math.h>
#include <steif/supervisor.h>
#include <string.h>

/* Where a window begins and can begin again. */
typedef struct point {
  sunrealtype t, log, h, G; /* log: of |w| / |w_0|; h: last step; G: of the sum */
  sunrealtype t_half, log_half;
} point;

typedef struct guard {
  steif_context *ctx;
  const char *method;
  steif_options options;
  steif_supervision how;
  stf_tangent tangent;
  steif_solver *solver; /* at work, or none */
  sunrealtype *z, *saved;
  point now, start;
  sunrealtype t1, half, size, cap; /* size: |w| now */
  long steps;                      /* in this window */
  int row;                         /* windows of real growth, to the last */
  steif_supervised *facts;
} guard;

/* -- solvers ----------------------------------------------------------------------------- */

static void close_solver(guard *g)
{
  if (!g->solver) return;
  steif_stats *all = &g->facts->cost;
  const steif_stats *part = steif_statistics(g->solver);
  all->steps += part->steps;
  all->rejected += part->rejected;
  all->nfe += part->nfe;
  all->nje += part->nje;
  all->nlu += part->nlu;
  all->nsolve += part->nsolve;
  all->newton += part->newton;
  all->newton_fails += part->newton_fails;
  all->h_last = part->h_last;
  all->cpu_s += part->cpu_s;
  steif_solver_free(&g->solver);
}

/* Goes on from z. A multistep method begins with its first order: the first step is short, since
 * its error tilts w as much as a whole window does later. */
static int open_solver(guard *g)
{
  steif_problem *p = &g->tangent.pair;
  steif_options o = g->options;
  p->y0 = g->z;
  p->t0 = g->now.t;
  p->t1 = o.t1 = g->t1;
  if (g->now.h > 0) o.h0 = fmin(STF_TAKE_OVER * fmin(g->now.h, g->cap), g->t1 - g->now.t);
  if (isfinite(g->cap)) o.h_max = o.h_max > 0 ? fmin(o.h_max, g->cap) : g->cap;
  g->size = stf_tangent_size(&g->tangent, g->z);
  STEIF_CHECK(g->size > 0 && isfinite(g->size), g->ctx, STEIF_NOT_FINITE,
              "the supervised solution w has the norm %g at t = %.12g", g->size, g->now.t);
  g->solver = steif_solver_new(g->ctx, p, g->method, &o);
  return g->solver ? STEIF_OK : steif_status(g->ctx);
}

static int step(guard *g)
{
  if (!g->solver) STEIF_TRY(open_solver(g));
  STEIF_TRY(steif_solve_step(g->solver));
  point *now = &g->now;
  memcpy(g->z, N_VGetArrayPointer(steif_solution(g->solver)),
         (size_t)g->tangent.pair.n * sizeof *g->z);
  const sunrealtype size = stf_tangent_size(&g->tangent, g->z), t = steif_time(g->solver);
  const sunrealtype gain = log(size / g->size);
  now->h = t - now->t;
  now->t = t;
  now->log += gain;
  now->G = fmax(0, now->G + gain + g->how.rate * now->h);
  g->size = size;
  g->steps++;
  g->facts->peak = fmax(g->facts->peak, now->log);
  if (isnan(now->t_half) && t >= g->half) {
    now->t_half = t;
    now->log_half = now->log;
  }
  return STEIF_OK;
}

/* -- windows ----------------------------------------------------------------------------- */

static void lower_cap(guard *g)
{
  const sunrealtype mean = (g->now.t - g->start.t) / (sunrealtype)g->steps;
  g->cap = g->how.shrink * fmin(g->cap, mean);
  close_solver(g);
}

/* On to the first step that ends at t or after it. */
static int attempt(guard *g, sunrealtype t, steif_supervised_window *out)
{
  g->steps = 0;
  while (g->now.t < t) {
    STEIF_TRY(step(g));
    if (g->how.rule == STEIF_SUPERVISE_SUM && g->now.G > g->how.swing) {
      g->facts->triggers++;
      g->now.G = 0;
      lower_cap(g);
    }
  }
  const sunrealtype span = g->now.t - g->start.t;
  out->t = g->now.t;
  out->log = g->now.log;
  out->mu = (g->now.log - g->start.log) / span;
  out->h = span / (sunrealtype)g->steps;
  return STEIF_OK;
}

/* Again with shorter steps until it decays, the steps have no say, or it has been enough. */
static int redo(guard *g, sunrealtype t, steif_supervised_window *out)
{
  const steif_supervision *how = &g->how;
  const sunrealtype once = how->shrink * fmin(g->cap, out->h);
  g->facts->triggers++;
  while (out->mu > -how->rate && out->redone < how->redo && !out->real) {
    const sunrealtype mu = out->mu;
    lower_cap(g);
    memcpy(g->z, g->saved, (size_t)g->tangent.pair.n * sizeof *g->z);
    g->now = g->start;
    STEIF_TRY(attempt(g, t, out));
    out->redone++;
    out->real = out->mu > -how->rate && mu - out->mu < how->real * fabs(mu + how->rate);
  }
  if (out->real && g->cap < once) {
    g->cap = once;
    close_solver(g);
  }
  g->facts->redone += out->redone;
  g->facts->real += out->real;
  g->facts->unresolved += out->mu > -how->rate && !out->real;
  return STEIF_OK;
}

/* What begins a window can begin it again; |w| stays within the range of numbers. */
static void mark(guard *g)
{
  stf_tangent *tangent = &g->tangent;
  const sunrealtype size = stf_tangent_size(tangent, g->z);
  if (size < STF_W_SMALLEST || size > STF_W_LARGEST) {
    sunrealtype *w = g->z + (tangent->direct ? 0 : tangent->n);
    for (sunindextype i = 0; i < tangent->n; i++) w[i] /= size;
    close_solver(g);
  }
  memcpy(g->saved, g->z, (size_t)tangent->pair.n * sizeof *g->z);
  g->start = g->now;
}

static int window(guard *g, sunrealtype t)
{
  const steif_supervision *how = &g->how;
  const bool whole = t <= g->t1 * (1 + (g->t1 > 0 ? STF_STEP_ROUNDING : -STF_STEP_ROUNDING));
  steif_supervised_window out = {0};
  mark(g);
  STEIF_TRY(attempt(g, fmin(t, g->t1), &out));
  if (how->rule == STEIF_SUPERVISE_WINDOWS && whole && out.mu > -how->rate)
    STEIF_TRY(redo(g, fmin(t, g->t1), &out));
  g->facts->windows++;
  g->row = out.real ? g->row + 1 : 0;
  STEIF_CHECK(
    g->row <= how->redo, g->ctx, STEIF_NOT_CERTIFIED,
    "'%s' grows in %d windows in a row up to t = %.12g, by %.3g per time in the last, "
    "whatever the step: it does not decay by the rate %g in windows of %g",
    g->tangent.problem->name, g->row, out.t, out.mu, how->rate, how->window);
  const int wish = how->tell ? how->tell(&out, how->user) : 0;
  STEIF_CHECK(wish == 0, g->ctx, STEIF_CALLBACK,
              "the callback .tell stopped the run at t = %.12g", out.t);
  return STEIF_OK;
}

/* -- the run ----------------------------------------------------------------------------- */

static int complete(guard *g, const steif_problem *p, const steif_options *o)
{
  steif_supervision *how = &g->how;
  steif_context *ctx = g->ctx;
  STEIF_CHECK(how->rule == STEIF_SUPERVISE_NONE || (how->rate > 0 && isfinite(how->rate)), ctx,
              STEIF_BAD_INPUT,
              "the rate %g must be positive and finite: it separates growth from decay",
              how->rate);
  STEIF_CHECK(how->window > 0 && how->window <= (g->t1 - p->t0) * (1 + STF_STEP_ROUNDING), ctx,
              STEIF_BAD_INPUT,
              "the window %g must be positive and fit into the run of %g: whole periods of the "
              "coefficients, or what the problem takes to decay",
              how->window, g->t1 - p->t0);
  if (how->swing == 0) how->swing = 7;
  if (how->shrink == 0) how->shrink = 0.7;
  if (how->real == 0) how->real = 0.35;
  if (how->redo == 0) how->redo = 12;
  STEIF_CHECK(
    how->swing > 0 && how->shrink > 0 && how->shrink < 1 && how->real > 0 && how->real < 1 &&
      how->redo > 0,
    ctx, STEIF_BAD_INPUT,
    "swing = %g and redo = %d must be positive, shrink = %g and real = %g lie between "
    "0 and 1",
    how->swing, how->redo, how->shrink, how->real);
  STEIF_CHECK(
    !(o->h > 0) && !o->mesh && !o->atols && !o->ewt && !o->observe && !o->like, ctx,
    STEIF_UNSUPPORTED,
    "a supervised run adapts its step size by rtol and atol, on serial vectors: leave out h, "
    "mesh, atols, ewt, observe and like");
  return STEIF_OK;
}

static int suits(steif_context *ctx, const steif_problem *p, const char *method,
                 const stf_tangent *tangent)
{
  steif_method_info info;
  STEIF_TRY(steif_method_find(ctx, method, &info));
  /* auto may choose one of them */
  const bool exact = strstr("rosenbrock exprb etd auto", info.family) != NULL;
  STEIF_CHECK(
    tangent->direct || !exact, ctx, STEIF_UNSUPPORTED,
    "'%s' needs the exact Jacobian of '%s' with its variational equation, which contains "
    "second derivatives of f: take another family of methods",
    method, p->name);
  return STEIF_OK;
}

static int begin(stf_pool *pool, guard *g, const steif_problem *p)
{
  stf_tangent *tangent = &g->tangent;
  STEIF_TRY(stf_tangent_open(pool, g->ctx, p, tangent));
  STEIF_TRY(suits(g->ctx, p, g->method, tangent));
  const sunindextype all = tangent->pair.n;
  g->z = stf_pool_array(pool, 2 * (size_t)all, sizeof *g->z);
  if (!g->z) return STEIF_NO_MEMORY;
  g->saved = g->z + all;
  STEIF_TRY(stf_tangent_begin(tangent, g->z));
  tangent->rtol = g->options.rtol > 0 ? g->options.rtol : steif_defaults().rtol;
  tangent->atol = g->options.atol > 0 ? g->options.atol
                                      : tangent->rtol * (p->rtol_scale > 0 ? p->rtol_scale : 1);
  g->options.ewt = stf_tangent_weights;
  g->now = (point){.t = p->t0, .t_half = NAN};
  g->half = p->t0 + (g->t1 - p->t0) / 2;
  g->cap = INFINITY;
  return STEIF_OK;
}

/* y at the end; where w is y its norm comes back. */
static void finish(guard *g, const steif_problem *p, sunrealtype *y)
{
  steif_supervised *facts = g->facts;
  const sunindextype n = p->n;
  facts->cap = g->cap;
  facts->direct = g->tangent.direct;
  facts->mu = (g->now.log - g->now.log_half) / (g->now.t - g->now.t_half);
  facts->end = g->now.t;
  sunrealtype scale = 1;
  if (g->tangent.direct) {
    const bool nothing = !(stf_tangent_size(&g->tangent, p->y0) > 0);
    scale = nothing ? 0
                    : stf_tangent_size(&g->tangent, p->y0) * exp(g->now.log) /
                        stf_tangent_size(&g->tangent, g->z);
  }
  for (sunindextype i = 0; y && i < n; i++) y[i] = scale * g->z[i];
}

int steif_supervise(steif_context *ctx, const steif_problem *problem, const char *method,
                    const steif_options *options, const steif_supervision *how, sunrealtype *y,
                    steif_supervised *facts)
{
  STF_NAMED(problem);
  steif_supervised unused;
  STEIF_CHECK(problem && method && options && how, ctx, STEIF_BAD_INPUT,
              "a problem, a method, options and a supervision are needed");
  guard g = {.ctx = ctx,
             .method = method,
             .options = *options,
             .how = *how,
             .t1 = options->t1 != 0 ? options->t1 : problem->t1,
             .facts = facts ? facts : &unused};
  *g.facts = (steif_supervised){.peak = 0};
  STEIF_TRY(complete(&g, problem, options));
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = begin(pool, &g, problem);
  for (long k = 1; code == STEIF_OK && g.now.t < g.t1; k++)
    code = window(&g, problem->t0 + (sunrealtype)k * how->window);
  close_solver(&g);
  if (code == STEIF_OK || (code == STEIF_STOPPED && g.z)) finish(&g, problem, y);
  stf_pool_free(&pool);
  return code;
}
