/* decay_sentence.c: what two exponents with their errors say of a step, and the sentence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "decay.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void STEIF_PRINTF(2, 3) add(steif_decay *d, const char *format, ...)
{
  const size_t used = strlen(d->sentence);
  va_list a;
  va_start(a, format);
  vsnprintf(d->sentence + used, sizeof d->sentence - used, format, a);
  va_end(a);
}

/* Digits that the error leaves, 2 to 6. */
static int digits(sunrealtype value, sunrealtype error)
{
  const sunrealtype ratio = fabs(value) / fmax(error, 1e-300);
  const int known = ratio > 1 ? (int)ceil(log10(ratio)) : 1;
  return known < 2 ? 2 : known > 6 ? 6 : known;
}

/* The equation decays. */
static void decaying(steif_decay *d)
{
  const sunrealtype off = fabs(d->mu - d->lambda), more = d->rise_numbers - d->rise,
                    room = STF_DECAY_SHARE * fabs(d->lambda) + d->lambda_error + d->mu_error;
  const int p = digits(d->lambda, d->lambda_error), q = digits(d->mu, d->mu_error);
  d->verdict = STEIF_DECAY_LOST;
  add(d, "the equation decays at %.*g; ", p, d->lambda);
  if (d->mu > d->mu_error) {
    add(d, "the numbers grow at %+.*g: the step is too long", q, d->mu);
  } else if (more > STF_RISE_MORE) {
    add(d,
        "the numbers decay in the end, at %.*g, but grow on the way by %.2g; the equation "
        "grows by "
        "%.4g at most: the step is too long",
        q, d->mu, exp(d->rise_numbers), exp(d->rise));
  } else if (off > room) {
    add(d, "the numbers decay, but at %.*g: the step is too long", q, d->mu);
  } else {
    add(d, "the numbers decay at %.*g: the step keeps the decay", q, d->mu);
    d->verdict = STEIF_DECAY_KEPT;
  }
}

/* The equation grows. */
static void growing(steif_decay *d)
{
  const sunrealtype room = STF_DECAY_SHARE * fabs(d->lambda) + d->lambda_error + d->mu_error;
  const int p = digits(d->lambda, d->lambda_error), q = digits(d->mu, d->mu_error);
  d->verdict = STEIF_DECAY_LOST;
  add(d, "the equation grows at %+.*g; the numbers %s at %+.*g", p, d->lambda,
      d->mu > 0 ? "grow" : "decay", q, d->mu);
  if (d->mu < 0) {
    add(d, ": false damping");
  } else if (fabs(d->mu - d->lambda) > room) {
    add(d, ": the step is too long");
  } else {
    add(d, ": the step keeps the growth");
    d->verdict = STEIF_DECAY_KEPT;
  }
}

static void sampling(sunrealtype h, steif_decay *d)
{
  for (int m = 1; m <= 4 && d->period > 0; m++) {
    const sunrealtype turns = h * m / d->period, whole = round(turns);
    if (whole < 1 || fabs(turns - whole) > STF_NEAR_FRACTION * whole) continue;
    d->turns = (int)whole, d->parts = m;
    break;
  }
}

void stf_decay_judge(sunrealtype h, steif_decay *d)
{
  d->sentence[0] = 0;
  sampling(h, d);
  if (!isfinite(d->lambda_error)) {
    d->verdict = STEIF_DECAY_UNDECIDED;
    add(d, "undecided: the exponent of the equation did not converge: run longer (t1), take "
           "shorter steps (h), or give a "
           "period");
  } else if (fabs(d->lambda) <= d->lambda_error || fabs(d->mu) <= d->mu_error) {
    d->verdict = STEIF_DECAY_UNDECIDED;
    add(
      d,
      "undecided: the equation has the exponent %.3g +- %.1g, the numbers %.3g +- %.1g, and a "
      "sign is not known: run longer (t1)",
      d->lambda, d->lambda_error, d->mu, d->mu_error);
  } else if (d->lambda < 0) {
    decaying(d);
  } else {
    growing(d);
  }
}

/* Rounded down to three digits: what is said of steps below holds. */
static sunrealtype below(sunrealtype h)
{
  const sunrealtype unit = pow(10, floor(log10(h)) - 2);
  return floor(h / unit * (1 + 4 * STF_EPS)) * unit;
}

void stf_decay_tell(const stf_question *q, steif_decay *d)
{
  /* Between steps that were tried there may be bad ones, near fractions of a period: those are tried where
   * it is known. */
  const bool all = d->periodic && isfinite(d->h_bad);
  if (d->lambda < 0 && d->h_good > 0)
    add(d, all ? "; they decay for h below %.3g" : "; they decay for every h tried up to %.3g",
        below(d->h_good));
  if (d->most > 0)
    add(d, " (all h = P/m, m = %ld .. %ld; beyond: %s)", d->least, d->most,
        d->tail ? "measured, not proven" : "not known");
  if (d->found) add(d, "; all entries of A come back after %.10g: its period", d->period);
  if (d->turns > 0 && d->parts == 1)
    add(d, "; h is %d time(s) the period %.6g of %s: every step samples the same phase",
        d->turns, d->period, q->linear ? "A" : "f");
  else if (d->turns > 0)
    add(d, "; h is %d/%d of the period %.6g of %s: steps sample %d phases", d->turns, d->parts,
        d->period, q->linear ? "A" : "f", d->parts);
}
