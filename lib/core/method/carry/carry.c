/* carry.c: the equations of a step, differentiated and solved with the factors at hand.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "pencil.h"
#include <math.h>
#include <steif/parameters.h>

enum { SWEEPS = 6, MOST = 40 }; /* before M is made anew, and before the step is given up */

static N_Vector **columns(stf_step *s, int count, int width)
{
  N_Vector **v = stf_pool_array(s->pool, (size_t)count, sizeof *v);
  for (int k = 0; v && width > 0 && k < count; k++)
    if (!(v[k] = stf_pool_vectors(s->pool, width, s->y))) return NULL;
  return v;
}

static int claim_columns(stf_step *s, stf_carry *T)
{
  const stf_carrier_size *z = &T->size;
  T->kept = columns(s, T->count, z->kept), T->trial = columns(s, T->count, z->trial);
  T->misses = columns(s, T->count, z->missed);
  for (int d = 0; d < STF_CARRY_MISSES; d++)
    if (!(T->missed[d] = columns(s, T->count, z->missed))) return STEIF_NO_MEMORY;
  T->r = columns(s, T->count, z->stages), T->other = columns(s, T->count, z->stages);
  T->slope = columns(s, z->points, T->count);
  T->tolerance = stf_pool_array(s->pool, (size_t)T->count, sizeof *T->tolerance);
  T->column = stf_pool_array(s->pool, (size_t)T->count, sizeof *T->column);
  T->moved = stf_pool_array(s->pool, (size_t)T->count, sizeof *T->moved);
  T->from = stf_pool_array(s->pool, (size_t)T->count, sizeof *T->from);
  if (!T->column || !T->moved || !T->from) return STEIF_NO_MEMORY;
  return T->kept && T->trial && T->misses && T->r && T->other && T->slope && T->tolerance
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

int stf_carry_open(stf_step *s, int count, const int *parameter, const sunrealtype *scale,
                   stf_carry *T)
{
  *T = (stf_carry){.step = s, .carrier = s->method->carrier, .count = count};
  T->parameter = parameter, T->scale = scale;
  if (T->carrier->check) STEIF_TRY(T->carrier->check(s));
  T->size = T->carrier->size(s);
  N_Vector **one[] = {&T->S, &T->next, &T->before, &T->error, &T->weights};
  for (size_t i = 0; i < sizeof one / sizeof *one; i++)
    if (!(*one[i] = stf_pool_vectors(s->pool, count, s->y))) return STEIF_NO_MEMORY;
  N_Vector *scratch[] = {&T->work, &T->product, &T->Y, &T->Yp, &T->last, &T->last_slope};
  for (size_t i = 0; i < sizeof scratch / sizeof *scratch; i++)
    if (!(*scratch[i] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  STEIF_TRY(claim_columns(s, T));
  for (int k = 0; T->carrier->commit && k < count; k++) T->kept[k][0] = T->S[k];
  STEIF_TRY(stf_matrices_at_open(s->pool, &s->system, T->size.points, &T->at));
  STEIF_TRY(stf_carry_direct_open(T));
  if (T->carrier->open) STEIF_TRY(T->carrier->open(T));
  return stf_slopes_open(s->pool, s->ctx, s->problem, s->system.form, s->y, &T->slopes);
}

int stf_carry_point(stf_carry *T, int point, sunrealtype t, N_Vector y, N_Vector yp)
{
  STEIF_TRY(stf_matrices_at_fill(&T->at, point, t, y, yp));
  for (int k = 0; k < T->count; k++) {
    N_Vector out = T->slope[point][k];
    STEIF_TRY(stf_slopes_at(T->slopes, T->parameter[k], t, y, yp, out));
    if (!stf_finite(&T->step->system.space, out))
      return stf_slopes_not_finite(T->slopes, T->parameter[k], t, out);
  }
  return STEIF_OK;
}

int stf_carry_residual(stf_carry *T, int point, int k, N_Vector S, N_Vector slope, N_Vector out)
{
  const stf_space *space = &T->step->system.space;
  STEIF_TRY(stf_matrices_at_product(&T->at, point, 'A', S, out));
  stf_axpy(space, -1, T->slope[point][k], out);
  if (!slope) return STEIF_OK;
  STEIF_TRY(stf_matrices_at_product(&T->at, point, 'E', slope, T->product));
  stf_axpy(space, -1, T->product, out);
  return STEIF_OK;
}

int stf_carry_stage_residuals(stf_carry *T, const stf_carry_stages *g, int k, N_Vector *r)
{
  const stf_space *space = &T->step->system.space;
  N_Vector *Z = T->trial[k] + g->to;
  for (int j = 0; j < g->m; j++) {
    N_Vector Y = Z[j];
    stf_combine(space, g->m, g->B_over_h + j * g->m, Z, T->work);
    if (g->offset) stf_axpy(space, 1, g->offset[k], T->work);
    if (g->base) stf_sum(space, 1, g->base[k], 1, Z[j], Y = T->Y);
    STEIF_TRY(stf_carry_residual(T, g->first + j, k, Y, T->work, r[j]));
  }
  return STEIF_OK;
}

/* One sweep over the columns that are live. */
static int sweep(stf_carry *T, const stf_carry_stages *g)
{
  stf_step *s = T->step;
  const stf_space *space = &s->system.space;
  for (int i = 0; i < T->live; i++)
    STEIF_TRY(stf_carry_stage_residuals(T, g, T->column[i], T->r[i]));
  STEIF_TRY(T->carrier->apply(s, g->h, T->live, T->r, T->other));
  T->sweeps++;
  for (int i = 0; i < T->live; i++) {
    const int k = T->column[i];
    sunrealtype sum = 0;
    for (int j = 0; j < g->m; j++) {
      const sunrealtype part = stf_norm(space, T->r[i][j], T->weights[k]);
      stf_axpy(space, 1, T->r[i][j], T->trial[k][g->to + j]);
      sum += part * part;
    }
    T->moved[i] = sqrt(sum / g->m);
  }
  return STEIF_OK;
}

/* The largest, and NaN if one is. */
static sunrealtype largest(const stf_carry *T)
{
  sunrealtype most = 0;
  for (int i = 0; i < T->live && most == most; i++)
    if (!(T->moved[i] <= most)) most = T->moved[i];
  return most;
}

/* Columns that a sweep moved by at most this are done. */
static void settle(stf_carry *T, sunrealtype enough)
{
  int left = 0;
  for (int i = 0; i < T->live; i++) {
    if (T->moved[i] <= enough) continue;
    T->column[left] = T->column[i], T->moved[left++] = T->moved[i];
  }
  T->live = left;
}

static int refuse(stf_carry *T, const stf_carry_stages *g, sunrealtype norm, sunrealtype rate)
{
  return STEIF_RECOVER(T->step->ctx, isfinite(norm) ? STEIF_NO_CONVERGENCE : STEIF_NOT_FINITE,
                       "the sensitivities of problem '%s' did not converge in the step to t = "
                       "%.12g with h = %.6g: "
                       "the last correction is %.3g of what may be left, rate %.2g; make the "
                       "step smaller or check "
                       "the Jacobian",
                       T->step->problem->name, g->t, g->h, norm, rate);
}

/* Corrections of this size that no longer shrink, with M of the step, are rounding: more of it in columns whose
 * entries are differences of large numbers, as is seen where sweeps have converged before. */
static bool at_rounding(const stf_carry *T, sunrealtype norm, sunrealtype first)
{
  const bool adaptive = T->step->adaptive, converged = norm <= 1e-6 * first;
  return norm <= (adaptive ? converged ? 0.1 : 0.01 : converged ? 100 : 1);
}

/* Of the tolerance of S. In adaptive steps errors of S may be larger than those of y, and so may what the sweeps
 * leave of them. What they leave of algebraic unknowns the estimate of the next step sees at any h, many times over with
 * many stages; and the rate of a sweep over all unknowns, which falls with h, is not theirs: they are not taken for
 * better than `algebraic`. */
static const sunrealtype algebraic = 0.3;
static sunrealtype sweep_tolerance(const stf_step *s)
{
  const sunrealtype most = 0.3, least = 3e-3, one = 1e-3, more = 1e-4, prescribed = 1e-3;
  if (!s->adaptive) return fmin(s->newton.tolerance, prescribed);
  if (s->problem->dae_index > 0) return s->problem->dae_index > 1 ? more : one;
  return fmax(least, fmin(10 * s->newton.tolerance, most));
}

int stf_carry_solve(stf_carry *T, const stf_carry_stages *g)
{
  stf_step *s = T->step;
  const sunrealtype tolerance = sweep_tolerance(s), doubt = 1.5, age = 1.05;
  const sunrealtype least = s->adaptive && s->problem->dae_index > 0 ? algebraic : 0;
  const sunrealtype known =
    T->eta > 0 && s->adaptive ? fmax(least, fmin(1, doubt * T->eta)) : 1;
  sunrealtype norm, first = 0, last = 0, rate = 0;
  bool anew = s->system.linear;
  if (T->K) {
    const int code = stf_carry_direct(T, g);
    if (code != STEIF_RETRY) return code; /* a singular matrix of stages: try M */
    T->eta = 0;
  }
  for (int k = 0; k < T->count && !g->predicted; k++)
    for (int j = 0; j < g->m; j++) stf_zero(&s->system.space, T->trial[k][g->to + j]);
  T->live = T->count;
  for (int k = 0; k < T->count; k++) T->column[k] = k;
  for (int m = 1, all = 1;; m++, all++, last = largest(T)) {
    STEIF_TRY(sweep(T, g));
    norm = largest(T);
    if (!(norm <= 1e300)) return refuse(T, g, norm, rate);
    if ((s->system.linear && !s->system.krylov) || norm == 0) return STEIF_OK;
    first = fmax(first, norm);
    if (m == 1 && !anew) settle(T, tolerance / known);
    if (m > 1) {
      rate = norm / last;
      if (rate < 1) T->eta = rate / (1 - rate), settle(T, tolerance / fmax(least, T->eta));
    }
    if (T->live == 0) {
      if (m == 1) T->eta *= age; /* until it is seen again */
      return STEIF_OK;
    }
    if (m == 1) continue;
    if (rate >= 0.5 && (anew ? at_rounding(T, norm, first) : norm <= s->newton.rounding))
      return STEIF_OK;
    if (!anew && (rate > 0.5 || m >= SWEEPS)) {
      STEIF_TRY(T->carrier->renew(s, g->t, g->h, g->Y, g->Yp));
      anew = true, m = 0;
      T->eta = 0;
      continue;
    }
    if (rate >= 1 || all >= MOST) return refuse(T, g, norm, rate);
  }
}

/* ---- the step ----------------------------------------------------------------------------- */

sunrealtype stf_carry_slack(const stf_step *s, int q, int p)
{
  const sunrealtype most = 30;
  return s->problem->dae_index > 1 ? 1 : pow(most, (q + 1.0) / (p + 1.0));
}

sunrealtype stf_carry_allowed(const stf_step *s, sunrealtype allowed, int q, int p)
{
  return fmax(allowed, fmin(1, allowed * stf_carry_slack(s, q, p)));
}

/* By the values at the beginning of the step, as for y; levels as for y. */
static void weigh(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  const steif_options *o = s->options;
  const sunrealtype rtol = s->adaptive ? o->rtol : 1e-10;
  const int *index = s->problem->index;
  for (int k = 0; k < T->count; k++) {
    const sunrealtype *S = stf_array(T->S[k]);
    sunrealtype *w = stf_array(T->weights[k]);
    for (sunindextype i = 0; i < s->problem->n; i++) {
      const sunrealtype given = o->atols ? o->atols[i] : o->atol,
                        atol = s->adaptive ? given : 1e-10 * s->system.scale;
      w[i] = 1 / (rtol * fabs(S[i]) + atol / T->scale[k]);
      for (int level = index ? index[i] : 1; level > 1; level--) w[i] *= h;
    }
  }
}

/* Differences by p have rounding errors, which shorter steps do not make smaller: below them errors are not asked
 * for. Terms of F are as large as y'. */
static void allow_noise(stf_carry *T, sunrealtype h, int k)
{
  const stf_space *space = &T->step->system.space;
  const sunrealtype noise = h * stf_slopes_noise(T->slopes, T->parameter[k]);
  if (noise == 0) return;
  stf_sum(space, 1 / h, T->step->next, -1 / h, T->step->y, T->work);
  const sunrealtype least = noise * stf_norm(space, T->work, T->weights[k]);
  T->noise = fmax(T->noise, least / T->tolerance[k]);
  T->tolerance[k] = fmax(T->tolerance[k], least);
}

/* GMRES leaves a part of each right-hand side: sweeps see it, methods without take what they get. */
static void aim(stf_carry *T)
{
  stf_step *s = T->step;
  const sunrealtype left = T->carrier->apply ? 0.01 : 1e-10;
  if (!s->system.krylov) return;
  stf_pencil_aim(s->system.pencil, s->newton.weights, 0);
  stf_pencil_force(s->system.pencil, left, true);
}

int stf_carry_carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  weigh(T, h);
  aim(T);
  STEIF_TRY(T->carrier->carry(T, h));
  T->relative = 0;
  for (int k = 0; k < T->count; k++) {
    if (!stf_finite(&s->system.space, T->next[k]))
      return STEIF_RECOVER(
        s->ctx, STEIF_NOT_FINITE,
        "the derivative of problem '%s' by parameter %d is not finite in the "
        "step from t = %.12g with h = %.6g",
        s->problem->name, T->parameter[k] + 1, s->t, h);
    if (!s->adaptive) continue;
    allow_noise(T, h, k);
    const sunrealtype e =
      stf_norm(&s->system.space, T->error[k], T->weights[k]) / T->tolerance[k];
    if (!(e <= T->relative)) T->relative = e;
  }
  return STEIF_OK;
}

static void exchange(N_Vector **a, N_Vector **b)
{
  N_Vector *c = *a;
  *a = *b, *b = c;
}

static void remember_misses(stf_carry *T)
{
  const stf_step *s = T->step;
  N_Vector **oldest = T->missed[STF_CARRY_MISSES - 1];
  if (s->restart) T->history = 0;
  if (T->history <= STF_CARRY_MISSES) T->history++;
  for (int d = STF_CARRY_MISSES - 1; d > 0; d--)
    T->missed[d] = T->missed[d - 1], T->h_before[d] = T->h_before[d - 1];
  T->missed[0] = T->misses, T->misses = oldest, T->h_before[0] = s->h;
}

void stf_carry_commit(stf_carry *T)
{
  if (T->carrier->commit) {
    T->carrier->commit(T);
    return;
  }
  exchange(&T->before, &T->S);
  exchange(&T->S, &T->next);
  N_Vector **trial = T->trial;
  T->trial = T->kept, T->kept = trial;
  remember_misses(T);
}
