/* step_image.c: what a run remembers between two steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "step_error.h"

static void keep_scalars(stf_step *s, stf_image *m)
{
  STF_KEEP(m, s->t);
  STF_KEEP(m, s->h);
  STF_KEEP(m, s->h_equal);
  STF_KEEP(m, s->h_try);
  STF_KEEP(m, s->count);
  STF_KEEP(m, s->yp_known);
  STF_KEEP(m, s->rejected);
  STF_KEEP(m, s->crossed);
  STF_KEEP(m, s->tries);
  STF_KEEP(m, s->restart);
  STF_KEEP(m, s->end_slope_known);
  STF_KEEP(m, s->control);
  STF_KEEP(m, s->factors);
  STF_KEEP(m, s->solves);
  STF_KEEP(m, s->undamped);
  STF_KEEP(m, s->undamped_start);
  STF_KEEP(m, s->undamped_end);
}

void stf_step_keep(stf_step *s, stf_image *m)
{
  keep_scalars(s, m);
  stf_keep_vector(m, s->y);
  stf_keep_vector(m, s->yp);
  stf_keep_vector(m, s->weights);
  if (m->reads && s->system.pencil && s->newton.weights)
    stf_pencil_aim(s->system.pencil, s->newton.weights, 0);
  stf_system_keep(&s->system, m);
  stf_newton_keep(&s->newton, m);
}

void stf_method_keep(stf_step *s, stf_image *m)
{
  if (m->code) return;
  if (s->method->keep)
    s->method->keep(s, m);
  else
    stf_image_stop(m,
                   STEIF_FAIL(s->ctx, STEIF_UNSUPPORTED,
                              "the family '%s' does not say what it remembers: its runs cannot "
                              "be saved (steif_method.keep)",
                              s->method->about));
}

void stf_carried_keep(stf_carried *c, stf_image *m)
{
  bool followed = c->e;
  STF_KEEP(m, followed);
  if (m->code) return;
  if (!followed) c->e = NULL;
  if (c->e) stf_keep_vector(m, c->e);
  STF_KEEP(m, c->steps);
  STF_KEEP(m, c->time);
  STF_KEEP(m, c->growth);
  STF_KEEP(m, c->remembered);
  STF_KEEP(m, c->size);
  STF_KEEP(m, c->sum);
  STF_KEEP(m, c->peak);
  STF_KEEP(m, c->least);
  STF_KEEP(m, c->loose);
  STF_KEEP(m, c->seen);
  STF_KEEP(m, c->added);
  STF_KEEP(m, c->rise);
  STF_KEEP(m, c->rises);
  STF_KEEP(m, c->failure);
  STF_KEEP(m, c->forgets);
  STF_KEEP(m, c->jumped);
}
