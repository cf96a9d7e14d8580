/* pencil_image.c: the factors of a pencil as they are, so that a run goes on with the same bits: what would
 * be factored anew from the same matrix may have other pivots than what was refactored.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"

/* A slot as a factorisation would find it. */
static void prepare(steif_pencil *p, int slot, stf_image *m)
{
  if (m->code) return;
  p->revived = true;
  stf_image_stop(m, p->backend->prepare(p, slot, p->shift[slot]));
  p->revived = false;
}

/* The values that the matrices have now, as the back end sees them. */
static void update(steif_pencil *p, stf_image *m)
{
  if (m->reads && !m->code && !p->stale) stf_image_stop(m, p->backend->update(p));
}

void stf_pencil_keep(steif_pencil *p, stf_image *m)
{
  size_t slots = (size_t)p->slots;
  bool aims = p->weights;
  stf_keep_count(m, &slots, STEIF_PENCIL_SLOTS);
  if (m->code) return;
  p->slots = (int)slots;
  stf_keep(m, p->shift, slots * sizeof *p->shift);
  STF_KEEP(m, p->stale);
  STF_KEEP(m, p->aim);
  STF_KEEP(m, aims);
  if (!aims) p->weights = NULL;
  update(p, m);
  for (int k = 0; k < (int)slots && !m->code; k++) {
    bool fresh = p->fresh[k];
    STF_KEEP(m, fresh);
    if (m->reads) prepare(p, k, m);
    p->fresh[k] = fresh;
    if (!m->code) p->backend->keep(p, k, m);
  }
  STF_KEEP(m, p->relative);
  STF_KEEP(m, p->ahead);
  STF_KEEP(m, p->forced);
  STF_KEEP(m, p->counts);
  STF_KEEP(m, p->stats);
}
