/* common_start.c: one start for all methods of a comparison.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "comparison.h"
#include <stdlib.h>
#include <string.h>

static void *copy(const void *list, size_t bytes)
{
  void *kept = malloc(bytes);
  return kept ? memcpy(kept, list, bytes) : NULL;
}

/* The start and the index of components that a run by steif would use. */
static int take(struct call *call, comparison *c, const steif_repair *used)
{
  const size_t n = (size_t)c->problem.n;
  if (used->message[0]) steif_report_text(c->report, "initial", used->message);
  if (used->y) c->problem.y0 = c->start = copy(used->y, n * sizeof *used->y);
  if (used->number) {
    c->problem.index = c->number = copy(used->number, n * sizeof *used->number);
    c->problem.dae_index = used->index;
  }
  const bool missing = (used->y && !c->start) || (used->number && !c->number);
  return missing ? no_memory(call, "a start", "free memory") : EXIT_OK;
}

int compare_start(struct call *call, comparison *c)
{
  steif_options o = options_of(call);
  const int form = steif_problem_form(call->ctx, &c->problem);
  c->start = NULL, c->number = NULL;
  if (!form) return fail(call);
  if (o.initial == STEIF_AS_GIVEN || (form != STEIF_MASS && form != STEIF_IMPLICIT))
    return EXIT_OK;
  o.h = 0, o.rtol = 1e-8;
  steif_solver *s = steif_solver_new(call->ctx, &c->problem, "radau:s=3", &o);
  if (!s) return fail(call);
  const int code = take(call, c, steif_initial_used(s));
  steif_solver_free(&s);
  return code;
}

void compare_end(struct call *call, comparison *c)
{
  steif_report_free(&c->report);
  steif_problem_clear(call->ctx, &c->given);
  free(c->start);
  free(c->number);
  free(c->values);
}
