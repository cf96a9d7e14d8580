/* own_reference.c: end values for a problem of which nothing is known: radau:s=7, a hundred times tighter than
 * the rows ask, believed as far as radau:s=5 agrees with it, in steps of a hundredth of the interval at most, which see
 * what long steps may pass over.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "comparison.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>

static const double finest = 1e-13, tighter = 1e-2, seconds_most = 20, digits_least = 2,
                    parts = 100;

static const char *const method[] = {"radau:s=7", "radau:s=5"};

static double least_of(struct call *call)
{
  double value[REALS_MOST], least = 1;
  const size_t count = reals_of(call, "--rtols", value);
  for (size_t i = 0; i < count; i++) least = fmin(least, value[i]);
  return least;
}

static steif_options tight(struct call *call, double rtol)
{
  steif_options o = options_of(call);
  const double least = least_of(call);
  o.initial = STEIF_AS_GIVEN;
  o.start = NULL;
  o.h = o.h0 = 0;
  o.rtol = rtol;
  o.atol *= rtol / least;
  o.max_seconds = o.max_seconds > 0 ? fmin(o.max_seconds, seconds_most) : seconds_most;
  return o;
}

/* y(t1); the sentence of a run that does not come there. */
static int end_values(struct call *call, const comparison *c, const char *by, double rtol,
                      double *y, char *why, size_t room)
{
  steif_options o = tight(call, rtol);
  const double t1 = o.t1 > 0 ? o.t1 : c->problem.t1, part = (t1 - c->problem.t0) / parts;
  steif_solver *s = NULL;
  if (by == method[1] && !(o.h_max > 0 && o.h_max < part)) o.h_max = part;
  progress(call, "reference: %s, rtol %.3g", by, rtol);
  const outcome out = integrate_from(call->ctx, &c->problem, by, &o, &s, NULL, NULL);
  const double *end = s && !out.code ? N_VGetArrayPointer(steif_solution(s)) : NULL;
  if (end)
    memcpy(y, end, (size_t)c->problem.n * sizeof *y);
  else if (out.code == STEIF_EVENT)
    snprintf(why, room, "the run ends by an event, before t = %g", t1);
  else
    snprintf(why, room, "%s, rtol %.3g: %s", by, rtol, out.message);
  steif_solver_free(&s);
  return end ? EXIT_OK : EXIT_FAILED;
}

static bool nothing_known(struct call *call, const steif_problem *p)
{
  const double given = real_of(call, "--t1"), t1 = given > 0 ? given : p->t1;
  const steif_reference *r = p->reference;
  return !p->exact && p->n > 0 && !(r && fabs(r->t - t1) <= 1e-12 * fabs(t1));
}

/* Digits to which the two runs agree. */
static void agreed(struct call *call, const comparison *c, double ratio, double *scd,
                   double *mescd)
{
  const double t = c->own.t;
  N_Vector v = N_VMake_Serial(c->problem.n, c->check, steif_sundials(call->ctx));
  *scd = *mescd = 0;
  if (v && steif_problem_digits(call->ctx, &c->problem, t, v, ratio, scd, mescd))
    *scd = *mescd = 0;
  if (v) N_VDestroy(v);
  steif_forget(call->ctx);
}

static bool make(struct call *call, comparison *c, double rtol, char *text, size_t room)
{
  const steif_options o = tight(call, rtol);
  const size_t n = (size_t)c->problem.n;
  double scd, mescd, *y = c->values = calloc(2 * n, sizeof *y);
  snprintf(text, room, "no memory for it");
  if (!y || end_values(call, c, method[0], rtol, y, text, room) ||
      end_values(call, c, method[1], rtol, y + n, text, room))
    return false;
  c->check = y + n;
  c->own = (steif_reference){.t = o.t1 > 0 ? o.t1 : c->problem.t1, .value = y};
  c->problem.reference = &c->own;
  agreed(call, c, tolerance_ratio(&c->problem, &o), &scd, &mescd);
  c->own.digits = (int)fmax(mescd, 0);
  snprintf(text, room, "%s, rtol %.3g; %s agrees to %.1f digits", method[0], rtol, method[1],
           fmax(mescd, 0));
  return mescd >= digits_least;
}

void own_reference(struct call *call, comparison *c)
{
  char why[1400], line[1500];
  c->values = c->check = NULL;
  if (!nothing_known(call, &c->problem)) return;
  const bool there = make(call, c, fmax(tighter * least_of(call), finest), why, sizeof why);
  snprintf(line, sizeof line, "%s: %s", there ? "made here" : "none", why);
  steif_report_text(c->report, "reference", line);
  if (there) return;
  c->check = NULL;
  c->problem.reference = c->given.reference;
}

void own_digits(struct call *call, const comparison *c, const steif_options *o, outcome *out)
{
  double scd, mescd;
  if (!c->check || !out->known) return;
  agreed(call, c, tolerance_ratio(&c->problem, o), &scd, &mescd);
  out->scd = fmin(out->scd, scd);
  out->mescd = fmin(out->mescd, mescd);
}
