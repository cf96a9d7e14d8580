/* forcing_sides.c: limits of f at its breaks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing_sides.h"
#include "base.h"
#include <math.h>

/* Limits are taken BESIDE eps of the break, beyond the rounding of what an expression makes of it. */
#define BESIDE 8

static sunrealtype beside(sunrealtype t, bool left)
{
  const sunrealtype away = BESIDE * STF_EPS * fabs(t);
  return left ? t - away : t + away;
}

int stf_sides_force(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const stf_sides *s = user;
  for (size_t b = 0; b < s->count && s->to > s->from; b++) {
    const sunrealtype at = s->breaks[b];
    if (fabs(at - s->to) <= s->near && fabs(t - s->to) <= s->near)
      return s->f(beside(at, true), derivative, g, s->user);
    if (fabs(at - s->from) <= s->near && fabs(t - s->from) <= s->near)
      return s->f(beside(at, false), derivative, g, s->user);
  }
  return s->f(t, derivative, g, s->user);
}

void stf_sides_step(stf_sides *s, sunrealtype from, sunrealtype to, sunrealtype near)
{
  s->from = from, s->to = to, s->near = near * (to - from);
}
