/* region.c: the stability region of a method and its constants.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include <stdlib.h>

static int find(struct call *call, struct region_answer *a)
{
  const char *method = call->word[0];
  progress(call, "%s", method);
  if (steif_region_find(call->ctx, method, &a->region) != STEIF_OK ||
      steif_region_boundary(call->ctx, method, given(call, "--star"), a->count, a->point))
    return fail(call);
  for (size_t i = 0; i < a->count; i++) {
    a->re[i] = a->point[2 * i];
    a->im[i] = a->point[2 * i + 1];
  }
  return region_present(call, a);
}

static int run(struct call *call)
{
  struct region_answer a = {.count = (size_t)whole_of(call, "--points")};
  a.point = malloc(4 * a.count * sizeof *a.point);
  if (!a.point) return no_memory(call, "the boundary", "ask for fewer --points");
  a.re = a.point + 2 * a.count;
  a.im = a.re + a.count;
  const int code = find(call, &a);
  free(a.point);
  return code;
}

static const struct option options[] = {
  {"--points", COUNT, "N", "number of points of the boundary", "400"},
  {"--star", FLAG, NULL, "trace the order star |R(z)| = |e^z| instead", NULL},
  OPTIONS_END,
};
static const struct rule rules[] = {{"--points", AT_MOST, "1000000"}, RULES_END};

const struct verb verb_region = {
  .name = "region",
  .about = "Find the stability region of a method and its constants",
  .usage = "METHOD [--points N --star]",
  .least = 1,
  .most = 1,
  .picture = true,
  .option = options,
  .rule = rules,
  .matrices = true,
  .run = run,
};
