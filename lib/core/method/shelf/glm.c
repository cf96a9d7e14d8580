/* glm.c: general linear methods, explicit or with one real shift:
 *   G = U X_n + h C F,   X_{n+1} = V X_n + h D F.
 * What a step leaves, X_{n+1}, h F and X_n, determines Nordsieck's vector z of order p (as far
 * as W asks for it), and from it the solution, the history for another step length, X <- W
 * diag(q^j) z, and dense output; the combination that gives error h^{p+1} y^{(p+1)} is the
 * estimate. Where there is none the change of z_p = h^p y^(p) since the last step gives it, in the first
 * step the values of the start. The start is fitted to p further values within the first step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "glm_state.h"
#include "step_error.h"
#include <math.h>

enum { DATA = STF_GLM_DATA, POWERS = STF_GLM_POWERS };

static const sunrealtype rounding = 5e-14;

typedef stf_glm_state state;

static stf_glm_step last_step(const state *e)
{
  return (stf_glm_step){e->at, e->slopes, e->past, e->scale};
}

static stf_glm_step trial_step(const state *e, sunrealtype h)
{
  return (stf_glm_step){e->to, e->chain.K, e->x, h};
}

static bool uses(const steif_glm *g, int j)
{
  for (int i = 0; i < g->k; i++)
    if (g->W[i * (g->order + 1) + j] != 0) return true;
  return false;
}

/* ---- opening ---- */

static int rows(stf_step *s, state *e)
{
  const steif_glm *g = e->g;
  sunrealtype target[POWERS + 1] = {0};
  bool found = true;
  e->dense = true;
  for (int j = 0; j <= e->p; j++) {
    target[j] = 1;
    STEIF_TRY(stf_glm_combination(s->ctx, g, target, false, e->z + j * e->data, &e->known[j]));
    target[j] = 0;
    found = found && (e->known[j] || !uses(g, j));
    e->dense = e->dense && e->known[j];
  }
  STEIF_TRY(stf_glm_solution(s->ctx, g, e->finish));
  s->rest = e->dense ? STF_REST_ACROSS : found ? STF_REST_SHORTER : STF_REST_NONE;
  STEIF_CHECK(
    found || s->h_equal > 0, s->ctx, STEIF_UNSUPPORTED,
    "'%s' cannot change its step: X does not determine Nordsieck's vector; give equal "
    "steps with h",
    g->name);
  target[e->p + 1] = g->error;
  return stf_glm_combination(s->ctx, g, target, true, e->error, &e->estimates);
}

static int check(stf_step *s, const steif_glm *g)
{
  const enum steif_table_kind shape = stf_glm_shape(g);
  STEIF_CHECK(shape != STEIF_COLLOCATION, s->ctx, STEIF_UNSUPPORTED,
              "'%s' has a full C: stages one after another are served, C lower triangular",
              g->name);
  bool explicit_ = false;
  for (int i = 0; i < g->r; i++) explicit_ = explicit_ || g->C[i * (g->r + 1)] == 0;
  STEIF_CHECK(!explicit_ || s->system.form == STEIF_ODE, s->ctx, STEIF_UNSUPPORTED,
              "'%s' has explicit stages, which need y' = f(t, y); problem '%s' has form %s",
              g->name, s->problem->name, steif_form_name(s->system.form));
  STEIF_CHECK(g->order <= STEIF_PAST, s->ctx, STEIF_UNSUPPORTED,
              "'%s' has order %d; %d is the highest served", g->name, g->order, STEIF_PAST);
  return STEIF_OK;
}

/* With algebraic unknowns errors must not grow where |z| is infinite. */
static int check_infinity(stf_step *s, const steif_glm *g)
{
  const sunrealtype bounded = 1 + 1e-3;
  sunrealtype radius;
  if (!s->adaptive || s->problem->dae_index < 1) return STEIF_OK;
  STEIF_TRY(stf_glm_at_infinity(s->ctx, g, &radius));
  STEIF_CHECK(
    !(radius > bounded), s->ctx, STEIF_UNSUPPORTED,
    "'%s' multiplies errors of algebraic unknowns by %.3g in each step, and problem "
    "'%s' has some: take bdf, radau:s=3 or another method that is bounded at infinity",
    g->name, radius, s->problem->name);
  return STEIF_OK;
}

/* The last terms of the Taylor polynomial at the end, whose x is 0 there and -1 at the start. */
static void between(stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  const stf_glm_step now = trial_step(e, h);
  sunrealtype d[DATA], factorial = 1;
  if (!e->dense || e->p < 2) return;
  for (int j = 1; j <= e->p; j++) {
    factorial *= j;
    if (j < e->p - 2) continue;
    for (int m = 0; m < e->data; m++) d[m] = e->z[j * e->data + m] / factorial;
    stf_glm_combine(s, d, &now, e->power[j - e->p + 2]);
  }
  stf_between_taylor(s, e->p, e->power);
}

/* Explicit methods refuse what is below rounding. Implicit ones carry their errors along, and are believed
 * where order 2, or rounding, leaves no room for what problems make of them. */
static int open_share(stf_step *s)
{
  state *e = s->state;
  const sunrealtype part = 0.5;
  if (!s->adaptive) return STEIF_OK;
  if (!(e->chain.gamma > 0)) {
    STEIF_TRY(stf_share_open(s, e->g->name, e->p, e->p, 0.5));
    e->explicit_share = part * s->control.tolerance;
    return STEIF_OK;
  }
  s->control.order = e->p;
  e->wanted = part * stf_share(s, e->p, e->p, 0);
  const bool rough = e->p <= 2 || 2 * e->wanted < rounding / s->options->rtol;
  return stf_carried_open(s, rounding, 0.05, rough, &e->carried);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  state *e = s->state;
  const steif_glm *g = e->g = table->general;
  (void)spec;
  e->k = g->k, e->r = g->r, e->p = g->order, e->data = 2 * e->k + e->r;
  e->chain = (stf_chain){.s = g->r, .k = g->k, .A = g->C, .c = g->xi, .U = g->U};
  STEIF_TRY(check(s, g));
  STEIF_TRY(stf_check_index(s, g->name));
  STEIF_TRY(check_infinity(s, g));
  STEIF_TRY(rows(s, e));
  const int powers = stf_glm_powers(g), count = powers || e->estimates ? powers : 1;
  const bool explicit_ = stf_glm_shape(g) == STEIF_EXPLICIT;
  STEIF_TRY(stf_begin_open(s, count, e->p, explicit_, &e->begin));
  e->first = stf_pool_array(s->pool, (size_t)(e->k * (count + 1)), sizeof *e->first);
  if (!e->first) return STEIF_NO_MEMORY;
  stf_glm_first(g, count, e->first);
  STEIF_TRY(stf_chain_open(s, g->name, &e->chain));
  STEIF_TRY(open_share(s));
  e->at = stf_pool_vectors(s->pool, e->k, s->y);
  e->past = stf_pool_vectors(s->pool, e->k, s->y);
  e->from = stf_pool_vectors(s->pool, e->k, s->y);
  e->to = stf_pool_vectors(s->pool, e->k, s->y);
  e->slopes = stf_pool_vectors(s->pool, e->r, s->y);
  e->before = stf_pool_vector(s->pool, s->y);
  e->power = stf_pool_vectors(s->pool, 3, s->y);
  s->control.grow = 2; /* history of a much shorter step is of little use */
  return e->at && e->past && e->from && e->to && e->slopes && e->before && e->power
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

/* ---- a step ---- */

static int history(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  e->x = e->from;
  if (e->begun) {
    STEIF_TRY(stf_begin_run(s, &e->begin, h));
    stf_mix(&s->system.space, e->k, e->begin.count + 1, e->first, e->begin.part->value,
            e->from);
    return STEIF_OK;
  }
  /* Lengths that differ by the rounding of the clock are the same. */
  if (fabs(h - e->scale) <= 4 * STF_EPS * (fabs(s->t) + h))
    e->x = e->at;
  else {
    const stf_glm_step last = last_step(e);
    stf_glm_rescale(s, h, &last, e->from);
  }
  return STEIF_OK;
}

static int advance(stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  const stf_glm_step now = trial_step(e, h);
  stf_glm_advance(s, &now, s->next);
  if (!stf_finite(&s->system.space, s->next))
    return STEIF_RECOVER(
      s->ctx, STEIF_NOT_FINITE,
      "the step of problem '%s' from t = %.12g with h = %.6g overflowed: the "
      "step is too large for '%s'",
      s->problem->name, s->t, h, e->g->name);
  return STEIF_OK;
}

static int estimate(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const sunrealtype filter = e->chain.gamma > 0 ? 1 / (e->chain.gamma * h) : 1;
  const stf_glm_step now = trial_step(e, h), last = last_step(e);
  if (e->begun && !e->estimates)
    stf_sum(space, 1, s->next, -1, e->begin.part->value[e->begin.count], e->chain.base);
  else
    stf_glm_error(s, &now, &last, s->error, e->chain.base);
  stf_scale(space, filter, e->chain.base, e->chain.base);
  return stf_chain_filter(s, &e->chain);
}

/* What the estimate may be. Those of first steps show the rounding of the values that the start is fitted
 * to; they do not add up. */
static int set_tolerance(stf_step *s)
{
  state *e = s->state;
  const sunrealtype first = 0.05;
  sunrealtype allowed = e->explicit_share;
  if (e->chain.gamma > 0) {
    STEIF_TRY(stf_carried_retry(s, &e->carried));
    allowed = stf_carried_share(&e->carried, e->wanted);
  }
  s->control.tolerance = e->begun ? fmax(allowed, first) : allowed;
  if (e->chain.gamma > 0)
    stf_share_newton(s, fmax(rounding, 0.1 * e->carried.least * s->options->rtol));
  return STEIF_OK;
}

/* Errors are carried on by the factors of the steps: those of a Jacobian that Newton's iteration alone would
 * keep for ever are not theirs. */
static void renew(stf_step *s)
{
  enum { AGE = 50, YOUNG = 10 };
  state *e = s->state;
  if (s->system.nje != e->seen) e->seen = s->system.nje, e->since = s->count;
  if (s->count - e->since >= (e->carried.exact ? YOUNG : AGE)) s->newton.jacobian_wanted = true;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  if (e->wanted > 0) renew(s);
  e->begun = s->count == 0 || s->restart;
  if (s->adaptive) STEIF_TRY(set_tolerance(s));
  STEIF_TRY(history(s, h));
  e->chain.guess = s->count > 0 && !s->restart ? e->slopes[e->r - 1] : NULL;
  STEIF_TRY(stf_chain_run(s, &e->chain, 0, e->x, h));
  STEIF_TRY(advance(s, h));
  if (!s->adaptive) return STEIF_OK;
  if (e->chain.gamma > 0) between(s, h);
  return estimate(s, h);
}

static void commit(stf_step *s)
{
  state *e = s->state;
  if (e->wanted > 0) {
    stf_carried_add(s, &e->carried, 1 / (e->chain.gamma * s->h_try), s->error, s->error_norm);
    stf_carried_tell(&e->carried, e->wanted, &s->control);
  }
  N_Vector *free1 = e->past, *free2 = e->x == e->at ? e->from : e->at, *F = e->slopes,
           y = e->before;
  e->past = e->x, e->at = e->to, e->to = free1, e->from = free2;
  e->slopes = e->chain.K, e->chain.K = F;
  e->scale = s->h_try;
  e->before = s->y, s->y = s->next, s->next = y;
  if (s->system.form == STEIF_IMPLICIT) stf_copy(&s->system.space, e->slopes[e->r - 1], s->yp);
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  const stf_glm_step last = last_step(e);
  stf_glm_dense(s, t, &last, e->before, s->y, y);
  return STEIF_OK;
}

/* ---- the rest ---- */

static int stages(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
                  N_Vector **X)
{
  const state *e = s->state;
  *count = e->r, *c = e->g->xi, *b = NULL, *X = e->chain.X;
  return STEIF_OK;
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vectors(m, e->k, e->at);
  stf_keep_vectors(m, e->k, e->past);
  stf_keep_vectors(m, e->r, e->slopes);
  stf_keep_vectors(m, e->r, e->chain.X);
  stf_keep_vector(m, e->before);
  STF_KEEP(m, e->scale);
  STF_KEEP(m, e->seen);
  STF_KEEP(m, e->since);
  stf_carried_keep(&e->carried, m);
}

static int propagator(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                      const sunrealtype z[2], int *r, sunrealtype *M)
{
  (void)spec;
  *r = table->general->k;
  return M ? steif_glm_propagator(ctx, table->general, z, M) : STEIF_OK;
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  const steif_glm *g = table->general;
  sunrealtype target[POWERS + 1] = {0}, d[DATA];
  bool estimates = false, damps = true;
  (void)spec;
  info->family = "glm", info->about = table->about;
  info->order = g->order, info->stages = g->r, info->claims = table->claims;
  if (g->order <= STEIF_PAST) {
    target[g->order] = 1;
    STEIF_TRY(stf_glm_combination(ctx, g, target, false, d, &estimates));
    target[g->order] = 0, target[g->order + 1] = g->error;
    if (!estimates) STEIF_TRY(stf_glm_combination(ctx, g, target, true, d, &estimates));
    STEIF_TRY(stf_glm_rescales(ctx, g, &damps));
  }
  info->adaptive = estimates && damps && g->error != 0;
  return STEIF_OK;
}

static const stf_tables tables = {
  .kind = STEIF_GLM, .prefix = "glm", .example = "glm:nord22, glm:ab,p=3, glm:file=PATH"};

static stf_example example(size_t i)
{
  static const char *const spec[] = {"glm:ab,p=2",
                                     "glm:ab,p=3",
                                     "glm:ab,p=4",
                                     "glm:am,p=2",
                                     "glm:am,p=3",
                                     "glm:am,p=4",
                                     "glm:bdf,p=3",
                                     "glm:irks,p=1",
                                     "glm:irks,p=2",
                                     "glm:irks,p=3",
                                     "glm:irks,p=4",
                                     "glm:dimsim1,p=3",
                                     "glm:dimsim1,p=4",
                                     "glm:dimsim2,p=3",
                                     "glm:dimsim2,p=4",
                                     "glm:nordsieck,of=bdf,p=2",
                                     "glm:nordsieck,of=bdf,p=4",
                                     "glm:nordsieck,of=am,p=3",
                                     "glm:nordsieck,of=am,p=5"};
  return (stf_example){i < sizeof spec / sizeof *spec ? spec[i] : NULL, 4};
}

const steif_method steif_method_glm = {
  .about = "general linear methods",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .traits = STF_ADAPTIVE,
  .tables = &tables,
  .example = example,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .stages = stages,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .carrier = &stf_glm_carrier,
};
