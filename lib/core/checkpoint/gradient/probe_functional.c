/* probe_functional.c: slopes of functionals and transposed products as they are given, against differences, as dF/dp is
 * (sensitivity/probe_slopes.c): at a point and near it.
 *
 * Along a direction without a pattern, and by each parameter, with values over [-d, d], [-2d, 2d] and [0, d]: a slope is
 * wrong that is off by ten times their errors, of truncation and of rounding, and by 1e-3 of itself.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include "probe.h"
#include "saltation.h"
#include <math.h>

static const sunrealtype sure = 10, relative = 1e-3, units = 8, golden = 0.6180339887498949;

enum { UP, DOWN, FAR_UP, FAR_DOWN, HERE, ROUNDED, VALUES };
static const sunrealtype place[VALUES] = {1, -1, 2, -2, 0, 0};

typedef struct probe {
  stf_backwards *B;
  int at_end;
  sunrealtype t, d;
  N_Vector y, along, moved;
  sunrealtype *value; /* VALUES rows of count */
} probe;

static int values(probe *q, N_Vector y, int row)
{
  const steif_functional *J = q->B->functional;
  const steif_values what = q->at_end ? J->end : J->integrand;
  return what(q->t, y, q->value + row * q->B->count, J->user ? J->user : q->B->problem->user);
}

/* Of y by rounding, which does not depend on where differences are made. */
static int near(probe *q)
{
  sunrealtype *to = stf_array(q->moved);
  const sunrealtype *from = stf_array(q->y);
  for (sunindextype i = 0; i < q->B->n; i++)
    to[i] = from[i] * (1 + (i % 2 ? -units : units) * STF_EPS);
  const int code = values(q, q->moved, ROUNDED);
  return code ? code : values(q, q->y, HERE);
}

static int by_y(probe *q)
{
  int code = 0;
  for (int j = 0; !code && j < HERE; j++) {
    stf_sum(&q->B->space, 1, q->y, place[j] * q->d, q->along, q->moved);
    code = values(q, q->moved, j);
  }
  return code;
}

static int by_p(probe *q, int k)
{
  const sunrealtype p = q->B->problem->parameters->value[k];
  int code = 0;
  for (int j = 0; !code && j < HERE; j++) {
    code = stf_set_parameter(q->B->home, k, p + place[j] * q->d);
    if (!code) code = values(q, q->y, j);
  }
  return stf_set_parameter(q->B->home, k, p) ? -1 : code;
}

/* The slope of functional i by differences, and what it may be off by. */
static sunrealtype slope_of(const probe *q, int i, sunrealtype *bar)
{
  sunrealtype g[VALUES];
  for (int j = 0; j < VALUES; j++) g[j] = q->value[j * q->B->count + i];
  const sunrealtype found = (g[UP] - g[DOWN]) / (2 * q->d),
                    wide = (g[FAR_UP] - g[FAR_DOWN]) / (4 * q->d),
                    half = (g[UP] - g[HERE]) / q->d,
                    rounding = fabs(g[ROUNDED] - g[HERE]) + units * STF_EPS * fabs(g[HERE]);
  *bar = sure * (fmax(fabs(found - wide), fabs(found - half)) + rounding / q->d);
  return found;
}

static bool wrong(sunrealtype given, sunrealtype found, sunrealtype bar)
{
  return fabs(given - found) > fmax(bar, relative * fmax(fabs(given), fabs(found)));
}

static const char *what(const probe *q) { return q->at_end ? "end" : "integrand"; }

static int check_y(probe *q)
{
  const stf_backwards *B = q->B;
  const sunrealtype *v = stf_array(q->along);
  q->d = cbrt(STF_EPS);
  if (by_y(q)) return STEIF_OK;
  for (int i = 0; i < B->count; i++) {
    const sunrealtype *gy = stf_array(B->gy[i]);
    sunrealtype given = 0, bar = 0, found = slope_of(q, i, &bar);
    for (sunindextype j = 0; j < B->n; j++) given += gy[j] * v[j];
    STEIF_CHECK(!wrong(given, found, bar), B->ctx, STEIF_BAD_INPUT,
                "slopes of functional %d of problem '%s' are wrong: dy of the %s gives %.6g "
                "along a direction at t = %.6g, where differences of its values are %.6g, to "
                "about %.1g; correct them, or leave .slopes NULL",
                i + 1, B->problem->name, what(q), given, q->t, found, bar);
  }
  return STEIF_OK;
}

static int check_p(probe *q, int k)
{
  const stf_backwards *B = q->B;
  const steif_parameters *p = B->problem->parameters;
  q->d = stf_slopes_increment(p, k);
  if (by_p(q, k)) return STEIF_OK;
  for (int i = 0; i < B->count; i++) {
    sunrealtype bar = 0;
    const sunrealtype found = slope_of(q, i, &bar), given = B->gp[i * B->P + k];
    STEIF_CHECK(!wrong(given, found, bar), B->ctx, STEIF_BAD_INPUT,
                "slopes of functional %d of problem '%s' are wrong: dp of the %s gives %.6g by "
                "parameter %d%s%.40s%s at t = %.6g, where differences of its values are %.6g, "
                "to about %.1g; correct them, or leave .slopes NULL",
                i + 1, B->problem->name, what(q), given, k + 1, p->name ? " (" : "",
                p->name ? p->name[k] : "", p->name ? ")" : "", q->t, found, bar);
  }
  return STEIF_OK;
}

/* What cannot be evaluated is not judged. */
static int look(probe *q)
{
  const stf_backwards *B = q->B;
  const bool before = stf_silence(B->ctx, true);
  const int code = stf_functional_at(q->B, q->at_end, q->t, q->y) || near(q);
  stf_silence(B->ctx, before);
  if (code) return STEIF_OK;
  STEIF_TRY(check_y(q));
  for (int k = 0; k < B->P; k++) STEIF_TRY(check_p(q, k));
  return STEIF_OK;
}

/* Lengths of about the size of each component. */
static void aim(probe *q)
{
  const sunrealtype *y = stf_array(q->y);
  sunrealtype *v = stf_array(q->along);
  for (sunindextype i = 0; i < q->B->n; i++)
    v[i] = (i % 3 == 1 ? -1 : 1) * (0.5 + fmod(golden * (sunrealtype)(i + 1), 1)) *
           fmax(fabs(y[i]), stf_floor(&q->B->home->step.system, i));
}

static int look_twice(stf_pool *pool, probe *q)
{
  stf_backwards *B = q->B;
  N_Vector close = stf_pool_vector(pool, B->space.like);
  q->along = stf_pool_vector(pool, B->space.like);
  q->moved = stf_pool_vector(pool, B->space.like);
  q->value = stf_pool_array(pool, VALUES * (size_t)B->count, sizeof *q->value);
  if (!close || !q->along || !q->moved || !q->value) return STEIF_NO_MEMORY;
  aim(q);
  STEIF_TRY(look(q));
  stf_sum(&B->space, 1, q->y, relative, q->along, close);
  q->y = close;
  return look(q);
}

int stf_probe_functional(stf_backwards *B, int at_end, sunrealtype t, N_Vector y)
{
  const steif_functional *J = B->functional;
  probe q = {.B = B, .at_end = at_end, .t = t, .y = y};
  if (!J->slopes || !(at_end ? J->end : J->integrand)) return STEIF_OK;
  stf_pool *pool = stf_pool_new(B->ctx);
  const int code = pool ? look_twice(pool, &q) : STEIF_NO_MEMORY;
  stf_pool_free(&pool);
  return code;
}

/* ---- w . dF/dp ----------------------------------------------------------------------------------- */

/* Near the start, where what is 0 or cancels there does not. */
static void beside(const stf_backwards *B, N_Vector y, N_Vector yp)
{
  const steif_solver *s = B->home;
  const sunrealtype *from = stf_array(y), *slope = stf_array(yp), span = s->t1 - s->problem->t0;
  for (sunindextype i = 0; i < B->n; i++) {
    const sunrealtype share = 0.5 + fmod(golden * (sunrealtype)(i + 1), 1),
                      floor = stf_floor(&s->step.system, i);
    stf_array(B->Y[0])[i] = from[i] + relative * share * fmax(fabs(from[i]), floor);
    stf_array(B->Yp[0])[i] = slope[i] - relative * share * fmax(fabs(slope[i]), floor / span);
  }
}

static int check_pull(stf_backwards *B, int k, sunrealtype t, N_Vector y, N_Vector yp,
                      N_Vector w)
{
  const bool before = stf_silence(B->ctx, true);
  const int code = stf_slopes_at(B->slopes, k, t, y, yp, B->work);
  stf_silence(B->ctx, before);
  sunrealtype sum = 0, size = fabs(B->Fp[k]);
  for (sunindextype i = 0; !code && i < B->n; i++) {
    const sunrealtype term = stf_array(w)[i] * stf_array(B->work)[i];
    sum += term, size = fmax(size, fabs(term));
  }
  STEIF_CHECK(code || !(fabs(sum - B->Fp[k]) > relative * size), B->ctx, STEIF_BAD_INPUT,
              "dFdp_transposed of problem '%s' is wrong: with some w it gives %.6g by "
              "parameter %d at t = %.6g, where w . dF/dp by dFdp is %.6g; correct it, or "
              "leave it NULL",
              B->problem->name, B->Fp[k], k + 1, t, sum);
  return STEIF_OK;
}

int stf_probe_pull(stf_backwards *B, sunrealtype t, N_Vector y, N_Vector yp)
{
  const steif_parameters *q = B->problem->parameters;
  N_Vector w = B->error;
  if (!B->P || !q->dFdp || !q->dFdp_transposed) return STEIF_OK;
  for (sunindextype i = 0; i < B->n; i++)
    stf_array(w)[i] = (i % 3 == 1 ? -1 : 1) * (0.5 + fmod(golden * (sunrealtype)(i + 1), 1));
  beside(B, y, yp);
  const bool before = stf_silence(B->ctx, true);
  const int code = stf_parameters_times(B, t, B->Y[0], B->Yp[0], w, B->Fp);
  stf_silence(B->ctx, before);
  for (int k = 0; !code && k < B->P; k++) STEIF_TRY(check_pull(B, k, t, B->Y[0], B->Yp[0], w));
  return STEIF_OK;
}
