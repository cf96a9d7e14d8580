/* parts.c: the verdict of rows, and what parts by themselves say. An error is the sum of those of the parts,
 * each of which has its own order as h tends to 0, and parts of different orders depend on different
 * derivatives of g: for all g together they do not cancel.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parts.h"
#include <math.h>
#include <stdio.h>

/* Orders so far apart are different ones. */
#define APART 0.5

static void leave_open(parts *all, const part *p, sunrealtype least)
{
  if (least >= all->least) return;
  all->open = *p;
  all->least = least;
}

void stf_parts_note(parts *all, const part *p)
{
  const bool open = p->converges < 0 || (p->converges == 0 && p->doubtful);
  all->count++;
  if (open) {
    all->known = false;
    leave_open(all, p, -INFINITY);
  } else if (p->converges == 0) {
    if (all->bad.converges != 0 || p->q >= 0) all->bad = *p;
  } else if (isnan(p->order) || p->doubtful)
    leave_open(all, p, p->least);
  else if (p->order < all->lowest.order)
    all->lowest = *p;
}

/* Is the lowest order known? Below it by less than APART is as good. */
static bool ordered(const parts *all)
{
  return all->least == INFINITY || all->least > all->lowest.order - APART;
}

/* The part in words. */
static void name(const parts *all, const part *p, char *text, size_t room)
{
  if (p->q == STF_SMOOTH)
    snprintf(text, room, "the smooth part");
  else if (p->q == STF_JUMP)
    snprintf(text, room, "the jump at t = 0");
  else
    snprintf(text, room, "impulses of order %d (%.2g of the largest)", p->q,
             p->size / all->most);
}

/* Rows that converge, or say nothing, beside a part that does not. What rounding of x(0+) becomes is in
 * the smooth part, too. */
static void oppose(const parts *all, steif_weak_result *r)
{
  char what[64];
  const bool sure = all->bad.q >= 0;
  name(all, &all->bad, what, sizeof what);
  r->converges = sure ? 0 : -1, r->order = NAN;
  snprintf(r->verdict, sizeof r->verdict,
           sure
             ? "does not converge weakly: %s, by themselves do not; these rows do not show it"
             : "undecided: by itself %s does not converge; these rows do not show it",
           what);
}

/* A part that may be there or be rounding, and would not converge: rows in which it is not seen yet do not tell. */
static void withhold(const parts *all, steif_weak_result *r)
{
  char what[64];
  const sunrealtype seen = r->order;
  name(all, &all->open, what, sizeof what);
  r->converges = -1, r->order = NAN;
  if (isfinite(seen))
    snprintf(r->verdict, sizeof r->verdict,
             "undecided: order %.2f with these steps; that of %s is not known, and may be 0",
             seen, what);
  else
    snprintf(
      r->verdict, sizeof r->verdict,
      "undecided: below rounding with these steps; the order of %s is not known, and may be 0",
      what);
}

/* All parts converge that are known, and so do rows. */
static void lower(const parts *all, bool whole, steif_weak_result *r)
{
  char what[64];
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  const sunrealtype seen = r->order, order = all->lowest.order;
  const bool other = order < seen - APART || (whole && order > seen + APART && isfinite(order));
  if (whole && !all->known) {
    withhold(all, r);
    return;
  }
  if (!isfinite(seen)) return;
  if (whole && !ordered(all)) {
    r->order = NAN;
    name(all, &all->open, what, sizeof what);
    snprintf(text, room,
             "converges weakly, order %.2f with these steps; that of %s is not known", seen,
             what);
  } else if (other) {
    r->order = order;
    name(all, &all->lowest, what, sizeof what);
    snprintf(text, room, "converges weakly, order %.2f, that of %s; %.2f with these steps",
             order, what, seen);
  }
}

/* All parts converge, while rows say nothing. */
static void decide(const parts *all, steif_weak_result *r)
{
  char what[64];
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  const sunrealtype order = all->lowest.order;
  name(all, &all->lowest, what, sizeof what);
  r->converges = 1;
  r->order = ordered(all) && isfinite(order) ? order : NAN;
  if (isfinite(r->order))
    snprintf(text, room,
             "converges weakly, order %.2f, that of %s, by itself; these rows alone decide "
             "nothing",
             order, what);
  else if (isfinite(order))
    snprintf(text, room,
             "converges weakly: every part by itself does, %s with order %.2f, not all orders "
             "are known",
             what, order);
  else
    snprintf(text, room, "converges weakly: every part of the solution by itself %s",
             ordered(all) ? "is exact" : "does, with orders that are not known");
}

void stf_parts_conclude(const parts *all, bool whole, steif_weak_result *r)
{
  const bool bad = all->bad.converges == 0;
  if (bad) {
    if (r->converges == 1 || (whole && r->converges < 0)) oppose(all, r);
  } else if (r->converges == 1)
    lower(all, whole, r);
  else if (r->converges < 0 && whole && all->known)
    decide(all, r);
  else if (r->converges == 0 && all->known) {
    r->converges = -1, r->order = NAN;
    snprintf(r->verdict, sizeof r->verdict,
             "undecided: every part of the solution by itself converges, these rows do not "
             "show it; ask for more");
  }
}
