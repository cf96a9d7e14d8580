/* fit_sentence.c: what was found and what there is to doubt, in words.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const sunrealtype unlikely = 1e-3; /* a probability */

static void add(steif_fit *f, const char *format, ...) STEIF_PRINTF(2, 3);
static void add(steif_fit *f, const char *format, ...)
{
  const size_t used = strlen(f->message);
  va_list list;
  va_start(list, format);
  vsnprintf(f->message + used, sizeof f->message - used, format, list);
  va_end(list);
}

const char *stf_fit_name(const stf_descent *d, int i, char *room)
{
  const steif_parameters *q = d->problem->parameters;
  if (q->name) return q->name[d->parameter[i]];
  snprintf(room, STEIF_SPEC_WORD, "p%d", d->parameter[i] + 1);
  return room;
}

/* What the standard deviations given let expect of chi2/dof. */
static void weigh(steif_fit *f)
{
  const sunrealtype ratio = f->chi2 / (sunrealtype)f->dof, large = f->probability;
  if (large < unlikely)
    add(
      f,
      ": chi2/dof = %.4g is far above 1 (one as large has the probability %.2g), so this is a "
      "local minimum, or the model does not describe the data, or their standard deviations "
      "are too small: try other values to begin with, or several starts; sd and intervals "
      "stand on the standard deviations given, and by the scatter of the data were %.3g times "
      "as wide",
      ratio, large, sqrt(ratio));
  else if (1 - large < unlikely)
    add(
      f,
      ": chi2/dof = %.3g is far below 1, so the standard deviations of the data are too large",
      ratio);
  else
    add(f,
        ": chi2/dof = %.3g is what the standard deviations let expect (one as large has the "
        "probability %.2g)",
        ratio, large);
}

/* "p and q", of the parameters with this fate. */
static void list(const stf_descent *d, steif_fit *f, enum stf_fate fate)
{
  char room[STEIF_SPEC_WORD];
  const char *before = "";
  for (int i = 0; i < f->count; i++) {
    if (d->fate[i] != fate) continue;
    add(f, "%s%.40s", before, stf_fit_name(d, i, room));
    before = " and ";
  }
}

static void flats(const stf_descent *d, steif_fit *f)
{
  int less = -1, any = 0;
  for (int i = 0; i < f->count; i++) {
    if (d->fate[i] == STF_NO_SLOPE) less = i;
    if (d->fate[i] == STF_IDLE) any = i;
  }
  add(f, ": no minimum: chi2 has no slope along ");
  list(d, f, less < 0 ? STF_IDLE : STF_NO_SLOPE);
  add(f, " %s%s: start elsewhere, or take several starts",
      stf_fit_place(d, less < 0 ? any : less), less < 0 ? "" : ", and is less elsewhere");
}

static void ways(const stf_descent *d, steif_fit *f)
{
  char room[STEIF_SPEC_WORD];
  const char *before = ": no minimum: ";
  bool zero = false;
  for (int i = 0; i < f->count; i++) {
    const bool to_zero = d->fate[i] == STF_TO_ZERO;
    if (!to_zero && d->fate[i] != STF_TO_INFINITY) continue;
    add(f, "%s%.40s ran from %.4g to %.4g", before, stf_fit_name(d, i, room), d->from[i],
        f->p[i]);
    before = ", ";
    zero |= to_zero;
  }
  add(f, ", where chi2 hardly changes: %s",
      zero ? "log p reaches neither 0 nor another sign, which the linear scale "
             "(options.scale) does; or start "
             "elsewhere, fix it or give bounds"
           : "start elsewhere, fix it or give bounds");
}

/* Why it is none. */
static void no_minimum(const stf_descent *d, steif_fit *f)
{
  if (d->end == STF_AT_A_FLAT)
    flats(d, f);
  else if (d->end == STF_AWAY)
    ways(d, f);
  else if (d->end == STF_AT_A_WALL)
    add(f,
        ": no minimum: chi2 falls on along its derivatives, by %.2g of it, to where runs fail",
        d->share);
  else
    add(
      f,
      ": no minimum: chi2 does not go down along its derivatives, which promise it to fall by "
      "%.2g of it: they are wrong (parameters.dFdp, parameters.start), or chi2 has a "
      "jump or a kink, or the tolerance of the runs is too loose",
      d->share);
  add(f, "; sd and intervals are those of a minimum, which this is not");
}

static void judge(const stf_descent *d, steif_fit *f)
{
  add(f, "chi2 = %.6g with %ld degrees of freedom", f->chi2, f->dof);
  if (f->exhausted < 0)
    add(f, ", the best of %ld runs when the search was stopped%s; go on from here", f->runs,
        f->exhausted == STEIF_TIME_LIMIT ? " by max_seconds" : "");
  else if (f->exhausted && d->end)
    no_minimum(d, f);
  else if (f->exhausted)
    add(f,
        ", and still falling: %d runs of a descent were not enough; go on from here, or raise "
        "options.evaluations",
        d->evaluations);
  else if (f->dof < 1)
    add(f, ": no more measurements than parameters, and no %s",
        f->known ? "way to judge the model" : "intervals");
  else if (f->known)
    weigh(f);
  else
    add(f, "; the standard deviation of the measurements comes out as %.3g",
        sqrt(f->chi2 / (sunrealtype)f->dof));
}

/* The parameter without a slope whose direction k is; -1. */
static int slopeless(const stf_descent *d, const steif_fit *f, int k)
{
  for (int i = 0; i < f->count; i++)
    if (d->fate[i] != STF_FOUND && d->fate[i] < STF_TO_ZERO &&
        fabs(f->direction[k * f->count + i]) > 0.999)
      return i;
  return -1;
}

static void without_slope(const stf_descent *d, steif_fit *f, int i)
{
  char room[STEIF_SPEC_WORD];
  if (d->end == STF_AT_A_FLAT) return;
  add(f, ". chi2 has no slope along %.40s %s, and is %s", stf_fit_name(d, i, room),
      stf_fit_place(d, i),
      d->fate[i] == STF_AT_REST
        ? "more to both sides: no derivatives tell its standard deviation"
        : "not less elsewhere: the data do not determine it there; fix it, or start elsewhere");
}

static void undetermined(const stf_descent *d, steif_fit *f)
{
  char room[STEIF_SPEC_WORD];
  const int P = f->count;
  int fixed = 0;
  for (int i = 0; i < P; i++) fixed += f->bound[i] != 0;
  for (int k = P - fixed - f->undetermined; k < P - fixed; k++) {
    const char *before = " (";
    const int lone = slopeless(d, f, k);
    if (lone >= 0) {
      without_slope(d, f, lone);
      continue;
    }
    add(f, ". The data do not determine the direction");
    for (int i = 0; i < P; i++) {
      const sunrealtype part = f->direction[k * P + i];
      if (fabs(part) <= 1e-3) continue;
      add(f, "%s%.3g of %s", before, part, stf_fit_name(d, i, room));
      before = ", ";
    }
    add(f, ") in %s: its singular value is %.1e of the largest; fix a parameter of it",
        f->log ? "log p" : "p / scale",
        f->singular[0] > 0 ? f->singular[k] / f->singular[0] : 0);
  }
}

static void rest(const stf_descent *d, steif_fit *f)
{
  char room[STEIF_SPEC_WORD];
  int same = 0;
  for (int i = 0; i < f->count; i++)
    if (f->bound[i]) add(f, ". %s is at its bound %.6g", stf_fit_name(d, i, room), f->p[i]);
  for (int i = 0; i < f->starts; i++) same += f->chi2_of[i] <= f->chi2 * (1 + 1e-3) + 1e-300;
  if (f->starts > 1) add(f, ". %d of %d starts came to this chi2", same, f->starts);
  if (f->failed)
    add(f, ". %ld of %ld runs failed and were steps too long, the last: %.200s", f->failed,
        f->runs, f->failure);
}

void stf_fit_say(const stf_descent *d, steif_fit *f)
{
  f->message[0] = 0;
  judge(d, f);
  undetermined(d, f);
  rest(d, f);
}
