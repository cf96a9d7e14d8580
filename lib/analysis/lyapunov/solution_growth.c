/* solution_growth.c: growth and one-step defects of a numerical solution of x' = A(t) x. The exact flow
 * over a step is that of Gauss's method of order 12 with substeps.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "variation.h"
#include <math.h>
#include <string.h>

enum { LEFT_OUT = 50 };

typedef struct column {
  stf_variation v, flow, start;
  sunrealtype *x, *old; /* the solution, and where the flow takes the one before */
  sunrealtype *z, *y;   /* exact column: k blocks, the oldest first; scratch */
  sunrealtype size0, lte_old;
  long defects, ratios, residuals, made;
  bool multistep, weak_start;
  sunrealtype log_half, t_half,
    log_before; /* ln |w| where the second half begins, a step before */
  int scale; /* everything kept is the solution by 2^scale: small ones stay above underflow */
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

static int exact_step(column *c, sunrealtype t, sunrealtype h, sunrealtype *x)
{
  return stf_variation_carry(&c->flow, t, h, stf_variation_substeps(&c->v, h), x);
}

/* ---- what is measured ---- */

static void growth(column *c, long n)
{
  steif_growth_facts *out = &c->out;
  const long half = out->steps / 2;
  const sunrealtype t = (sunrealtype)n * c->v.h;
  if (n + 1 < half) return;
  stf_variation_principal(&c->v, c->y);
  const sunrealtype log_w = log(norm(c->v.d, c->y) / c->size0) - c->scale * log(2);
  if (n < half || n < 1) c->log_before = log_w;
  if (n < half || n < 1) return;
  if (isnan(c->log_half)) {
    c->log_half = log_w;
    c->t_half = t;
  }
  out->mu = fmax(out->mu, log_w / t);
  out->mu_last = log_w / t;
  out->mu_partial = fmax(out->mu_partial, (log_w - c->log_before) / t);
  if (!(t > c->t_half)) return;
  out->mu_window = (log_w - c->log_half) / (t - c->t_half);
  out->mu_running = fmax(out->mu_running, out->mu_window);
}

/* scaled: lte by 2^scale, as the one before is kept. A step that was exact has no ratio. */
static void defect(column *c, sunrealtype scaled, sunrealtype lte)
{
  steif_growth_facts *out = &c->out;
  if (c->defects++ > 0) {
    const bool early = out->steps >= 2 * LEFT_OUT && c->ratios < LEFT_OUT;
    const sunrealtype ratio = c->lte_old > 0 ? scaled / c->lte_old : 0;
    out->tau_all = fmax(out->tau_all, ratio);
    if (!early) out->tau_max = fmax(out->tau_max, ratio);
    c->ratios++;
  }
  c->lte_old = scaled;
  out->lte_max = fmax(out->lte_max, lte);
  out->lte_mean += (lte - out->lte_mean) / (sunrealtype)c->defects;
}

static void size(column *c)
{
  c->out.norm_end = ldexp(norm(c->v.d, c->x), -c->scale);
  c->out.norm_max = fmax(c->out.norm_max, c->out.norm_end);
}

/* The problem is linear: a small solution goes on as a multiple. */
static void raise(column *c)
{
  enum { SMALL = -300, BY = 200 };
  const size_t d = (size_t)c->v.d, k = (size_t)c->v.g->k;
  const sunrealtype now = fmax(norm(c->v.d, c->x), norm((int)(k * d), c->z));
  if (!(now > 0 && now < ldexp(1, SMALL))) return;
  const sunrealtype factor = ldexp(1, BY);
  for (size_t i = 0; i < k * d; i++) c->v.X[i] *= factor, c->z[i] *= factor;
  for (size_t i = 0; i < d; i++) c->x[i] *= factor;
  c->lte_old *= factor;
  c->scale += BY;
}

/* |x_k - sum U_j x_j - h beta J x_k| of k + 1 blocks, the oldest first, J of the step just
 * made. */
static sunrealtype formula(column *c, const sunrealtype *x)
{
  const steif_glm *g = c->v.g;
  const int d = c->v.d, k = g->k;
  stf_jacobian_times(c->v.J[0], 1, -c->v.h * g->C[0], x + k * d, c->y);
  for (int a = 0; a < d; a++) {
    c->y[a] += x[k * d + a];
    for (int j = 0; j < k; j++) c->y[a] -= g->U[j] * x[j * d + a];
  }
  return norm(d, c->y);
}

static void average(sunrealtype value, long count, sunrealtype *mean, sunrealtype *most)
{
  *most = fmax(*most, value);
  *mean += (value - *mean) / (sunrealtype)count;
}

/* Of the exact solution (z moves on) and of the one through the value before the step, `old`
 * after it. */
static int residuals(column *c, sunrealtype t, const sunrealtype *before)
{
  const int d = c->v.d, k = c->v.g->k;
  const size_t bytes = (size_t)d * sizeof *before;
  sunrealtype *z = c->z + k * d, *local = z + d;
  memcpy(z, z - d, bytes);
  STEIF_TRY(exact_step(c, t, c->v.h, z));
  average(ldexp(formula(c, c->z), -c->scale), ++c->residuals, &c->out.residual_mean,
          &c->out.residual_max);
  memmove(c->z, c->z + d, (size_t)(k * d) * sizeof *z);
  memcpy(local + k * d, c->old, bytes);
  memcpy(local + (k - 1) * d, before, bytes);
  for (int j = k - 2; j >= 0; j--) {
    memcpy(local + j * d, local + (j + 1) * d, bytes);
    STEIF_TRY(exact_step(c, t - (k - 2 - j) * c->v.h, -c->v.h, local + j * d));
  }
  average(ldexp(formula(c, local), -c->scale), c->residuals, &c->out.local_mean,
          &c->out.local_max);
  return STEIF_OK;
}

/* ---- the run ---- */

/* x_0 .. x_{k-1} by rk4, and the exact column beside them. */
static int begin_multistep(column *c)
{
  const int d = c->v.d, k = c->v.g->k;
  const sunrealtype t0 = c->v.t0, h = c->v.h;
  const size_t bytes = (size_t)d * sizeof *c->z;
  memcpy(c->v.X, c->x, bytes);
  memcpy(c->z, c->x, bytes);
  for (int j = 1; j < k; j++) {
    const sunrealtype t = t0 + (j - 1) * h;
    sunrealtype *x = c->v.X + j * d, *z = c->z + j * d;
    memcpy(x, x - d, bytes);
    memcpy(z, z - d, bytes);
    STEIF_TRY(stf_variation_carry(&c->start, t, h, 1, x));
    const sunrealtype *last = c->start.K + 3 * d;
    for (int a = 0; a < d && c->weak_start; a++) x[a] -= last[a] / 6;
    STEIF_TRY(exact_step(c, t, h, z));
    c->out.norm_max = fmax(c->out.norm_max, norm(d, x));
  }
  memcpy(c->x, c->v.X + (k - 1) * d, bytes);
  c->v.t0 = t0 + (k - 1) * h;
  c->v.t = c->v.t0;
  return STEIF_OK;
}

/* X_0 fitted to exact values in the first step. */
static int begin_general(column *c)
{
  const steif_glm *g = c->v.g;
  const int d = c->v.d, count = stf_glm_powers(g), n = count + 1;
  sunrealtype first[STEIF_PAST * (STEIF_PAST + 1)];
  stf_glm_first(g, count, first);
  memset(c->v.X, 0, (size_t)(g->k * d) * sizeof *c->x);
  memcpy(c->old, c->x, (size_t)d * sizeof *c->x);
  for (int i = 0; i < n; i++) {
    const sunrealtype step = c->v.h / (count ? count : 1);
    if (i) STEIF_TRY(exact_step(c, c->v.t0 + (i - 1) * step, step, c->old));
    for (int j = 0; j < g->k; j++)
      for (int a = 0; a < d; a++) c->v.X[j * d + a] += first[j * n + i] * c->old[a];
  }
  return STEIF_OK;
}

static int begin(column *c)
{
  const int d = c->v.d;
  memcpy(c->x, c->v.problem->y0, (size_t)d * sizeof *c->x);
  c->size0 = c->out.norm_max = norm(d, c->x);
  STEIF_CHECK(c->size0 > 0, c->v.ctx, STEIF_BAD_INPUT,
              "'%s' starts at 0 and stays there: give another y0", c->v.problem->name);
  STEIF_TRY(stf_variation_matrix(&c->v, 0, c->v.t0, c->v.y, NULL));
  c->out.mu = c->out.mu_running = c->out.mu_partial = -INFINITY;
  c->log_half = NAN;
  if (c->multistep) return begin_multistep(c);
  c->out.residual_mean = c->out.residual_max = NAN;
  c->out.local_mean = c->out.local_max = NAN;
  return begin_general(c);
}

/* How far the step was from the exact flow, into the facts and to the one who is told. */
static int measured(column *c, const steif_lyapunov_options *o)
{
  const sunrealtype scaled = distance(c->v.d, c->x, c->old), lte = ldexp(scaled, -c->scale);
  defect(c, scaled, lte);
  size(c);
  const int wish = o->tell ? o->tell(c->v.t, c->out.norm_end, lte, o->user) : 0;
  STEIF_CHECK(wish == 0, c->v.ctx, STEIF_CALLBACK,
              "the callback .tell stopped the run at t = %.12g", c->v.t);
  STEIF_CHECK(
    isfinite(c->out.norm_end) && isfinite(c->out.lte_max), c->v.ctx, STEIF_NOT_FINITE,
    "the solution of '%s' by %s overflows at t = %.12g: end the run before, or take a "
    "smaller h",
    c->v.problem->name, c->v.method, c->v.t);
  return STEIF_OK;
}

static int follow(column *c, const steif_lyapunov_options *o)
{
  const long lag = c->multistep ? c->v.g->k - 1 : 0, last = c->out.steps;
  const size_t bytes = (size_t)c->v.d * sizeof *c->x;
  sunrealtype *before = c->y + c->v.d;
  growth(c, 0);
  c->v.stop = o->stop;
  for (long n = 1; n + lag <= last; n++) {
    const sunrealtype t = c->v.t;
    memcpy(c->old, c->x, bytes);
    memcpy(before, c->x, bytes);
    c->made = n - 1 + lag;
    STEIF_TRY(stf_variation_step(&c->v));
    STEIF_TRY(exact_step(c, t, c->v.h, c->old));
    stf_variation_solution(&c->v, c->x);
    STEIF_TRY(measured(c, o));
    growth(c, n);
    if (c->multistep) STEIF_TRY(residuals(c, t, before));
    raise(c);
  }
  return STEIF_OK;
}

static int open(stf_pool *pool, steif_context *ctx, const steif_problem *p, const char *method,
                const steif_lyapunov_options *o, column *c)
{
  stf_constant steps;
  STEIF_CHECK(p->n <= STF_DENSE_MOST, ctx, STEIF_UNSUPPORTED,
              "'%s' with n = %lld: exact flows cost too much above n = %d", p->name,
              (long long)p->n, STF_DENSE_MOST);
  STEIF_TRY(stf_constant_steps(ctx, o->h, p->t0, o->t1 != 0 ? o->t1 : p->t1, &steps));
  const sunrealtype h = steps.h, t1 = steps.end;
  c->out.steps = steps.whole;
  STEIF_TRY(stf_variation_open(pool, ctx, p, method, h, t1, 1, o->linear, &c->v));
  STEIF_CHECK(c->v.linear, ctx, STEIF_UNSUPPORTED,
              "the Jacobian of '%s' depends on y: the defects of one solution are measured on "
              "linear problems",
              p->name);
  STEIF_TRY(stf_variation_open(pool, ctx, p, "gauss:s=6", h, t1, 1, 1, &c->flow));
  STEIF_TRY(stf_variation_open(pool, ctx, p, "rk4", h, t1, 1, 1, &c->start));
  const int k = c->v.g->k;
  STEIF_CHECK(c->out.steps >= k, ctx, STEIF_BAD_INPUT,
              "%ld steps are too few: %s needs %d values to begin with", c->out.steps, method,
              k);
  const size_t d = (size_t)c->v.d;
  c->z = stf_pool_array(pool, (2 * ((size_t)k + 1) + 4) * d, sizeof *c->z);
  if (!c->z) return STEIF_NO_MEMORY;
  c->x = c->z + 2 * ((size_t)k + 1) * d;
  c->old = c->x + d;
  c->y = c->old + d;
  return STEIF_OK;
}

int steif_growth_measure(steif_context *ctx, const steif_problem *problem, const char *method,
                         const steif_lyapunov_options *options, steif_growth_facts *facts)
{
  STF_NAMED(problem);
  column c = {.lte_old = 0};
  steif_method_info info;
  STEIF_CHECK(problem && method && options && facts, ctx, STEIF_BAD_INPUT,
              "a problem, a method, options and room for the facts are needed");
  STEIF_TRY(steif_method_find(ctx, method, &info));
  c.multistep = !strcmp(info.family, "bdf");
  c.weak_start = options->weak_start != 0;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = open(pool, ctx, problem, method, options, &c);
  if (code == STEIF_OK) code = begin(&c);
  if (code == STEIF_OK) code = follow(&c, options);
  if (code == STEIF_STOPPED) c.out.steps = c.made;
  if (code == STEIF_OK || code == STEIF_STOPPED) *facts = c.out;
  stf_pool_free(&pool);
  return code;
}
