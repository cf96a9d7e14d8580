/* diagnose.c: the index of a problem at a point.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "diagnose.h"

const char *steif_confidence_name(enum steif_confidence confidence)
{
  switch (confidence) {
  case STEIF_SURE: return "sure";
  case STEIF_PROBABLE: return "probable";
  default: return "undecided";
  }
}

int stf_diagnosis_claim(steif_context *ctx, size_t n, steif_diagnosis *d)
{
  stf_pool *pool = stf_pool_new(ctx);
  *d = (steif_diagnosis){.memory = pool, .index = -1};
  int *lists = pool ? stf_claim(pool, 6 * n, sizeof *lists) : NULL;
  if (!lists) {
    steif_diagnosis_clear(d);
    return STEIF_NO_MEMORY;
  }
  d->number = lists, d->derivatives = lists + n, d->determined = lists + 2 * n;
  d->prescribe = lists + 3 * n, d->c = lists + 4 * n, d->d = lists + 5 * n;
  return STEIF_OK;
}

void steif_diagnosis_clear(steif_diagnosis *d)
{
  if (!d) return;
  stf_pool *pool = d->memory;
  stf_pool_free(&pool);
  *d = (steif_diagnosis){.index = -1};
}

static int diagnose(stf_lens *lens, steif_diagnosis *d)
{
  stf_evidence evidence;
  int code = stf_evidence_gather(lens, &evidence);
  if (!code) code = stf_diagnosis_claim(lens->ctx, lens->n, d);
  if (!code) code = stf_verdict(&evidence, d);
  stf_evidence_free(&evidence);
  return code;
}

int steif_diagnose(steif_context *ctx, const steif_problem *problem,
                   const steif_inquiry *inquiry, steif_diagnosis *d)
{
  stf_lens lens;
  STEIF_CHECK(d, ctx, STEIF_BAD_INPUT, "a place for the diagnosis is needed, got NULL");
  *d = (steif_diagnosis){.index = -1};
  STEIF_TRY(stf_diagnose_open(ctx, problem, inquiry, &lens));
  const int code = diagnose(&lens, d);
  stf_diagnose_close(&lens);
  if (!code) steif_forget(ctx); /* of the points where callbacks refused */
  return code;
}
