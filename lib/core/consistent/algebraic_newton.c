/* algebraic_newton.c: consistent starts of index 1: F(t, y, y') = 0 is solved for the derivatives y_d' of
 * the components that have one and for the other components y_a (P. N. Brown, A. C. Hindmarsh and
 * L. R. Petzold, SIAM J. Sci. Comput. 19 (1998) 1495-1512), by Newton's iteration with damping on sparse factors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "repair.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { MOST = 50, HALVINGS = 12 };
/* C x = b is solved for a known x with relative errors above this: C is taken for singular. */
static const sunrealtype regular_to = 1e-7;
/* Iterations end where a correction is this part of the tolerances, or of |y| by rounding; and where corrections have
 * ceased to fall, as solves with an ill-conditioned C leave rounding of all components in each of them, far below the
 * tolerances, or below them and of the size of rounding of the largest. */
static const sunrealtype enough = 1e-9, rounding = 1e-14;
static const sunrealtype far_below = 1e-3, below = 0.1, of_largest = 1e-12;

/* 1 over the largest entry of column j: whatever the units of unknowns are, all have a part in C x. */
static sunrealtype known(SUNMatrix C, size_t j)
{
  sunrealtype top = 0;
  for (sunindextype k = SM_INDEXPTRS_S(C)[j]; k < SM_INDEXPTRS_S(C)[j + 1]; k++)
    top = fmax(top, fabs(SM_DATA_S(C)[k]));
  return top > 0 ? 1 / top : 1;
}

/* Largest relative error of a solve whose solution is known. */
static sunrealtype probe(stf_repair *r, const stf_view_factor *c)
{
  N_Vector x = r->point.r;
  sunrealtype *a = stf_array(x), worst = 0;
  const size_t n = r->point.n;
  memset(a, 0, n * sizeof *a);
  for (size_t j = 0; j < n; j++) {
    const sunrealtype xj = known(c->C, j);
    for (sunindextype k = SM_INDEXPTRS_S(c->C)[j]; k < SM_INDEXPTRS_S(c->C)[j + 1]; k++)
      a[SM_INDEXVALS_S(c->C)[k]] += SM_DATA_S(c->C)[k] * xj;
  }
  if (steif_pencil_solve(c->pencil, 0, 1, &x, NULL)) return INFINITY;
  for (size_t j = 0; j < n; j++) worst = fmax(worst, fabs(a[j] / known(c->C, j) - 1));
  return worst;
}

int stf_index_one(stf_repair *r, bool *regular)
{
  stf_view_factor c;
  const int code = stf_view_factor_open(r, 1, r->algebraic, 1, &c);
  *regular = code == STEIF_OK && probe(r, &c) < regular_to;
  if (*regular)
    r->first = c;
  else
    stf_view_factor_close(&c);
  if (code == STEIF_SINGULAR || code == STEIF_NOT_FINITE) steif_forget(r->ctx);
  return code == STEIF_SINGULAR || code == STEIF_NOT_FINITE ? STEIF_OK : code;
}

/* -C^{-1} F at (y, yp) into delta; > 0 where F cannot be evaluated. */
static int correction(stf_repair *r, const stf_view_factor *c, const sunrealtype *y,
                      const sunrealtype *yp, sunrealtype *delta)
{
  const size_t n = r->point.n;
  N_Vector x = r->point.r;
  STEIF_TRY(stf_point_residual(&r->point, r->point.t, y, yp, delta));
  memcpy(stf_array(x), delta, n * sizeof *delta);
  STEIF_TRY(steif_pencil_solve(c->pencil, 0, 1, &x, NULL));
  for (size_t j = 0; j < n; j++) delta[j] = -stf_array(x)[j];
  return STEIF_OK;
}

/* Largest part of y_a, in tolerances. */
static sunrealtype size_of(const stf_repair *r, const sunrealtype *delta)
{
  sunrealtype most = 0;
  for (size_t j = 0; j < r->point.n; j++)
    if (r->algebraic[j]) {
      const sunrealtype part = fabs(delta[j]) / r->weight[j];
      if (!(part <= most)) most = part;
    }
  return most;
}

static void add(const stf_repair *r, sunrealtype factor, const sunrealtype *delta,
                sunrealtype *y, sunrealtype *yp)
{
  for (size_t j = 0; j < r->point.n; j++) {
    if (r->algebraic[j])
      y[j] = r->y[j] + factor * delta[j];
    else
      yp[j] = r->yp[j] + factor * delta[j];
  }
}

/* The natural test of monotony (Deuflhard): the correction with the old factors must fall. work: 3 n. */
static int damped(stf_repair *r, const stf_view_factor *c, const sunrealtype *delta,
                  sunrealtype before, sunrealtype *work, sunrealtype *after)
{
  const size_t n = r->point.n;
  sunrealtype *y = work, *yp = work + n, *next = work + 2 * n, factor = 1;
  memcpy(y, r->y, n * sizeof *y);
  memcpy(yp, r->yp, n * sizeof *yp);
  for (int k = 0; k < HALVINGS; k++, factor /= 2) {
    add(r, factor, delta, y, yp);
    const int code = correction(r, c, y, yp, next);
    if (code < 0) return code;
    *after = code ? INFINITY : size_of(r, next);
    if (*after <= (1 - factor / 4) * before || *after <= enough) break;
  }
  if (!(*after < INFINITY)) return STEIF_RETRY;
  memcpy(r->y, y, n * sizeof *y);
  memcpy(r->yp, yp, n * sizeof *yp);
  return STEIF_OK;
}

static bool at_rounding(const stf_repair *r, const sunrealtype *delta)
{
  for (size_t j = 0; j < r->point.n; j++)
    if (r->algebraic[j] && fabs(delta[j]) > rounding * (fabs(r->y[j]) + r->weight[j]))
      return false;
  return true;
}

/* `now` and `before`: sizes of this correction and of the last one. */
static bool ceased(const stf_repair *r, const sunrealtype *delta, sunrealtype now,
                   sunrealtype before)
{
  sunrealtype largest = 0, moved = 0;
  if (!(now > before / 2) || !(now <= below)) return false;
  for (size_t j = 0; j < r->point.n; j++) {
    if (!r->algebraic[j]) continue;
    largest = fmax(largest, fabs(r->y[j]));
    moved = fmax(moved, fabs(delta[j]));
  }
  return now <= far_below || moved <= of_largest * largest;
}

/* Those of the look at the index serve the first correction. */
static int factors_at(stf_repair *r, int k, stf_view_factor *c)
{
  if (k > 0 || !r->first.pencil) return stf_view_factor_open(r, 1, r->algebraic, 1, c);
  *c = r->first;
  r->first = (stf_view_factor){0};
  return STEIF_OK;
}

static int iterate(stf_repair *r, sunrealtype *first, sunrealtype *delta)
{
  const size_t n = r->point.n;
  sunrealtype before = INFINITY;
  for (int k = 0; k < MOST; k++) {
    stf_view_factor c;
    sunrealtype after = 0;
    int code = factors_at(r, k, &c);
    if (!code) code = correction(r, &c, r->y, r->yp, delta);
    const sunrealtype now = code ? 0 : size_of(r, delta);
    if (!code && k == 0) *first = now;
    const bool done = !code && ((k == 0 && now <= 1) || now <= enough ||
                                at_rounding(r, delta) || ceased(r, delta, now, before));
    before = now;
    if (!code && !done) code = damped(r, &c, delta, now, delta + n, &after);
    stf_view_factor_close(&c);
    if (code || done) return code;
    STEIF_TRY(stf_view_take(&r->point, r->point.t, r->y, r->yp, &r->view));
  }
  return STEIF_RETRY;
}

int stf_algebraic_newton(stf_repair *r, sunrealtype *first)
{
  sunrealtype *work = stf_allocate(r->ctx, 4 * r->point.n, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  const int code = iterate(r, first, work);
  stf_release(r->ctx, work);
  return code;
}
