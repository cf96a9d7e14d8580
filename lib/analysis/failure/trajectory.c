/* trajectory.c: causes that show in the accepted points: blow-up, growth, impasse, ringing.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "causes.h"
#include <math.h>
#include <steif/method.h>
#include <steif/table.h>
#include <string.h>

enum { POINTS = 12, LOOKED_AT = 48, RING = 10 };

/* Largest misfit of z = a + b t over the range of z; *root: where the line vanishes. */
static sunrealtype misfit(size_t count, const sunrealtype *t, const sunrealtype *z,
                          sunrealtype *root)
{
  sunrealtype mt = 0, mz = 0, tt = 0, tz = 0, low = INFINITY, high = -INFINITY, worst = 0;
  for (size_t k = 0; k < count; k++)
    mt += t[k] / (sunrealtype)count, mz += z[k] / (sunrealtype)count;
  for (size_t k = 0; k < count; k++) {
    tt += (t[k] - mt) * (t[k] - mt), tz += (t[k] - mt) * (z[k] - mz);
    low = fmin(low, z[k]), high = fmax(high, z[k]);
  }
  const sunrealtype slope = tz / tt;
  for (size_t k = 0; k < count; k++) worst = fmax(worst, fabs(z[k] - mz - slope * (t[k] - mt)));
  *root = mt - mz / slope;
  return high > low && slope < 0 ? worst / (high - low) : INFINITY;
}

/* -- blow-up ----------------------------------------------------------------------------- */

static const sunrealtype spacing = 2, least_growth = 250, blow_up_misfit = 0.05,
                         blow_up_distance = 1e-6;

/* Points backward from the last at which |y_j'| has fallen by `spacing` each time, but none so near the
 * end that the clock's rounding shows. */
static size_t collect(const steif_history *s, size_t n, size_t j, sunrealtype *t,
                      sunrealtype *x)
{
  const sunrealtype end = s->t[s->count - 1], near = 1e3 * STF_EPS * fabs(end);
  size_t count = 0;
  sunrealtype below = INFINITY;
  for (size_t k = s->count; k-- > 0 && count < 9;) {
    const sunrealtype now = fabs(s->yp[k * n + j]);
    if (!(now <= below) || fabs(end - s->t[k]) < near) continue;
    t[count] = s->t[k], x[count++] = now;
    below = now / spacing;
  }
  return count;
}

/* What blows up is larger than ever before, and than its tolerance: below, its slopes are rounding. */
static bool largest_now(const steif_history *s, size_t n, size_t j)
{
  const sunrealtype now = fabs(s->y[(s->count - 1) * n + j]);
  if (!s->prescribed && !(now > (s->atols ? s->atols[j] : s->atol))) return false;
  for (size_t k = 0; k + 1 < s->count; k++)
    if (fabs(s->y[k * n + j]) > now) return false;
  return true;
}

int stf_cause_blow_up(stf_search *c)
{
  const steif_history *s = c->scene;
  const size_t n = c->point->n;
  sunrealtype t[9], x[9], z[9], best = blow_up_misfit, T = NAN, alpha = 0, growth = 0;
  size_t at = n;
  for (size_t j = 0; j < n; j++) {
    if (collect(s, n, j, t, x) < 9 || !(x[0] > least_growth * x[8])) continue;
    if (!largest_now(s, n, j)) continue;
    for (int step = 0; step <= 15;
         step++) { /* to q = 1, a logarithm: what is above stays finite */
      const sunrealtype q = 0.25 + 0.05 * step;
      sunrealtype root;
      for (int k = 0; k < 9; k++) z[k] = pow(x[k] / x[0], -q);
      const sunrealtype now = misfit(9, t, z, &root);
      if (!(now < best) || !(fabs(root - t[0]) < blow_up_distance * fabs(t[0] - s->t0)))
        continue;
      best = now, T = root, alpha = 1 / q - 1, growth = x[0] / x[8], at = j;
    }
  }
  if (at == n) return STEIF_OK;
  char room[STEIF_SPEC_WORD];
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_BLOW_UP, cause->t = T, cause->unknown = (sunindextype)at;
  cause->value[0] = alpha, cause->value[1] = growth;
  stf_point_say(cause->message, "Solution blows up: %s grows like ",
                stf_point_unknown(c->point, at, room));
  if (fabs(alpha) < 0.03)
    stf_point_say(cause->message, "-log(T - t)");
  else
    stf_point_say(cause->message, "(T - t)^%.2f", -alpha);
  stf_point_say(cause->message,
                " with T = %.9g; it is %.4g at t = %.9g. Nothing is wrong with the solver: end "
                "before T.",
                T, c->point->y0[at], c->point->t);
  return STEIF_OK;
}

/* -- growth ------------------------------------------------------------------------------ */

/* Growth without a time at which it ends, as e^t: relative tolerances follow it, until numbers end. A step that is
 * prescribed may make it by itself. */
bool stf_cause_growth(stf_search *c)
{
  const sunrealtype much = 1e100;
  const steif_history *s = c->scene;
  const size_t n = c->point->n, last = s->count ? s->count - 1 : 0;
  size_t at = n;
  sunrealtype most = much;
  char room[STEIF_SPEC_WORD];
  for (size_t j = 0; j < n && s->count > 1 && !s->prescribed; j++) {
    const sunrealtype now = fabs(s->y[last * n + j]) / fmax(fabs(s->y[j]), 1);
    if (now > most) most = now, at = j;
  }
  if (at == n) return false;
  const sunrealtype y = s->y[last * n + at], tenfold = log(10) * fabs(y / s->yp[last * n + at]);
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_GROWTH, cause->unknown = (sunindextype)at;
  cause->value[0] = most, cause->value[1] = tenfold;
  const char *name = stf_point_unknown(c->point, at, room);
  stf_point_say(
    cause->message,
    "%s has grown from %.4g to %.4g, now tenfold in %.3g of time: numbers end at 1.8e308, and "
    "the steps before that are many. Nothing is wrong with the solver: end earlier, or solve "
    "for the logarithm of %s.",
    name, s->y[at], y, tenfold, name);
  return true;
}

/* -- impasse ----------------------------------------------------------------------------- */

static const sunrealtype beyond = 1e9, impasse_spacing = 1.3, impasse_growth = 30,
                         impasse_misfit = 0.2;

/* Largest entry of (s E - A)^{-1} in units of the first point; *row: of which unknown. */
static int inverse(stf_search *c, const stf_view *v, stf_factor *f, sunrealtype s,
                   const sunrealtype *unit, sunrealtype *largest, size_t *row)
{
  const size_t n = c->point->n;
  sunrealtype *x = c->point->scratch + 5 * n;
  *largest = 0;
  STEIF_TRY(stf_factor_shift(f, v, s));
  for (size_t i = 0; i < n; i++) {
    memset(x, 0, n * sizeof *x);
    x[i] = unit[i];
    STEIF_TRY(stf_factor_solve(f, false, x));
    for (size_t j = 0; j < n; j++)
      if (fabs(x[j]) / c->point->size[j] > *largest)
        *largest = fabs(x[j]) / c->point->size[j], *row = j;
  }
  return STEIF_OK;
}

typedef struct track {
  size_t count, row; /* points so far, newest first; unknown of the largest entry at the last */
  sunrealtype t[POINTS], N[POINTS];
} track;

/* Follow N backward through the history, keeping points where it fell by
 * `impasse_spacing`. */
static int follow(stf_search *c, stf_view *v, stf_factor *f, sunrealtype s,
                  const sunrealtype *unit, track *p)
{
  const steif_history *scene = c->scene;
  const size_t n = c->point->n;
  const sunindextype entries = v->column[n];
  size_t looked = 0, stride = 1, row = 0;
  for (size_t k = scene->count; k-- > 0 && looked < LOOKED_AT && p->count < POINTS; looked++) {
    sunrealtype N;
    const sunrealtype *y = scene->y + k * n, *yp = scene->yp + k * n;
    const int code = stf_view_take(c->point, scene->t[k], y, yp, v);
    if (code < 0) return code;
    if (code) return STEIF_OK;
    if (v->column[n] != entries) continue;
    const int singular = inverse(c, v, f, s, unit, &N, &row);
    if (singular && singular != STEIF_SINGULAR) return singular;
    if (singular || !isfinite(N)) continue;
    if (p->count == 0) p->row = row;
    if (p->count == 0 || N <= p->N[p->count - 1] / impasse_spacing)
      p->t[p->count] = scene->t[k], p->N[p->count++] = N;
    else if (looked > LOOKED_AT / 2) /* older points are looked at more thinly */
      stride *= 2;
    k = k > stride ? k - stride + 1 : 0;
  }
  return STEIF_OK;
}

/* Units of equations: their largest term at the rate s. */
static void units(const stf_point *s, const stf_view *v, sunrealtype rate, sunrealtype *unit)
{
  memset(unit, 0, s->n * sizeof *unit);
  for (size_t j = 0; j < s->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      unit[v->row[k]] =
        fmax(unit[v->row[k]], (fabs(v->b[k]) + rate * fabs(v->e[k])) * s->size[j]);
}

static void judge_impasse(stf_search *c, const track *p)
{
  sunrealtype z[POINTS], T;
  char room[STEIF_SPEC_WORD];
  if (p->count < 5 || !(p->N[0] > impasse_growth * p->N[p->count - 1])) return;
  for (size_t k = 0; k < p->count; k++) z[k] = pow(p->N[0] / p->N[k], 2);
  const sunrealtype off = misfit(p->count, p->t, z, &T);
  const sunrealtype ahead = fabs(p->t[0] - p->t[p->count - 1]);
  if (!(off < impasse_misfit) || !(fabs(T - p->t[0]) < ahead)) return;
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_IMPASSE, cause->t = T, cause->unknown = (sunindextype)p->row;
  cause->value[0] = p->N[0] / p->N[p->count - 1], cause->value[1] = off;
  stf_point_say(cause->message,
                "The equations stop having a solution near t = %.6g: %s turns back (the matrix "
                "that determines it vanishes like sqrt(T - t), down by %.2g). End before, or "
                "change the model there.",
                T, stf_point_unknown(c->point, p->row, room), cause->value[0]);
}

/* E and B at that of the last points with the most entries: where the run ended, what vanishes may be 0. */
static int take_fullest(stf_search *c, stf_view *v)
{
  enum { LAST = 4 };
  const steif_history *scene = c->scene;
  const size_t n = c->point->n;
  size_t best = scene->count;
  sunindextype most = 0;
  for (size_t k = scene->count; k-- > 0 && k + LAST >= scene->count;) {
    const int code =
      stf_view_take(c->point, scene->t[k], scene->y + k * n, scene->yp + k * n, v);
    if (code < 0) return code;
    if (!code && v->column[n] > most) most = v->column[n], best = k;
  }
  if (best == scene->count) return STEIF_RETRY;
  return stf_view_take(c->point, scene->t[best], scene->y + best * n, scene->yp + best * n, v);
}

int stf_cause_impasse(stf_search *c)
{
  stf_point *point = c->point;
  stf_view v = {0};
  stf_factor *f = NULL;
  track p = {0};
  sunrealtype slow, fast;
  if (c->scene->count < 5) return STEIF_OK;
  sunrealtype *unit = stf_allocate(point->ctx, point->n, sizeof *unit);
  int code = unit ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code) code = take_fullest(c, &v);
  if (!code) code = stf_factor_open(point, &v, &f);
  if (!code) {
    stf_view_rates(point, &v, &slow, &fast);
    units(point, &v, slow, unit);
    code = follow(c, &v, f, beyond * slow, unit, &p);
  }
  if (!code) judge_impasse(c, &p);
  stf_factor_free(&f);
  stf_view_free(point, &v);
  stf_release(point->ctx, unit);
  return code > 0 ? STEIF_OK : code;
}

/* -- ringing ----------------------------------------------------------------------------- */

/* Share of sign changes among the differences of y_j' of the last steps, of those that, times the step, are a
 * tenth of their mean or more: a switch that is crossed to and fro in ever shorter steps is no ringing. *size: that
 * mean in weights. */
static sunrealtype alternation(const stf_search *c, size_t j, sunrealtype *size)
{
  const steif_history *s = c->scene;
  const size_t n = c->point->n, from = s->count - RING - 2;
  sunrealtype part[RING + 1], mean = 0;
  int changes = 0;
  for (size_t k = 0; k <= RING; k++) {
    const size_t at = from + k;
    part[k] = (s->yp[(at + 1) * n + j] - s->yp[at * n + j]) * (s->t[at + 1] - s->t[at]);
    mean += fabs(part[k]) / (RING + 1);
  }
  for (int k = 1; k <= RING; k++)
    changes += part[k] * part[k - 1] < 0 && 10 * fabs(part[k]) >= mean;
  *size = mean / c->weight[j];
  return (sunrealtype)changes / RING;
}

/* Methods that damp do not ring: what does is something else. */
static bool damps(const stf_search *c)
{
  steif_method_info info = {0};
  return c->scene->method && !steif_method_find(c->point->ctx, c->scene->method, &info) &&
         (info.claims & STEIF_L_STABLE);
}

int stf_cause_ringing(stf_search *c)
{
  const size_t n = c->point->n;
  char room[STEIF_SPEC_WORD];
  sunrealtype most = 1, share = 0, size;
  size_t at = n;
  for (size_t j = 0; c->scene->count >= RING + 2 && j < n; j++) {
    const sunrealtype part = alternation(c, j, &size);
    if (part >= 0.8 && size > most) most = size, share = part, at = j;
  }
  if (at == n || damps(c)) return STEIF_OK;
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_RINGING, cause->unknown = (sunindextype)at;
  cause->value[0] = share, cause->value[1] = most;
  stf_point_say(cause->message,
                "%s rings: the sign of its slope changed in %d of %d steps, amplitude %.2g "
                "weights; %s does not damp stiff components. Use radau, or start on the slow "
                "solution.",
                stf_point_unknown(c->point, at, room), (int)lround(share * RING), RING, most,
                c->scene->method ? c->scene->method : "the method");
  return STEIF_OK;
}
