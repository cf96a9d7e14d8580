/* first_jump.c: does a start lie on the hidden constraints? A step of backward Euler of length h, linearised at
 * the start, moves y by delta(h) = -(E/h + B)^{-1} F(t + h, y, 0). Unknowns with a derivative move by
 * jump + h y' + O(h^2) with F at t + h, jump = 0 if and only if the linearised constraints up to those on them hold;
 * 2 delta(h) - delta(2 h) is free of h y'.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"
#include <math.h>
#include <string.h>

/* Of the interval: rounding of velocities is eps/h, what is left of smooth motion h^2. */
static const sunrealtype part = 1e-6, longest = 1e-3;

/* work: 2 n */
static int move(stf_repair *r, sunrealtype h, sunrealtype *work, sunrealtype *delta)
{
  stf_view_factor c;
  int code = stf_view_factor_open(r, 1 / h, NULL, 1, &c);
  N_Vector x = r->point.r;
  sunrealtype *rest = work, *F = work + r->point.n;
  if (!code) code = stf_point_residual(&r->point, r->point.t + h, r->y, rest, F);
  if (!code) {
    memcpy(stf_array(x), F, r->point.n * sizeof *F);
    code = steif_pencil_solve(c.pencil, 0, 1, &x, NULL);
  }
  for (size_t j = 0; j < r->point.n && !code; j++) delta[j] = -stf_array(x)[j];
  stf_view_factor_close(&c);
  return code;
}

/* Steps of h and 2 h; work: 4 n. */
static int pair(stf_repair *r, sunrealtype h, sunrealtype *work, sunrealtype *largest)
{
  const size_t n = r->point.n;
  sunrealtype *once = work + 2 * n, *twice = work + 3 * n;
  STEIF_TRY(move(r, h, work, once));
  STEIF_TRY(move(r, 2 * h, work, twice));
  *largest = 0;
  for (size_t j = 0; j < n; j++)
    if (!r->algebraic[j])
      *largest = fmax(*largest, fabs(2 * once[j] - twice[j]) / r->weight[j]);
  return STEIF_OK;
}

/* A jump is there for every short h; motion and rounding are not: several are tried before one is
 * believed. */
int stf_first_jump(stf_repair *r, sunrealtype *largest)
{
  sunrealtype *work = stf_allocate(r->ctx, 4 * r->point.n, sizeof *work), slow, fast;
  if (!work) return STEIF_NO_MEMORY;
  const sunrealtype span = r->given->t1 - r->given->t0;
  stf_view_rates(&r->point, &r->view, &slow, &fast);
  const sunrealtype h[] = {part * span, part / sqrt(slow * fast), part / fast,
                           1e-3 * part * span};
  int code = STEIF_OK;
  *largest = INFINITY;
  const size_t count = sizeof h / sizeof *h;
  for (size_t k = 0; k < count && !(*largest <= 1) && !code; k++) {
    sunrealtype found = INFINITY;
    if (h[k] > 0 && h[k] <= longest * span) code = pair(r, h[k], work, &found);
    *largest = fmin(*largest, found);
  }
  stf_release(r->ctx, work);
  return code;
}
