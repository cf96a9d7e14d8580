/* diagnose.c: index, structure and consistent start of a problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "attributes.h"
#include "integration.h"
#include "two_starts.h"
#include <stdlib.h>

/* Is there something to look for a consistent start in? */
static bool has_start(const steif_problem *p, const steif_diagnosis *d)
{
  return d->verdict != STEIF_NO_SOLUTION && d->verdict != STEIF_NOT_UNIQUE &&
         d->confidence != STEIF_UNDECIDED && p->n <= STEIF_DIAGNOSE_LARGEST;
}

/* At the point, NULL: at the start of the problem. */
static int look(struct call *call, const steif_problem *p, const steif_point *q,
                const steif_request *request)
{
  struct diagnosis_answer a = {.problem = p, .diagnosis = {.index = -1}};
  progress(call, "%s", p->name);
  if (steif_diagnose(call->ctx, p, q, &a.diagnosis) != STEIF_OK) return fail(call);
  if (has_start(p, &a.diagnosis) &&
      steif_consistent(call->ctx, p, q, request, &a.start) != STEIF_OK)
    say(call, "%s", steif_message(call->ctx));
  if (!q && a.start.y) two_starts_of_problem(call, p, a.start.y, a.beside);
  const int code = diagnosis_present(call, &a);
  steif_start_clear(&a.start);
  steif_diagnosis_clear(&a.diagnosis);
  return code;
}

static int find(struct call *call, const steif_problem *p)
{
  struct point point;
  int *attributes;
  const double t = real_or(call, "--at", p->t0);
  int code = attributes_of(call, p, &attributes);
  const steif_request request = {.attribute = (enum steif_attribute *)attributes};
  if (code || t <= p->t0) {
    if (!code) code = look(call, p, NULL, &request);
    free(attributes);
    return code;
  }
  code = point_open(call, p, t, &point);
  if (!code) code = look(call, p, &point.at, &request);
  point_close(&point);
  free(attributes);
  return code;
}

static int run(struct call *call) { return with_problem(call, find); }

static const struct option options[] = {
  SET_OPTION,
  {"--at", REAL, "T", "time on the solution instead of the start", NULL},
  ATTRIBUTE_OPTIONS,
  OPTIONS_END,
};

const struct verb verb_diagnose = {
  .name = "diagnose",
  .about = "Find index, structure and consistent start of a problem",
  .usage = "PROBLEM [--at T]",
  .least = 1,
  .most = 1,
  .option = options,
  .matrices = true,
  .run = run,
};
