/* erk.c: explicit Runge-Kutta methods, for contrast and for nonstiff problems. A table with embedded
 * weights chooses steps; inside of them its solution is that of a shorter step, of full order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"

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
  if (table->bhat) STEIF_TRY(stf_share_open(s, table->name, table->order_hat, table->order));
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
      "the step of problem '%s' from t = %.12g with h = %.6g overflowed: the step "
      "is too large for an explicit method",
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
};
