/* constraints.c: constraints on the sign of components, kept at the ends of steps.
 *
 * A step that leaves a constraint by less than the error allowed in the component ends on it; one that
 * leaves it by more is refused and made smaller, as is one that touches a strict constraint.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

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

int stf_constraint_check(steif_solver *s, sunrealtype t, N_Vector v, const char *where)
{
  const steif_problem *p = s->problem;
  const sunrealtype *y = stf_array(v);
  for (sunindextype i = 0; p->constraint && i < p->n; i++)
    STEIF_CHECK(
      holds(p->constraint[i], y[i]), s->ctx, STEIF_INFEASIBLE,
      "component %lld of problem '%s' is %.9g %s, t = %.12g, and is declared to be %s: "
      "correct the value or .constraint",
      (long long)i + 1, p->name, y[i], where, t, sign_of(p->constraint[i]));
  return STEIF_OK;
}

int stf_constraint_open(steif_solver *s)
{
  const steif_problem *p = s->problem;
  if (!p->constraint) return STEIF_OK;
  for (sunindextype i = 0; i < p->n; i++)
    STEIF_CHECK(p->constraint[i] >= -2 && p->constraint[i] <= 2, s->ctx, STEIF_BAD_INPUT,
                "constraint[%lld] = %d of problem '%s' must be 0 (none), 1 (y >= 0), 2 (> 0), "
                "-1 (<= 0) or -2 (< 0)",
                (long long)i, p->constraint[i], p->name);
  STEIF_CHECK(stf_array(s->shown), s->ctx, STEIF_UNSUPPORTED,
              "constraints of problem '%s' need all unknowns in one host array", p->name);
  return stf_constraint_check(s, p->t0, s->shown, "at the start");
}

/* The error allowed in component i. */
static sunrealtype allowed(const steif_solver *s, sunindextype i)
{
  const steif_options *o = &s->options;
  const sunrealtype y = stf_array(s->step.y)[i];
  return o->rtol * fabs(y) + (o->atols ? o->atols[i] : o->atol);
}

static int left(steif_solver *s, sunindextype i, sunrealtype y, sunrealtype h)
{
  return STEIF_FAIL(
    s->ctx, STEIF_INFEASIBLE,
    "component %lld of problem '%s' becomes %.9g in the step of %.3g from t = "
    "%.12g, and is declared to be %s: the solution leaves the constraint there, "
    "or the tolerance (with prescribed steps the step) is too large",
    (long long)i + 1, s->problem->name, y, h, s->step.t, sign_of(s->problem->constraint[i]));
}

int stf_constraint_keep(steif_solver *s, sunrealtype h, int tries)
{
  const steif_problem *p = s->problem;
  sunrealtype *y = stf_array(s->step.next);
  bool pressed = false;
  /* a hundredth of what a step may err */
  const sunrealtype noise =
    s->step.adaptive ? fmin(1e-3, 0.01 * s->step.control.tolerance) : 1e-3;
  for (sunindextype i = 0; i < p->n; i++) {
    const int c = p->constraint[i];
    if (holds(c, y[i])) continue;
    const sunrealtype off = fabs(y[i]) / allowed(s, i);
    if (c * c > 1 || off > 1)
      return s->step.adaptive && tries < PATIENCE ? STEIF_RETRY : left(s, i, y[i], h);
    if (off > noise && s->constraint_moves >= PRESSED) return left(s, i, y[i], h);
    pressed = pressed || off > noise;
    y[i] = 0;
  }
  s->constraint_moves = pressed ? s->constraint_moves + 1 : 0;
  return STEIF_OK;
}
