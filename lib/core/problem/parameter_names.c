/* parameter_names.c: parameters of a problem by name and number, and other values of theirs.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>
#include <steif/parameters.h>
#include <stdio.h>
#include <string.h>

int stf_parameter_check(steif_context *ctx, const steif_problem *p, int k)
{
  STEIF_CHECK(p && p->parameters && p->parameters->count > 0 && p->parameters->value, ctx,
              STEIF_BAD_INPUT, "problem '%s' has no parameters: set .parameters",
              p && p->name ? p->name : "NULL");
  STEIF_CHECK(k >= 0 && k < p->parameters->count, ctx, STEIF_BAD_INPUT,
              "parameter %d of problem '%s' must lie in 0 .. %d", k, p->name,
              p->parameters->count - 1);
  STEIF_CHECK(isfinite(p->parameters->value[k]), ctx, STEIF_NOT_FINITE,
              "parameter %d of problem '%s' is %g", k, p->name, p->parameters->value[k]);
  return STEIF_OK;
}

int steif_parameter_find(steif_context *ctx, const steif_problem *p, const char *name)
{
  STF_NAMED(p);
  if (stf_parameter_check(ctx, p, 0) || !name) return -1;
  const steif_parameters *q = p->parameters;
  for (int k = 0; q->name && k < q->count; k++)
    if (!strcmp(q->name[k], name)) return k;
  char own[STEIF_SPEC_WORD];
  for (int k = 0; !q->name && k < q->count; k++) {
    snprintf(own, sizeof own, "p%d", k + 1);
    if (!strcmp(own, name)) return k;
  }
  char guess[STF_GUESS] = "; they are p1, p2, ...";
  if (q->name) stf_guess(name, q->name, (size_t)q->count, sizeof *q->name, guess);
  if (q->name && !*guess) snprintf(guess, sizeof guess, "; the first one is '%.40s'", *q->name);
  STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "problem '%s' has no parameter '%s'%s", p->name, name,
             guess);
  return -1;
}

int steif_parameter_set(steif_context *ctx, const steif_problem *p, int k, sunrealtype value)
{
  STF_NAMED(p);
  STEIF_TRY(stf_parameter_check(ctx, p, k));
  STEIF_CHECK(isfinite(value), ctx, STEIF_NOT_FINITE, "parameter %d of problem '%s' is %g",
              k + 1, p->name, value);
  const steif_parameters *q = p->parameters;
  q->value[k] = value;
  const int returned = q->moved ? q->moved(p->user) : 0;
  STEIF_CHECK(returned == 0, ctx, STEIF_CALLBACK,
              "parameters.moved of problem '%s' returned %d for parameter %d = %g", p->name,
              returned, k + 1, value);
  return STEIF_OK;
}
