/* verdict.c: what the rows of a weak measure entitle to say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak_inside.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Orders within FLAT of zero mean a limit other than the exact value; orders AGREED apart are one;
 * the distance of an order from the whole number it tends to halves from row to row, a term of lower
 * order that takes over doubles it: beyond NEAR it must not grow. */
#define FLAT 0.25
#define AGREED 0.25
#define NEAR 0.03
/* Zero to rounding: below TIMES the level, which is known to be below TINY of the value. */
#define TIMES 4
#define TINY 1e-9
/* Changes of an error that comes to a limit: so much of the one before, or of the error itself. */
#define HALVED 0.65
#define STILL 0.02
enum { LEAST = STF_LEAST_ROWS };

static bool zero(const stf_judged *j, size_t i)
{
  const steif_weak_row *r = j->row + i;
  return fabs(r->error) <= TIMES * r->rounding &&
         r->rounding <= TINY * fmax(j->size, fabs(r->value));
}

static bool nothing(const stf_judged *j)
{
  for (size_t i = 0; i < j->rows; i++)
    if (!zero(j, i)) return false;
  return true;
}

static const char exact[] = "exact to rounding at every h measured";

bool stf_weak_is_exact(const steif_weak_result *r) { return !strcmp(r->verdict, exact); }

/* Rows from `from` on that are zero to rounding, all to the last. */
static bool zeros(const stf_judged *j, size_t from)
{
  if (j->rows - from < LEAST) return false;
  for (size_t i = from; i < j->rows; i++)
    if (!zero(j, i)) return false;
  return true;
}

/* The limit of the errors (Aitken), or of first-order ones. */
static sunrealtype limit(const steif_weak_row *last)
{
  const sunrealtype c = last->error, b = last[-1].error, a = last[-2].error;
  const bool regular = fabs(c - b) < 0.9 * fabs(b - a);
  return regular ? c - (c - b) * (c - b) / ((c - b) - (b - a)) : 2 * c - b;
}

/* Do the last errors come to a limit other than 0? Their distances to it should be halved at least, from row
 * to row, and be small beside it. */
static bool steady(const steif_weak_row *last)
{
  const sunrealtype change = fabs(last->error - last[-1].error),
                    before = fabs(last[-1].error - last[-2].error);
  if (change <= STILL * fabs(last->error)) return true;
  return change <= HALVED * before && fabs(limit(last)) >= fabs(last->error) / 2;
}

static int undecided(steif_weak_result *r) { return r->converges = -1; }

/* Where terms of different order cancel at some step, orders seen across it are no orders. */
static bool one_sign(const steif_weak_row *last)
{
  return (last->error < 0) == (last[-1].error < 0) &&
         (last[-1].error < 0) == (last[-2].error < 0);
}

/* By the orders of the last three usable rows. */
static int by_orders(const steif_weak_row *last, steif_weak_result *r)
{
  const sunrealtype order = last->order, before = last[-1].order, whole = round(order);
  const sunrealtype away = fabs(order - whole), was = fabs(before - whole);
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  undecided(r);
  if (!one_sign(last))
    return snprintf(
      text, room,
      "undecided: the errors %.2g, %.2g, %.2g change their sign and show no order; "
      "ask for more rows",
      last[-2].error, last[-1].error, last->error);
  if (!(fabs(order - before) <= AGREED))
    return snprintf(text, room,
                    "undecided: the observed orders %.2f and %.2f differ; ask for more rows",
                    before, order);
  if (away > FLAT || (away > NEAR && away > was))
    return snprintf(text, room,
                    "undecided: the observed orders %.2f and %.2f are on the way to another "
                    "one; ask for more rows",
                    before, order);
  if (whole > 0) {
    r->converges = 1, r->order = order;
    return snprintf(text, room, "converges weakly, order %.2f", order);
  }
  if (whole == 0 && !steady(last))
    return snprintf(
      text, room, "undecided: the errors fall slowly, orders %.2f and %.2f; ask for more rows",
      before, order);
  r->converges = 0;
  return whole == 0
           ? snprintf(text, room, "does not converge weakly: error tends to %.3g", limit(last))
           : snprintf(text, room, "does not converge weakly: error grows like h^%.1f", order);
}

/* Fewer than three usable rows. */
static int too_few(const stf_judged *j, size_t from, size_t usable, steif_weak_result *r)
{
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  undecided(r);
  if (j->rows == 1 && from == 0 && !zero(j, 0))
    return snprintf(text, room, "none: one row shows no order; three decide (.rows)");
  if (from == j->rows)
    return snprintf(
      text, room,
      "undecided: steps of %.3g do not resolve %s; take them below %.2g (.h), or a "
      "shorter interval (.g->t1)",
      j->row[j->rows - 1].h, j->fastest, j->longest);
  if (zeros(j, from + usable)) {
    r->converges = 1;
    return usable || !nothing(j)
             ? snprintf(text, room, "converges weakly, below rounding from h = %.3g on",
                        j->row[from + usable].h)
             : snprintf(text, room, "%s", exact);
  }
  if (j->rows - from < LEAST)
    return snprintf(text, room, "undecided: three rows decide; ask for more (.rows)");
  return snprintf(
    text, room,
    "undecided: rounding from h = %.3g on; larger steps (.h = %.3g, .rows = 5)%s decide",
    j->row[from + usable].h, fmin(4 * j->row[from].h, j->longest),
    j->decidable ? " or .exact" : "");
}

void stf_say_inside(const stf_judged *j, const char *what, char *text, size_t room)
{
  const int used = snprintf(text, room,
                            "undecided: the break of f at %.6g lies inside a step, %s "
                            "depend on where and have no order",
                            j->inside, what);
  char *more = text + used;
  if (isfinite(j->fitting))
    snprintf(more, room - (size_t)used, "; .h = %.17g puts it on the mesh", j->fitting);
  else
    snprintf(more, room - (size_t)used, "; %s (.restart)",
             j->able ? "let steps end there"
                     : "one-step methods and .start = \"cq\" can restart there");
}

void stf_weak_judge(const stf_judged *j, steif_weak_result *r)
{
  size_t from = 0, usable = 0;
  while (from < j->rows && j->row[from].h > j->longest) from++;
  while (from + usable < j->rows && j->row[from + usable].usable) usable++;
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  if (isfinite(j->inside)) {
    undecided(r);
    stf_say_inside(j, "errors", text, room);
    return;
  }
  if (!isfinite(j->accuracy) && from < j->rows) {
    undecided(r);
    snprintf(text, room,
             "undecided: the exact value is not known, f changes too fast for its integrals; "
             "take a shorter interval (.g->t1)");
    return;
  }
  if (usable < LEAST)
    too_few(j, from, usable, r);
  else
    by_orders(j->row + from + usable - 1, r);
  if (j->blind < 0 || r->converges != 1) return;
  undecided(r);
  snprintf(
    text, room,
    "undecided: the test function does not see impulses of order %d, its derivative there "
    "is 0; take another one, such as (1 - t)^%d",
    j->blind, r->index + 3);
}
