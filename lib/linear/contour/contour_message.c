/* contour_message.c: the sentences on what circles and ranks have found of a pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "contour.h"
#include "contour_thresholds.h"
#include <stdio.h>

/* "the structural degree", or by what it exceeds the count exactly. */
static const char *degree(const steif_structure *s, char *text, size_t room)
{
  if (s->exact < 0 || s->exact == s->degree)
    snprintf(text, room, "equals the structural degree");
  else
    snprintf(
      text, room,
      "equals the degree %lld of the pattern less what cancels exactly (ranks modulo two "
      "primes, false with probability %.0e)",
      (long long)s->degree, s->doubt);
  return text;
}

static void say_certified(const stf_contour_circle *c, steif_structure *s, char *text,
                          size_t room)
{
  char by[160], snapped[128] = "";
  if (c->rounded && c->field.snap)
    snprintf(snapped, sizeof snapped,
             "; the diagonals of %lld row%s, the first is %lld, are taken for exact sums",
             (long long)c->rounded, c->rounded == 1 ? "" : "s", (long long)c->rounded_row + 1);
  snprintf(
    text, room, "index %d, %lld finite eigenvalues, all in |s| <= %.3g: the count %.6f %s%s",
    s->index, (long long)s->finite, c->radius, s->count, degree(s, by, sizeof by), snapped);
}

/* Eigenvalues outside of the circle, as many as ranks or at least the pattern tell. */
static void say_outside(const stf_contour_circle *c, const steif_structure *s, char *text,
                        size_t room)
{
  const long long finite = s->finite, exact = s->exact, allowed = s->degree;
  if (exact < 0)
    snprintf(
      text, room,
      "the pattern allows %lld; up to %lld faster modes relaxed, unless values cancel what "
      "the pattern allows",
      allowed, allowed - finite);
  else if (finite > exact)
    snprintf(
      text, room,
      "ranks modulo two primes allow %lld of the %lld of the pattern: rounding counts more",
      exact, allowed);
  else if (c->rounded)
    snprintf(
      text, room,
      "ranks find %lld, and %lld once the diagonals of %lld row%s, the first is %lld, are "
      "the negative sums of their rows without rounding in the last place, as 0.1 + 0.2 "
      "has: give numbers with exact sums, or take these for exact (snap)",
      exact, finite, (long long)c->rounded, c->rounded == 1 ? "" : "s",
      (long long)c->rounded_row + 1);
  else
    snprintf(
      text, room,
      "ranks modulo two primes find %lld (the pattern: %lld): faster ones, %lld, relaxed",
      exact, allowed, exact - finite);
}

static void say_open(const stf_contour_circle *c, steif_structure *s, char *text, size_t room)
{
  char outside[320];
  const char *index = s->index < 0 ? "index undecided, at least" : "index";
  const long long finite = s->finite;
  if (finite < 0)
    snprintf(text, room,
             "%s %d, not certified: the count %.4f of finite eigenvalues in |s| <= %.3g is no "
             "whole number up to %lld; %s",
             index, s->index_least, s->count, s->radius, (long long)s->degree,
             c->given ? "take another radius" : "use a dense algorithm");
  else if (c->complete && c->ranked >= 0 && c->moments >= 0)
    snprintf(text, room,
             "%s %d: the moments end like those of index %d, but ranks modulo two primes give "
             "index %d; rounding makes infinite eigenvalues finite: use a dense algorithm",
             index, s->index_least, c->moments, c->ranked);
  else if (c->complete && c->ranked >= 0)
    snprintf(
      text, room,
      "%s %d: the moments part by %.1e only, though ranks modulo two primes give index %d "
      "for the entries exactly as given: use a dense algorithm",
      index, s->index_least, s->gap, c->ranked);
  else if (c->complete && s->gap >= STF_GAP)
    snprintf(text, room,
             "%s %d: the moments end like those of another index than the count %.6f, the "
             "structural degree, leaves room for; rounding makes infinite eigenvalues finite: "
             "use a dense algorithm",
             index, s->index_least, s->count);
  else if (c->complete)
    snprintf(
      text, room,
      "%s %d: the moments part by %.1e only, the count %.6f equals the structural degree",
      index, s->index_least, s->gap, s->count);
  else {
    say_outside(c, s, outside, sizeof outside);
    snprintf(text, room,
             "%s %d, not certified: %lld finite eigenvalues in |s| <= R = %.3g; valid for time "
             "scales >= 1/R = %.3g; %s",
             index, s->index_least, finite, s->radius, 1 / s->radius, outside);
  }
}

void stf_contour_say(const stf_contour_circle *circle, steif_structure *s)
{
  if (s->certified)
    say_certified(circle, s, s->message, sizeof s->message);
  else
    say_open(circle, s, s->message, sizeof s->message);
}

void stf_contour_say_start(const steif_structure *s, sunrealtype gap, steif_impulse *out)
{
  const sunrealtype R = out->radius;
  const size_t room = sizeof out->message;
  const long long relaxed = (s->exact >= 0 ? s->exact : s->degree) - s->finite;
  if (out->certified)
    snprintf(
      out->message, room,
      "%d impulse coefficients with R = %.3g: circles of R and 2R differ by %.1e, and the "
      "count of finite eigenvalues equals the degree",
      out->count, R, out->estimate);
  else if (s->certified)
    snprintf(
      out->message, room,
      "not certified: circles of R = %.3g and 2R differ by %.1e, above %.0e; fast and slow "
      "parts lie too far apart for this radius: scale time, or use a dense algorithm",
      R, gap, STF_CIRCLES_CERTIFY);
  else if (s->finite >= 0 && relaxed > 0)
    snprintf(out->message, room,
             "not certified: x(0+), c_i valid for time scales >= 1/R = %.3g; up to %lld faster "
             "modes relaxed (circles of R = %.3g and 2R differ by %.1e)",
             1 / R, relaxed, R, out->estimate);
  else
    snprintf(out->message, room,
             "not certified, as the structure is not (index %d%s): circles of R = %.3g and 2R "
             "differ by %.1e",
             out->index, s->index < 0 ? " assumed" : "", R, out->estimate);
}
