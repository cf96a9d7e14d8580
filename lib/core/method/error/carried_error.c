/* carried_error.c: what has become of the errors of all steps so far.
 *
 * Every step adds its estimate to what the steps before have left, which the linearised problem carries on:
 *   e <- R e + estimates,   R = (1 + (tau - 2) x)/(1 - x)^2 at x = A/sigma, tau = sigma H, E e' = A e,
 * two solves with the factors at hand, whose shift is sigma, for the steps of a time H. R agrees with
 * e^(tau x) to first order, at tau = 2 +- sqrt(2) to second; it damps what is stiff, no oscillation grows for
 * tau between these, |1 + (tau - 2) i y|^2 <= (1 + y^2)^2, and what grows does so. The lengths of e
 * before and after tell how much of the past is remembered; for this alone longer times H are
 * carried on as if they were shorter.
 *
 * The errors of a problem that forgets them need not be kept small enough for all steps to add up: each may
 * be a part of the tolerance over the number of steps remembered. Motions without friction never
 * forget, and some magnify errors later by much: for them the share stays what stf_share makes it.
 *
 * Where e has been seen to shrink and never to grow, its size leads: the errors to come may add up to what
 * is left of the tolerance. Whether it grows is seen by R over the first steps, whose times H are carried on in
 * whole, and by the weights, which grow where solutions decay; one growth by 2 ends this for the run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "step_error.h"
#include <math.h>

/* Steps before anything is known, times that before it is sure; parts of a time before a step that became far
 * shorter. */
enum { FIRST = 20, SURE = 5, MOST_PARTS = 4 };
static const sunrealtype LONGEST = 3.41421356237309505, MOST = 0.1; /* LONGEST: of tau */

int stf_carried_open(stf_step *s, sunrealtype rounding, sunrealtype all, bool exact,
                     stf_carried *c)
{
  if (!s->adaptive) return STEIF_OK;
  if (!c->first) c->first = FIRST, c->most = 0.3;
  c->all = all;
  c->exact = exact;
  c->loose = c->always ? MOST : 0;
  c->growth = 1;
  c->least = fmin(MOST, rounding / s->options->rtol);
  c->whole = 1 / s->options->rtol;
  c->e = stf_pool_vector(s->pool, s->y);
  c->work = stf_pool_vector(s->pool, s->y);
  c->other = stf_pool_vector(s->pool, s->y);
  if (!c->e || !c->work || !c->other) return STEIF_NO_MEMORY;
  stf_zero(&s->system.space, c->e);
  return STEIF_OK;
}

int stf_carried_by_one_step(stf_step *s, int first, sunrealtype most, stf_carried *c)
{
  const sunrealtype all = 0.1;
  c->goal = 0.5, c->first = first, c->most = most;
  return stf_carried_open(s, 0, all, false, c);
}

/* Largest component, in tolerances. */
static sunrealtype largest(stf_step *s, const stf_carried *c, N_Vector x)
{
  if (!s->system.space.serial) {
    stf_count_sum(&s->system.space);
    stf_by_component(&s->system.space, x, s->weights, c->work);
    return N_VMaxNorm(c->work);
  }
  const sunrealtype *a = STF_ARRAY(x), *w = STF_ARRAY(s->weights);
  sunrealtype most = 0;
  for (sunindextype i = 0; i < s->system.space.n; i++) most = fmax(most, fabs(a[i]) * w[i]);
  return most;
}

/* e <- R e for tau <= LONGEST, and its norm. Iterative solvers know what is small by Newton's tolerance: solutions have many
 * times its length. */
static int apply(stf_step *s, stf_carried *c, sunrealtype sigma, sunrealtype tau,
                 sunrealtype *norm)
{
  const stf_space *space = &s->system.space;
  const sunrealtype before = *norm, bend = tau - 2, many = 20;
  const sunrealtype slow = 0.05; /* what is slow must not seem to be forgotten */
  if (!(before > 0)) return STEIF_OK;
  const sunrealtype unit = before / (many * (c->solve ? 1 : s->newton.tolerance)), h = s->h_try;
  stf_by_E *product = c->product ? c->product : stf_product_by_pencil;
  stf_by_shift *solve = c->solve ? c->solve : stf_solve_by_pencil;
  if (!c->solve) stf_pencil_force(s->system.pencil, slow, true);
  stf_scale(space, sigma / unit, c->e, c->e);
  STEIF_TRY(product(s, c->e, c->work));
  STEIF_TRY(solve(s, h, c->work));
  stf_scale(space, sigma, c->work, c->e);
  STEIF_TRY(product(s, c->e, c->other));
  STEIF_TRY(solve(s, h, c->other));
  stf_sum(space, -unit * bend, c->work, unit * (1 + bend), c->other, c->e);
  *norm = stf_norm(space, c->e, s->weights);
  c->growth *= *norm / before;
  return isfinite(c->growth) ? STEIF_OK : STEIF_NOT_FINITE;
}

/* Is it still open whether e shrinks, so that no time may be passed over? */
static bool watched(const stf_carried *c)
{
  return c->goal > 0 && !c->rises && c->steps < SURE * c->first;
}

/* The norm has grown from `before` to `now` over a part of the time, the `stretch`th, and by its weights since it
 * was looked at last. */
static void watch(stf_carried *c, sunrealtype before, sunrealtype now, sunrealtype stretch)
{
  const sunrealtype much = 2, old = before - c->added;
  const sunrealtype heavier = c->seen > 0 && old > c->seen ? log(old / c->seen) : 0;
  c->rise = fmax(0, c->rise + stretch * log(now / before) + heavier);
  c->rises = c->rises || c->rise > log(much);
  c->seen = now;
  c->added = 0;
}

/* In parts of the time of second order while e is watched; what is left of it waits. */
static int carry(stf_step *s, stf_carried *c, sunrealtype sigma)
{
  const sunrealtype tau = c->time * sigma;
  const sunrealtype before = stf_norm(&s->system.space, c->e, s->weights);
  sunrealtype norm = before;
  const bool rest = watched(c) && floor(tau / LONGEST) <= MOST_PARTS;
  const sunrealtype all = rest ? floor(tau / LONGEST) : ceil(tau / LONGEST),
                    parts = c->exact || watched(c) ? fmin(all, MOST_PARTS) : 1,
                    part = rest ? LONGEST : fmin(tau / parts, LONGEST);
  c->time = rest ? fmax(0, tau - parts * part) / sigma : 0;
  for (int k = 0; k < parts; k++) STEIF_TRY(apply(s, c, sigma, part, &norm));
  if (before > 0) watch(c, before, norm, rest ? 1 : tau / (parts * part));
  if (c->growth < 1) {
    c->remembered *= c->growth;
    c->sum *= c->growth;
    c->growth = 1;
  }
  c->size = largest(s, c, c->e);
  c->peak = fmax(c->peak, c->size);
  return STEIF_OK;
}

/* What is left of the tolerance, for each error that will be remembered at the end. Steps grow by factors above
 * 1.5 alone, and make less than they may: hence twice. Of derivatives less is known, where they count. */
static sunrealtype share_of_rest(const stf_step *s, const stf_carried *c)
{
  const sunrealtype shrunk = 0.7, times = 2;
  const sunrealtype left = (s->options->t1 - s->t) / s->h_try - 1;
  const bool known =
    c->goal > 0 && !c->rises && !c->jumped && c->remembered < shrunk * (sunrealtype)c->steps;
  const bool counts = s->carry && !s->options->untested_sensitivities;
  if (!known || counts || !(left > 0)) return 0;
  const sunrealtype count = c->forgets ? fmin(left, c->remembered) : left;
  return times * fmax(0, c->goal - c->size) / fmax(1, count);
}

/* What one of the errors remembered may be; 0 as long as the problem was never seen to forget. */
static sunrealtype share(const stf_step *s, stf_carried *c)
{
  const sunrealtype times = 4;
  if (c->always) return fmin(MOST, c->all / c->remembered);
  if (c->steps < c->first) return 0;
  if ((sunrealtype)c->steps > times * c->remembered) c->forgets = true;
  const sunrealtype of_all = c->forgets ? fmin(MOST, c->all / c->remembered) : 0;
  return fmin(c->most, fmax(of_all, share_of_rest(s, c)));
}

/* Of e, in parts that are carried on: the longer, the less there is to know. */
static bool due(const stf_step *s, const stf_carried *c, sunrealtype sigma)
{
  const sunrealtype most = 0.5, parts = 2, long_pause = 8;
  if (c->dear) return (c->time + s->h_try) * sigma > long_pause * LONGEST;
  if (watched(c)) return c->time * sigma >= parts * LONGEST;
  const bool rare = c->steps > c->first && c->remembered > most * (sunrealtype)c->steps;
  const sunrealtype pause = c->exact ? 1 : rare ? long_pause : 2;
  return (c->time + s->h_try) * sigma > pause * LONGEST;
}

/* Is e not carried on, of the index that holds now? Events change it. */
static bool summed(const stf_step *s, const stf_carried *c)
{
  return s->problem->dae_index > (c->goal > 0 ? 2 : 1);
}

/* Steps on problems of index 3, and of index 2 where no goal is set, are all remembered: R does not carry on
 * the errors of their hidden constraints. */
void stf_carried_add(stf_step *s, stf_carried *c, sunrealtype sigma, N_Vector error,
                     sunrealtype norm)
{
  const stf_space *space = &s->system.space;
  if (!c->e) return;
  c->time += s->h_try;
  c->steps++;
  c->jumped = c->jumped || s->crossed;
  c->remembered++;
  c->sum += c->goal > 0 ? norm : largest(s, c, error);
  if (summed(s, c)) {
    c->size = c->sum;
    c->loose = c->always ? share(s, c) : 0;
    return;
  }
  stf_axpy(space, 1, error, c->e);
  c->added += norm;
  if (due(s, c, sigma)) {
    const int code = carry(s, c, sigma);
    if (code == STEIF_CALLBACK) c->failure = code;
    if (code) {
      c->e = NULL; /* nothing is known any more */
      c->loose = c->size = 0;
      return;
    }
  }
  c->loose = share(s, c);
}

/* The bound `all` is on corrections: what a stage leaves enters the next ones ten times, by the coefficients. No correction
 * is smaller than rounding. */
void stf_carried_newton(stf_step *s, const stf_carried *c)
{
  const sunrealtype all = 0.01, least = 0.1 * STF_EPS / s->options->rtol;
  if (!s->adaptive || !c->e || s->options->newton > 0) return;
  s->newton.tolerance = fmin(s->newton.tolerance, fmax(least, all / c->remembered));
}

int stf_carried_retry(const stf_step *s, stf_carried *c)
{
  enum { MANY = 6, MORE = 2 };
  if (s->tries >= MANY && s->count > c->first) c->least = fmin(MOST, MORE * c->least);
  return c->failure;
}

sunrealtype stf_carried_share(const stf_carried *c, sunrealtype wanted)
{
  return fmax(wanted, fmax(c->least, c->loose));
}

/* What is left of e after it has shrunk by this much may be what R, of low order, has lost of it, as in
 * relaxation oscillations, whose errors grow beyond the solution itself. Less is lost where they never did and
 * most are still remembered, as in orbits that pass close to each other. */
static sunrealtype lost(const stf_carried *c)
{
  const sunrealtype much = 0.03, little = 1e-3, half = 0.5;
  const bool linear = c->peak < c->whole && c->remembered > half * (sunrealtype)c->steps;
  return linear ? little : much;
}

/* Where e is lost, half the sum, which has no signs, is nearer. So it is after events whose times depend on y, where
 * e jumps by a derivative that is not at hand: limit cycles by switches contract there what grows between them. */
void stf_carried_tell(const stf_carried *c, sunrealtype wanted, stf_control *control)
{
  const sunrealtype half = 0.5;
  const bool rough = c->exact || 2 * wanted < c->least;
  control->accumulated = rough ? fmin(c->size, c->sum) : 0;
  const bool followed = c->size > lost(c) * c->peak && !c->jumped;
  control->reached = !c->exact  ? control->accumulated
                     : followed ? c->size
                                : half * control->accumulated;
}
