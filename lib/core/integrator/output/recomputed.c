/* recomputed.c: the solution shown, put on all constraints: positions and velocities move least, and unknowns of
 * index 2 and 3 are computed from them instead of from stages, which have lower orders for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "integrator.h"
#include <math.h>
#include <string.h>

/* Components of index 1 that would move by more tolerances than this: the point is another one. */
static const sunrealtype furthest = 10;

sunrealtype stf_allowed(const steif_solver *s, const sunrealtype *y, size_t j)
{
  const steif_options *o = &s->options;
  return o->rtol * fabs(y[j]) + (o->atols ? o->atols[j] : o->atol);
}

static void measure(const steif_solver *s, const sunrealtype *y, const steif_start *start,
                    sunrealtype *drift, sunrealtype *corrected)
{
  const int *index = s->problem->index;
  sunrealtype most[2] = {0, 0};
  for (size_t j = 0; j < (size_t)s->problem->n; j++) {
    const bool high = index && index[j] > 1;
    most[high] = fmax(most[high], fabs(start->moved[j]) / stf_allowed(s, y, j));
  }
  if (drift) *drift = most[0];
  if (corrected) *corrected = most[1];
}

/* Do components with a derivative, and those of index 1, stay where they are? */
static bool stays(const steif_solver *s, const sunrealtype *y, const steif_start *start)
{
  const int *index = s->problem->index;
  for (size_t j = 0; j < (size_t)s->problem->n; j++)
    if ((index[j] < 2 || !s->repair.algebraic[j]) &&
        !(fabs(start->moved[j]) <= furthest * stf_allowed(s, y, j)))
      return false;
  return true;
}

int stf_recompute_mode(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, bool *known)
{
  steif_start start;
  *known = false;
  if (!stf_recomputes(s)) return STEIF_OK;
  const size_t n = (size_t)s->problem->n;
  const steif_point at = {.y = stf_array(y), .t = t};
  int *number = stf_allocate(s->ctx, n, sizeof *number);
  if (!number) return STEIF_NO_MEMORY;
  const bool before = stf_silence(s->ctx, true);
  const int code = stf_start_beside(s->ctx, s->problem, &at, NULL, &start, number);
  stf_silence(s->ctx, before);
  const bool same = !code && !memcmp(number, s->problem->index, n * sizeof *number);
  stf_release(s->ctx, number);
  if (code == STEIF_NO_MEMORY) return code;
  *known = same && stays(s, at.y, &start);
  if (*known) {
    memcpy(stf_array(y), start.y, (size_t)s->problem->n * sizeof *start.y);
    memcpy(stf_array(yp), start.yp, (size_t)s->problem->n * sizeof *start.yp);
  }
  steif_start_clear(&start);
  if (code) steif_forget(s->ctx);
  return STEIF_OK;
}

int steif_recompute(steif_solver *s, N_Vector y, sunrealtype *drift, sunrealtype *corrected)
{
  if (!s) return STEIF_BAD_INPUT;
  const size_t n = (size_t)s->problem->n;
  STEIF_CHECK(
    !s->agreed, s->ctx, STEIF_UNSUPPORTED,
    "steif_recompute needs all %zu unknowns in one place, and these vectors are spread "
    "over ranks",
    n);
  STEIF_CHECK(y && stf_array(y) && N_VGetLength(y) == s->problem->n && stf_array(s->shown),
              s->ctx, STEIF_BAD_INPUT, "a vector of %zu components with a host array is needed",
              n);
  steif_start start;
  const steif_point at = {.y = stf_array(s->shown), .t = stf_side(s, s->t_shown)};
  STEIF_TRY(stf_start_project(s->ctx, s->problem, &at, &start));
  measure(s, at.y, &start, drift, corrected);
  memcpy(stf_array(y), start.y, n * sizeof *start.y);
  steif_start_clear(&start);
  return STEIF_OK;
}

bool stf_recomputes(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  return !s->engine && s->step.adaptive && s->step.count > 0 && p->index && p->dae_index > 1 &&
         p->dae_index <= 3 && p->n <= STEIF_DIAGNOSE_LARGEST && s->step.system.space.serial &&
         s->step.system.storage != STEIF_KRYLOV && !s->step.system.krylov;
}

/* Equations that hold from the end of the step on do not tell of times before. */
static bool before_event(const steif_solver *s, sunrealtype t)
{
  return s->events && s->events->cut && t < s->end;
}

bool stf_recomputes_at(const steif_solver *s, sunrealtype t)
{
  return stf_recomputes(s) && !before_event(s, t);
}

/* Cubics by slopes of stages of order 1, which of index 2 and 3 have few digits: what is shown is off by as much. */
static int check_drift(const steif_solver *s, sunrealtype t, sunrealtype drift)
{
  STEIF_CHECK(
    drift <= furthest || !stf_low_stages(s->step.table) || t == s->step.t, s->ctx,
    STEIF_NOT_CERTIFIED,
    "the solution of problem '%s' that '%s' has inside its steps, at t = %.12g, is %.2g "
    "tolerances off the constraints: take radau or bdf for times between the steps of "
    "problems of index %d",
    s->problem->name, s->method, t, drift, s->problem->dae_index);
  return STEIF_OK;
}

/* Differences over a part between two breaks may have few digits: do those over half of it say the same? */
static int check_narrow(steif_solver *s, const steif_point *at, const steif_start *start,
                        bool *known)
{
  const sunrealtype shortest = 1e3 * STF_EPS * fabs(at->t);
  const sunrealtype from = s->nodes.from - at->t, to = s->nodes.to - at->t;
  *known = !s->nodes.narrow;
  if (*known || !(to - from > shortest)) return STEIF_OK;
  steif_problem shorter = *s->problem;
  const sunrealtype after = nextafter(at->t, INFINITY);
  const sunrealtype ends[] = {at->t + from / 2, fmax(at->t + to / 2, after)};
  steif_start other;
  sunrealtype apart = 0;
  shorter.breaks = ends, shorter.break_count = 2;
  const int code = stf_start_beside(s->ctx, &shorter, at, NULL, &other, NULL);
  for (size_t j = 0; !code && j < (size_t)s->problem->n; j++)
    apart = fmax(apart, fabs(other.y[j] - start->y[j]) / stf_allowed(s, start->y, j));
  steif_start_clear(&other);
  *known = !code && apart <= 1;
  return code == STEIF_NO_MEMORY ? code : STEIF_OK;
}

/* y at t as the method has it moves where it belongs, or stays where that cannot be told. */
static int put_in_place(steif_solver *s, sunrealtype t, N_Vector y)
{
  steif_start start;
  const steif_point at = {.y = stf_array(y), .t = stf_side(s, t)};
  bool known = false;
  const bool before = stf_silence(s->ctx, true);
  const int code = stf_start_beside(s->ctx, s->problem, &at, &s->nodes, &start, NULL);
  const int again = code ? code : check_narrow(s, &at, &start, &known);
  stf_silence(s->ctx, before);
  if (code == STEIF_NO_MEMORY) return code;
  if (again && !code) return steif_start_clear(&start), again;
  sunrealtype drift, corrected;
  if (!code) measure(s, at.y, &start, &drift, &corrected);
  if (known && drift <= furthest) {
    memcpy(stf_array(y), start.y, (size_t)s->problem->n * sizeof *start.y);
    s->drift = drift, s->corrected = corrected;
  }
  steif_start_clear(&start);
  if (known) return check_drift(s, t, drift);
  steif_forget(s->ctx);
  return STEIF_OK;
}

int stf_recompute_shown(steif_solver *s)
{
  s->drift = s->corrected = NAN;
  if (!s->options.recompute || !stf_recomputes_at(s, s->t_shown)) return STEIF_OK;
  if (s->shown != s->dense) N_VScale(1, s->shown, s->dense);
  STEIF_TRY(put_in_place(s, s->t_shown, s->dense));
  s->shown = s->dense;
  return STEIF_OK;
}

int steif_output(steif_solver *s, sunrealtype t, N_Vector y)
{
  if (!s) return STEIF_BAD_INPUT;
  if (t == s->t_shown)
    N_VScale(1, s->shown, y);
  else
    STEIF_TRY(steif_dense(s, t, y));
  s->drift = s->corrected = NAN;
  return stf_recomputes_at(s, t) ? put_in_place(s, t, y) : STEIF_OK;
}

int steif_recomputed(const steif_solver *s, sunrealtype *drift, sunrealtype *corrected)
{
  if (!s) return STEIF_BAD_INPUT;
  if (drift) *drift = s->drift;
  if (corrected) *corrected = s->corrected;
  return STEIF_OK;
}
