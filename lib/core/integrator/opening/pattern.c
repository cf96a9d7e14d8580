/* pattern.c: the pattern of a sparse problem that nobody has given.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <stdio.h>
#include <string.h>

enum {
  LARGEST = 20000
}; /* unknowns: three evaluations for each cost more than most runs above */

typedef struct owned {
  steif_context *ctx;
  steif_pattern *pattern;
} owned;

static void release(void *of)
{
  owned *o = of;
  steif_pattern_free(o->ctx, &o->pattern);
}

/* Differences of a sparse Jacobian, of unknowns in one process. */
static bool wanted(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const steif_options *o = &s->options;
  const enum steif_storage storage = o->force_storage ? o->storage : p->storage;
  return storage == STEIF_SPARSE && !p->pattern && p->nnz <= 0 && !p->jac && !p->A &&
         !p->idajac && !p->begin && !o->like && !p->start && (p->f || p->F) && p->n > 0 &&
         p->n <= LARGEST;
}

int stf_look_at_pattern(steif_solver *s)
{
  if (!s->problem || !wanted(s)) return STEIF_OK;
  owned *o = stf_pool_array(s->pool, 1, sizeof *o);
  if (!o) return STEIF_NO_MEMORY;
  o->ctx = s->ctx;
  STEIF_TRY(steif_pattern_find(s->ctx, s->problem, &o->pattern));
  STEIF_TRY(stf_pool_adopt(s->pool, o, release));
  if (s->problem != &s->whole) s->whole = *s->problem;
  s->whole.pattern = o->pattern;
  s->problem = s->given = &s->whole;
  s->pattern_found = true;
  return STEIF_OK;
}

void stf_tell_pattern(steif_solver *s)
{
  const size_t end = strlen(s->method);
  const steif_pattern *found = s->pattern_found ? s->given->pattern : NULL;
  if (found)
    snprintf(s->method + end, sizeof s->method - end, " [pattern found: %lld entries]",
             (long long)found->column[s->given->n]);
}
