/* agreement.c: do the two answers for a jump agree, and what is said of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "jump.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { SHOWN = 6 };

/* " y1 0.3, y2 0.7" of x_j where of_j exceeds floor_j, x for them with the digits given. */
static int say_values(const stf_jump_search *w, const sunrealtype *x, const sunrealtype *of,
                      const sunrealtype *floor, int digits)
{
  char room[STEIF_SPEC_WORD];
  int shown = 0;
  for (size_t j = 0; j < w->point.n && shown < SHOWN; j++) {
    if (!(fabs(of[j]) > floor[j])) continue;
    stf_point_say(w->jump->message, "%s%s %.*g", shown++ ? ", " : " ",
                  stf_point_unknown(&w->point, j, room), digits, x[j]);
  }
  return shown;
}

static void find_spread(stf_jump_search *w)
{
  steif_jump *jump = w->jump;
  for (size_t j = 0; j < w->point.n; j++)
    if (w->carried[j])
      jump->spread = fmax(jump->spread, fabs(jump->y[j] - jump->before[j]) / w->tolerance[j]);
}

/* Does the solution hold derivatives of delta? */
static bool derives(const stf_jump_search *w)
{
  const size_t n = w->point.n;
  for (size_t k = n; k < (size_t)w->jump->count * n; k++)
    if (fabs(w->jump->c[k]) > w->noise[k]) return true;
  return false;
}

/* Is E at y(t+) another one than at y(t-)? */
static bool moves(const stf_jump_search *w)
{
  const size_t n = w->point.n;
  const sunrealtype noise = 1e-6;
  for (size_t i = 0; i < n; i++) {
    sunrealtype most = 0, off = 0;
    for (size_t j = 0; j < n; j++) {
      const sunrealtype a = w->E_before[j * n + i], b = SM_ELEMENT_D(w->E, i, j);
      most = fmax(most, fmax(fabs(a), fabs(b)) * w->point.size[j]);
      off = fmax(off, fabs(a - b) * w->point.size[j]);
    }
    if (off > noise * most) return true;
  }
  return false;
}

static void say_side(const stf_jump_search *w, const char *where, const sunrealtype *y,
                     const sunrealtype *c)
{
  char *text = w->jump->message;
  stf_point_say(text, "with the matrices at %s", where);
  say_values(w, y, w->d, w->tolerance, 12);
  if (!w->jump->count) return;
  stf_point_say(text, " and impulses of");
  say_values(w, c, c, w->noise, 12);
}

static void say_ambiguous(const stf_jump_search *w)
{
  char *text = w->jump->message;
  stf_point_say(text, "the jump is not unique: %s on jumping unknowns; ",
                moves(w) ? "E depends" : "the directions of the impulses depend");
  say_side(w, "y(t-)", w->jump->before, w->jump->before_c);
  stf_point_say(text, "; ");
  say_side(w, "y(t+)", w->jump->y, w->jump->c);
  stf_point_say(text,
                ". Nothing in the equations decides: take unknowns in which E is constant "
                "(charges, momenta), or give the model a rule");
}

static void say_positions(const stf_jump_search *w)
{
  char *text = w->jump->message;
  stf_point_say(text, "position jump: ");
  say_values(w, w->d, w->d, w->tolerance, 3);
  stf_point_say(
    text,
    w->request->stages
      ? "; by stages: positions moved least, velocities kept tangentially, a rule and no law"
      : "; the solution would hold derivatives of delta, whose products with what jumps have "
        "no meaning. Make the positions consistent, or ask for stages");
}

static void say_unique(const stf_jump_search *w)
{
  char *text = w->jump->message;
  stf_point_say(text, "moved");
  if (!say_values(w, w->d, w->d, w->tolerance, 6)) stf_point_say(text, " nothing");
  if (!w->jump->count) return;
  stf_point_say(text, "; impulses");
  if (!say_values(w, w->jump->c, w->jump->c, w->noise, 12)) stf_point_say(text, " none");
}

/* An impact gives back e times what it took. */
static void rebound(stf_jump_search *w)
{
  const size_t n = w->point.n;
  const sunrealtype e = w->request->restitution;
  steif_jump *jump = w->jump;
  if (!(e > 0)) return;
  for (size_t j = 0; j < n; j++)
    if (w->carried[j]) jump->y[j] += e * (jump->y[j] - w->from[j]);
  for (size_t k = 0; k < (size_t)jump->count * n; k++) jump->c[k] *= 1 + e;
  memset(jump->yp, 0, n * sizeof *jump->yp);
}

int stf_jump_judge(stf_jump_search *w)
{
  steif_jump *jump = w->jump;
  find_spread(w);
  const bool positions = !w->point.system.linear && derives(w);
  jump->unique = !positions && jump->spread <= STF_TOLERANCES;
  if (jump->unique) rebound(w);
  for (size_t j = 0; j < w->point.n; j++) w->d[j] = jump->y[j] - w->from[j];
  if (jump->unique)
    say_unique(w);
  else if (positions)
    say_positions(w);
  else
    say_ambiguous(w);
  return STEIF_OK;
}
