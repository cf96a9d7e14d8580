/* rounding.c: how large rounding errors have become beside the tolerance.
 *
 * Every step leaves errors of 8 eps |y_j| and random sign behind and carries those before it
 * along, as its linearisation does by the Pade approximant R(z) = 1/(1 - z + z^2/2) of e^z:
 *   e <- R(h E^{-1} A) e + 8 eps |y| sigma,   R(h E^{-1} A) = -2 Im ((1 + i) E - h A)^{-1} E,
 * which damps what is stiff and lets what grows grow by no more than 2 in a step: implicit
 * Euler's 1/(1 - z) has a pole at the z = 1 of slow growth. Where components decay by many
 * powers of ten to a balance that the large ones once had, what is left of e is no small part
 * of them: no tolerance is met then, however small the steps are. Only runs whose absolute
 * tolerances begin below the rounding of the largest component are followed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "step_error.h"
#include <math.h>

enum { EVERY = 4 }; /* steps are carried along together: the order of magnitude is asked for */
static const sunrealtype errors = 8; /* times eps |y|, of a step */

struct stf_rounding {
  stf_system system;               /* with factors of its own */
  N_Vector error, work, imaginary; /* e; parts of a solution */
  sunrealtype t;                   /* carried along up to here, ... */
  int waiting;                     /* ... and steps since then */
  unsigned state;
};

int stf_rounding_open(steif_solver *s)
{
  const stf_step *step = &s->step;
  const stf_system *from = &step->system;
  const sunrealtype *y = stf_array(step->y);
  if (!step->adaptive || (step->method->traits & STF_EXPLICIT) || s->options.ewt || !y ||
      from->storage == STEIF_KRYLOV || stf_above_rounding(s->problem, &s->options, y, errors))
    return STEIF_OK;
  stf_rounding *r = stf_pool_array(s->pool, 1, sizeof *r);
  if (!r) return STEIF_NO_MEMORY;
  r->error = stf_pool_vector(s->pool, step->y);
  r->work = stf_pool_vector(s->pool, step->y);
  r->imaginary = stf_pool_vector(s->pool, step->y);
  if (!r->error || !r->work || !r->imaginary) return STEIF_NO_MEMORY;
  N_VConst(0, r->error);
  r->state = 1, r->t = step->t;
  STEIF_TRY(stf_system_open(s->pool, s->ctx, s->problem, from->form, from->storage, from->scale,
                            from->floors, step->y, step->yp, &r->system));
  s->rounding = r;
  return STEIF_OK;
}

void stf_rounding_count(const steif_solver *s, steif_stats *sum)
{
  if (!s->rounding) return;
  const stf_system *system = &s->rounding->system;
  const steif_pencil_stats *pencil = steif_pencil_statistics(system->pencil);
  sum->nfe += system->nfe, sum->nje += system->nje;
  sum->nlu += pencil->factors + pencil->refactors, sum->nsolve += pencil->solves;
}

static sunrealtype noise(stf_rounding *r)
{
  r->state = r->state * 1664525u + 1013904223u;
  return (r->state >> 31 ? errors : -errors) * STF_EPS;
}

/* Of residuals of linear solves that nothing corrects, x += noise |A| |y| / 2048. Most of them
 * cancel: e5 loses between a tenth and all of this to rodas4, rodas4p2 and rodas5p, rober
 * nothing that shows. */
static sunrealtype surviving_noise(void *data)
{
  const sunrealtype survives = 1. / 2048;
  return survives * noise(data);
}

static void add(stf_rounding *r, const stf_step *step)
{
  const sunrealtype *y = stf_array(step->y);
  sunrealtype *e = stf_array(r->error);
  for (sunindextype j = 0; j < step->problem->n; j++)
    e[j] += 2 * noise(r) * fabs(y[j]); /* sqrt(EVERY) */
}

int stf_rounding_step(steif_solver *s)
{
  stf_rounding *r = s->rounding;
  const stf_step *step = &s->step;
  if (++r->waiting < EVERY && step->t < s->t1) return STEIF_OK;
  const sunrealtype rate = 1 / (step->t - r->t);
  const steif_shift shift = {rate, rate};
  r->waiting = 0, r->t = step->t;
  const bool before = stf_silence(s->ctx, true);
  int code = stf_system_linearise(&r->system, step->t, step->y, step->yp);
  if (!code) code = steif_pencil_product(r->system.pencil, 'E', r->error, r->work);
  if (!code) code = steif_pencil_factor(r->system.pencil, 1, &shift);
  N_VScale(rate, r->work, r->work);
  N_VConst(0, r->imaginary);
  if (step->method->traits & STF_UNCORRECTED)
    stf_system_add_entries(&r->system, surviving_noise, r, stf_array(step->y),
                           stf_array(r->work));
  if (!code) code = steif_pencil_solve(r->system.pencil, 0, 1, &r->work, &r->imaginary);
  N_VScale(-2, r->imaginary, r->error);
  stf_silence(s->ctx, before);
  if (code) {
    s->rounding = NULL; /* nothing is known any more */
    return code == STEIF_NO_MEMORY ? code : STEIF_OK;
  }
  add(r, step);
  s->rounded = stf_norm(&step->system.space, r->error, step->weights);
  return STEIF_OK;
}

void stf_rounding_keep(steif_solver *s, stf_image *m)
{
  bool followed = s->rounding;
  STF_KEEP(m, followed);
  if (m->code) return;
  if (!followed) s->rounding = NULL;
  stf_rounding *r = s->rounding;
  if (!r) return;
  stf_keep_vector(m, r->error);
  STF_KEEP(m, r->t);
  STF_KEEP(m, r->waiting);
  STF_KEEP(m, r->state);
  stf_system_keep(&r->system, m);
}
