/* carried_error.c: what has become of the errors of all steps so far.
 *
 * Every step adds its estimate to what the steps before have left, which the linearised problem carries on:
 *   e <- R e + estimates,   R = (1 - sqrt(2) x)/(1 - x)^2 at x = A/sigma, E e' = A e,
 * two solves with the factors at hand, whose shift is sigma. R damps what is stiff, keeps oscillations,
 * |R(iy)|^2 = 1 - y^4/(1 + y^2)^2, and lets grow what grows. Two steps are carried on together. The
 * lengths of e before and after tell how much of the past is remembered.
 *
 * The errors of a problem that forgets them need not be kept small enough for all steps to add up: each may
 * be half a tolerance over the number of steps remembered. Motions without friction never
 * forget, and some magnify errors later by much: for them the share stays what stf_share makes it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include "pencil.h"
#include <math.h>

enum { EVERY = 2, FIRST = 20 };
static const sunrealtype ROOT = 1.41421356237309505, MOST = 0.1;

int stf_carried_open(stf_step *s, sunrealtype rounding, sunrealtype all, stf_carried *c)
{
  if (!s->adaptive) return STEIF_OK;
  c->all = all;
  c->least = fmin(MOST, rounding / s->options->rtol);
  c->e = stf_pool_vector(s->pool, s->y);
  c->work = stf_pool_vector(s->pool, s->y);
  c->other = stf_pool_vector(s->pool, s->y);
  if (!c->e || !c->work || !c->other) return STEIF_NO_MEMORY;
  stf_zero(&s->system.space, c->e);
  return STEIF_OK;
}

/* Solutions have about the length 1: iterative solvers know what is small by the weights. */
static int carry(stf_step *s, stf_carried *c, sunrealtype sigma)
{
  const stf_space *space = &s->system.space;
  const sunrealtype before = stf_norm(space, c->e, s->weights);
  if (!(before > 0)) return STEIF_OK;
  stf_scale(space, sigma / before, c->e, c->e);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', c->e, c->work));
  STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &c->work, NULL));
  stf_scale(space, sigma, c->work, c->e);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', c->e, c->other));
  STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &c->other, NULL));
  stf_sum(space, before * ROOT, c->work, before * (1 - ROOT), c->other, c->e);
  const sunrealtype ratio = stf_norm(space, c->e, s->weights) / before;
  if (!isfinite(ratio)) return STEIF_NOT_FINITE;
  c->remembered *= ratio;
  c->size = s->problem->dae_index == 1 ? ratio * before : ratio * c->size;
  return STEIF_OK;
}

/* What one of the errors remembered may be; 0 as long as the problem was never seen to forget. */
static sunrealtype share(stf_carried *c)
{
  const sunrealtype times = 4;
  if (c->steps < FIRST) return 0;
  if ((sunrealtype)c->steps > times * c->remembered) c->forgets = true;
  return c->forgets ? fmin(MOST, c->all / c->remembered) : 0;
}

void stf_carried_add(stf_step *s, stf_carried *c, sunrealtype sigma, N_Vector estimate)
{
  const stf_space *space = &s->system.space;
  if (!c->e) return;
  if (c->steps % EVERY == EVERY - 1) {
    const int code = carry(s, c, sigma);
    if (code == STEIF_CALLBACK) c->failure = code;
    if (code) {
      c->e = NULL; /* nothing is known any more */
      c->loose = c->size = 0;
      return;
    }
  }
  stf_axpy(space, 1, estimate, c->e);
  const sunrealtype one = stf_norm(space, estimate, s->weights);
  c->steps++;
  c->remembered++;
  c->sum += one;
  if (s->problem->dae_index != 1) c->size += one; /* algebraic components hand nothing on */
  c->loose = s->problem->dae_index < 2 ? share(c) : 0;
  if (s->problem->dae_index > 1)
    c->size = c->sum; /* a step of R does not carry hidden constraints on */
}

int stf_carried_retry(const stf_step *s, stf_carried *c)
{
  enum { MANY = 6, MORE = 2 };
  if (s->tries >= MANY && s->count > FIRST) c->least = fmin(MOST, MORE * c->least);
  return c->failure;
}

sunrealtype stf_carried_share(const stf_carried *c, sunrealtype wanted)
{
  return fmax(wanted, fmax(c->least, c->loose));
}

sunrealtype stf_carried_excess(const stf_carried *c, sunrealtype wanted)
{
  return 2 * wanted < c->least ? fmin(c->size, c->sum) : 0;
}
