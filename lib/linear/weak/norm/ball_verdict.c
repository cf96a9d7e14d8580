/* ball_verdict.c: what norms in H^-m entitle to say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "norm.h"
#include <math.h>
#include <stdio.h>

/* Orders are multiples of 1/2 in the limit: AGREED apart they are one, beyond NEAR their distance from
 * it must not grow. */
#define AGREED 0.25
#define NEAR 0.03
enum { LEAST = 3 }; /* rows */

/* By rows h, h/2, ... of one m: order and converges of its space. */
void stf_ball_judge(const steif_ball_row *row, size_t rows, size_t stride, sunrealtype longest,
                    steif_ball_space *space)
{
  size_t from = 0, usable = 0;
  space->converges = -1, space->order = NAN, space->norm = NAN;
  while (from < rows && row[from * stride].h > longest) from++;
  while (from + usable < rows && row[(from + usable) * stride].usable) usable++;
  if (usable == 0) return;
  const steif_ball_row *last = row + (from + usable - 1) * stride;
  space->norm = last->norm;
  if (usable < LEAST) return;
  const sunrealtype order = last->order, before = (last - stride)->order,
                    near = round(2 * order) / 2, away = fabs(order - near);
  space->order = order;
  if (fabs(order - before) > AGREED || (away > NEAR && away > fabs(before - near))) return;
  space->converges = near > 0;
}

/* Spaces grow with m: what does not converge in H^-m does so in none before it, and what converges in one
 * does so in all after it, else rows do not show the limit yet. Two in a row show it, rounding may hide
 * the others. The first of them; count: none. */
static int first_good(const steif_weak_ball *r)
{
  int first = r->count;
  for (int i = r->count - 1; i >= 0 && r->space[i].converges != 0; i--) {
    const bool next = i + 1 == r->count || r->space[i + 1].converges == 1;
    if (r->space[i].converges == 1 && next) first = i;
  }
  return first;
}

void stf_ball_say(steif_weak_ball *r, size_t rows, bool decidable)
{
  char *text = r->verdict;
  const size_t room = sizeof r->verdict;
  steif_ball_space *last = r->space + r->count - 1;
  const steif_ball_space *first = r->space + first_good(r), *asked = NULL;
  for (int i = 0; i < r->count && last->converges == 0; i++) r->space[i].converges = 0;
  for (int i = 0; i < r->count; i++)
    if (r->space[i].m == r->m) asked = r->space + i;
  r->converges = first <= last ? 1 : last->converges;
  if (asked && asked >= first && asked->converges == 1)
    snprintf(text, room, "converges weakly in H^-%d, order %.2f: for every smooth g", r->m,
             asked->order);
  else if (first <= last)
    snprintf(text, room,
             "converges weakly for every smooth g: in H^-%d, order %.2f; in H^-%d undecided",
             first->m, first->order, r->m);
  else if (last->converges == 0)
    snprintf(text, room, "does not converge in any H^-m up to %d: norm %.3g, order %.2f there",
             last->m, last->norm, last->order);
  else if (rows == 1)
    snprintf(text, room, "none: one row shows no order; three decide (.rows)");
  else
    snprintf(text, room,
             "undecided: fewer than three norms above rounding, or their orders differ; take "
             "larger steps or more rows%s",
             decidable ? ", or set .exact" : "");
}
