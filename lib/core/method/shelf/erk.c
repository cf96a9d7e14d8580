/* erk.c: explicit Runge-Kutta methods, for contrast and for nonstiff problems. A table with embedded
 * weights chooses steps; inside of them its solution is that of a shorter step, of full order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "step_error.h"

typedef struct state {
  const steif_table *table;
  N_Vector *K, work, end_slope; /* end_slope: f at the end of the last step, for dense output */
  N_Vector before;              /* y and slope at the start of the last step */
  N_Vector slope;
  bool begun;                       /* K[0] = f(t_n, y_n) */
  sunrealtype differ[STEIF_STAGES]; /* b - bhat */
} state;

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)spec;
  state *e = s->state;
  e->table = table;
  for (int i = 0; table->bhat && i < table->s; i++) e->differ[i] = table->b[i] - table->bhat[i];
  if (table->bhat)
    STEIF_TRY(stf_share_open(s, table->name, table->order_hat, table->order, 0.1));
  e->K = stf_pool_vectors(s->pool, table->s, s->y);
  e->work = stf_pool_vector(s->pool, s->y);
  e->before = stf_pool_vector(s->pool, s->y);
  e->slope = stf_pool_vector(s->pool, s->y);
  e->end_slope = stf_pool_vector(s->pool, s->y);
  return e->K && e->work && e->before && e->slope && e->end_slope ? STEIF_OK : STEIF_NO_MEMORY;
}

/* out = y + h sum_j a_j K_j. */
static void advance(const stf_step *s, N_Vector y, int count, const sunrealtype *a,
                    sunrealtype h, N_Vector out)
{
  const state *e = s->state;
  stf_combine(&s->system.space, count, a, e->K, out);
  stf_sum(&s->system.space, 1, y, h, out, out);
}

/* A step from (t, y) into `end`, stages from `first` on. */
static int run(stf_step *s, sunrealtype t, N_Vector y, int first, sunrealtype h, N_Vector end)
{
  state *e = s->state;
  const steif_table *T = e->table;
  for (int i = first; i < T->s; i++) {
    if (i > 0) advance(s, y, i, T->A + i * T->s, h, e->work);
    STEIF_TRY(stf_system_rhs(&s->system, t + T->c[i] * h, i > 0 ? e->work : y, e->K[i]));
  }
  advance(s, y, T->s, T->b, h, end);
  return STEIF_OK;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const bool begun = e->begun && s->rejected;
  e->begun = false;
  STEIF_TRY(run(s, s->t, s->y, begun ? 1 : 0, h, s->next));
  e->begun = true;
  if (!stf_finite(&s->system.space, s->next))
    return STEIF_RECOVER(
      s->ctx, STEIF_NOT_FINITE,
      "the step of problem '%s' from t = %.12g with h = %.6g is not finite: it "
      "overflowed, as too large a step of an explicit method does, or f has left its domain",
      s->problem->name, s->t, h);
  if (!s->adaptive) return STEIF_OK;
  stf_combine(&s->system.space, e->table->s, e->differ, e->K, s->error);
  stf_scale(&s->system.space, h, s->error, s->error);
  return STEIF_OK;
}

static void commit(stf_step *s)
{
  state *e = s->state;
  stf_copy(&s->system.space, s->y, e->before);
  stf_copy(&s->system.space, e->K[0], e->slope);
  stf_swap(s);
}

/* A shorter step from the start of the last one, or the cubic. */
static int dense_by_f(stf_step *s, sunrealtype t, N_Vector y)
{
  state *e = s->state;
  const sunrealtype from = s->t - s->h;
  if (e->table->bhat) {
    e->begun = false;
    return run(s, from, e->before, 0, t - from, y);
  }
  return stf_hermite(s, t, e->before, e->slope, e->end_slope, y);
}

/* ---- derivatives by parameters: trial and kept hold those of the slopes K ------------------------ */

static stf_carrier_size sizes(const stf_step *s)
{
  const state *e = s->state;
  return (stf_carrier_size){e->table->s, 0, e->table->s, e->table->s, 0};
}

/* Of a step of length h from (t, y, S), whose slopes are there: those of the slopes, into trial. Of columns first ..
 * first + count - 1. */
static int carry_slopes(stf_carry *T, sunrealtype t, sunrealtype h, N_Vector y, N_Vector *S,
                        int first, int count)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  for (int i = 0; i < e->table->s; i++) {
    const sunrealtype *a = e->table->A + i * e->table->s;
    if (i > 0) advance(s, y, i, a, h, e->work);
    STEIF_TRY(stf_carry_point(T, i, t + e->table->c[i] * h, i > 0 ? e->work : y, e->K[i]));
    for (int k = first; k < first + count; k++) {
      stf_combine(space, i, a, T->trial[k], T->Y);
      stf_sum(space, 1, S[k], h, T->Y, T->Y);
      STEIF_TRY(stf_carry_residual(T, i, k, T->Y, NULL, T->trial[k][i]));
    }
  }
  return STEIF_OK;
}

/* out = S + h sum_j b_j dK_j of column k. */
static void carry_end(const stf_carry *T, sunrealtype h, N_Vector S, int k, N_Vector out)
{
  const steif_table *table = ((const state *)T->step->state)->table;
  const stf_space *space = &T->step->system.space;
  stf_combine(space, table->s, table->b, T->trial[k], out);
  stf_sum(space, 1, S, h, out, out);
}

static int carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  STEIF_TRY(carry_slopes(T, s->t, h, s->y, T->S, 0, T->count));
  for (int k = 0; k < T->count; k++) {
    carry_end(T, h, T->S[k], k, T->next[k]);
    if (!s->adaptive) continue;
    stf_combine(space, e->table->s, e->differ, T->trial[k], T->error[k]);
    stf_scale(space, h, T->error[k], T->error[k]);
    T->tolerance[k] =
      stf_carry_allowed(s, s->control.tolerance, s->control.order, e->table->order);
  }
  return STEIF_OK;
}

/* The cubic, with the slope of S at the end. */
static int carried_cubic(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  stf_step *s = T->step;
  const sunrealtype x = (t - (s->t - s->h)) / s->h, u = 1 - x;
  const sunrealtype c[] = {u * u * (1 + 2 * x), x * x * (1 + 2 * u), s->h * x * u * u,
                           -s->h * x * x * u};
  N_Vector v[] = {T->before[k], T->S[k], T->kept[k][0], T->Yp};
  STEIF_TRY(stf_carry_point(T, 0, s->t, s->y, s->yp));
  STEIF_TRY(stf_carry_residual(T, 0, k, T->S[k], NULL, T->Yp));
  stf_combine(&s->system.space, 4, c, v, S);
  return STEIF_OK;
}

/* As y inside a step, by the steps that this takes. */
static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  stf_step *s = T->step;
  state *e = s->state;
  const sunrealtype from = s->t - s->h;
  if (!e->table->bhat) return carried_cubic(T, k, t, S);
  e->begun = false;
  STEIF_TRY(run(s, from, e->before, 0, t - from, T->last));
  STEIF_TRY(carry_slopes(T, from, t - from, e->before, T->before, k, 1));
  carry_end(T, t - from, T->before[k], k, S);
  return STEIF_OK;
}

static const stf_carrier carrier = {.size = sizes, .carry = carry, .dense = carried_dense};

static void keep(stf_step *s, stf_image *m)
{
  const state *e = s->state;
  stf_keep_vector(m, e->before);
  stf_keep_vector(m, e->slope);
  stf_keep_vector(m, e->end_slope);
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
  (void)ctx, (void)spec;
  info->family = "erk", info->about = table->about;
  info->order = table->order, info->stages = table->s, info->claims = table->claims;
  info->adaptive = table->bhat != NULL;
  return STEIF_OK;
}

static const stf_tables tables = {.kind = STEIF_EXPLICIT};

const steif_method steif_method_erk = {
  .about = "explicit Runge-Kutta",
  .forms = STEIF_ODE,
  .traits = STF_EXPLICIT,
  .tables = &tables,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense_by_f = dense_by_f,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .carrier = &carrier,
};
