/* first_jump.c: does a start lie on the hidden constraints? A step of backward Euler of length h, linearised at
 * the start, moves y by d(h) = -(E/h + B)^{-1} F(t + h, y, 0): by jump + h c + O(h^2), and 2 d(h) - d(2 h) is free of
 * h c. The jump of an unknown with a derivative is 0 if and only if the linearised constraints up to those on it
 * hold; one of index 1 or 2 without a derivative jumps to its consistent value. (One of index 3 does not: the first
 * step gives it half of what the constraint asks for.)
 *
 * Both steps take the factors of C = E/h + B. With N = C^{-1} E/h it is E/(2 h) + B = C (I - N/2). N has
 * eigenvalues 1/(1 + h s) beside 1 for slow modes, beside 0 for stiff ones, and a nilpotent part of index 3 at most where
 * the DAE has none higher. So (I - N/2)^{-1} = p(N) but for rounding and O(h^3), with p of degree 5 that meets
 * 1/(1 - z/2) three times at z = 0 and three times at z = 1; between them it is within 1/512 of it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"
#include <math.h>
#include <string.h>

/* Of the interval: rounding of velocities is eps/h, what is left of smooth motion h^2. */
static const sunrealtype part = 1e-6, longest = 1e-3;

/* x = C^{-1} b */
static int solve(stf_repair *r, const stf_view_factor *c, const sunrealtype *b, sunrealtype *x)
{
  N_Vector v = r->point.r;
  memcpy(stf_array(v), b, r->point.n * sizeof *b);
  STEIF_TRY(steif_pencil_solve(c->pencil, 0, 1, &v, NULL));
  memcpy(x, stf_array(v), r->point.n * sizeof *x);
  return STEIF_OK;
}

/* out = E x/h */
static void times_mass(const stf_view *v, sunrealtype h, const sunrealtype *x, sunrealtype *out)
{
  memset(out, 0, v->n * sizeof *out);
  for (size_t j = 0; j < v->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      out[v->row[k]] += v->e[k] / h * x[j];
}

/* x = (I - N/2)^{-1} b by Horner's rule; work: n. */
static int lengthen(stf_repair *r, const stf_view_factor *c, sunrealtype h,
                    const sunrealtype *b, sunrealtype *work, sunrealtype *x)
{
  static const sunrealtype p[] = {1, 0.5, 0.25, 0.25, -0.25, 0.25};
  const size_t n = r->point.n;
  for (size_t j = 0; j < n; j++) x[j] = p[5] * b[j];
  for (int k = 4; k >= 0; k--) {
    times_mass(&r->view, h, x, work);
    STEIF_TRY(solve(r, c, work, x));
    for (size_t j = 0; j < n; j++) x[j] += p[k] * b[j];
  }
  return STEIF_OK;
}

/* 2 d(h) - d(2 h) into jump; work: 3 n. */
static int jump_within(stf_repair *r, const stf_view_factor *c, sunrealtype h,
                       sunrealtype *work, sunrealtype *jump)
{
  const size_t n = r->point.n;
  sunrealtype *rest = work, *F = work + n, *twice = work + 2 * n;
  memset(rest, 0, n * sizeof *rest);
  STEIF_TRY(stf_point_residual(&r->point, r->point.t + 2 * h, r->y, rest, F));
  STEIF_TRY(solve(r, c, F, F));
  STEIF_TRY(lengthen(r, c, h, F, rest, twice));
  memset(rest, 0, n * sizeof *rest);
  STEIF_TRY(stf_point_residual(&r->point, r->point.t + h, r->y, rest, F));
  STEIF_TRY(solve(r, c, F, jump));
  for (size_t j = 0; j < n; j++) jump[j] = twice[j] - 2 * jump[j];
  return STEIF_OK;
}

/* Is the consistent value of unknown j the limit of these steps? */
static bool shown(const stf_repair *r, size_t j)
{
  const int *index = r->problem.index;
  return !r->algebraic[j] || (index ? index[j] <= 2 : r->problem.dae_index == 1);
}

/* Those that a look at the pencil has left serve once. */
static int factors_of(stf_repair *r, sunrealtype h, stf_view_factor *c)
{
  if (!r->step.pencil || r->step_h != h) return stf_view_factor_open(r, 1 / h, NULL, 1, c);
  *c = r->step;
  r->step = (stf_view_factor){0};
  return STEIF_OK;
}

/* work: 4 n. */
static int measure(stf_repair *r, sunrealtype h, sunrealtype *work, sunrealtype *largest)
{
  stf_view_factor c;
  sunrealtype *jump = work + 3 * r->point.n, most = 0;
  int code = factors_of(r, h, &c);
  if (!code) code = jump_within(r, &c, h, work, jump);
  stf_view_factor_close(&c);
  for (size_t j = 0; j < r->point.n && !code; j++)
    if (shown(r, j)) most = fmax(most, fabs(jump[j]) / r->weight[j]);
  *largest = most;
  return code;
}

void stf_jump_lengths(stf_repair *r, sunrealtype *h)
{
  sunrealtype slow, fast;
  const sunrealtype span = r->given->t1 - r->given->t0;
  stf_view_rates(&r->point, &r->view, &slow, &fast);
  const sunrealtype a = part * span, b = part / sqrt(slow * fast);
  const sunrealtype all[STF_JUMP_LENGTHS] = {fmin(a, b), fmax(a, b), part / fast, 1e-3 * a};
  for (int k = 0; k < STF_JUMP_LENGTHS; k++) h[k] = all[k] <= longest * span ? all[k] : 0;
}

/* A jump is there for every short h; motion and rounding are not: several are tried before one is
 * believed. */
int stf_first_jump(stf_repair *r, sunrealtype *largest)
{
  sunrealtype *work = stf_allocate(r->ctx, 4 * r->point.n, sizeof *work), h[STF_JUMP_LENGTHS];
  if (!work) return STEIF_NO_MEMORY;
  int code = STEIF_OK;
  *largest = INFINITY;
  stf_jump_lengths(r, h);
  for (int k = 0; k < STF_JUMP_LENGTHS && !(*largest <= 1) && !code; k++) {
    sunrealtype found = INFINITY;
    if (h[k] > 0) code = measure(r, h[k], work, &found);
    *largest = fmin(*largest, found);
  }
  stf_release(r->ctx, work);
  return code;
}
