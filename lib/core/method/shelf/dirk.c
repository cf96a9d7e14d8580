/* dirk.c: diagonally implicit Runge-Kutta methods with one nonzero diagonal entry gamma, stage
 * after stage with one real shift 1/(gamma h); an explicit first stage takes the last slope.
 *
 *   Y_i = y_n + h sum_{j<i} a_ij K_j + Z_i,  K_i = Z_i / (gamma h),  F(t_n + c_i h, Y_i, K_i) =
 * 0. Error estimate: h sum (b_i - bhat_i) K_i filtered by (E/(gamma h) - A)^{-1} E/(gamma h).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "stage_chain.h"
#include "step_error.h"

typedef struct state {
  const steif_table *table;
  stf_chain chain;
  int s, first;  /* first implicit stage, 0 or 1 */
  N_Vector *old; /* slopes of the last step */
  N_Vector before;
  N_Vector *power; /* coefficients of the solution between the ends, and one more */
  bool accurate;   /* stiffly accurate */
  bool stepped;
  stf_carried carried;
  sunrealtype wanted; /* what an estimate may be where all errors add */
} state;

static int check(stf_step *s, state *e)
{
  const steif_table *T = e->table;
  e->first = T->A[0] == 0;
  for (int i = e->first; i < T->s; i++)
    STEIF_CHECK(
      T->A[i * (T->s + 1)] > 0, s->ctx, STEIF_UNSUPPORTED,
      "table '%s' has the diagonal entry %g at stage %d: explicit stages are served at the "
      "beginning only",
      T->name, T->A[i * (T->s + 1)], i + 1);
  STEIF_CHECK(
    !e->first || s->yp_known, s->ctx, STEIF_UNSUPPORTED,
    "'dirk:%s' begins with the slope y'(t0), which form %s of problem '%s' does not give: "
    "set .yp0, or take a method with an implicit first stage",
    T->name, steif_form_name(s->system.form), s->problem->name);
  STEIF_CHECK(!e->first || (T->claims & STEIF_STIFFLY_ACCURATE), s->ctx, STEIF_UNSUPPORTED,
              "table '%s' has an explicit first stage and is not stiffly accurate", T->name);
  STEIF_CHECK(!s->adaptive || T->bhat, s->ctx, STEIF_UNSUPPORTED,
              "'dirk:%s' has no embedded method: give steps with h", T->name);
  return STEIF_OK;
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)spec;
  state *e = s->state;
  e->table = table, e->s = table->s;
  e->accurate = table->claims & STEIF_STIFFLY_ACCURATE;
  e->chain = (stf_chain){.s = e->s, .k = 1, .A = table->A, .c = table->c};
  STEIF_TRY(check(s, e));
  STEIF_TRY(stf_check_index(s, table->name));
  STEIF_TRY(stf_chain_open(s, table->name, &e->chain));
  e->old = stf_pool_vectors(s->pool, e->s, s->y);
  e->before = stf_pool_vector(s->pool, s->y);
  e->power = stf_pool_vectors(s->pool, 4, s->y);
  const int q = table->order_hat < table->order ? table->order_hat : table->order;
  STEIF_TRY(stf_share_open(s, table->name, q, table->order, 0.1));
  e->wanted = s->control.tolerance;
  if (e->accurate) STEIF_TRY(stf_carried_by_one_step(s, 6, 0.06, &e->carried));
  return e->old && e->before && e->power ? STEIF_OK : STEIF_NO_MEMORY;
}

/* The estimate filtered once, which base still has, where the second filter leaves nothing of it: unknowns of index 2. */
static void raise(stf_step *s, sunrealtype h, sunrealtype whole)
{
  const state *e = s->state;
  const sunrealtype nothing = 1e-6;
  if (s->error_norm < nothing * whole) {
    stf_scale(&s->system.space, nothing * e->chain.gamma * h, e->chain.base, s->error);
    s->error_norm = nothing * whole;
  }
  stf_raise_stiff(s, whole);
}

/* Stiff components have the order of the stages: their error is between the estimate filtered once, `whole`, and twice.
 * That of methods of stage order 1 is small for the sake of the others. */
static int estimate(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  sunrealtype weight[STEIF_STAGES];
  for (int i = 0; i < e->s; i++)
    weight[i] = (e->table->b[i] - e->table->bhat[i]) / e->chain.gamma;
  const stf_space *space = &s->system.space;
  stf_combine(space, e->s, weight, e->chain.K, e->chain.base);
  STEIF_TRY(stf_chain_filter(s, &e->chain));
  if (!e->accurate) return STEIF_OK;
  const sunrealtype whole = stf_norm(space, s->error, s->weights), stiff = 0.1;
  stf_scale(space, 1 / (e->chain.gamma * h), s->error, e->chain.base);
  STEIF_TRY(stf_chain_filter(s, &e->chain));
  s->error_norm = stf_norm(space, s->error, s->weights);
  s->control.tolerance =
    s->error_norm < stiff * whole ? e->wanted : stf_carried_share(&e->carried, e->wanted);
  if (e->first) raise(s, h, whole);
  return STEIF_OK;
}

/* The coefficients of `polynomial` with d = y_{n+1} - y_n and slopes f, g at the ends: x (2 d - h g) + x^2 (h g - d), or
 * x h f + x^2 (3 d - 2 h f - h g) + x^3 (h f + h g - 2 d). */
static void between(stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  N_Vector *c = e->power, d = c[3], g = e->chain.K[e->s - 1],
           f = e->first ? e->chain.K[0] : NULL;
  if (!e->accurate) return;
  stf_sum(space, 1, s->next, -1, s->y, d);
  if (f) {
    stf_scale(space, h, f, c[0]);
    stf_sum(space, 3, d, -h, g, c[1]);
    stf_axpy(space, -2 * h, f, c[1]);
    stf_sum(space, h, f, h, g, c[2]);
    stf_axpy(space, -2, d, c[2]);
  } else {
    stf_sum(space, 2, d, -h, g, c[1]);
    stf_sum(space, -1, d, h, g, c[2]);
  }
  stf_between_powers(s, f ? 3 : 2, c);
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  stf_chain *chain = &e->chain;
  STEIF_TRY(stf_carried_retry(s, &e->carried));
  if (e->first) {
    const bool start = !e->stepped || (s->restart && s->yp_known);
    stf_copy(space, start ? s->yp : e->old[e->s - 1], chain->K[0]);
    stf_copy(space, s->y, chain->X[0]);
  }
  chain->guess = e->stepped && !s->restart ? e->old[e->s - 1] : NULL;
  STEIF_TRY(stf_chain_run(s, chain, e->first, &s->y, h));
  if (e->accurate)
    stf_copy(space, chain->X[e->s - 1], s->next);
  else {
    stf_combine(space, e->s, e->table->b, chain->K, s->next);
    stf_sum(space, 1, s->y, h, s->next, s->next);
  }
  if (!s->adaptive) return STEIF_OK;
  between(s, h);
  return estimate(s, h);
}

static void commit(stf_step *s)
{
  state *e = s->state;
  N_Vector *K = e->old, y = e->before;
  const sunrealtype own = 1 / (e->chain.gamma * s->h_try); /* which operators follow */
  stf_carried_add(s, &e->carried, s->system.krylov ? own : s->newton.shift, s->error,
                  s->error_norm);
  stf_carried_newton(s, &e->carried);
  e->old = e->chain.K, e->chain.K = K;
  e->before = s->y, s->y = s->next, s->next = y;
  e->stepped = true;
  if (s->system.form == STEIF_IMPLICIT) stf_copy(&s->system.space, e->old[e->s - 1], s->yp);
}

/* Both end values, the slope at the end (last stage of a stiffly accurate method) and the slope
 * at the start (explicit first stage): of degree 1 to 3, as many as the method gives. */
static int polynomial(const stf_step *s, sunrealtype t, N_Vector before, N_Vector y,
                      N_Vector *K, N_Vector out)
{
  const state *e = s->state;
  const sunrealtype x = (t - (s->t - s->h)) / s->h, u = 1 - x;
  if (!e->accurate || !e->first) {
    const sunrealtype end = e->accurate ? 1 : 0,
                      c[] = {u * (1 - end * x), x * (1 + end * u), -s->h * x * u * end};
    N_Vector v[] = {before, y, K[e->s - 1]};
    stf_combine(&s->system.space, 3, c, v, out);
    return STEIF_OK;
  }
  const sunrealtype c[] = {u * u * (1 + 2 * x), x * x * (1 + 2 * u), s->h * x * u * u,
                           -s->h * x * x * u};
  N_Vector v[] = {before, y, K[0], K[e->s - 1]};
  stf_combine(&s->system.space, 4, c, v, out);
  return STEIF_OK;
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  return polynomial(s, t, e->before, s->y, e->old, y);
}

static int stages(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
                  N_Vector **X)
{
  const state *e = s->state;
  *count = e->s, *c = e->table->c, *b = e->table->b, *X = e->chain.X;
  return STEIF_OK;
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vectors(m, e->s, e->old);
  stf_keep_vectors(m, e->s, e->chain.X);
  stf_keep_vector(m, e->before);
  STF_KEEP(m, e->stepped);
  stf_carried_keep(&e->carried, m);
}

/* ---- derivatives by parameters: trial and kept hold those of the slopes K ------------------------ */

static stf_carrier_size sizes(const stf_step *s)
{
  const state *e = s->state;
  return (stf_carrier_size){e->s, 1, e->s, e->s, 0};
}

/* Explicit: that of the last slope, or at the beginning of y' = f itself; point 0 is the start. */
static int first_slope(stf_carry *T)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const bool start = !e->stepped || (s->restart && s->yp_known);
  if (start) STEIF_TRY(stf_carry_point(T, 0, s->t, s->y, s->yp));
  for (int k = 0; k < T->count; k++)
    if (!start)
      stf_copy(&s->system.space, T->kept[k][e->s - 1], T->trial[k][0]);
    else
      STEIF_TRY(stf_carry_residual(T, 0, k, T->S[k], NULL, T->trial[k][0]));
  return STEIF_OK;
}

static int carry_stage(stf_carry *T, sunrealtype h, int i)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  const sunrealtype shift = 1 / (e->chain.gamma * h), t = s->t + e->table->c[i] * h;
  N_Vector Y = e->chain.X[i], Yp = e->chain.K[i];
  const bool guess = !s->system.linear && (i > 0 || (T->history && !s->restart));
  STEIF_TRY(stf_carry_point(T, i, t, Y, Yp));
  for (int k = 0; k < T->count; k++) {
    stf_combine(space, i, e->table->A + i * e->s, T->trial[k], T->next[k]);
    stf_sum(space, 1, T->S[k], h, T->next[k], T->next[k]);
    if (guess)
      stf_scale(space, 1 / shift, i > 0 ? T->trial[k][i - 1] : T->kept[k][e->s - 1],
                T->trial[k][i]);
  }
  const stf_carry_stages g = {.first = i,
                              .m = 1,
                              .t = t,
                              .h = h,
                              .predicted = guess,
                              .Y = Y,
                              .Yp = Yp,
                              .B_over_h = &shift,
                              .base = T->next,
                              .to = i};
  STEIF_TRY(stf_carry_solve(T, &g));
  for (int k = 0; k < T->count; k++) stf_scale(space, shift, T->trial[k][i], T->trial[k][i]);
  return STEIF_OK;
}

static int carry_estimate(stf_carry *T, sunrealtype h, int k)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  sunrealtype weight[STEIF_STAGES];
  for (int i = 0; i < e->s; i++)
    weight[i] = (e->table->b[i] - e->table->bhat[i]) / e->chain.gamma;
  stf_combine(space, e->s, weight, T->trial[k], T->error[k]);
  for (int round = 0; round < 1 + e->accurate; round++) {
    if (round) stf_scale(space, 1 / (e->chain.gamma * h), T->error[k], T->error[k]);
    STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', T->error[k], T->work));
    stf_copy(space, T->work, T->error[k]);
    STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &T->error[k], NULL));
  }
  T->tolerance[k] = stf_carry_allowed(s, e->wanted, s->control.order, e->table->order);
  return STEIF_OK;
}

static int carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  if (e->first) STEIF_TRY(first_slope(T));
  for (int i = e->first; i < e->s; i++) STEIF_TRY(carry_stage(T, h, i));
  const sunrealtype *b = e->accurate ? e->table->A + (e->s - 1) * e->s : e->table->b;
  for (int k = 0; k < T->count; k++) {
    stf_combine(space, e->s, b, T->trial[k], T->next[k]);
    stf_sum(space, 1, T->S[k], h, T->next[k], T->next[k]);
    if (s->adaptive) STEIF_TRY(carry_estimate(T, h, k));
  }
  return STEIF_OK;
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  return polynomial(T->step, t, T->before[k], T->S[k], T->kept[k], S);
}

static int check_carry(const stf_step *s)
{
  const state *e = s->state;
  STEIF_CHECK(
    !e->first || s->system.form == STEIF_ODE, s->ctx, STEIF_UNSUPPORTED,
    "'dirk:%s' begins with y'(t0), whose derivative by parameters is known for y' = f "
    "only: take dirk:hw43 or radau:s=3 for problem '%s'",
    e->table->name, s->problem->name);
  STEIF_CHECK(e->chain.gamma > 0, s->ctx, STEIF_UNSUPPORTED,
              "'dirk:%s' is explicit and carries no sensitivities", e->table->name);
  return STEIF_OK;
}

static const stf_carrier carrier = {.check = check_carry,
                                    .size = sizes,
                                    .carry = carry,
                                    .apply = stf_newton_carry_apply,
                                    .renew = stf_newton_carry_renew,
                                    .dense = carried_dense};

static int trace(const stf_step *s, stf_trace *out)
{
  const state *e = s->state;
  *out = (stf_trace){.kind = STF_TRACE_CHAIN, .Y = e->chain.X, .Yp = e->old};
  return check_carry(s);
}

static int propagator(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                      const sunrealtype z[2], int *r, sunrealtype *M)
{
  (void)spec;
  sunrealtype R[2];
  STEIF_TRY(steif_table_stability(ctx, table, z, R));
  stf_propagate_scalar(R, r, M);
  return STEIF_OK;
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  static const char *const keys[] = {"", NULL};
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  info->family = "dirk", info->about = table->about;
  info->order = table->order, info->stages = table->s, info->claims = table->claims;
  info->adaptive = table->bhat != NULL;
  return STEIF_OK;
}

static const stf_tables tables = {
  .kind = STEIF_DIRK, .prefix = "dirk", .example = "dirk:alexander2"};

const steif_method steif_method_dirk = {
  .about = "diagonally implicit Runge-Kutta",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .traits = STF_ADAPTIVE,
  .tables = &tables,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .stages = stages,
  .trial = stages,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .carrier = &carrier,
  .trace = trace,
};
