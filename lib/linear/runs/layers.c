/* layers.c: equal steps of BDF and Radau IIA on E x' + F x = f, and changes of their length.
 *
 * On N x' + x = f a method with steps h makes of x the sum of (-1)^j N^j d^j f, d its
 * difference quotient, as soon as all values that d^(k-1) reaches back to are its own: after
 * p (k - 1) steps of BDF-p, k - 1 of a method with R(inf) = 0. Before, values are those of an
 * impulse; after a change of the step by ratio r, d^2 of order 1 has a factor (1 + 1/r)/2,
 * and errors are h^(p+2-k) for k > 2. C. W. Gear, H. H. Hsu and L. Petzold (1981); L.
 * Petzold, SIAM J. Sci. Stat. Comput. 3 (1982). So a new length begins as many steps before
 * the last value, from values interpolated there, and what it makes of times behind it is
 * thrown away: every value kept is outside of layers. BDF of order above 1 starts as
 * convolution quadrature, which needs no values before x(0-) (C. Lubich, Numer. Math. 52,
 * 1988); the roots of its polynomial die away in its first layer.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "engine.h"
#include "layers.h"
#include "run_scale.h"
#include "method.h"
#include <steif/runs.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/table.h>
#include <string.h>

enum { POINTS = 12 };

/* x at t through the rows kept that lie around it. */
static void interpolate(const stf_layers *w, sunrealtype t, sunrealtype *x)
{
  sunrealtype node[POINTS] = {0}, weight[POINTS];
  const int wanted = w->order + STF_BEYOND, there = w->kept - w->valid;
  const int count = wanted < there ? wanted : there;
  int from = w->kept - count;
  while (from > w->valid && w->t[from + count / 2] > t) from--;
  for (int j = 0; j < count; j++) node[j] = (w->t[from + j] - t) / w->h;
  stf_interpolate(count - 1, node, 0, weight);
  memset(x, 0, (size_t)w->n * sizeof *x);
  for (int j = 0; j < count; j++)
    for (int i = 0; i < w->n; i++) x[i] += weight[j] * w->x[(from + j) * w->n + i];
}

static int before(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  stf_layers *w = user;
  sunrealtype *x = N_VGetArrayPointer(w->g);
  (void)yp;
  interpolate(w, t, x);
  stf_apart_enter(&w->apart, w->n, x, N_VGetArrayPointer(y));
  return 0;
}

/* A solver at t with steps h from w->start on. */
static int launch(stf_layers *w, sunrealtype t, sunrealtype h, const char *start)
{
  steif_solver_free(&w->solver);
  STEIF_TRY(steif_linear_problem(w->ctx, &w->linear, w->start, t, w->t1, &w->problem));
  w->problem.exact = before, w->problem.dae_index = w->index;
  steif_options o = w->options;
  o.h = h, o.start = w->past > 1 ? start : NULL;
  w->solver = steif_solver_new(w->ctx, &w->problem, w->method, &o);
  return w->solver ? STEIF_OK : steif_status(w->ctx);
}

/* ---- rows ------------------------------------------------------------------------------- */

static void push(stf_layers *w)
{
  w->t[w->count] = steif_time(w->solver);
  stf_apart_leave(&w->apart, w->n, N_VGetArrayPointer(steif_solution(w->solver)),
                  w->x + (w->count++) * w->n);
}

int stf_layers_step(stf_layers *w)
{
  STEIF_TRY(stf_step_untimed(w->solver));
  push(w);
  return STEIF_OK;
}

/* Rows that a change to steps twice as long looks back on. */
static int reach(const stf_layers *w)
{
  return 2 * (w->width + w->past) + w->order + STF_BEYOND;
}

void stf_layers_keep(stf_layers *w)
{
  const int drop = w->count - reach(w);
  w->kept = w->count;
  if (drop <= 0 || w->count < w->room / 2) return;
  memmove(w->t, w->t + drop, (size_t)(w->count - drop) * sizeof *w->t);
  memmove(w->x, w->x + drop * w->n, (size_t)(w->count - drop) * (size_t)w->n * sizeof *w->x);
  w->count = w->kept = w->count - drop;
  w->valid = w->valid > drop ? w->valid - drop : 0;
  w->clean = w->clean > drop ? w->clean - drop : 0;
}

/* ---- lengths ---------------------------------------------------------------------------- */

int stf_layers_begin(stf_layers *w, sunrealtype h)
{
  stf_apart_enter(&w->apart, w->n, w->x0, w->start);
  w->h = h, w->count = w->kept = 0;
  STEIF_TRY(launch(w, w->t0, h, "cq"));
  if (w->past > 1) push(w); /* solved for */
  for (int i = 0; i < w->opening && steif_time(w->solver) < w->t1; i++)
    STEIF_TRY(stf_layers_step(w));
  w->valid = w->clean = w->count;
  return STEIF_OK;
}

static sunrealtype back(const stf_layers *w, sunrealtype h)
{
  return w->t[w->kept - 1] - (w->width + w->past - 1) * h;
}

bool stf_layers_fit(const stf_layers *w, sunrealtype h)
{
  return w->kept - w->valid >= w->order + STF_BEYOND &&
         back(w, h) >= w->t[w->valid] - 1e-9 * w->h;
}

int stf_layers_change(stf_layers *w, sunrealtype h)
{
  const sunrealtype t = back(w, h);
  sunrealtype *x = w->start + w->n;
  w->count = w->kept;
  interpolate(w, t, x);
  stf_apart_enter(&w->apart, w->n, x, w->start);
  STEIF_TRY(launch(w, t, h, "exact"));
  for (int i = 0; i < w->width + w->past - 1; i++) STEIF_TRY(stf_step_untimed(w->solver));
  w->stats.again += w->width, w->stats.changes++;
  w->h = h, w->clean = w->count;
  return STEIF_OK;
}

/* ---- opening ---------------------------------------------------------------------------- */

/* Steps until the largest root but 1 of sum_j (1 - z)^j / j, j = 1 .. p, is below a tenth of
 * rtol. */
static int fading(int p, sunrealtype rtol)
{
  static const sunrealtype root[] = {0, 0, 0.33334, 0.42640, 0.56086, 0.70871, 0.86338};
  return p > 1 ? p - 1 + (int)ceil(log(0.1 * rtol) / log(root[p])) : 0;
}

static int know(stf_layers *w)
{
  steif_method_info info;
  STEIF_TRY(steif_method_find(w->ctx, w->method, &info));
  const bool bdf = !strcmp(info.family, "bdf");
  const bool radau = info.claims & STEIF_STIFFLY_ACCURATE && info.order == 2 * info.stages - 1;
  STEIF_CHECK(
    bdf || radau, w->ctx, STEIF_UNSUPPORTED,
    "'%s' does not come through layers in a known number of steps: take be, bdf:p= or "
    "radau:s=",
    w->method);
  const int chain = w->index > 1 ? w->index - 1 : 0;
  const bool falls = radau && info.stages > 1; /* with the index */
  w->order = falls ? info.stages + (chain > 0 ? 1 - chain : 0) : info.order;
  w->past = bdf ? info.order : 1;
  w->width = w->past * chain;
  w->opening = w->width + fading(w->past, w->options.rtol);
  STEIF_CHECK(w->order > 0, w->ctx, STEIF_UNSUPPORTED,
              "'%s' does not converge for index %d, its order is %d: take more stages, or bdf",
              w->method, w->index, w->order);
  return STEIF_OK;
}

static int claim(stf_layers *w)
{
  const int most = w->opening + 1 > reach(w) ? w->opening + 1 : reach(w);
  w->room = 2 * (most + w->width + w->order + w->past + STF_BEYOND);
  const size_t room = (size_t)w->room, n = (size_t)w->n;
  w->t = stf_allocate(w->ctx, room + room * n + 2 * n, sizeof *w->t);
  w->g = N_VNew_Serial(w->n, steif_sundials(w->ctx));
  if (!w->t) return STEIF_NO_MEMORY;
  STEIF_CHECK(w->g, w->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  w->x = w->t + room, w->start = w->x + room * n;
  return STEIF_OK;
}

static int open(stf_layers *w, const steif_linear *l, const steif_analysis *analysis)
{
  steif_structure s = {0};
  STEIF_TRY(steif_structure_find(w->ctx, l->E, l->F, analysis, &s));
  w->n = (int)s.n, w->index = s.index;
  int code = s.index < 0 ? STEIF_FAIL(w->ctx, STEIF_NOT_CERTIFIED,
                                      "the index decides how long layers are: %s", s.message)
                         : know(w);
  if (!code) code = stf_apart_open(w->ctx, l, &s, &w->apart);
  if (w->apart.linear.E) w->linear = w->apart.linear;
  steif_structure_clear(w->ctx, &s);
  return code ? code : claim(w);
}

/* The absolute tolerance where none is given. */
static int measure(stf_layers *w, const steif_linear *l)
{
  sunrealtype scale;
  if (w->options.atol > 0 || w->options.atols) return STEIF_OK;
  STEIF_TRY(stf_run_scale(w->ctx, l, w->x0, w->t0, w->t1, &scale));
  w->options.atol = w->options.rtol * scale;
  return STEIF_OK;
}

int stf_layers_open(steif_context *ctx, const steif_linear *l, const sunrealtype *x0,
                    sunrealtype t0, const char *method, const steif_options *options,
                    const steif_analysis *analysis, stf_layers *w)
{
  steif_problem p;
  STEIF_CHECK(options && method, ctx, STEIF_BAD_INPUT,
              "a method and options with t1 are needed, one is NULL");
  STEIF_CHECK(!(options->h > 0) && !options->mesh, ctx, STEIF_BAD_INPUT,
              "steps are adaptive here: h and mesh belong to steif_solver_new");
  STEIF_TRY(steif_linear_problem(ctx, l, x0, t0, options->t1, &p));
  *w = (stf_layers){.linear = *l,
                    .ctx = ctx,
                    .method = method,
                    .options = *options,
                    .x0 = x0,
                    .t0 = t0,
                    .t1 = options->t1};
  STEIF_CHECK(w->t1 > t0, ctx, STEIF_BAD_INPUT, "t1 = %.17g must be after t0 = %.17g", w->t1,
              t0);
  int code = measure(w, l);
  if (!code) code = open(w, l, analysis);
  if (code) stf_layers_close(w);
  return code;
}

void stf_layers_close(stf_layers *w)
{
  if (!w->ctx) return;
  steif_solver_free(&w->solver);
  stf_apart_close(&w->apart);
  if (w->g) N_VDestroy(w->g);
  stf_release(w->ctx, w->t);
  *w = (stf_layers){0};
}
