/* pencil.c: regularity, index, structure and finite eigenvalues of a pencil s E + F.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "eigenvalues_of.h"

static int verdict(const struct call *call, const struct descriptor *l,
                   const struct structure_answer *a)
{
  const bool open = a->eigenvalues && !a->values.certified;
  if (!a->found.regular) return descriptor_singular(call, l, &a->found, true);
  if (!a->found.certified) say(call, "%s [STEIF_NOT_CERTIFIED]", a->found.message);
  if (open) say(call, "%s [STEIF_NOT_CERTIFIED]", a->values.message);
  return a->found.certified && !open ? EXIT_OK : EXIT_UNCERTIFIED;
}

static int find(struct call *call, const struct descriptor *l, struct structure_answer *a)
{
  const steif_linear *q = &l->system;
  const steif_analysis how = descriptor_analysis(call, l);
  progress(call, "%ld equations", (long)l->n);
  if (steif_structure_find(call->ctx, q->E, q->F, &how, &a->found) ||
      steif_structure_ranks(call->ctx, q->E, q->F, &a->found))
    return descriptor_fail(call);
  a->names = l->names;
  int code = eigenvalues_of(call, l, a);
  if (!code) code = structure_present(call, a);
  return code ? code : verdict(call, l, a);
}

static int run(struct call *call)
{
  struct descriptor l;
  struct structure_answer a = {.names = NULL};
  int code = read_near(call, a.near);
  if (code) return code;
  code = descriptor_open(call, &l, 0, false);
  if (!code) code = find(call, &l, &a);
  steif_eigenvalues_clear(call->ctx, &a.values);
  steif_structure_clear(call->ctx, &a.found);
  descriptor_close(call, &l);
  return code;
}

static const struct option options[] = {
  ANALYSIS_OPTIONS,
  PARALLEL_OPTION("circles shared by ranks: mpirun -np N steif ... --parallel, N = points / 8"),
  {"--count", COUNT, "N",
   "eigenvalues nearest to --near (default: all of dense or small pencils)", NULL},
  {"--near", WORD, "RE[,IM]", "a point S of the complex plane (default: 0)", NULL},
  OPTIONS_END};

const struct verb verb_pencil = {
  .name = "pencil",
  .about = "Find regularity, index, structure and eigenvalues of a pencil s E + F",
  .usage = "E.mtx F.mtx | FILE.mat | PROBLEM [--count N --near S] [--algorithm A] [--radius R]",
  .least = 1,
  .most = 2,
  .picture = true,
  .option = options,
  .matrices = true,
  .run = run,
};
