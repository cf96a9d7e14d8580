/* bdf_adaptive.c: BDF with chosen steps and orders 1 to 5 (or up to the p of the spec), variable
 * coefficients on the true mesh.
 *
 *   y'(t_{n+1}) = (1/h) sum_j alpha_j y_{n+1-j},
 *   error_k = h/(t_{n+1} - t_{n-k}) (y_{n+1} - pred_k),
 * pred_k the extrapolation through k + 1 past points. A first step from a start without y' is two of
 * half its length, whose error is their second difference: the way from y_0 to y_1, all that one step
 * has to show, is O(h), and would be kept below the tolerance. Factors are kept while alpha_0/h stays
 * within a ratio of 1.67; steps grow only by factors above 1.5, and every k + 1 steps the
 * neighbouring orders are compared (biases 6, 6, 10 as in VODE: Brown, Byrne, Hindmarsh, SISC
 * 10, 1989). Newton stops at a hundredth of what the error may be: what it leaves in the past values is
 * amplified by up to 2^(k+1) - 1 in the estimate, and more of it would hold the step down where
 * the solution is smooth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "bdf_adaptive.h"
#include "step_error.h"
#include <math.h>
#include <string.h>

/* Steps a Jacobian may serve; where it carries errors on. */
enum { HIGHEST = STF_BDF_HIGHEST, POINTS = STF_BDF_POINTS, AGE = 50, YOUNG = 10 };

/* Beginnings late on the clock cannot be made of steps as short as they should be: the few of less than so
 * many rounding errors of t may have this part of the tolerance. */
enum { CLOCK = 1000 };
static const sunrealtype first = 0.1;

/* Of past values, amplified by up to 2^(k+1) - 1 in the estimate. */
static const sunrealtype rounding = 3e-12;
/* GMRES leaves an error of the size that Newton's iteration may; CVODE allows a tenth of the error test too. */
static const sunrealtype INEXACT = 10;

typedef stf_bdf state;

void stf_bdf_extrapolate(const state *e, int count, sunrealtype t, sunrealtype *weight)
{
  sunrealtype node[POINTS];
  for (int j = 0; j < count; j++) node[j] = e->t[j] - t;
  stf_interpolate(count - 1, node, 0, weight);
}

static void predict(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const int count = e->points < e->k + 1 ? e->points : e->k + 1;
  sunrealtype weight[POINTS];
  stf_bdf_extrapolate(e, count, s->t + h, weight);
  stf_combine(space, count, weight, e->y, e->base);
  if (e->points == 1 && s->yp_known) stf_axpy(space, h, s->yp, e->base);
}

/* From t on with e->alpha and their sum over past values in e->offset. */
static int finish(stf_step *s, sunrealtype t, sunrealtype h)
{
  static const sunrealtype c[] = {1};
  state *e = s->state;
  const stf_space *space = &s->system.space;
  stf_newton_single(&s->newton, e->alpha[0]);
  if (!s->absolute) stf_axpy(space, e->alpha[0] / h, e->base, e->offset);
  stf_zero(space, e->Z);
  const stf_stages g = {.t = t,
                        .h = h,
                        .c = c,
                        .base = s->absolute ? NULL : &e->base,
                        .offset = &e->offset,
                        .Z = s->absolute ? &s->next : &e->Z};
  STEIF_TRY(stf_solve_stages(s, &g));
  if (!s->absolute) stf_sum(space, 1, e->base, 1, e->Z, s->next);
  return STEIF_OK;
}

static int solve(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  sunrealtype a[HIGHEST + 1], node[HIGHEST + 1] = {0};
  for (int j = 1; j <= e->k; j++) node[j] = (e->t[j - 1] - (s->t + h)) / h;
  stf_differentiate(e->k, node, e->alpha);
  for (int j = 1; j <= e->k; j++) a[j - 1] = e->alpha[j] / h;
  stf_combine(&s->system.space, e->k, a, e->y, e->offset);
  return finish(s, s->t, h);
}

/* Two steps of order 1 and length h / 2 with their error; e->other: the point between them. */
static int halves(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const sunrealtype d = h / 2, c[] = {1, -2, 1};
  e->alpha[0] = 1, e->alpha[1] = -1;
  stf_copy(space, s->y, e->base);
  stf_scale(space, -1 / d, s->y, e->offset);
  STEIF_TRY(finish(s, s->t, d));
  stf_copy(space, s->next, e->other);
  stf_sum(space, 2, e->other, -1, s->y, e->base);
  stf_scale(space, -1 / d, e->other, e->offset);
  STEIF_TRY(finish(s, s->t + d, d));
  N_Vector v[] = {s->next, e->other, s->y};
  stf_combine(space, 3, c, v, s->error);
  return STEIF_OK;
}

/* Derivatives by parameters begin without slopes. */
bool stf_bdf_halves(const stf_step *s)
{
  const state *e = s->state;
  return e->points == 1 && (!s->yp_known || s->options->sensitivities);
}

/* Orders above 2 amplify oscillations whose frequency times h is of size 1; where the fastest are
 * beyond, slower ones are there. */
static int find_oscillation(stf_step *s)
{
  state *e = s->state;
  e->omega_of = s->system.nje;
  stf_sum(&s->system.space, 1, s->next, -1, e->y[0], e->Z);
  return stf_oscillation(s, e->Z, e->other, e->offset, &e->omega);
}

static bool oscillates(const state *e, sunrealtype h) { return e->omega * h > 1; }

/* What rounding leaves in algebraic unknowns is no error that shorter steps make smaller: Newton's iteration
 * may stall there, and estimates, which amplify it by up to 2^(k+1) - 1, may come to that. */
static int find_noise(stf_step *s)
{
  state *e = s->state;
  const sunrealtype times = 4;
  if (!s->newton.factored || s->system.nje == e->noise_of) return STEIF_OK;
  e->noise_of = s->system.nje;
  STEIF_TRY(stf_algebraic_noise(s, e->Z, e->other, e->offset, &e->noise));
  s->newton.rounding = fmax(s->newton.rounding, times * e->noise);
  return STEIF_OK;
}

static sunrealtype amplified(const state *e, int k)
{
  return fmin(1, e->noise * (pow(2, k + 1) - 1) / (k + 1));
}

/* What errors may be, by those before this step. */
static int share(stf_step *s)
{
  state *e = s->state;
  STEIF_TRY(stf_carried_retry(s, &e->carried));
  STEIF_TRY(find_noise(s));
  for (int k = 1; k <= HIGHEST; k++)
    e->allowed[k] = fmax(stf_carried_share(&e->carried, e->wanted[k]), amplified(e, k));
  s->control.order = e->k, s->control.tolerance = e->allowed[e->k];
  return STEIF_OK;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  if (s->restart) e->points = 1, e->k = 1, e->wait = 2, e->t[0] = s->t;
  if (!s->rejected) e->refusals = 0;
  if (++e->refusals > 4) e->k = 1; /* the history is not to be trusted */
  if (e->k > e->points) e->k = e->points;
  if (s->system.nje != e->seen) e->seen = s->system.nje, e->since = s->count;
  if (s->count - e->since >= (e->carried.exact ? YOUNG : AGE)) s->newton.jacobian_wanted = true;
  STEIF_TRY(share(s));
  if (e->k <= 2 && h < CLOCK * STF_EPS * fabs(s->t))
    s->control.tolerance = fmax(s->control.tolerance, first);
  stf_share_newton(s, rounding);
  if (s->system.krylov && !(s->options->newton > 0)) s->newton.tolerance *= INEXACT;
  e->halved = stf_bdf_halves(s);
  if (e->halved) return halves(s, h);
  predict(s, h);
  STEIF_TRY(solve(s, h));
  if (s->system.nje != e->omega_of) STEIF_TRY(find_oscillation(s));
  const sunrealtype span = e->points > e->k ? s->t + h - e->t[e->k] : 2 * h;
  stf_sum(&s->system.space, h / span, s->next, -h / span, e->base, s->error);
  return STEIF_OK;
}

/* e->other := the error of order k for the step just made from `past` to `next`. */
static void error_of(stf_step *s, int k, N_Vector *past, N_Vector next)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  sunrealtype weight[POINTS];
  const sunrealtype t = s->t + s->h_try, scale = s->h_try / (t - e->t[k]);
  stf_bdf_extrapolate(e, k + 1, t, weight);
  stf_combine(space, k + 1, weight, past, e->other);
  stf_sum(space, scale, next, -scale, e->other, e->other);
}

static const stf_carry *tested(const stf_step *s)
{
  return s->options->untested_sensitivities ? NULL : s->carry;
}

/* Its norm in units of what is allowed, the largest of y and its derivatives. */
static sunrealtype error_at(stf_step *s, int k)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const stf_carry *T = tested(s);
  error_of(s, k, e->y, s->next);
  sunrealtype most = stf_norm(space, e->other, s->weights) / e->allowed[k];
  for (int i = 0; T && i < T->count; i++) {
    error_of(s, k, T->kept[i], T->next[i]);
    const sunrealtype norm = stf_norm(space, e->other, T->weights[i]);
    most = fmax(most, norm / stf_carry_allowed(s, e->allowed[k], k, k));
  }
  return most;
}

/* The same of the step's own order. */
static sunrealtype error_now(const stf_step *s)
{
  const state *e = s->state;
  const stf_carry *T = tested(s);
  sunrealtype most = s->error_norm;
  if (!(most >= 0)) most = stf_norm(&s->system.space, s->error, s->weights);
  most /= e->allowed[e->k];
  const sunrealtype allowed = stf_carry_allowed(s, e->allowed[e->k], e->k, e->k);
  for (int i = 0; T && i < T->count; i++)
    most = fmax(most, stf_norm(&s->system.space, T->error[i], T->weights[i]) / allowed);
  return most;
}

static sunrealtype step_factor(sunrealtype bias, sunrealtype error, int k)
{
  return 1 / (pow(bias * error, 1 / (k + 1.0)) + 1e-6);
}

/* Order and length of the next step; among orders that reach the longest one, the highest. */
static void choose(stf_step *s)
{
  state *e = s->state;
  const int k = e->k;
  const sunrealtype cap = s->options->h_max > 0 ? s->options->h_max / s->h_try : INFINITY;
  sunrealtype best = step_factor(6, error_now(s), k);
  int order = k;
  if (--e->wait <= 0) {
    const sunrealtype lower = k > 1 ? step_factor(6, error_at(s, k - 1), k - 1) : 0;
    const bool room = k < (oscillates(e, s->h_try) ? 2 : e->p) && e->points >= k + 2;
    const sunrealtype higher = room ? step_factor(10, error_at(s, k + 1), k + 1) : 0;
    if (fmin(lower, cap) > best) best = lower, order = k - 1;
    if (fmin(higher, cap) >= fmin(best, cap)) best = higher, order = k + 1;
    e->wait = 2;
  }
  if (k > 2 && oscillates(e, s->h_try)) {
    e->k = 2, e->wait = 3;
    s->control.next = fmax(fmin(step_factor(6, error_at(s, 2), 2), 1), 0.1);
    return;
  }
  s->control.next = best < 1.5 ? 1 : fmin(best, s->count < 2 ? 1e4 : 10);
  if (s->control.next == 1 && !(order > k && best >= cap)) return;
  if (order != k) e->k = order;
  e->wait = e->k + 1;
}

static void commit(stf_step *s)
{
  state *e = s->state;
  e->last = e->k;
  const sunrealtype own = e->alpha[0] / s->h_try; /* which operators follow */
  stf_carried_add(s, &e->carried, s->system.krylov ? own : s->newton.shift, s->error,
                  s->error_norm);
  stf_carried_tell(&e->carried, e->wanted[e->p], &s->control);
  choose(s);
  N_Vector oldest = e->y[POINTS];
  for (int j = POINTS; j > 0; j--) e->y[j] = e->y[j - 1], e->t[j] = e->t[j - 1];
  e->y[0] = s->y = s->next;
  e->t[0] = s->t + s->h_try;
  s->next = oldest;
  if (e->points < POINTS) e->points++;
  if (s->system.form == STEIF_IMPLICIT) stf_copy(&s->system.space, s->newton.Zp[0], s->yp);
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  sunrealtype weight[POINTS];
  stf_bdf_extrapolate(e, e->last + 1, t, weight);
  stf_combine(&s->system.space, e->last + 1, weight, e->y, y);
  return STEIF_OK;
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vectors(m, POINTS, e->y + 1); /* e->y[0] is s->y */
  STF_KEEP(m, e->t);
  STF_KEEP(m, e->k);
  STF_KEEP(m, e->last);
  STF_KEEP(m, e->points);
  STF_KEEP(m, e->wait);
  STF_KEEP(m, e->refusals);
  STF_KEEP(m, e->omega);
  STF_KEEP(m, e->seen);
  STF_KEEP(m, e->since);
  STF_KEEP(m, e->omega_of);
  STF_KEEP(m, e->noise);
  STF_KEEP(m, e->noise_of);
  STF_KEEP(m, e->alpha);
  STF_KEEP(m, e->allowed);
  stf_carried_keep(&e->carried, m);
}

/* What the errors remembered may come to, in tolerances. */
static sunrealtype together(const stf_step *s, bool low)
{
  if (!low) return 0.3;
  return s->problem->dae_index > 1 ? 0.1 : 0.2;
}

/* What an error of order k may be where all of them add. Order 1 serves beginnings, whose few errors do not. */
static sunrealtype alone(const stf_step *s, int k, sunrealtype least)
{
  const int order = k > 1 ? k : 2;
  return stf_share(s, order, order, least);
}

/* Highest orders 1 and 2 would need a million steps for few digits if all errors added: the tolerance is
 * shared among those that are remembered, down to what makes a million steps, and they say what has come
 * of it. Tolerances above 2e-3 and weights of the caller mean the error of one step. Errors of index above
 * 1 are not carried on, but counted where they are rounding. Where a solve is one of GMRES, longer steps do not pay for
 * errors carried on often: bruss2d:n=32 with multigrid, rtol 1e-3 to 1e-7, was 3 tolerances off for 5 to 15 %
 * more cycles than it takes to be 0.4 off. */
static int open_shares(stf_step *s)
{
  state *e = s->state;
  const bool low = e->p <= 2, given = s->options->rtol > 2e-3 || s->options->ewt;
  const sunrealtype least = e->p == 1 ? 1e-9 : rounding, rounded = least / s->options->rtol;
  const bool rough = low || 2 * alone(s, e->p, 0) < rounded;
  const bool counted = low ? !given : rough || s->problem->dae_index < 3;
  const bool followed = low ? !given : s->problem->dae_index < 2;
  for (int k = 1; k <= HIGHEST; k++)
    e->wanted[k] = !low ? alone(s, k, followed ? 0 : rounding) : given ? first : 0;
  if (!counted) return STEIF_OK;
  e->carried.always = low;
  e->carried.dear = s->system.krylov && !low && !rough;
  e->carried.goal = low || rough ? 0 : e->carried.dear ? 0.2 : 1;
  return stf_carried_open(s, least, together(s, low), rough, &e->carried);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  state *e = s->state;
  stf_transform transform;
  const bool be = s->table || !strcmp(spec->name, "be"); /* a table: radau:s=1 */
  const char *start = s->options->start ? s->options->start : stf_spec_word(spec, "start");
  STEIF_CHECK(!start || !strcmp(start, "ramp"), s->ctx, STEIF_UNSUPPORTED,
              "start=%s is for prescribed steps: set h", start);
  STEIF_TRY(stf_spec_int(s->ctx, spec, "p", 1, 6, be ? 1 : HIGHEST, &e->p));
  if (e->p > HIGHEST) e->p = HIGHEST;
  STEIF_TRY(stf_transform_single(s->pool, 1, &transform));
  STEIF_TRY(stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  s->newton.shift_ratio_most = 1.67, s->newton.renew_with_factors = true,
  s->newton.stale_rate = 0.7;
  e->base = stf_pool_vector(s->pool, s->y);
  e->offset = stf_pool_vector(s->pool, s->y);
  e->Z = stf_pool_vector(s->pool, s->y);
  e->other = stf_pool_vector(s->pool, s->y);
  if (!e->base || !e->offset || !e->Z || !e->other) return STEIF_NO_MEMORY;
  e->y[0] = s->y, e->t[0] = s->t;
  e->points = 1, e->k = 1, e->wait = 2;
  for (int j = 1; j <= POINTS; j++)
    if (!(e->y[j] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  s->control.bias = 6;
  return open_shares(s);
}

static int trace(const stf_step *s, stf_trace *out)
{
  state *e = s->state;
  *out = (stf_trace){
    .kind = STF_TRACE_BDF, .order = e->last, .alpha = e->alpha, .past = e->y, .t = e->t};
  if (e->halved) out->between = e->other;
  return STEIF_OK;
}

const steif_method steif_method_bdf_adaptive = {
  .about = "backward differentiation formulas of variable step and order",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .traits = STF_ADAPTIVE | STF_MULTISTEP,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .keep = keep,
  .carrier = &stf_bdf_carrier,
  .trace = trace,
};
