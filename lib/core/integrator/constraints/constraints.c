/* constraints.c: constraints on the sign of components, kept at the ends of steps.
 *
 * A step that leaves a constraint by less than the error allowed in the component ends on it; one that
 * leaves it by more is refused and made smaller, as is one that touches a strict constraint. The first component
 * that does not let a step pass decides what becomes of it. Over ranks each looks at its own rows; one sum a step
 * tells all of them whether there is such a component, and more are made only where it ends the run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "problem.h"
#include <math.h>
#include <stdio.h>

enum {
  PATIENCE = 12, /* refusals in one step, a factor of about a million */
  PRESSED = 20 /* steps in a row that end on a constraint by more than a thousandth of the error
                    allowed: they do not meet it by chance */
};

static const char *sign_of(int constraint)
{
  static const char *const names[] = {"< 0", "<= 0", "free", ">= 0", "> 0"};
  return names[constraint + 2];
}

static bool holds(int constraint, sunrealtype y)
{
  switch (constraint) {
  case 2: return y > 0;
  case 1: return y >= 0;
  case -1: return y <= 0;
  case -2: return y < 0;
  default: return true;
  }
}

/* A component in a sentence: its number from 1, over ranks that of all, its name, and where it is. */
typedef struct component {
  sunindextype at; /* of own rows */
  long long first; /* rows of the ranks before */
  int rank;        /* -1: not known */
} component;

enum { WHERE = STEIF_SPEC_WORD + 32 };

static const char *where(const steif_solver *s, const component *c, char room[WHERE])
{
  const steif_names *names = s->problem->names;
  const bool named = names && names->unknown;
  char name[STEIF_SPEC_WORD] = "";
  *room = 0;
  if (named) stf_unknown(s->problem, c->at, name);
  if (s->agreed && c->rank < 0) snprintf(room, WHERE, " of a rank");
  if (s->agreed && c->rank >= 0)
    snprintf(room, WHERE, " (%s%son rank %d)", name, named ? ", " : "", c->rank);
  return room;
}

static long long number(const component *c) { return c->first + c->at + 1; }

/* Is this the rank that is to speak, the lowest of those with a fault? */
static bool speaks(const steif_solver *s, bool fault, sunindextype rows, component *c)
{
  return stf_agree_lowest(s->options.like, fault, rows, &c->rank, &c->first);
}

/* -- at the start ------------------------------------------------------------------------------ */

static int infeasible(steif_solver *s, const component *c, sunrealtype y)
{
  const steif_problem *p = s->problem;
  char room[WHERE];
  return STEIF_FAIL(
    s->ctx, STEIF_INFEASIBLE,
    "component %lld%s of problem '%s' is %.9g at the start, t = %.12g, and is declared to be "
    "%s: correct the value or .constraint",
    number(c), where(s, c, room), p->name, y, p->t0, sign_of(p->constraint[c->at]));
}

int stf_constraint_open(steif_solver *s)
{
  const int *sign = s->problem->constraint;
  sunindextype rows, i = 0;
  s->constrained = false;
  if (!sign) return STEIF_OK;
  const sunrealtype *y = stf_own_rows(s->shown, &rows);
  STEIF_CHECK(y, s->ctx, STEIF_UNSUPPORTED,
              "constraints of problem '%s' need %s in one host array", s->problem->name,
              s->agreed ? "the rows of a rank" : "all unknowns");
  STEIF_TRY(stf_agreed_gate(s));
  while (i < rows && holds(sign[i], y[i])) i++;
  bool flag[] = {false, i < rows}; /* is there a constraint; is one not kept */
  for (sunindextype k = 0; k < rows; k++) flag[0] = flag[0] || sign[k];
  stf_agree_any(s->options.like, 2, flag);
  s->constrained = flag[0];
  if (!flag[1]) return STEIF_OK;
  component c = {.at = i};
  const bool mine = speaks(s, i < rows, rows, &c);
  return stf_agree(s->ctx, s->options.like, mine ? infeasible(s, &c, y[i]) : STEIF_OK);
}

/* -- at the ends of steps ---------------------------------------------------------------------- */

/* The error allowed in component i of own rows. */
static sunrealtype allowed(const steif_solver *s, sunindextype i)
{
  const steif_options *o = &s->options;
  sunindextype rows;
  const sunrealtype y = stf_own_rows(s->step.y, &rows)[i];
  return o->rtol * fabs(y) + (o->atols ? o->atols[i] : o->atol);
}

static int left(steif_solver *s, const component *c, sunrealtype y, sunrealtype h)
{
  char room[WHERE];
  return STEIF_FAIL(
    s->ctx, STEIF_INFEASIBLE,
    "component %lld%s of problem '%s' becomes %.9g in the step of %.3g from t = "
    "%.12g, and is declared to be %s: the solution leaves the constraint there, "
    "or the tolerance (with prescribed steps the step) is too large",
    number(c), where(s, c, room), s->problem->name, y, h, s->step.t,
    sign_of(s->problem->constraint[c->at]));
}

/* Own rows of the trial, moved where they may be. Not 0: what row *at asks for. */
static int keep_rows(steif_solver *s, sunrealtype *y, sunindextype rows, int tries,
                     sunindextype *at, bool *pressed)
{
  const stf_step *step = &s->step;
  /* a hundredth of what a step may err */
  const sunrealtype noise = step->adaptive ? fmin(1e-3, 0.01 * step->control.tolerance) : 1e-3;
  for (sunindextype i = *at = 0; i < rows; *at = ++i) {
    const int c = s->problem->constraint[i];
    if (holds(c, y[i])) continue;
    const sunrealtype off = fabs(y[i]) / allowed(s, i);
    if (c * c > 1 || off > 1)
      return step->adaptive && tries < PATIENCE ? STEIF_RETRY : STEIF_INFEASIBLE;
    if (off > noise && s->constraint_moves >= PRESSED) return STEIF_INFEASIBLE;
    *pressed = *pressed || off > noise;
    y[i] = 0;
  }
  return STEIF_OK;
}

int stf_constraint_keep(steif_solver *s, sunrealtype h, int tries)
{
  N_Vector like = s->options.like;
  sunindextype rows;
  sunrealtype *y = stf_own_rows(s->step.next, &rows);
  component c = {0};
  bool pressed = false;
  const int code = keep_rows(s, y, rows, tries, &c.at, &pressed);
  bool flag[] = {code == STEIF_RETRY, code == STEIF_INFEASIBLE, pressed};
  stf_agree_any(like, 3, flag);
  if (s->agreed) s->agreements++;
  if (flag[1]) {
    const bool mine = speaks(s, code, rows, &c) && code == STEIF_INFEASIBLE;
    STEIF_TRY(stf_agree(s->ctx, like, mine ? left(s, &c, y[c.at], h) : STEIF_OK));
    return STEIF_RETRY;
  }
  if (flag[0]) return STEIF_RETRY;
  s->constraint_moves = flag[2] ? s->constraint_moves + 1 : 0;
  return STEIF_OK;
}
