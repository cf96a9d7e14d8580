/* midpoint.c: a family of the test of extensions, of one method: y + h f(t + h/2, y + h/2 f(t, y)).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include <string.h>

typedef struct state {
  N_Vector slope, before;
} state;

static bool owns(const char *name) { return !strcmp(name, "midpoint"); }

static stf_example example(size_t i)
{
  return (stf_example){i == 0 ? "midpoint" : NULL, STF_PLACES - 1};
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)spec, (void)table;
  state *e = s->state;
  e->slope = stf_pool_vector(s->pool, s->y);
  e->before = stf_pool_vector(s->pool, s->y);
  return e->slope && e->before ? STEIF_OK : STEIF_NO_MEMORY;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  STEIF_TRY(stf_system_rhs(&s->system, s->t, s->y, e->slope));
  stf_sum(space, 1, s->y, h / 2, e->slope, s->next);
  STEIF_TRY(stf_system_rhs(&s->system, s->t + h / 2, s->next, e->slope));
  stf_sum(space, 1, s->y, h, e->slope, s->next);
  return STEIF_OK;
}

static void commit(stf_step *s)
{
  state *e = s->state;
  stf_copy(&s->system.space, s->y, e->before);
  stf_swap(s);
}

/* The line through both ends. */
static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  const sunrealtype x = (s->t - t) / s->h;
  stf_sum(&s->system.space, 1 - x, s->y, x, e->before, y);
  return STEIF_OK;
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
  info->family = "midpoint";
  info->about = "the explicit midpoint rule: C. Runge, Math. Ann. 46 (1895)";
  info->order = 2;
  info->stages = 2;
  return STEIF_OK;
}

const steif_method steif_method_midpoint = {
  .about = "the explicit midpoint rule",
  .forms = STEIF_ODE,
  .traits = STF_EXPLICIT,
  .owns = owns,
  .example = example,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .describe = describe,
};
