/* irk.c: fully implicit Runge-Kutta methods (Gauss, Radau, Lobatto IIIC), all stages at once.
 *
 * Stages Y_i = y_n + Z_i with slopes Y_i' = (1/h) sum_m B_im Z_m, B = A^{-1}, are solved through the split of B. The
 * polynomial u(t_n + x h) of stage_polynomial.h gives the end value (w(1) = b^T B), the start of the next iteration and
 * dense output.
 * compensated=1: stages solved until rounding stops it, coefficients in two parts, and the end value
 * a sum that remembers its rounding (E. Hairer, R. I. McLachlan and A. Razakarivony, BIT 48 (2008)).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kick_drift.h"
#include "carry.h"
#include "irk_state.h"
#include "step_error.h"
#include <math.h>

typedef stf_irk_state state;

static int claim(stf_step *s, state *e)
{
  const size_t count = (size_t)e->s;
  e->row_sum = stf_pool_array(s->pool, count, sizeof *e->row_sum);
  e->Z = stf_pool_vectors(s->pool, e->s, s->y);
  e->trial = stf_pool_vectors(s->pool, e->s, s->y);
  e->X = stf_pool_vectors(s->pool, e->s, s->y);
  e->base = stf_pool_array(s->pool, count, sizeof *e->base);
  e->offset = s->absolute ? stf_pool_vectors(s->pool, e->s, s->y) : e->base;
  e->before = stf_pool_vector(s->pool, s->y);
  e->work = stf_pool_vector(s->pool, s->y);
  e->imaginary = stf_pool_vector(s->pool, s->y);
  return e->imaginary && e->row_sum && e->Z && e->trial && e->X && e->base && e->offset &&
             e->before && e->work
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

static int open_sums(stf_step *s, const steif_spec *spec)
{
  state *e = s->state;
  int compensated;
  STEIF_TRY(stf_spec_int(s->ctx, spec, "compensated", 0, 1, 0, &compensated));
  if (!compensated) return STEIF_OK;
  STEIF_CHECK(!s->absolute, s->ctx, STEIF_UNSUPPORTED,
              "compensated=1 of '%s' is for problems that are not of form descriptor",
              spec->name);
  STEIF_TRY(stf_transform_parts(s->pool, s->ctx, e->table, &e->parts));
  for (int i = 0; i < 2; i++) s->newton.B_part[i] = e->parts.B[i];
  e->lost = stf_pool_vector(s->pool, s->y);
  e->next_lost = stf_pool_vector(s->pool, s->y);
  return e->lost && e->next_lost ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Sparse factors cost many solves: one real matrix is factored in place of s, and serves steps within a ratio of 2. The
 * iteration converges linearly however exact the Jacobian: renewed when it does worse than 0.4, or with the factors. */
static int blend(stf_step *s)
{
  state *e = s->state;
  stf_newton *newton = &s->newton;
  const sunrealtype re = newton->transform.re[0], im = newton->transform.im[0];
  e->filter = re / (re * re + im * im);
  newton->shift_ratio_most = 2, newton->renew_with_factors = true, newton->stale_rate = 0.4;
  if (!s->options->iterations) newton->iterations = 14;
  return stf_newton_blend(s->pool, s->table, newton);
}

/* What the iteration may leave, of the index that holds now: events change it. */
static void aim(stf_step *s)
{
  const bool blended = s->newton.gamma > 0;
  stf_stages_known(s, blended ? 0 : s->table->order);
  if (blended && !(s->options->newton > 0) && s->problem->dae_index < 2)
    s->newton.tolerance = 0.03;
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  state *e = s->state;
  stf_transform transform;
  e->table = table, e->s = table->s;
  if (!(table->claims & STEIF_STIFFLY_ACCURATE)) STEIF_TRY(stf_check_index(s, table->name));
  STEIF_TRY(stf_transform_build(s->pool, s->ctx, table, &transform));
  STEIF_TRY(stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  STEIF_TRY(claim(s, e));
  STEIF_TRY(open_sums(s, spec));
  STEIF_TRY(stf_stage_polynomial_open(s->pool, table, transform.B, &e->u));
  for (int j = 0; j < e->s; j++) {
    e->row_sum[j] = 0;
    for (int m = 0; m < e->s; m++) e->row_sum[j] += transform.B[j * e->s + m];
  }
  STEIF_CHECK(!s->adaptive || table->c[0] > 0, s->ctx, STEIF_UNSUPPORTED,
              "'%s' has no error estimate (its first node is 0): give steps with h",
              table->name);
  const bool factors = s->system.storage == STEIF_SPARSE && !s->system.krylov,
             blended = s->adaptive && table->s > 1 && !s->system.linear && factors;
  if (blended) STEIF_TRY(blend(s));
  stf_estimate_open(&e->higher_order, table, &transform, s->options->rtol);
  return STEIF_OK;
}

/* Stage increments of the next step from the last one's; zero for linear systems, whose one solve
 * needs no start. Of equations that are not linear in y' the slope at the start says which solution is meant. */
static void predict(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  if (s->system.linear && (!s->system.krylov || s->absolute)) return;
  if (!e->history || s->restart) {
    const bool known =
      s->yp_known && s->system.form == STEIF_IMPLICIT && (s->restart || s->count == 0);
    for (int j = 0; j < e->s; j++)
      known ? stf_scale(space, e->table->c[j] * h, s->yp, e->trial[j])
            : stf_zero(space, e->trial[j]);
    return;
  }
  stf_mix(space, e->s, e->s, stf_stage_polynomial_ahead(&e->u, h / s->h), e->Z, e->trial);
}

static int solve(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  stf_stages g = {
    .t = s->t, .h = h, .c = e->table->c, .Z = e->trial, .predicted = !s->absolute};
  if (!s->absolute) {
    for (int j = 0; j < e->s; j++) e->base[j] = s->y;
    g.base = e->base;
    STEIF_TRY(stf_solve_stages(s, &g));
    return e->lost ? stf_newton_polish(&s->newton, &g) : STEIF_OK;
  }
  for (int j = 0; j < e->s; j++) stf_scale(space, -e->row_sum[j] / h, s->y, e->offset[j]);
  g.offset = e->offset;
  STEIF_TRY(stf_solve_stages(s, &g));
  if (e->u.accurate) stf_copy(space, e->trial[e->s - 1], s->next);
  for (int j = 0; j < e->s; j++) stf_axpy(space, -1, s->y, e->trial[j]);
  return STEIF_OK;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  aim(s);
  predict(s, h);
  STEIF_TRY(solve(s, h));
  if (e->lost) {
    stf_combine(space, e->s, e->parts.w[0], e->trial, e->work);
    stf_combine(space, e->s, e->parts.w[1], e->trial, e->imaginary);
    stf_axpy(space, 1, e->imaginary, e->work);
    stf_add_compensated(space, e->work, (stf_point){s->y, e->lost},
                        (stf_point){s->next, e->next_lost});
  } else if (!e->u.accurate) {
    stf_combine(space, e->s, e->u.end, e->trial, s->next);
    stf_axpy(space, 1, s->y, s->next);
  } else if (!s->absolute)
    stf_sum(space, 1, s->y, 1, e->trial[e->s - 1], s->next);
  if (!s->adaptive) return STEIF_OK;
  return stf_irk_estimate(s, h);
}

static void commit(stf_step *s)
{
  state *e = s->state;
  N_Vector *Z = e->Z, y = e->before, lost = e->lost;
  e->Z = e->trial, e->trial = Z;
  e->before = s->y, s->y = s->next, s->next = y;
  e->lost = e->next_lost, e->next_lost = lost;
  e->history = true, e->fails = s->newton.fails;
  if (s->system.form == STEIF_IMPLICIT)
    stf_copy(&s->system.space, s->newton.Zp[e->s - 1], s->yp);
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  return stf_stage_polynomial_at(&e->u, &s->system.space, (t - (s->t - s->h)) / s->h, e->before,
                                 e->Z, y);
}

static int stages(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
                  N_Vector **X)
{
  const state *e = s->state;
  *count = e->s, *c = e->table->c, *b = e->table->b, *X = e->X;
  for (int j = 0; j < e->s; j++) stf_sum(&s->system.space, 1, e->before, 1, e->Z[j], e->X[j]);
  return STEIF_OK;
}

static int trial_stages(const stf_step *s, int *count, const sunrealtype **c,
                        const sunrealtype **b, N_Vector **X)
{
  const state *e = s->state;
  *count = e->s, *c = e->table->c, *b = e->table->b, *X = e->X;
  for (int j = 0; j < e->s; j++) stf_sum(&s->system.space, 1, s->y, 1, e->trial[j], e->X[j]);
  return STEIF_OK;
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vectors(m, e->s, e->Z);
  stf_keep_vector(m, e->before);
  if (e->lost) stf_keep_vector(m, e->lost);
  STF_KEEP(m, e->omega);
  STF_KEEP(m, e->omega_of);
  STF_KEEP(m, e->fails);
  STF_KEEP(m, e->history);
}

static stf_carrier_size sizes(const stf_step *s)
{
  const state *e = s->state;
  return (stf_carrier_size){e->s + s->adaptive, e->s, e->s, e->s, e->s};
}

static int carry(stf_carry *T, sunrealtype h)
{
  state *e = T->step->state;
  const stf_collocation_stages c = {.u = &e->u,
                                    .ahead = &e->u,
                                    .B_over_h = T->step->newton.B_over_h,
                                    .estimate = &e->higher_order,
                                    .oscillates = e->omega * h > 1,
                                    .Z = e->trial,
                                    .filter = stf_irk_filter_all};
  return stf_carry_collocation(T, h, &c);
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  const stf_step *s = T->step;
  const state *e = s->state;
  return stf_stage_polynomial_at(&e->u, &s->system.space, (t - (s->t - s->h)) / s->h,
                                 T->before[k], T->kept[k], S);
}

static const stf_carrier carrier = {.size = sizes,
                                    .carry = carry,
                                    .apply = stf_newton_carry_apply,
                                    .renew = stf_newton_carry_renew,
                                    .dense = carried_dense};

static int trace(const stf_step *s, stf_trace *out)
{
  (void)s;
  *out = (stf_trace){.kind = STF_TRACE_COLLOCATION};
  return STEIF_OK;
}

static int propagator(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                      const sunrealtype z[2], int *r, sunrealtype *M)
{
  sunrealtype R[2];
  (void)spec;
  STEIF_TRY(steif_table_stability(ctx, table, z, R));
  return stf_propagate_scalar(R, r, M), STEIF_OK;
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  int compensated;
  STEIF_TRY(stf_spec_int(ctx, spec, "compensated", 0, 1, 0, &compensated));
  info->family = "irk", info->about = table->about;
  info->order = table->order, info->stages = table->s, info->claims = table->claims;
  info->adaptive = table->c[0] > 0;
  return STEIF_OK;
}

static const stf_tables tables = {.kind = STEIF_COLLOCATION};

static stf_example example(size_t i)
{
  static const char *const spec[] = {
    "gauss:s=1",   "gauss:s=2",     "gauss:s=3",     "gauss:s=4",    "gauss:s=5", "radau:s=1",
    "radau:s=2",   "radau:s=3",     "radau:s=4",     "radau:s=5",    "radau:s=7", "radau1a:s=2",
    "radau1a:s=3", "lobatto3c:s=2", "lobatto3c:s=3", "lobatto3c:s=4"};
  return (stf_example){i < sizeof spec / sizeof *spec ? spec[i] : NULL, 1};
}

static const steif_method *variant(const stf_step *s)
{
  const steif_table *T = s->table;
  if (s->adaptive && T->s == 1 && T->c[0] == 1) return &steif_method_bdf_adaptive;
  return stf_interleaved_serves(s) ? &steif_method_irk_interleaved : NULL;
}

const steif_method steif_method_irk = {
  .about = "fully implicit Runge-Kutta",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .traits = STF_ADAPTIVE,
  .tables = &tables,
  .example = example,
  .variant = variant,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .stages = stages,
  .trial = trial_stages,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .carrier = &carrier,
  .trace = trace,
};
