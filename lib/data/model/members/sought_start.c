/* sought_start.c: the search for start values that fulfil the equations. Conditions are as they are at the guess, then
 * as they are at what is found, until they hold there. From a singular guess, as z ~ 0 of 0 = z^2 - x, which no
 * step leads away from, others near it are tried. SPDX-License-Identifier: BSD-3-Clause */
#include "exact_start.h"
#include "model.h"
#include "reactions.h"
#include <math.h>
#include <steif/model.h>
#include <stdio.h>
#include <string.h>

/* -- conditions -------------------------------------------------------------------------- */

static void conditions_at(stf_model *m, sunrealtype *y)
{
  sunrealtype *kept = m->y0;
  m->y0 = y;
  stf_reactions_begin(m->t0, m);
  m->y0 = kept;
}

static bool same(const stf_model *m, const sunrealtype *a, const sunrealtype *b)
{
  for (int32_t i = 0; i < m->n; i++)
    if (fabs(a[i] - b[i]) > 1e-9 * (fabs(a[i]) + 1)) return false;
  return true;
}

static int never_hold(stf_model *m, const sunrealtype *from, const sunrealtype *to)
{
  int32_t at = 0;
  for (int32_t i = 1; i < m->n; i++)
    if (fabs(to[i] - from[i]) > fabs(to[at] - from[at])) at = i;
  return STEIF_FAIL(
    m->ctx, STEIF_BAD_INPUT,
    "no start was found at which the conditions in the equations hold: with those at %s = "
    "%.6g the equations give %.6g, where other conditions hold, with which that is no "
    "solution: give a guess of %s nearer to a solution, if there is one.",
    m->unknown[at], from[at], to[at], m->unknown[at]);
}

/* work: 2 n, then the memory. *turns: equations are fulfilled, but conditions do not hold there. */
static int look(stf_model *m, const steif_problem *p, const steif_request *request,
                const sunrealtype *from, sunrealtype *work, steif_start *start, bool *turns)
{
  enum { TURNS = 8 };
  const size_t n = (size_t)m->n, bytes = (size_t)m->memories * sizeof *m->memory;
  sunrealtype *y = work, *last = work + n, *memory = work + 2 * n;
  memcpy(y, from, n * sizeof *y);
  memcpy(last, from, n * sizeof *y);
  conditions_at(m, y);
  for (int k = 0; k < TURNS; k++) {
    const steif_point at = {.y = y, .t = p->t0, .yp = p->yp0};
    const bool begun = k == 0 && from == m->y0;
    const int code =
      stf_consistent_along(m->ctx, p, begun ? NULL : &at, request, steif_model_taylor, start);
    if (code == STEIF_NO_MEMORY || (code && k == 0)) return code;
    if (code) break;
    if (k > 0 && same(m, start->y, y)) return STEIF_OK;
    memcpy(memory, m->memory, bytes);
    memcpy(last, y, n * sizeof *y);
    memcpy(y, start->y, n * sizeof *y);
    conditions_at(m, y);
    if (!memcmp(memory, m->memory, bytes)) return STEIF_OK;
    steif_start_clear(start);
  }
  *turns = true;
  return never_hold(m, last, y);
}

static int near(stf_model *m, const steif_problem *p, const steif_request *request,
                const sunrealtype *from, steif_start *start, bool *turns)
{
  const size_t room = 2 * (size_t)m->n + (size_t)m->memories;
  sunrealtype *work = stf_allocate(m->ctx, room, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  const int code = look(m, p, request, from, work, start, turns);
  stf_release(m->ctx, work);
  return code;
}

int stf_start_near(stf_model *m, const steif_problem *p, const steif_request *request,
                   const sunrealtype *from, steif_start *start)
{
  bool turns = false;
  return near(m, p, request, from, start, &turns);
}

/* -- other guesses ----------------------------------------------------------------------- */

/* Without a value after '=' and without a derivative. */
static bool open(const stf_model *m, int32_t i)
{
  const sunindextype *column = m->E.column;
  return m->start[i] != '=' && (!column || column[i] == column[i + 1]);
}

static sunrealtype distance(const stf_model *m, const sunrealtype *y)
{
  sunrealtype most = 0;
  for (int32_t i = 0; i < m->n; i++) most = fmax(most, fabs(y[i] - m->y0[i]));
  return most;
}

/* The nearest start from guesses on both sides; code as it is where there is none. */
static int from_others(stf_model *m, const steif_problem *p, const steif_request *request,
                       sunrealtype *from, int code, steif_start *best)
{
  static const sunrealtype apart[] = {0.1, -0.1, 1, -1, 0.01, -0.01};
  bool found = false, any = false;
  for (int32_t i = 0; i < m->n; i++) any = any || open(m, i);
  for (size_t k = 0; any && k < sizeof apart / sizeof *apart; k++) {
    steif_start trial = {0};
    for (int32_t i = 0; i < m->n; i++) {
      const sunrealtype part = 1 + 0.3 * sin(7.0 * i), size = fmax(fabs(m->y0[i]), 1);
      from[i] = m->y0[i] + (open(m, i) ? apart[k] * part * size : 0);
    }
    const int other = stf_start_near(m, p, request, from, &trial);
    if (other == STEIF_NO_MEMORY) return other;
    if (other) steif_forget(m->ctx);
    if (!other && (!found || distance(m, trial.y) < distance(m, best->y))) {
      steif_start_clear(best);
      *best = trial, found = true;
    } else {
      steif_start_clear(&trial);
    }
  }
  return found ? STEIF_OK : code;
}

/* The repair of a run takes all values for guesses. Would it move one after '='? *at, -1: none. */
static int moved_by_repair(stf_model *m, const steif_problem *p, int32_t *at, sunrealtype *way)
{
  const steif_request all = {0};
  steif_start start = {0};
  *at = -1, *way = 0;
  int code = stf_start_near(m, p, &all, m->y0, &start);
  for (int32_t i = 0; i < m->n && !code; i++) {
    const sunrealtype off = start.y[i] - m->y0[i];
    const bool far = m->start[i] == '=' && fabs(off) > 1e-6 * fabs(m->y0[i]) + 1e-9;
    if (far && fabs(off) > fabs(*way)) *at = i, *way = off;
  }
  steif_start_clear(&start);
  if (code && code != STEIF_NO_MEMORY) steif_forget(m->ctx), code = STEIF_OK;
  return code;
}

static bool any_fixed(const stf_model *m)
{
  for (int32_t i = 0; i < m->n; i++)
    if (m->start[i] == '=') return true;
  return false;
}

/* What a run cannot start from, whatever it repairs, is an error; `code` else, as a run may start all the same. */
static int tell(stf_model *m, const steif_problem *p, int code, bool turns, char *why)
{
  int32_t at = -1, which = 0;
  sunrealtype way = 0;
  snprintf(m->moved, sizeof m->moved, "not moved: %s", why);
  char *name = strstr(why, " [STEIF_"); /* of the code, which is added again */
  if (name) *name = 0;
  STEIF_CHECK(!turns, m->ctx, STEIF_BAD_INPUT, "%s: %s", p->name, why);
  STEIF_CHECK(code != STEIF_BAD_INPUT || !any_fixed(m), m->ctx, STEIF_BAD_INPUT,
              "%s: %s Values after '=' are fixed: '~' makes one a guess, which may move",
              p->name, why);
  while (which < m->n && !open(m, which)) which++;
  if (which < m->n && (code == STEIF_NO_CONVERGENCE || code == STEIF_SINGULAR))
    STEIF_TRY(moved_by_repair(m, p, &at, &way));
  STEIF_CHECK(
    at < 0, m->ctx, STEIF_BAD_INPUT,
    "%s: no start was found with %s = %.6g, which would have to move by %.3g: give a guess "
    "of %s after '~' that is nearer to a solution, or make %s a guess (%.250s)",
    p->name, m->unknown[at], m->y0[at], way, m->unknown[which], m->unknown[at], why);
  return code == STEIF_BAD_INPUT ? STEIF_NO_CONVERGENCE : code;
}

int stf_sought_start(stf_model *m, const steif_problem *p, const steif_request *request,
                     steif_start *start)
{
  enum { MOST = 30 };
  char why[500];
  bool turns = false;
  int code = near(m, p, request, m->y0, start, &turns);
  if (!code || code == STEIF_NO_MEMORY || m->form == STEIF_DESCRIPTOR) return code;
  snprintf(why, sizeof why, "%s", steif_message(m->ctx));
  steif_forget(m->ctx);
  if (m->n <= MOST && code != STEIF_CALLBACK) {
    sunrealtype *from = stf_allocate(m->ctx, (size_t)m->n, sizeof *from);
    if (!from) return STEIF_NO_MEMORY;
    code = from_others(m, p, request, from, code, start);
    stf_release(m->ctx, from);
    if (!code || code == STEIF_NO_MEMORY) return code;
  }
  return tell(m, p, code, turns, why);
}
