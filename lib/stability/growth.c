/* growth.c: growth and one-step defects of a numerical solution of x' = A(t) x.
 *
 * The exact flow over a step is that of Gauss's method of order 12 with substeps: h |A| is below 1/2
 * in each of them (while that needs at most 64), so its error is that of rounding.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "variation.h"
#include <math.h>
#include <string.h>

enum { SUBSTEPS = 64, LEFT_OUT = 50 };

typedef struct column {
  stf_variation v, flow, start;
  sunrealtype *z, *old, *y; /* exact column: k blocks, the oldest first; flow of x; scratch */
  sunrealtype size0, lte_old;
  long defects, ratios, residuals;
  sunrealtype log_half, t_half; /* ln |w| where the second half begins */
  steif_growth_facts out;
} column;

static sunrealtype norm(int d, const sunrealtype *x)
{
  sunrealtype sum = 0;
  for (int i = 0; i < d; i++) sum = hypot(sum, x[i]);
  return sum;
}

static sunrealtype distance(int d, const sunrealtype *x, const sunrealtype *y)
{
  sunrealtype sum = 0;
  for (int i = 0; i < d; i++) sum = hypot(sum, x[i] - y[i]);
  return sum;
}

/* |J| of the last step by row sums. */
static sunrealtype size_of(const stf_variation *v)
{
  sunrealtype most = 0;
  for (int i = 0; i < v->formula.r * v->d; i++) {
    sunrealtype row = 0;
    for (int j = 0; j < v->d; j++) row += fabs(v->J[i * v->d + j]);
    most = fmax(most, row);
  }
  return most;
}

/* x := one column carried from t over h by `count` steps of v. */
static int carry(stf_variation *v, sunrealtype t, sunrealtype h, int count, sunrealtype *x)
{
  const size_t bytes = (size_t)v->d * sizeof *x;
  v->t = v->t0 = t, v->count = 0, v->h = h / count;
  memcpy(v->X, x, bytes);
  for (int i = 0; i < count; i++) STEIF_TRY(stf_variation_step(v));
  memcpy(x, v->X, bytes);
  return STEIF_OK;
}

static int exact_step(column *c, sunrealtype t, sunrealtype *x)
{
  const sunrealtype wanted = ceil(2 * c->v.h * (1 + size_of(&c->v)));
  return carry(&c->flow, t, c->v.h, wanted < SUBSTEPS ? (int)wanted : SUBSTEPS, x);
}

static sunrealtype *newest(const column *c) { return c->v.X + (c->v.formula.k - 1) * c->v.d; }

/* ---- what is measured ---- */

static void growth(column *c, long n)
{
  const sunrealtype t = (sunrealtype)n * c->v.h;
  if (2 * n + 1 < c->out.steps || n < 1) return;
  stf_variation_principal(&c->v, c->y);
  const sunrealtype log_w = log(norm(c->v.d, c->y) / c->size0);
  if (isnan(c->log_half)) c->log_half = log_w, c->t_half = t;
  c->out.mu = fmax(c->out.mu, log_w / t), c->out.mu_last = log_w / t;
  if (t > c->t_half) c->out.mu_window = (log_w - c->log_half) / (t - c->t_half);
}

static void defect(column *c, sunrealtype lte)
{
  steif_growth_facts *out = &c->out;
  if (c->defects++ > 0) {
    const bool early = out->steps >= 2 * LEFT_OUT && c->ratios < LEFT_OUT;
    if (!early) out->tau_max = fmax(out->tau_max, lte / c->lte_old);
    c->ratios++;
  }
  c->lte_old = lte;
  out->lte_max = fmax(out->lte_max, lte);
  out->lte_mean += (lte - out->lte_mean) / (sunrealtype)c->defects;
}

static void size(column *c)
{
  c->out.norm_end = norm(c->v.d, newest(c));
  c->out.norm_max = fmax(c->out.norm_max, c->out.norm_end);
}

/* z_{n+1} - sum U_j z_j - h beta J z_{n+1} at the exact solution; z moves on. */
static int residual(column *c, sunrealtype t)
{
  const stf_formula *g = &c->v.formula;
  const int d = c->v.d, k = g->k;
  sunrealtype *z = c->z + k * d;
  memcpy(z, z - d, (size_t)d * sizeof *z);
  STEIF_TRY(exact_step(c, t, z));
  for (int a = 0; a < d; a++) {
    c->y[a] = z[a];
    for (int j = 0; j < k; j++) c->y[a] -= g->U[j] * c->z[j * d + a];
    for (int b = 0; b < d; b++) c->y[a] -= c->v.h * g->C[0] * c->v.J[a * d + b] * z[b];
  }
  const sunrealtype left = norm(d, c->y);
  memmove(c->z, c->z + d, (size_t)(k * d) * sizeof *z);
  c->out.residual_max = fmax(c->out.residual_max, left);
  c->out.residual_mean += (left - c->out.residual_mean) / (sunrealtype)++c->residuals;
  return STEIF_OK;
}

/* ---- the run ---- */

/* x_0 .. x_{k-1} by rk4, and the exact column beside them. */
static int begin(column *c, bool multistep)
{
  const int d = c->v.d, k = c->v.formula.k;
  const sunrealtype t0 = c->v.t0, h = c->v.h, *y0 = c->v.problem->y0;
  const size_t bytes = (size_t)d * sizeof *y0;
  memcpy(c->v.X, y0, bytes), memcpy(c->z, y0, bytes);
  c->size0 = c->out.norm_max = norm(d, y0);
  STEIF_CHECK(c->size0 > 0, c->v.ctx, STEIF_BAD_INPUT,
              "'%s' starts at 0, and so it stays: give another y0", c->v.problem->name);
  STEIF_TRY(stf_variation_matrix(&c->v, 0, t0, c->v.y));
  for (int j = 1; j < k; j++) {
    const sunrealtype t = t0 + (j - 1) * h;
    sunrealtype *x = c->v.X + j * d, *z = c->z + j * d;
    memcpy(x, x - d, bytes), memcpy(z, z - d, bytes);
    STEIF_TRY(carry(&c->start, t, h, 1, x));
    STEIF_TRY(exact_step(c, t, z));
    c->out.norm_max = fmax(c->out.norm_max, norm(d, x));
  }
  c->v.t0 = t0 + (k - 1) * h, c->v.t = c->v.t0;
  c->out.mu = -INFINITY, c->log_half = NAN;
  c->out.residual_mean = c->out.residual_max = multistep ? 0 : NAN;
  return STEIF_OK;
}

static int follow(column *c, bool multistep)
{
  const int k = c->v.formula.k;
  growth(c, 0);
  for (long n = 1; n + k - 1 <= c->out.steps; n++) {
    const sunrealtype t = c->v.t;
    memcpy(c->old, newest(c), (size_t)c->v.d * sizeof *c->old);
    STEIF_TRY(stf_variation_step(&c->v));
    STEIF_TRY(exact_step(c, t, c->old));
    defect(c, distance(c->v.d, newest(c), c->old));
    size(c);
    growth(c, n);
    if (multistep) STEIF_TRY(residual(c, t));
    STEIF_CHECK(
      isfinite(c->out.norm_end) && isfinite(c->out.lte_max), c->v.ctx, STEIF_NOT_FINITE,
      "the solution of '%s' by %s overflows at t = %.12g: end the run before, or take a "
      "smaller h",
      c->v.problem->name, c->v.method, c->v.t);
  }
  return STEIF_OK;
}

static int open(stf_pool *pool, steif_context *ctx, const steif_problem *p, const char *method,
                const steif_lyapunov_options *o, column *c)
{
  const sunrealtype t1 = o->t1 != 0 ? o->t1 : p->t1, span = t1 - p->t0;
  STEIF_TRY(stf_equal_steps(ctx, o->h, span, &c->out.steps));
  const sunrealtype h = span / (sunrealtype)c->out.steps;
  STEIF_TRY(stf_variation_open(pool, ctx, p, method, h, t1, 1, o->linear, &c->v));
  STEIF_CHECK(c->v.linear, ctx, STEIF_UNSUPPORTED,
              "the Jacobian of '%s' depends on y: the defects of one solution are measured on "
              "linear problems",
              p->name);
  STEIF_TRY(stf_variation_open(pool, ctx, p, "gauss:s=6", h, t1, 1, 1, &c->flow));
  STEIF_TRY(stf_variation_open(pool, ctx, p, "rk4", h, t1, 1, 1, &c->start));
  const int k = c->v.formula.k;
  STEIF_CHECK(c->out.steps >= k, ctx, STEIF_BAD_INPUT,
              "%ld steps are too few: %s needs %d values to begin with", c->out.steps, method,
              k);
  const size_t d = (size_t)c->v.d;
  c->z = stf_claim(pool, (STF_PAST + 3) * d, sizeof *c->z);
  if (!c->z) return STEIF_NO_MEMORY;
  c->old = c->z + (STF_PAST + 1) * d, c->y = c->old + d;
  return STEIF_OK;
}

int steif_growth_measure(steif_context *ctx, const steif_problem *problem, const char *method,
                         const steif_lyapunov_options *options, steif_growth_facts *facts)
{
  column c = {.lte_old = 0};
  steif_method_info info;
  STEIF_CHECK(problem && method && options && facts, ctx, STEIF_BAD_INPUT,
              "a problem, a method, options and room for the facts are needed");
  STEIF_TRY(steif_method_find(ctx, method, &info));
  const bool multistep = !strcmp(info.family, "bdf");
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = open(pool, ctx, problem, method, options, &c);
  if (code == STEIF_OK) code = begin(&c, multistep);
  if (code == STEIF_OK) code = follow(&c, multistep);
  if (code == STEIF_OK) *facts = c.out;
  stf_pool_free(&pool);
  return code;
}
