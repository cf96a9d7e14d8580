/* step_search.c: the end h* of the first interval of steps with which the numbers decay.
 *
 * From h downwards until three in a row decay; from the least of these upwards in 24 steps an octave to the
 * first that does not; between the two by bisection. With a period all steps tried are fractions of it, so
 * that their exponents are those of a map, and the steps P/m are looked at one by one besides.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "decay.h"
#include <math.h>

typedef struct search {
  const stf_question *q;
  steif_decay *d;
  long steps; /* made so far */
} search;

/* A step near h whose numbers are measured exactly: turns periods in 1/width steps or more. */
static sunrealtype near_fraction(const stf_question *q, sunrealtype h, sunrealtype width)
{
  if (!(q->period > 0)) return h;
  const sunrealtype wanted = ceil(h / q->period / width);
  const sunrealtype turns = fmax(1, fmin(wanted, STF_TURNS_MOST));
  return turns * q->period / fmax(1, round(turns * q->period / h));
}

/* A run that overflows or finds no stages does not decay. */
static bool decays(search *s, sunrealtype h)
{
  stf_rate rate;
  const bool before = stf_silence(s->q->ctx, true);
  const int code = stf_rate_of_step(s->q, h, &rate);
  stf_silence(s->q->ctx, before);
  s->steps += code ? (long)((s->q->t1 - s->q->problem->t0) / h) : rate.steps;
  return !code && rate.value + STF_SIGN_ERRORS * rate.error < 0 &&
         rate.rise <= s->d->rise + STF_RISE_MORE;
}

static bool enough(const search *s)
{
  return s->steps > STF_SEARCH_STEPS || (s->q->stop && *s->q->stop);
}

/* The least of the first steps in a row that decay; 0: none. */
static sunrealtype downwards(search *s, sunrealtype h)
{
  int row = 0;
  for (sunrealtype at = h; at > STF_SEARCH_LEAST * h; at *= STF_SEARCH_DOWN) {
    const sunrealtype tried = near_fraction(s->q, at, 1.0 / 400);
    row = decays(s, tried) ? row + 1 : 0;
    if (row == STF_SEARCH_ROW) return tried;
    if (enough(s)) return 0;
  }
  return 0;
}

/* The next step above h, at most `most`, that samples nearly the same phases for long: near turns/parts of a
 * period, where holes of S are narrow. */
static sunrealtype near_resonance(const stf_question *q, sunrealtype h, sunrealtype most)
{
  static const sunrealtype off[] = {-1e-2, -3e-3, -1e-3, -3e-4, 0, 3e-4, 1e-3, 3e-3, 1e-2};
  enum { PARTS = 4, TURNS = 8 };
  sunrealtype next = most;
  if (!(q->period > 0) || h > TURNS * q->period) return most;
  for (int parts = 1; parts <= PARTS; parts++)
    for (size_t k = 0; k < sizeof off / sizeof *off; k++) {
      const sunrealtype unit = q->period / parts * (1 + off[k]);
      next = fmin(next, (floor(h / unit * (1 + STF_SEARCH_SMALLEST)) + 1) * unit);
    }
  return next;
}

/* To the first that does not decay; beyond h0 as far as the run has some hundred steps left. */
static void upwards(search *s, sunrealtype h0, sunrealtype from)
{
  const sunrealtype factor = exp2(1.0 / STF_SEARCH_GRID),
                    span = s->q->t1 - s->q->problem->t0 - s->q->transient,
                    most = fmax(h0, span / STF_SEARCH_FEWEST);
  steif_decay *d = s->d;
  sunrealtype at = from * factor;
  d->h_good = from, d->h_bad = INFINITY;
  for (sunrealtype next = from; next < most && !enough(s);) {
    next = near_resonance(s->q, next, at);
    const bool grid = next == at;
    if (grid) at *= factor;
    const sunrealtype h = near_fraction(s->q, next, grid ? 1.0 / 400 : STF_SEARCH_WIDTH / 4);
    if (!(h > d->h_good * (1 + STF_SEARCH_SMALLEST))) continue;
    if (!decays(s, h)) {
      d->h_bad = h;
      return;
    }
    d->h_good = h;
  }
}

static void bisect(search *s)
{
  steif_decay *d = s->d;
  while (d->h_bad - d->h_good > STF_SEARCH_WIDTH * d->h_good) {
    const sunrealtype h = near_fraction(s->q, (d->h_good + d->h_bad) / 2, STF_SEARCH_WIDTH / 4);
    if (!(h > d->h_good && h < d->h_bad)) return;
    if (decays(s, h))
      d->h_good = h;
    else
      d->h_bad = h;
  }
}

/* ---- steps P/m ---- */

static bool fraction(search *s, long m, sunrealtype *mu)
{
  stf_rate rate;
  const bool before = stf_silence(s->q->ctx, true);
  const int code = stf_rate_of_periods(s->q, s->q->method, 1, m, &rate);
  stf_silence(s->q->ctx, before);
  s->steps += m;
  *mu = code ? INFINITY : rate.value;
  return !code && rate.value + STF_SIGN_ERRORS * rate.error < 0;
}

/* Does mu - lambda at P/m, m = most, 2 most, 4 most, fall like a power of h, and by how much? */
static bool tail(search *s)
{
  sunrealtype off[3];
  for (int k = 0; k < 3; k++) {
    if (!fraction(s, s->d->most << k, &off[k])) return false;
    off[k] = fabs(off[k] - s->d->lambda);
  }
  const sunrealtype noise = s->d->lambda_error + 1e-9 * (1 + fabs(s->d->lambda));
  if (off[0] < noise) return true; /* converged: below what is known of lambda */
  const sunrealtype first = log2(off[0] / off[1]), second = log2(off[1] / off[2]);
  return off[0] < fabs(s->d->lambda) / 2 && first > 0 &&
         fabs(first - second) <= STF_TAIL_AGREES * first;
}

static void fractions(search *s)
{
  enum { LONGEST = 600 };
  steif_decay *d = s->d;
  sunrealtype mu;
  const long from = (long)floor(s->q->period / fmin(d->h_bad, 2 * d->h_good)),
             to = 4 * (long)ceil(s->q->period / d->h_good);
  if (to > LONGEST * 4) return;
  d->least = from > 1 ? from : 1;
  d->most = to > 8 ? to : 8;
  for (long m = d->least; m <= d->most; m++)
    if (!fraction(s, m, &mu)) d->least = m + 1;
  d->most = 4 * d->least > d->most ? d->most : 4 * d->least;
  d->tail = tail(s);
}

int stf_step_search(const stf_question *q, sunrealtype h, steif_decay *d)
{
  search s = {.q = q, .d = d};
  const sunrealtype from = downwards(&s, h);
  if (!(from > 0)) return STEIF_OK;
  upwards(&s, h, from);
  if (isfinite(d->h_bad)) bisect(&s);
  if (q->period > 0) fractions(&s);
  /* Runs that were stopped do not decay for that: nothing of them is kept. */
  if (q->stop && *q->stop) d->h_good = d->h_bad = NAN, d->least = d->most = 0;
  return STEIF_OK;
}
