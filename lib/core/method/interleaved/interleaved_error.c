/* interleaved_error.c: the error of a step of collocation with interleaved shifts.
 *
 *   (lambda_0/h M - J)^{-1} [f(t_n, y_n) + M/h sum d_j Z_j], filtered twice at the start and
 *   after a refusal; where the end is not a stage, the same of f and the slope at the end. Where the problem forgets
 *   the errors of earlier steps (carried_error.c), those to come may be larger.
 * Hairer and Wanner, Solving ODEs II, IV.8.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "irk_interleaved.h"
#include "step_error.h"
#include <math.h>
#include <string.h>

typedef stf_irk_interleaved state;

int stf_irk_interleaved_product(stf_step *s, N_Vector v, N_Vector out)
{
  const state *e = s->state;
  const double *a = STF_ARRAY(v);
  double *x = STF_ARRAY(out);
  for (int i = 0; i < e->n; i++) {
    x[i] = e->M ? 0 : a[i];
    for (int j = 0; e->M && j < e->n; j++) x[i] += e->M[i * e->n + j] * a[j];
  }
  return STEIF_OK;
}

static int slope(stf_step *s, double t, N_Vector y, double *out)
{
  state *e = s->state;
  STEIF_TRY(stf_system_rhs(&s->system, t, y, s->error));
  memcpy(out, STF_ARRAY(s->error), (size_t)e->n * sizeof *out);
  return STEIF_OK;
}

/* x = f + M/h sum d_j Z_j. */
static void defect(const state *e, const double *f, double h, double *x)
{
  double sum[STF_INTERLEAVED];
  for (int i = 0; i < e->n; i++) {
    sum[i] = 0;
    for (int j = 0; j < e->s; j++) sum[i] += e->d[j] * e->L->Z[i * e->L->wide + j];
    sum[i] /= h;
  }
  for (int i = 0; i < e->n; i++) {
    x[i] = e->M ? f[i] : f[i] + sum[i];
    for (int j = 0; e->M && j < e->n; j++) x[i] += e->M[i * e->n + j] * sum[j];
  }
}

static bool algebraic(const state *e, int i)
{
  double row = 0;
  for (int j = 0; e->M && j < e->n; j++) row += fabs(e->M[i * e->n + j]);
  return e->M && row == 0;
}

static void without_residuals(const stf_step *s, double *f)
{
  const state *e = s->state;
  for (int i = 0; stf_residuals_remain(s) && i < e->n; i++)
    if (algebraic(e, i)) f[i] = 0;
}

/* The polynomial of this attempt at t + x h; K gives its coefficients about the end. */
static int inside(stf_step *s, double x, N_Vector v)
{
  const state *e = s->state;
  double *y = STF_ARRAY(v);
  stf_copy(&s->system.space, s->next, v);
  for (int j = 0; j < e->s; j++) {
    double weight = 0;
    for (int k = e->s; k-- > 0;) weight = (weight + e->K[j][k]) * (x - 1);
    for (int i = 0; i < e->n; i++) y[i] += weight * e->L->Z[i * e->L->wide + j];
  }
  return STEIF_OK;
}

static int look_between(stf_step *s, double h)
{
  const state *e = s->state;
  double x[STF_EIGEN_STAGES];
  const stf_look look = {.x = x,
                         .points = stf_between_nodes(e->table, x),
                         .inside = inside,
                         .product = stf_irk_interleaved_product,
                         .solve = stf_irk_interleaved_damp,
                         .y = e->moved,
                         .Ep = e->between,
                         .off = e->rest};
  return stf_look_between(s, h, &look);
}

/* The estimate with f at y + the first one: free of what stiff components off their slow manifold
 * add to that at every step size, and at index 3 of the errors of velocities. */
static int filter_again(stf_step *s, double t, N_Vector y, double h)
{
  state *e = s->state;
  double *x = STF_ARRAY(s->error), f[STF_INTERLEAVED];
  stf_sum(&s->system.space, 1, y, 1, s->error, e->moved);
  STEIF_TRY(slope(s, t, e->moved, f));
  if (y == s->y) without_residuals(s, f);
  defect(e, f, h, x);
  stf_interleaved_filter(e->L, x);
  return STEIF_OK;
}

static bool finite(int n, const double *x)
{
  double zero = 0;
  for (int i = 0; i < n; i++) zero += 0 * x[i];
  return zero == 0;
}

/* Each component has a ratio of its own, never below that of all: its differences may pass 0. */
static void find_own(stf_step *s)
{
  state *e = s->state;
  if (!e->own) return;
  const double *estimate = STF_ARRAY(s->error);
  double *own = STF_ARRAY(e->own);
  for (int i = 0; i < e->n; i++) own[i] = fmax(e->ratio[i], e->least) * estimate[i];
  e->own_norm = stf_norm(&s->system.space, e->own, s->weights);
}

/* What the estimate may be by the errors before it. */
static void share(stf_step *s)
{
  const state *e = s->state;
  find_own(s);
  if (e->own)
    stf_estimate_share(s, &e->higher_order,
                       e->own_norm / stf_norm(&s->system.space, s->error, s->weights),
                       stf_carried_share(&e->carried, 0));
}

static int estimate(stf_step *s, double h)
{
  state *e = s->state;
  if (!e->f0_known) STEIF_TRY(slope(s, s->t, s->y, e->f0));
  e->f0_known = finite(e->n, e->f0);
  without_residuals(s, e->f0);
  defect(e, e->f0, h, STF_ARRAY(s->error));
  stf_interleaved_filter(e->L, STF_ARRAY(s->error));
  if (stf_filters_twice(s) &&
      stf_norm(&s->system.space, s->error, s->weights) > s->control.tolerance)
    STEIF_TRY(filter_again(s, s->t, s->y, h));
  share(s);
  return stf_estimate_stiff(s, &e->higher_order, h, stf_irk_interleaved_product,
                            stf_irk_interleaved_damp, e->moved, e->rest);
}

static int estimate_end(stf_step *s, double h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  double f[STF_INTERLEAVED];
  STEIF_TRY(slope(s, s->t + h, s->next, f));
  defect(e, f, h, STF_ARRAY(s->error));
  stf_interleaved_filter(e->L, STF_ARRAY(s->error));
  STEIF_TRY(filter_again(s, s->t + h, s->next, h));
  const int rounds = stf_filter_rounds(s);
  for (int k = 1; k < rounds; k++) STEIF_TRY(filter_again(s, s->t + h, e->moved, h));
  stf_sum(space, 1, e->moved, -1, s->next, e->moved);
  return stf_test_undamped(s, e->moved, rounds, e->fails > 0, false);
}

void stf_irk_interleaved_tolerance(stf_step *s)
{
  state *e = s->state;
  const double *w = STF_ARRAY(s->weights);
  const stf_estimate *o = &e->higher_order;
  double top = 0, below = 0, lower = 0;
  const int *index = s->problem->index;
  for (int i = 0; i < e->n; i++) {
    const double *z = e->L->Z + i * e->L->wide;
    double high = 0, low = 0, lowest = 0;
    if (e->own) e->ratio[i] = 1;
    if (index && index[i] > 1) continue;
    for (int j = 0; j < e->s; j++)
      high += o->top[j] * z[j], low += o->below[j] * z[j], lowest += o->lower[j] * z[j];
    if (e->own) e->ratio[i] = stf_estimate_ratio(o, fabs(high), fabs(low));
    high *= w[i], low *= w[i], lowest *= w[i]; /* whose squares do not overflow */
    top += high * high, below += low * low, lower += lowest * lowest;
  }
  top = e->rounding_limited ? 0 : sqrt(top), below = sqrt(below);
  stf_estimate_set(s, o, top, below);
  stf_estimate_between(s, o, sqrt(lower), below, top);
  e->least = stf_estimate_sees(o, top) ? stf_estimate_ratio(o, top, below) : 1;
}

int stf_irk_interleaved_estimate(stf_step *s, double h)
{
  const state *e = s->state;
  STEIF_TRY(e->accurate ? estimate(s, h) : estimate_end(s, h));
  stf_estimate_levels(s);
  find_own(s);
  return look_between(s, h);
}
