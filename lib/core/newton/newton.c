/* newton.c: simplified Newton over independent shifts.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "blended.h"
#include "inexact.h"
#include "pencil.h"
#include <math.h>
#include <stdio.h>

int stf_transform_single(stf_pool *pool, sunrealtype b, stf_transform *transform)
{
  sunrealtype *one = stf_pool_array(pool, 2, sizeof *one);
  if (!one) return STEIF_NO_MEMORY;
  one[0] = b, one[1] = 1;
  *transform =
    (stf_transform){.s = 1, .shifts = 1, .re = {b}, .B = one, .T = one + 1, .Tinv = one + 1};
  return STEIF_OK;
}

int stf_newton_open(stf_pool *pool, stf_system *system, const stf_transform *transform,
                    N_Vector weights, stf_newton *newton)
{
  const int s = transform->s;
  N_Vector like = system->space.like;
  newton->system = system, newton->transform = *transform, newton->weights = weights;
  newton->stale_rate = 0.1, newton->relax = 1;
  newton->eta = newton->eta_of = 1;
  newton->Y = stf_pool_vector(pool, like);
  newton->residual = stf_pool_vectors(pool, s, like);
  newton->Zp = stf_pool_vectors(pool, s, like);
  newton->omega = s > 1 ? stf_pool_vectors(pool, s, like) : newton->residual;
  newton->dZ = s > 1 ? stf_pool_vectors(pool, s, like) : newton->residual;
  newton->zero = stf_pool_vector(pool, like);
  newton->B_over_h = stf_pool_array(pool, (size_t)(s * s), sizeof *newton->B_over_h);
  newton->minus_T = stf_pool_array(pool, (size_t)(s * s), sizeof *newton->minus_T);
  for (int i = 0; newton->minus_T && i < s * s; i++) newton->minus_T[i] = -transform->T[i];
  const bool good = newton->Y && newton->residual && newton->Zp && newton->omega &&
                    newton->dZ && newton->zero && newton->B_over_h && newton->minus_T;
  return good ? STEIF_OK : STEIF_NO_MEMORY;
}

/* May the factors in use serve another shift? Then corrections are scaled by 2 / (1 + ratio), which centres the rate
 * of convergence over the spectrum (Petzold, DASSL). Not of DAEs: that leaves a share of each correction in rows without
 * a derivative, which old factors solve exactly; a predictor of order k multiplies it by up to 2^k - 1 from step to
 * step, up to what the tolerance lets be, and components of index 2 and 3 divide it by h and h^2. */
static bool serves(stf_newton *newton, sunrealtype shift)
{
  const sunrealtype ratio = shift / newton->shift, window = newton->shift_ratio_most;
  if (!(window > 1) || newton->jacobian_wanted || newton->system->linear) return false;
  if (!(ratio < window && ratio > 1 / window)) return false;
  const bool centred = newton->gamma == 0 && newton->system->problem->dae_index < 1;
  newton->relax = centred ? 2 / (1 + ratio) : 1;
  return true;
}

static int factor(stf_newton *newton, sunrealtype h)
{
  const stf_transform *transform = &newton->transform;
  steif_shift shift[STEIF_STAGES];
  for (int k = 0; k < transform->shifts; k++)
    shift[k] = (steif_shift){transform->re[k] / h, transform->im[k] / h};
  newton->factored = false;
  if (newton->gamma > 0) shift[0] = (steif_shift){1 / (newton->gamma * h), 0};
  const int count = newton->gamma > 0 ? 1 : transform->shifts;
  STEIF_TRY(steif_pencil_factor(newton->system->pencil, count, shift));
  newton->shift = shift[0].re, newton->factored = true;
  newton->relax = 1, newton->eta = 1;
  return STEIF_OK;
}

/* Products follow the shift for nothing; the preconditioner stays. */
static int follow(stf_newton *newton, sunrealtype shift)
{
  if (!newton->system->krylov || newton->gamma > 0 || !(newton->shift_ratio_most > 1))
    return STEIF_OK;
  newton->relax = 1;
  return steif_pencil_factor(newton->system->pencil, 1, &(steif_shift){shift, 0});
}

int stf_newton_prepare(stf_newton *newton, sunrealtype t, sunrealtype h, N_Vector y,
                       N_Vector yp, bool jacobian)
{
  const stf_transform *transform = &newton->transform;
  const sunrealtype shift = newton->gamma > 0 ? 1 / (newton->gamma * h) : transform->re[0] / h;
  const bool same = newton->factored && shift == newton->shift;
  if (!same || newton->h != h)
    for (int i = 0; i < transform->s * transform->s; i++)
      newton->B_over_h[i] = transform->B[i] / h;
  newton->h = h;
  stf_inexact_whole(newton);
  if (!jacobian && same) return newton->relax = 1, follow(newton, shift);
  if (!jacobian && newton->factored && serves(newton, shift)) return follow(newton, shift);
  if (!jacobian) jacobian = newton->renew_with_factors && !newton->jacobian_new;
  if (jacobian && !(newton->system->linear && newton->factored)) {
    STEIF_TRY(stf_system_linearise(newton->system, t, y, yp));
    newton->factored = false, newton->jacobian_wanted = false;
  }
  if (jacobian) newton->jacobian_new = true;
  return newton->factored && shift == newton->shift ? STEIF_OK : factor(newton, h);
}

/* The first residual of a solve from Z = 0: slopes are the offsets, arguments the bases. */
static int first_residuals(stf_newton *newton, const stf_stages *g)
{
  for (int j = 0; j < newton->transform.s; j++)
    STEIF_TRY(stf_system_residual(
      newton->system, g->t + g->c[j] * g->h, g->base ? g->base[j] : newton->zero,
      g->offset ? g->offset[j] : newton->zero, newton->residual[j]));
  return STEIF_OK;
}

/* Zp = (1/h) B Z; the part of B that is left adds to the sum before 1/h does, which is an error of h
 * and of no coefficient. */
static void slopes(stf_newton *newton, const stf_stages *g)
{
  const int s = newton->transform.s;
  const stf_space *space = &newton->system->space;
  if (!newton->B_part[0]) {
    stf_mix(space, s, s, newton->B_over_h, g->Z, newton->Zp);
    return;
  }
  stf_mix(space, s, s, newton->B_part[0], g->Z, newton->Zp);
  stf_mix(space, s, s, newton->B_part[1], g->Z, newton->residual);
  for (int j = 0; j < s; j++)
    stf_sum(space, 1 / g->h, newton->Zp[j], 1 / g->h, newton->residual[j], newton->Zp[j]);
}

/* residual_j = F at stage j. */
static int residuals(stf_newton *newton, const stf_stages *g)
{
  const stf_transform *transform = &newton->transform;
  const stf_space *space = &newton->system->space;
  slopes(newton, g);
  for (int j = 0; j < transform->s; j++) {
    N_Vector Y = g->Z[j];
    if (g->offset) stf_axpy(space, 1, g->offset[j], newton->Zp[j]);
    if (g->base) stf_sum(space, 1, g->base[j], 1, g->Z[j], Y = newton->Y);
    STEIF_TRY(stf_system_residual(newton->system, g->t + g->c[j] * g->h, Y, newton->Zp[j],
                                  newton->residual[j]));
  }
  return STEIF_OK;
}

/* Shifts after feed those before: rhs_k -= (1/h) E sum_{m > k} S_km omega_m. */
static int couple(stf_newton *newton, int k)
{
  const stf_transform *transform = &newton->transform;
  const stf_space *space = &newton->system->space;
  const int first = transform->row[k], rows = transform->im[k] != 0 ? 2 : 1,
            after = first + rows;
  const int s = transform->s;
  if (after >= s) return STEIF_OK;
  for (int i = first; i < after; i++) {
    stf_combine(space, s - after, transform->coupling + i * s + after, newton->omega + after,
                newton->Y);
    STEIF_TRY(steif_pencil_product(newton->system->pencil, 'E', newton->Y, newton->Zp[0]));
    stf_axpy(space, -1 / newton->h, newton->Zp[0], newton->omega[i]);
  }
  return STEIF_OK;
}

/* omega: right sides in, solutions out, shift by shift from the last where they are coupled. */
static int solve_shifts(stf_newton *newton)
{
  const stf_transform *transform = &newton->transform;
  N_Vector re[STEIF_STAGES], im[STEIF_STAGES];
  for (int k = 0; k < transform->shifts; k++) {
    re[k] = newton->omega[transform->row[k]];
    im[k] = transform->im[k] != 0 ? newton->omega[transform->row[k] + 1] : NULL;
  }
  if (!transform->coupling)
    return stf_parallel_solve(newton->system->pencil, transform->shifts, re, im);
  for (int k = transform->shifts; k-- > 0;) {
    STEIF_TRY(couple(newton, k));
    STEIF_TRY(steif_pencil_solve(newton->system->pencil, k, 1, &re[k], im[k] ? &im[k] : NULL));
  }
  return STEIF_OK;
}

static int shift_corrections(stf_newton *newton)
{
  const int s = newton->transform.s;
  const stf_space *space = &newton->system->space;
  if (s > 1) stf_mix(space, s, s, newton->transform.Tinv, newton->residual, newton->omega);
  STEIF_TRY(solve_shifts(newton));
  if (s > 1) stf_mix(space, s, s, newton->transform.T, newton->omega, newton->dZ);
  return STEIF_OK;
}

int stf_newton_correct(stf_newton *newton)
{
  return newton->gamma > 0 ? stf_blend_correction(newton) : shift_corrections(newton);
}

/* dZ of one sweep and its weighted norm over all stages. The residual enters with its own sign:
 * Z - dZ is the next iterate. */
static int sweep(stf_newton *newton, const stf_stages *g, int m, sunrealtype *norm)
{
  const int s = newton->transform.s;
  const stf_space *space = &newton->system->space;
  newton->sweeps++;
  stf_inexact_sweep(newton, m);
  stf_inexact_defer(newton, true);
  int code = residuals(newton, g);
  if (!code) code = stf_newton_correct(newton);
  stf_inexact_defer(newton, false);
  stf_inexact_sweep(newton, 0);
  if (code) return code;
  *norm = stf_norms(space, s, newton->dZ, newton->weights);
  for (int j = 0; j < s; j++) stf_axpy(space, -newton->relax, newton->dZ[j], g->Z[j]);
  return STEIF_OK;
}

/* The first component of s vectors that is not finite, or -1. */
static sunindextype not_finite(const stf_newton *newton, N_Vector *v)
{
  sunindextype i = -1;
  for (int j = 0; j < newton->transform.s && i < 0; j++) i = stf_not_finite(v[j]);
  return i;
}

/* Where it began: in the residuals, which a single stage has solved over, or in what was made of them. */
static sunindextype culprit(stf_newton *newton, const stf_stages *g)
{
  const bool linear = newton->system->linear, lost = newton->omega == newton->residual;
  if (lost && !linear) {
    stf_zero(&newton->system->space, g->Z[0]);
    if (residuals(newton, g) == STEIF_OK) return not_finite(newton, newton->residual);
  }
  const sunindextype i = not_finite(newton, newton->residual);
  return i < 0 ? not_finite(newton, linear ? g->Z : newton->dZ) : i;
}

static int refuse_values(stf_newton *newton, const stf_stages *g)
{
  const steif_problem *p = newton->system->problem;
  char name[STEIF_SPEC_WORD], where[STEIF_SPEC_WORD + 8] = "";
  const sunindextype i = culprit(newton, g);
  if (i >= 0) snprintf(where, sizeof where, " (%s)", stf_unknown(p, i, name));
  return STEIF_RECOVER(
    newton->system->ctx, STEIF_NOT_FINITE,
    "a stage of problem '%s' is not finite%s in the step from t = %.12g with h = %.6g: "
    "the callbacks returned NaN or infinity, or the step is too large",
    p->name, where, g->t, g->h);
}

static int refuse(stf_newton *newton, const stf_stages *g, int iterations, sunrealtype norm,
                  sunrealtype theta)
{
  steif_context *ctx = newton->system->ctx;
  newton->fails++, newton->jacobian_wanted = true, newton->eta = 1;
  newton->system->doubted = true;
  if (!isfinite(norm)) return refuse_values(newton, g);
  return STEIF_RECOVER(
    ctx, STEIF_NO_CONVERGENCE,
    "Newton's iteration did not converge for problem '%s' in the step from t = %.12g "
    "with h = %.6g: after %d iterations the correction is %.3g of its tolerance, "
    "rate %.2g; make the step smaller or check the Jacobian",
    newton->system->problem->name, g->t, g->h, iterations, norm / newton->tolerance, theta);
}

/* Corrections that are this small and no longer shrink cannot be made smaller. */
static bool stalled(const stf_newton *newton, sunrealtype norm, sunrealtype quotient)
{
  return quotient >= 0.5 && norm <= fmax(newton->tolerance, newton->rounding);
}

/* Is a solve refined by a second sweep? Where the index is above 1 the error of plain factors fills
 * zero blocks of s E - A that carry it, and is amplified by 1/h for each above 1; what refinement
 * leaves keeps the pattern (R. D. Skeel, Math. Comp. 35, 1980). Small systems have that from
 * coordinates in which E is triangular. */
static bool refines(const stf_newton *newton)
{
  return newton->system->storage == STEIF_SPARSE && newton->system->problem->dae_index > 1;
}

/* A linear system is solved by one sweep from Z = 0: Z = -T omega. */
static int solve_linear(stf_newton *newton, const stf_stages *g)
{
  const int s = newton->transform.s;
  const stf_space *space = &newton->system->space;
  newton->sweeps++, newton->count = 1;
  stf_inexact_sweep(newton, 1);
  stf_inexact_defer(newton, true);
  int code = first_residuals(newton, g);
  if (!code && s > 1)
    stf_mix(space, s, s, newton->transform.Tinv, newton->residual, newton->omega);
  if (!code) code = solve_shifts(newton);
  stf_inexact_defer(newton, false);
  stf_inexact_sweep(newton, 0);
  if (code) return code;
  if (s > 1)
    stf_mix(space, s, s, newton->minus_T, newton->omega, g->Z);
  else
    stf_scale(space, -1, newton->omega[0], g->Z[0]);
  sunrealtype norm = 0;
  for (int j = 0; space->serial && j < s; j++)
    if (!stf_finite(space, g->Z[j])) norm = NAN;
  if (!space->serial) norm = stf_norms(space, s, g->Z, newton->weights);
  if (!isfinite(norm)) return refuse(newton, g, 1, NAN, 0);
  return refines(newton) ? sweep(newton, g, 2, &norm) : STEIF_OK;
}

/* The same from a start, which leaves less to GMRES. */
static int solve_predicted(stf_newton *newton, const stf_stages *g)
{
  sunrealtype norm;
  STEIF_TRY(sweep(newton, g, newton->count = 1, &norm));
  return norm <= 1e300 ? STEIF_OK : refuse(newton, g, 1, norm, 0);
}

/* What corrections leave, theta / (1 - theta). The blended iteration is far from normal: a correction of a thousandth of
 * the last, which took smooth errors of the predictor away, may be followed by one as large. */
static sunrealtype left_at(const stf_newton *newton, sunrealtype theta)
{
  const bool blended = newton->gamma > 0 && newton->system->problem->dae_index < 2;
  return fmax(theta / (1 - theta), blended ? 0.7 : 0);
}

/* What is expected of the first sweep, theta / (1 - theta), with uncentred factors of another shift: a component of
 * which the Jacobian has next to nothing contracts by |1 - ratio|. */
static sunrealtype expected(const stf_newton *newton)
{
  if (newton->gamma > 0 || newton->relax != 1 || newton->transform.s > 1) return 0;
  const sunrealtype rate = fabs(1 - newton->transform.re[0] / newton->h / newton->shift);
  return rate < 1 ? rate / (1 - rate) : 1;
}

int stf_newton_solve(stf_newton *newton, const stf_stages *g)
{
  const bool starts = g->predicted && newton->system->krylov;
  if (newton->system->linear) return (starts ? solve_predicted : solve_linear)(newton, g);
  sunrealtype norm, last = 0, theta = newton->theta = 0, first = 0;
  newton->eta = fmax(newton->eta_least, sqrt(newton->eta * sqrt(newton->eta))); /* eta^(3/4) */
  newton->eta = fmax(newton->eta, fmax(left_at(newton, 0), expected(newton)));
  for (int m = 1;; m++) {
    STEIF_TRY(sweep(newton, g, m, &norm));
    newton->count = m;
    if (!(norm <= 1e300)) return refuse(newton, g, m, norm, theta);
    if (m > 1) {
      const sunrealtype quotient = norm / last;
      theta = m == 2 ? quotient : sqrt(theta * quotient);
      newton->theta = theta;
      if (stalled(newton, norm, quotient)) { /* once more for velocities, which keep errors */
        if (newton->system->problem->dae_index >= 3) STEIF_TRY(sweep(newton, g, m + 1, &norm));
        break;
      }
      if (theta >= 1 || m >= newton->iterations) return refuse(newton, g, m, norm, theta);
      newton->eta = left_at(newton, theta);
      if (m == 2) first = newton->eta, newton->eta_of = last;
    }
    const sunrealtype larger = m == 1 ? fmax(1, norm / newton->eta_of) : 1;
    if (norm == 0 || larger * newton->eta * norm <= newton->tolerance) break;
    last = norm;
  }
  newton->eta = fmax(newton->eta, first);
  if (theta > newton->stale_rate) newton->jacobian_wanted = true;
  return STEIF_OK;
}

int stf_newton_full(stf_newton *newton, const stf_stages *g)
{
  const stf_space *space = &newton->system->space;
  const int end = newton->transform.s - 1;
  sunrealtype norm = 0, last = 0, rate = 0;
  for (int m = 1; m <= newton->iterations; m++, last = norm) {
    STEIF_TRY(residuals(newton, g)); /* leaves Zp at Z */
    stf_copy(space, g->Z[end], newton->Y);
    if (g->base) stf_axpy(space, 1, g->base[end], newton->Y);
    STEIF_TRY(stf_newton_prepare(newton, g->t + g->c[end] * g->h, g->h, newton->Y,
                                 newton->Zp[end], true));
    STEIF_TRY(sweep(newton, g, m + 1, &norm));
    newton->jacobian_wanted = true; /* the Jacobian is that of another point */
    newton->count = m;
    if (!(norm <= 1e300)) break;
    if (m > 1) rate = norm / last;
    if (norm <= newton->tolerance || stalled(newton, norm, rate)) return STEIF_OK;
  }
  return refuse(newton, g, newton->count, norm, rate);
}

int stf_newton_polish(stf_newton *newton, const stf_stages *g)
{
  sunrealtype norm = 0, last = INFINITY;
  for (int m = 0; m < newton->iterations; m++) {
    STEIF_TRY(sweep(newton, g, m + 1, &norm));
    if (!(norm < last / 2) || norm == 0) break;
    last = norm;
  }
  return STEIF_OK;
}

void stf_newton_single(stf_newton *newton, sunrealtype b)
{
  if (newton->transform.re[0] == b) return;
  newton->transform.re[0] = newton->single = b;
  newton->transform.B = &newton->single;
  newton->h = 0;
}

bool stf_newton_stale(const stf_newton *newton) { return newton->jacobian_wanted; }
