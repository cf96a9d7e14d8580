/* index.c: the index of a problem at a point: all of the diagnosis on one page.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "component_numbers.h"
#include "evidence.h"

const char *steif_confidence_name(enum steif_confidence confidence)
{
  switch (confidence) {
  case STEIF_SURE: return "sure";
  case STEIF_PROBABLE: return "probable";
  default: return "undecided";
  }
}

static int allocate(steif_context *ctx, size_t n, steif_diagnosis *d)
{
  stf_pool *pool = stf_pool_new(ctx);
  *d = (steif_diagnosis){.memory = pool, .index = -1};
  int *lists = pool ? stf_pool_array(pool, 6 * n, sizeof *lists) : NULL;
  if (!lists) {
    steif_diagnosis_clear(d);
    return STEIF_NO_MEMORY;
  }
  d->number = lists;
  d->derivatives = lists + n;
  d->determined = lists + 2 * n;
  d->prescribe = lists + 3 * n;
  d->c = lists + 4 * n;
  d->d = lists + 5 * n;
  return STEIF_OK;
}

void steif_diagnosis_clear(steif_diagnosis *d)
{
  if (!d) return;
  stf_pool *pool = d->memory;
  stf_pool_free(&pool);
  *d = (steif_diagnosis){.index = -1};
}

int stf_diagnose(stf_point *point, stf_evidence *e, steif_diagnosis *d)
{
  *e = (stf_evidence){.point = point};
  STEIF_TRY(allocate(point->ctx, point->n, d));
  STEIF_TRY(stf_evidence_points(e));
  STEIF_TRY(stf_evidence_offsets(e));
  STEIF_TRY(stf_evidence_growth(e));
  const bool enough = e->points >= 3 || point->system.linear;
  if (!point->brief || !enough || !stf_evidence_agrees(e)) {
    STEIF_TRY(stf_evidence_consistent(e));
    STEIF_TRY(stf_evidence_arrays(e));
  }
  const stf_summary summary = stf_summarise(e);
  stf_verdict(&summary, d);
  stf_index_message(&summary, d);
  return STEIF_OK;
}

static int diagnose(steif_context *ctx, const steif_problem *problem, const steif_point *where,
                    bool brief, steif_diagnosis *d)
{
  stf_point point;
  stf_evidence evidence;
  *d = (steif_diagnosis){.index = -1};
  STEIF_TRY(stf_point_open(ctx, problem, where, &point));
  point.brief = brief;
  const int code = stf_diagnose(&point, &evidence, d);
  stf_evidence_free(&evidence);
  stf_point_close(&point);
  if (code)
    steif_diagnosis_clear(d);
  else
    steif_forget(ctx); /* of the points where callbacks failed */
  return code;
}

int stf_index_of_components(steif_context *ctx, const steif_problem *problem,
                            steif_diagnosis *d)
{
  return diagnose(ctx, problem, NULL, true, d);
}

int steif_diagnose(steif_context *ctx, const steif_problem *problem, const steif_point *where,
                   steif_diagnosis *d)
{
  STF_NAMED(problem);
  STEIF_CHECK(d, ctx, STEIF_BAD_INPUT, "a place for the diagnosis is needed, got NULL");
  return diagnose(ctx, problem, where, false, d);
}
