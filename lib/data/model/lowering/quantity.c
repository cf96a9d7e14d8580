/* quantity.c: the tapes of all blocks for one quantity, made and run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <string.h>

int stf_compile_quantity(stf_model *m, const stf_block *block, const stf_vector *stores,
                         stf_quantity *q)
{
  if (!stores->count) return STEIF_OK;
  stf_tape *tape = stf_vector_push(m->ctx, &q->tapes, sizeof *tape);
  double **space = tape ? stf_vector_push(m->ctx, &q->spaces, sizeof *space) : NULL;
  if (!space) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_tape_compile(&block->graph, &block->box, stores->count, stores->data, tape));
  *space = stf_pool_array(m->pool, stf_tape_space(tape), sizeof **space);
  if (!*space) return STEIF_NO_MEMORY;
  stf_tape_prepare(tape, &m->feed, *space);
  return STEIF_OK;
}

/* Whether none of the outputs at from, from + 1, ... has been written before. */
static bool mark(uint8_t *seen, int64_t from, int64_t count)
{
  for (int64_t k = from; k < from + count; k++) {
    if (seen[k]) return false;
    seen[k] = 1;
  }
  return true;
}

static bool mark_tape(const stf_tape *t, uint8_t *seen, int64_t *written)
{
  const int64_t passes = t->box.dims ? stf_passes(&t->box) : 0;
  for (size_t k = 0; k < t->results.count; k++) {
    const stf_stretch *r = STF_AT(t->results, stf_stretch, k);
    if (!mark(seen, r->a, r->count)) return false;
    *written += r->count;
  }
  for (size_t k = 0; k < t->stores.count; k++) {
    const stf_store *s = STF_AT(t->stores, stf_store, k);
    for (int64_t pass = 0; pass < passes; pass++) {
      const int32_t at = s->slot ? s->slot[pass] : stf_at_pass(&t->box, pass, s->a, s->stride);
      if (!mark(seen, at, 1)) return false;
    }
    *written += passes;
  }
  return true;
}

/* Each of the outputs is written, and only once. */
static bool once(const stf_quantity *q, int64_t size, uint8_t *seen)
{
  int64_t written = 0;
  for (size_t i = 0; i < q->tapes.count; i++)
    if (!mark_tape(STF_AT(q->tapes, stf_tape, i), seen, &written)) return false;
  return written == size;
}

int stf_quantity_close(stf_model *m, stf_quantity *q, int64_t size)
{
  uint8_t *seen = stf_allocate(m->ctx, (size_t)size + 1, 1);
  if (!seen) return STEIF_NO_MEMORY;
  q->size = size;
  q->assigns = once(q, size, seen);
  q->alone = q->assigns && q->tapes.count == 1;
  for (size_t i = 0; i < q->tapes.count; i++)
    STF_AT(q->tapes, stf_tape, i)->assigns = q->assigns;
  stf_release(m->ctx, seen);
  return STEIF_OK;
}

void stf_quantity_prepare(const stf_model *m, const stf_quantity *q)
{
  for (size_t i = 0; i < q->tapes.count; i++)
    stf_tape_prepare(STF_AT(q->tapes, stf_tape, i), &m->feed, *STF_AT(q->spaces, double *, i));
}

void stf_quantity_run(const stf_model *m, const stf_quantity *q, const stf_feed *feed,
                      double *out)
{
  (void)m;
  if (q->alone && !q->code) {
    stf_tape_run(q->tapes.data, feed, *(double **)q->spaces.data, out);
    return;
  }
  if (q->size && !q->assigns) memset(out, 0, (size_t)q->size * sizeof *out);
  for (size_t i = 0; i < q->tapes.count; i++) {
    const stf_tape *t = STF_AT(q->tapes, stf_tape, i);
    double *space = *STF_AT(q->spaces, double *, i);
    if (q->code && q->code[i])
      q->code[i](feed->t, feed->y, feed->yp, feed->p, feed->memory, space, q->slots[i], out);
    else
      stf_tape_run(t, feed, space, out);
  }
}

void stf_quantity_free(const stf_model *m, stf_quantity *q)
{
  for (size_t i = 0; i < q->tapes.count; i++)
    stf_tape_free(m->ctx, STF_AT(q->tapes, stf_tape, i));
  stf_vector_free(m->ctx, &q->tapes);
  stf_vector_free(m->ctx, &q->spaces);
}
