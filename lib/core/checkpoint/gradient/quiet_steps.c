/* quiet_steps.c: gradients of solutions that do not move. The error test of a run sees y alone: where y is in equilibrium, or
 * linear in t, steps are as long as they like, and derivatives that move over them are off by any factor. Then the way is made
 * again with shorter steps until the gradients of two agree.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "journey.h"
#include <math.h>
#include <stdio.h>

enum { ROUNDS = 7 };
static const sunrealtype nothing =
  1e-6; /* an error below this part of the tolerance says nothing of y */
static const sunrealtype much = 0.3; /* of the interval, in such steps */

void stf_quiet_step(stf_journey *J)
{
  const steif_solver *s = J->runner;
  const sunrealtype h = s->step.h;
  if (!s->step.adaptive) return;
  if (s->error_old <= nothing) J->quiet += h;
  if (h > J->longest) J->longest = h;
}

bool stf_quiet(const stf_journey *J)
{
  return J->quiet > much * (J->runner->t1 - J->back.problem->t0);
}

/* The first parameter by which J_i differ, -1: none. What J is over p tells of derivatives that are 0. */
static int apart(const stf_journey *call, const steif_parameters *q, const steif_gradient *a,
                 const steif_gradient *b, int i)
{
  const sunrealtype close = fmax(100 * call->options.rtol, 1e-9), floor = call->options.atol;
  for (int k = 0; k < a->parameters; k++) {
    const sunrealtype typical = q->scale ? q->scale[k] : fabs(q->value[k]);
    const sunrealtype x = a->dp[i * a->parameters + k], y = b->dp[i * a->parameters + k];
    const sunrealtype least = (fabs(a->value[i]) + floor) / (typical > 0 ? typical : 1);
    const bool known = !(isnan(x) && isnan(y)); /* options.active */
    if (known && !(fabs(x - y) <= close * (fmax(fabs(x), fabs(y)) + least))) return k;
  }
  return -1;
}

/* Do dJ_i/dy0 agree? Of index 2 and 3 those off the constraints belong to the steps, and none is asked for. */
static bool starts_agree(const stf_journey *call, const steif_problem *p,
                         const steif_gradient *a, const steif_gradient *b, int i)
{
  const sunrealtype close = fmax(100 * call->options.rtol, 1e-9);
  const sunrealtype *x = a->dy0 + i * a->n, *y = b->dy0 + i * a->n;
  sunrealtype most = 0, size = 0;
  for (sunindextype j = 0; j < a->n && p->dae_index < 2; j++) {
    most = fmax(most, fabs(x[j] - y[j]));
    size = fmax(size, fmax(fabs(x[j]), fabs(y[j])));
  }
  return most <= close * size;
}

/* *g becomes `next`, and what it has cost is not forgotten. */
static void take(steif_context *ctx, steif_gradient *g, const steif_gradient *next)
{
  const steif_gradient_cost before = g->cost;
  steif_gradient_free(ctx, g);
  *g = *next;
  g->cost.factors += before.factors;
  g->cost.solves += before.solves, g->cost.transposed_solves += before.transposed_solves;
  g->cost.recomputed_steps += before.recomputed_steps;
}

/* k -1: by y0. */
static int not_certified(const stf_journey *call, const steif_problem *p, sunrealtype longest,
                         int i, int k)
{
  char by[40] = "y0";
  if (k >= 0) snprintf(by, sizeof by, "parameter %d", k + 1);
  return STEIF_FAIL(
    call->back.ctx, STEIF_NOT_CERTIFIED,
    "the derivative of functional %d of problem '%s' by %s still changes "
    "with steps of at most %.3g: the solution does not move, so that its error test "
    "does not see derivatives; take forward sensitivities, or a smaller h_max",
    i + 1, p->name, by, longest);
}

int stf_quiet_again(const stf_journey *call, const steif_problem *problem,
                    const steif_functional *functional, sunrealtype longest, steif_gradient *g)
{
  for (int round = 1;; round++) {
    stf_journey J = *call;
    steif_gradient next = {
      .memory = g->memory, .checkpoints = g->checkpoints, .folder = g->folder};
    J.options.h_max = longest = longest / 4;
    STEIF_TRY(stf_journey_once(&J, problem, functional, &next));
    int k = -1, i = 0;
    bool agree = true;
    for (; agree && i < g->count; i++) {
      k = apart(call, problem->parameters, g, &next, i);
      agree = k < 0 && starts_agree(call, problem, g, &next, i);
    }
    take(call->back.ctx, g, &next);
    if (agree) return STEIF_OK;
    if (round == ROUNDS) return not_certified(call, problem, longest, i - 1, k);
  }
}
