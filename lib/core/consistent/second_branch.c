/* second_branch.c: of starts of index 1, is the one that Newton's iteration has found the nearest?
 *
 * Between two solutions, as of 0 = z^2 - x near z = 0, the equations have a fold, and the first correction goes
 * far beyond the solution that the iteration ends at: for distances d_1 < d_2 on both sides of a parabola
 * it is d_1 d_2/(d_2 - d_1). Then the iteration is begun once more from the mirror image of that solution.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"
#include <math.h>
#include <string.h>

/* First corrections of so many times the way tell of a fold; distances within `alike` are no choice. */
static const sunrealtype beyond = 1.3, alike = 1.25;

/* Largest distance of algebraic components, in tolerances, and where. */
static sunrealtype apart(const stf_repair *r, const sunrealtype *a, const sunrealtype *b,
                         size_t *at)
{
  sunrealtype most = 0;
  for (size_t j = 0; j < r->point.n; j++) {
    const sunrealtype part = r->algebraic[j] ? fabs(a[j] - b[j]) / r->weight[j] : 0;
    if (part > most) most = part, *at = j;
  }
  return most;
}

/* Newton's iteration from 2 y0 - y. *found: it has ended elsewhere. What cannot be evaluated there is no start. */
static int mirrored(stf_repair *r, const sunrealtype *y, bool *found)
{
  const size_t n = r->point.n;
  sunrealtype first;
  size_t at = 0;
  *found = false;
  for (size_t j = 0; j < n; j++)
    if (r->algebraic[j]) r->y[j] = 2 * r->point.y0[j] - y[j];
  int code = stf_view_take(&r->point, r->point.t, r->y, r->yp, &r->view);
  if (!code) code = stf_algebraic_newton(r, &first);
  if (code == STEIF_NO_MEMORY || code == STEIF_CALLBACK) return code;
  if (code < 0) steif_forget(r->ctx);
  *found = !code && apart(r, r->y, y, &at) > 1;
  return STEIF_OK;
}

static int choose(stf_repair *r, const sunrealtype *y, sunrealtype way, bool *nearer)
{
  char room[STEIF_SPEC_WORD];
  size_t at = 0, where = 0;
  apart(r, r->y, y, &where);
  const sunrealtype other = apart(r, r->y, r->point.y0, &at);
  STEIF_CHECK(
    other > alike * way || alike * other < way, r->ctx, STEIF_BAD_INPUT,
    "the start of '%s' is not consistent, and two that are lie about as near: %s = %.10g "
    "may become %.10g or %.10g; give the one that is meant",
    r->given->name, stf_point_unknown(&r->point, where, room), r->point.y0[where], y[where],
    r->y[where]);
  *nearer = other < way;
  return STEIF_OK;
}

int stf_nearest_branch(stf_repair *r, sunrealtype first)
{
  const size_t n = r->point.n;
  size_t at = 0;
  const sunrealtype way = apart(r, r->y, r->point.y0, &at);
  if (!(first > beyond * way)) return STEIF_OK;
  sunrealtype *kept = stf_allocate(r->ctx, 2 * n, sizeof *kept);
  if (!kept) return STEIF_NO_MEMORY;
  memcpy(kept, r->y, n * sizeof *kept);
  memcpy(kept + n, r->yp, n * sizeof *kept);
  bool found, nearer = false;
  int code = mirrored(r, kept, &found);
  if (!code && found) code = choose(r, kept, way, &nearer);
  if (!nearer) {
    memcpy(r->y, kept, n * sizeof *kept);
    memcpy(r->yp, kept + n, n * sizeof *kept);
  }
  stf_release(r->ctx, kept);
  return code;
}
