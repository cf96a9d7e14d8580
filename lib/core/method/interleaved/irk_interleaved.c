/* irk_interleaved.c: collocation with chosen steps for small dense systems y' = f or M y' = f: the same formulas
 * as irk.c, with all shifts in vector lanes (interleaved.h) and the control of an adaptive code.
 *
 *   Start of the iteration: the last polynomial, cut where its terms at the new step begin to grow.
 *   Jacobian: at (t_n + h/4, predicted) while the prediction is good, else at (t_n, y_n); renewed with
 *   the factors when the rate of convergence was above 1e-3.
 *   Newton: theta_m = ||d^m|| / ||d^(m-1)||, eta = theta/(1 - theta), stop at eta ||d|| <= kappa. The eta of the last
 *   step's first two corrections, or that of its last two if larger, judges the first one, as many times larger
 *   as that is, and never below 1e-3: where f couples y in one direction later corrections vanish, and say nothing of
 *   the first.
 *   Where many iterations are left, one new Jacobian and LU at a stage as it is then.
 * Hairer and Wanner, Solving ODEs II, IV.8.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "irk_interleaved.h"
#include "step_error.h"
#include <math.h>
#include <string.h>

typedef stf_irk_interleaved state;

bool stf_interleaved_serves(const stf_step *s)
{
  const steif_table *T = s->table;
  return T && T->kind == STEIF_COLLOCATION && T->s <= STF_EIGEN_STAGES && T->c[0] > 0 &&
         s->adaptive && s->system.space.serial && s->system.storage == STEIF_DENSE &&
         s->problem->n <= STF_INTERLEAVED &&
         (s->system.form == STEIF_ODE || s->system.form == STEIF_MASS);
}

/* Vectors whose data are the rows of an array. */
static N_Vector *views(stf_step *s, double *data)
{
  const state *e = s->state;
  N_Vector *v = stf_pool_array(s->pool, (size_t)e->s, sizeof *v);
  for (int j = 0; v && j < e->s; j++)
    if (!(v[j] = stf_pool_view(s->pool, s->y, data + j * e->n))) return NULL;
  return v;
}

static int claim(stf_step *s, state *e)
{
  const size_t n = (size_t)e->n;
  e->Y = views(s, e->L->Y), e->F = views(s, e->L->F);
  e->a = stf_pool_array(s->pool, n * (size_t)e->L->wide, sizeof *e->a);
  e->moved = stf_pool_vector(s->pool, s->y);
  e->rest = stf_pool_vector(s->pool, s->y);
  e->between = stf_pool_vector(s->pool, s->y);
  e->f0 = stf_pool_array(s->pool, n, sizeof *e->f0);
  e->before = stf_pool_array(s->pool, n, sizeof *e->before);
  if (e->M) e->last_Z = stf_pool_array(s->pool, n * (size_t)e->L->wide, sizeof *e->last_Z);
  if (e->M && !e->last_Z) return STEIF_NO_MEMORY;
  return e->Y && e->F && e->moved && e->rest && e->between && e->a && e->f0 && e->before
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

static int open_derivatives(stf_step *s)
{
  state *e = s->state;
  if (!s->options->sensitivities) return STEIF_OK;
  e->stage = stf_pool_vectors(s->pool, e->s, s->y);
  e->aside = stf_pool_array(s->pool, (size_t)(e->n * e->L->wide), sizeof *e->aside);
  if (!e->stage || !e->aside) return STEIF_NO_MEMORY;
  return stf_stage_polynomial_open(s->pool, e->table, e->B, &e->u);
}

/* What Newton's iteration may leave, of the index that holds now: events change it. */
static double left(const stf_step *s)
{
  if (s->options->newton > 0) return s->options->newton;
  return s->problem->dae_index < 3
           ? 1e-4
           : 10 * stf_multipliers_known(s->options->rtol, s->table->order);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)spec;
  state *e = s->state;
  stf_transform transform;
  e->table = table, e->s = table->s, e->n = (int)s->problem->n;
  e->accurate = table->claims & STEIF_STIFFLY_ACCURATE;
  if (!e->accurate) STEIF_TRY(stf_check_index(s, table->name));
  STEIF_TRY(stf_transform_build(s->pool, s->ctx, table, &transform));
  e->B = transform.B;
  STEIF_TRY(stf_system_mass(s->pool, &s->system, &e->M));
  if (!(e->L = stf_interleaved_new(s->pool, &transform, e->n, e->M))) return STEIF_NO_MEMORY;
  STEIF_TRY(claim(s, e));
  STEIF_TRY(open_derivatives(s));
  e->L->whole = true;
  for (int j = 0; j < e->s; j++) stf_irk_interleaved_basis(e, j);
  e->itmax =
    s->options->iterations ? s->options->iterations : 7 + (e->s > 3 ? 5 * (e->s - 3) / 2 : 0);
  e->eta = e->eta_of = 1, e->J_new = true;
  stf_estimate_open(&e->higher_order, table, &transform, s->options->rtol);
  e->carried.product = stf_irk_interleaved_product, e->carried.solve = stf_irk_interleaved_damp;
  if (e->accurate && transform.im[0] == 0)
    STEIF_TRY(stf_carried_by_one_step(s, 4, 0.2, &e->carried));
  if (!e->carried.e) return STEIF_OK;
  e->own = stf_pool_vector(s->pool, s->y);
  e->ratio = stf_pool_array(s->pool, (size_t)e->n, sizeof *e->ratio);
  return e->own && e->ratio ? STEIF_OK : STEIF_NO_MEMORY;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  if (s->restart || s->count == 0) e->kappa = left(s);
  stf_irk_interleaved_predict(s, e, h);
  STEIF_TRY(stf_irk_interleaved_prepare(s, h));
  STEIF_TRY(stf_irk_interleaved_iterate(s, h));
  stf_interleaved_end(e->L);
  stf_irk_interleaved_tolerance(s);
  double *next = STF_ARRAY(s->next);
  const double *y = STF_ARRAY(s->y);
  for (int i = 0; i < e->n; i++) {
    const double *z = e->L->Z + i * e->L->wide;
    double sum = e->accurate ? z[e->s - 1] : 0;
    for (int j = 0; !e->accurate && j < e->s; j++) sum += e->end[j] * z[j];
    next[i] = y[i] + sum;
  }
  const int reach = 2 * e->itmax;
  const stf_control *usual = &stf_control_usual;
  s->control.safety =
    fmin(usual->safety, usual->safety * (reach + 1) / (e->iterations + reach));
  s->control.grow = e->theta > 0.05 ? fmax(1, 0.5 / e->theta) : usual->grow;
  s->control.keep = e->theta <= 1e-3 ? usual->keep : 1;
  return stf_irk_interleaved_estimate(s, h);
}

static void commit(stf_step *s)
{
  state *e = s->state;
  const int wide = e->L->wide;
  double size = 0;
  const double *w = STF_ARRAY(s->weights);
  stf_carried_add(s, &e->carried, 1 / (e->higher_order.weight * e->h_factored), e->own,
                  e->own_norm);
  stf_interleaved_keep(e->L, e->K, e->a);
  for (int i = 0; i < e->n; i++) {
    const double z = w[i] * e->L->Z[i * wide + e->s - 1];
    size += z * z;
  }
  e->first_correction /= sqrt(size / (double)e->n) + 1e-300;
  memcpy(e->before, STF_ARRAY(s->y), (size_t)e->n * sizeof *e->before);
  stf_swap(s);
  e->history = true, e->f0_known = false, e->fails = 0, e->J_new = false;
  e->renew_J = e->theta > 1e-3;
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  const double x = (t - s->t) / s->h;
  for (int i = 0; i < e->n; i++) {
    const double *a = e->a + i * e->L->wide;
    double sum = 0;
    for (int k = e->s; k-- > 0;) sum = (sum + a[k]) * x;
    STF_ARRAY(y)[i] = STF_ARRAY(s->y)[i] + sum;
  }
  return STEIF_OK;
}

static int stages_from(const state *e, const sunrealtype *y, int *count, const sunrealtype **c,
                       const sunrealtype **b, N_Vector **X)
{
  *count = e->s, *c = e->table->c, *b = e->table->b, *X = e->Y;
  for (int j = 0; j < e->s; j++)
    for (int i = 0; i < e->n; i++) STF_ARRAY(e->Y[j])[i] = y[i] + e->L->Z[i * e->L->wide + j];
  return STEIF_OK;
}

static int stages(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
                  N_Vector **X)
{
  const state *e = s->state;
  return stages_from(e, e->before, count, c, b, X);
}

static int trial(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
                 N_Vector **X)
{
  return stages_from(s->state, STF_ARRAY(s->y), count, c, b, X);
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  const size_t n = (size_t)e->n;
  stf_keep(m, e->a, n * (size_t)e->L->wide * sizeof *e->a);
  stf_keep(m, e->before, n * sizeof *e->before);
  stf_keep(m, e->f0, n * sizeof *e->f0);
  stf_interleaved_image(e->L, m);
  STF_KEEP(m, e->iterations);
  STF_KEEP(m, e->fails);
  STF_KEEP(m, e->h_factored);
  STF_KEEP(m, e->theta);
  STF_KEEP(m, e->eta);
  STF_KEEP(m, e->eta_of);
  STF_KEEP(m, e->kappa);
  STF_KEEP(m, e->first_correction);
  STF_KEEP(m, e->rounding_limited);
  STF_KEEP(m, e->history);
  STF_KEEP(m, e->f0_known);
  STF_KEEP(m, e->renew_J);
  STF_KEEP(m, e->J_new);
  STF_KEEP(m, e->J_ahead);
  STF_KEEP(m, e->J_from_stage);
  stf_carried_keep(&e->carried, m);
}

static int trace(const stf_step *s, stf_trace *out)
{
  (void)s;
  *out = (stf_trace){.kind = STF_TRACE_COLLOCATION};
  return STEIF_OK;
}

const steif_method steif_method_irk_interleaved = {
  .about = "fully implicit Runge-Kutta, all shifts in vector lanes",
  .forms = STEIF_ODE | STEIF_MASS,
  .traits = STF_ADAPTIVE,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .stages = stages,
  .trial = trial,
  .keep = keep,
  .carrier = &stf_irk_interleaved_carrier,
  .trace = trace,
};
