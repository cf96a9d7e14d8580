/* rates.c: leading exponents of numbers at a step, and of the equation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "decay.h"
#include <math.h>
#include <string.h>

static const char OTHER[] = "radau:s=5";

int stf_rate_of_run(const stf_question *q, const char *method, sunrealtype h, sunrealtype t1,
                    stf_rate *rate)
{
  sunrealtype exponent, error;
  steif_lyapunov_facts facts;
  const steif_lyapunov_options o = {.h = h,
                                    .t1 = t1,
                                    .transient = q->transient,
                                    .count = 1,
                                    .linear = q->linear ? 1 : -1,
                                    .error = &error,
                                    .stop = q->stop};
  STEIF_TRY(steif_lyapunov(q->ctx, q->problem, method, &o, &exponent, NULL, &facts));
  *rate = (stf_rate){
    .value = exponent, .error = STF_STUDENT * error, .rise = facts.rise, .steps = facts.steps};
  if (isnan(rate->error)) rate->error = INFINITY;
  return STEIF_OK;
}

static long divisor(long a, long b)
{
  while (b) {
    const long rest = a % b;
    a = b, b = rest;
  }
  return a;
}

bool stf_commensurate(const stf_question *q, sunrealtype h, long *turns, long *steps)
{
  if (!(q->period > 0)) return false;
  for (long k = 1; k <= STF_TURNS_MOST; k++) {
    const sunrealtype exact = (sunrealtype)k * q->period / h, m = round(exact);
    if (m < 1 || fabs(exact - m) > STF_FRACTION_OFF * exact) continue;
    *turns = k, *steps = (long)m;
    return true;
  }
  return false;
}

/* Of a step that is turns periods / steps. */
static int by_map(const stf_question *q, long turns, long steps, stf_rate *rate)
{
  const long common = divisor(turns, steps);
  return stf_rate_of_periods(q, q->method, turns / common, steps / common, rate);
}

/* By two fractions of the period near h, each with thousands of phases; the error is what is between them. */
static int by_neighbours(const stf_question *q, sunrealtype h, stf_rate *rate)
{
  static const sunrealtype wanted[] = {2500, 2500 * STF_GOLDEN};
  stf_rate near[2];
  for (int k = 0; k < 2; k++) {
    const sunrealtype turns = fmin(ceil(wanted[k] * h / q->period), STF_TURNS_MOST);
    const sunrealtype steps = round(turns * q->period / h);
    STEIF_TRY(by_map(q, (long)turns, (long)fmax(steps, 1), &near[k]));
  }
  *rate =
    (stf_rate){.value = near[1].value,
               .error = fabs(near[1].value - near[0].value) + near[0].error + near[1].error,
               .steps = near[0].steps + near[1].steps};
  return STEIF_OK;
}

int stf_rate_of_step(const stf_question *q, sunrealtype h, stf_rate *rate)
{
  long turns, steps;
  stf_rate map;
  STEIF_TRY(stf_rate_of_run(q, q->method, h, q->t1, rate));
  if (!(q->period > 0)) return STEIF_OK;
  STEIF_TRY(stf_commensurate(q, h, &turns, &steps) ? by_map(q, turns, steps, &map)
                                                   : by_neighbours(q, h, &map));
  rate->value = map.value, rate->error = map.error, rate->steps += map.steps;
  return STEIF_OK;
}

/* ---- the equation ---- */

/* More and more steps in a period, whose numbers have no common divisor that matters. */
static int by_monodromy(const stf_question *q, stf_rate *rate)
{
  stf_rate now = {0}, before = {.value = NAN};
  sunrealtype steps = 16;
  for (int k = 0; k < 2 * STF_REFINEMENTS; k++, steps *= STF_GOLDEN, before = now) {
    STEIF_TRY(stf_rate_of_periods(q, q->exact, 1, lround(steps), &now));
    const sunrealtype off = fabs(now.value - before.value);
    rate->value = now.value;
    rate->error = off + now.error;
    if (off <= STF_MONODROMY_AGREES * (fmin(1, 1 / q->period) + fabs(now.value)))
      return STEIF_OK;
  }
  rate->error = INFINITY;
  return STEIF_OK;
}

/* Over as much of the run as so many steps reach. */
static sunrealtype reach(const stf_question *q, sunrealtype h)
{
  const sunrealtype far = q->problem->t0 + q->transient + STF_FLOW_STEPS * h;
  return fmin(q->t1, far);
}

/* Gauss's method barely damps what decays fast within a step, |R(infinity)| = 1: such components may lead its
 * numbers at any step that is tried. Radau IIA forgets them, and damps oscillations: where both agree it is
 * neither. */
static int confirmed(const stf_question *q, sunrealtype h, sunrealtype t1,
                     const stf_rate *found, bool *yes)
{
  stf_rate other;
  *yes = true;
  if (!strcmp(q->exact, OTHER)) return STEIF_OK;
  STEIF_TRY(stf_rate_of_run(q, OTHER, h, t1, &other));
  const sunrealtype unit = fmin(1, 1 / h) + fabs(found->value);
  *yes =
    fabs(other.value - found->value) <= STF_FLOW_AGREES * unit + other.error + found->error;
  return STEIF_OK;
}

static int by_runs(const stf_question *q, sunrealtype h, stf_rate *rate)
{
  bool agreed;
  stf_rate now = {0}, before = {.value = NAN, .error = NAN};
  const sunrealtype t1 = reach(q, h / STF_GOLDEN);
  const bool whole = q->linear && !q->problem->E && !q->problem->F;
  rate->error = INFINITY;
  for (int k = 0; k < STF_REFINEMENTS; k++, h /= STF_GOLDEN, before = now) {
    if ((t1 - q->problem->t0) / h > 4 * STF_FLOW_STEPS) return STEIF_OK;
    STEIF_TRY(stf_rate_of_run(q, q->exact, h, t1, &now));
    const sunrealtype off = fabs(now.value - before.value);
    rate->value = now.value, rate->rise = now.rise;
    /* Runs end at different phases, and those of a chaotic solution are not the same one: they agree to their
     * standard errors and no further. */
    const sunrealtype blur = now.error + before.error;
    if (!(off <= STF_FLOW_AGREES * (fmin(1, 1 / h) + fabs(now.value)) + blur)) continue;
    STEIF_TRY(confirmed(q, h, t1, &now, &agreed));
    if (!agreed) continue;
    rate->error = off + now.error;
    const sunrealtype fine = fmax(h / 4, (t1 - q->problem->t0) / STF_FLOW_STEPS);
    return whole ? stf_equation_rise(q, fine, t1, &rate->rise) : STEIF_OK;
  }
  return STEIF_OK;
}

int stf_rate_of_equation(const stf_question *q, sunrealtype h, stf_rate *rate)
{
  *rate = (stf_rate){.error = INFINITY};
  if (!(q->period > 0)) return by_runs(q, h, rate);
  STEIF_TRY(by_monodromy(q, rate));
  const sunrealtype fine = fmin(h, q->period / 8) / STF_GOLDEN;
  return stf_equation_rise(q, fine, reach(q, fine), &rate->rise);
}
