/* event_state.c: the memory of a run of a model as bytes for a checkpoint.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "image.h"
#include "reactions.h"

static void keep(stf_model *m, stf_image *image)
{
  stf_reactions *r = m->reactions;
  const size_t switches = (size_t)m->switches;
  stf_keep(image, m->memory, (size_t)m->memories * sizeof *m->memory);
  stf_keep(image, m->event_shift, switches * sizeof *m->event_shift);
  stf_keep(image, m->event_range, switches * sizeof *m->event_range);
  stf_keep(image, m->switch_open, switches * sizeof *m->switch_open);
  for (size_t i = 0; i < r->list.count; i++) {
    stf_reaction *e = STF_AT(r->list, stf_reaction, i);
    STF_KEEP(image, e->pending);
    STF_KEEP(image, e->truth);
    STF_KEEP(image, e->done);
  }
}

long stf_reactions_save(void *bytes, void *user)
{
  stf_model *m = user;
  stf_image image = {.ctx = m->ctx};
  keep(m, &image);
  if (!bytes) return (long)image.used;
  image = (stf_image){.ctx = m->ctx, .at = bytes, .size = image.used};
  keep(m, &image);
  return (long)image.used;
}

int stf_reactions_restore(const void *bytes, size_t count, void *user)
{
  stf_model *m = user;
  stf_image image = {.ctx = m->ctx, .from = bytes, .size = count, .reads = true};
  keep(m, &image);
  return image.code;
}
