/* pencil.c: regularity, index and structure of a pencil s E + F.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "descriptor.h"

static int find(struct call *call, const struct descriptor *l, struct structure_answer *a)
{
  const steif_linear *q = &l->system;
  const steif_analysis how = descriptor_analysis(call, l);
  progress(call, "%ld equations", (long)l->n);
  if (steif_structure_find(call->ctx, q->E, q->F, &how, &a->found) ||
      steif_structure_ranks(call->ctx, q->E, q->F, &a->found))
    return descriptor_fail(call);
  a->names = l->names;
  const int code = structure_present(call, a);
  if (code) return code;
  if (!a->found.regular) return descriptor_singular(call, l, &a->found);
  if (!a->found.certified) say(call, "%s [STEIF_NOT_CERTIFIED]", a->found.message);
  return a->found.certified ? EXIT_OK : EXIT_UNCERTIFIED;
}

static int run(struct call *call)
{
  struct descriptor l;
  struct structure_answer a = {.names = NULL};
  int code = descriptor_open(call, &l, 0, false);
  if (!code) code = find(call, &l, &a);
  steif_structure_clear(call->ctx, &a.found);
  descriptor_close(call, &l);
  return code;
}

static const struct option options[] = {ANALYSIS_OPTIONS, OPTIONS_END};

const struct verb verb_pencil = {
  .name = "pencil",
  .about = "Find regularity, index and structure of a pencil s E + F",
  .usage = "E.mtx F.mtx | FILE.mat | PROBLEM [--algorithm A] [--radius R]",
  .least = 1,
  .most = 2,
  .option = options,
  .run = run,
};
