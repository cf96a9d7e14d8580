/* quadrature.c: integrals of g(t, y; p) along a run, and their derivatives by parameters.
 *
 * q is known at `t`, the end of what has been integrated. A whole step of a Runge-Kutta method is integrated by its
 * own weights, anything else by Gauss' formula along dense output. dg/dp_k along a solution is the derivative of g
 * along (S_k, e_k).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include <math.h>
#include <steif/quadrature.h>
#include <string.h>

enum { GAUSS = 6, MOST = 1000 };

struct stf_quadratures {
  const steif_quadrature *given;
  void *user;
  int count, columns;
  sunrealtype t;               /* q is that at t ... */
  sunrealtype *q, *dq;         /* count, and count for each column */
  sunrealtype *g, *other;      /* values */
  sunrealtype *shown, *before; /* sums asked for; g on the near side of an event */
  sunrealtype node[GAUSS], weight[GAUSS];
  N_Vector y, moved, S;
};

/* ---- opening ---------------------------------------------------------------------------------- */

/* Gauss' nodes and weights on [0, 1] by Newton's iteration from Chebyshev points. */
static void gauss(sunrealtype *node, sunrealtype *weight)
{
  const sunrealtype pi = 3.14159265358979323846;
  for (int i = 0; i < GAUSS; i++) {
    sunrealtype x = cos(pi * (i + 0.75) / (GAUSS + 0.5)), slope = 1;
    for (int round = 0; round < 20; round++) {
      sunrealtype a = 1, b = x;
      for (int k = 2; k <= GAUSS; k++) {
        const sunrealtype c = ((2 * k - 1) * x * b - (k - 1) * a) / k;
        a = b, b = c;
      }
      slope = GAUSS * (x * b - a) / (x * x - 1);
      x -= b / slope;
    }
    node[i] = (1 - x) / 2, weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
}

static int claim(steif_solver *s, stf_quadratures *w)
{
  const size_t m = (size_t)w->count, columns = (size_t)w->columns;
  N_Vector like = s->engine ? s->run.y : s->step.y;
  w->y = stf_pool_vector(s->pool, like);
  w->moved = stf_pool_vector(s->pool, like);
  w->S = stf_pool_vector(s->pool, like);
  w->q = stf_pool_array(s->pool, m, sizeof *w->q);
  w->g = stf_pool_array(s->pool, 4 * m, sizeof *w->g);
  w->dq = stf_pool_array(s->pool, m * (columns + 1), sizeof *w->dq);
  if (!w->y || !w->moved || !w->S || !w->q || !w->g || !w->dq) return STEIF_NO_MEMORY;
  w->other = w->g + m, w->shown = w->other + m, w->before = w->shown + m;
  return STEIF_OK;
}

int stf_quadrature_open(steif_solver *s)
{
  const steif_quadrature *given = s->problem->quadrature;
  s->quadratures = NULL;
  STEIF_CHECK(given || !s->options.test_quadratures, s->ctx, STEIF_BAD_INPUT,
              "test_quadratures is set, and problem '%s' has no quadrature", s->problem->name);
  if (!given) return STEIF_OK;
  STEIF_CHECK(given->count > 0 && given->count <= MOST && given->value, s->ctx, STEIF_BAD_INPUT,
              "the quadrature of problem '%s' has %d values%s: from 1 to %d with .value are "
              "needed",
              s->problem->name, given->count, given->value ? "" : " and no .value", MOST);
  STEIF_CHECK(!s->options.test_quadratures || (!s->engine && s->step.method->trial), s->ctx,
              STEIF_UNSUPPORTED,
              "'%s' does not test quadratures: take collocation (radau:s=3) or dirk:hw43",
              s->spec);
  stf_quadratures *w = stf_pool_array(s->pool, 1, sizeof *w);
  if (!w) return STEIF_NO_MEMORY;
  w->given = given, w->user = given->user ? given->user : s->problem->user;
  w->count = given->count, w->t = s->problem->t0;
  w->columns = !s->engine && s->step.carry ? s->step.carry->count : 0;
  gauss(w->node, w->weight);
  STEIF_TRY(claim(s, w));
  s->quadratures = w;
  return STEIF_OK;
}

/* ---- values ----------------------------------------------------------------------------------- */

static int value(steif_solver *s, sunrealtype t, N_Vector y, sunrealtype *g)
{
  const stf_quadratures *w = s->quadratures;
  const long failures = stf_failures(s->ctx);
  const int returned = w->given->value(t, y, g, w->user);
  if (returned && stf_failures(s->ctx) > failures) return steif_status(s->ctx); /* told */
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
              "the quadrature of problem '%s' returned %d at t = %.12g", s->problem->name,
              returned, t);
  for (int i = 0; i < w->count; i++)
    STEIF_CHECK(isfinite(g[i]), s->ctx, STEIF_NOT_FINITE,
                "value %d of the quadrature of problem '%s' is not finite at t = %.12g", i + 1,
                s->problem->name, t);
  return STEIF_OK;
}

/* y_j moves by a part of its size; j < 0: all of index 2 and 3 that are here. */
static void move(const steif_solver *s, N_Vector y, sunindextype j)
{
  sunindextype rows;
  const sunrealtype *from = stf_own_rows(y, &rows);
  sunrealtype *to = stf_own_rows(s->quadratures->moved, &rows);
  N_VScale(1, y, s->quadratures->moved);
  for (sunindextype i = j < 0 ? 0 : j; to && i < (j < 0 ? rows : j + 1); i++)
    if (i == j || s->problem->index[i] > 1)
      to[i] += 1.0 / 64 * (fabs(from[i]) + s->step.system.scale);
}

int stf_quadrature_reads(steif_solver *s, sunrealtype t, N_Vector y, sunindextype j, int *i)
{
  stf_quadratures *w = s->quadratures;
  STEIF_TRY(value(s, t, y, w->g));
  move(s, y, j);
  STEIF_TRY(value(s, t, w->moved, w->other));
  for (*i = 0; *i < w->count && w->g[*i] == w->other[*i];) ++*i;
  if (*i == w->count) *i = -1;
  return STEIF_OK;
}

/* g at y + x dy, p_k + x. */
static int value_along(steif_solver *s, sunrealtype t, N_Vector y, N_Vector dy, int k,
                       sunrealtype x, sunrealtype *g)
{
  const stf_quadratures *w = s->quadratures;
  const sunrealtype p = s->problem->parameters->value[k];
  N_VLinearSum(1, y, x, dy, w->moved);
  int code = stf_set_parameter(s, k, p + x);
  if (!code) code = value(s, t, w->moved, g);
  const int back = stf_set_parameter(s, k, p);
  return code ? code : back;
}

/* out = g_y dy + dg/dp_k. */
static int slope(steif_solver *s, sunrealtype t, N_Vector y, N_Vector dy, int k,
                 sunrealtype *out)
{
  const stf_quadratures *w = s->quadratures;
  const steif_parameters *q = s->problem->parameters;
  if (w->given->slope) {
    const long failures = stf_failures(s->ctx);
    const int returned = w->given->slope(t, y, dy, k, out, w->user);
    if (returned && stf_failures(s->ctx) > failures) return steif_status(s->ctx);
    STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK,
                "the slope of the quadrature of problem '%s' returned %d at t = %.12g",
                s->problem->name, returned, t);
    return STEIF_OK;
  }
  const sunrealtype typical = q->scale ? q->scale[k] : fabs(q->value[k]);
  const sunrealtype *from = stf_array(y), *along = stf_array(dy);
  sunrealtype most = 1 / (typical > 0 ? typical : 1);
  for (sunindextype i = 0; i < s->problem->n; i++)
    most = fmax(most, fabs(along[i]) / (fabs(from[i]) + s->step.system.scale));
  const sunrealtype x = cbrt(STF_EPS) / most;
  STEIF_TRY(value_along(s, t, y, dy, k, x, out));
  STEIF_TRY(value_along(s, t, y, dy, k, -x, w->other));
  for (int i = 0; i < w->count; i++) out[i] = (out[i] - w->other[i]) / (2 * x);
  return STEIF_OK;
}

/* ---- sums ------------------------------------------------------------------------------------- */

/* Column -1: q. Else the column of dq. */
static int add(steif_solver *s, sunrealtype t, N_Vector y, int column, sunrealtype factor,
               sunrealtype *sum)
{
  stf_quadratures *w = s->quadratures;
  const stf_carry *T = s->step.carry;
  if (column < 0)
    STEIF_TRY(value(s, t, y, w->g));
  else {
    STEIF_TRY(stf_column_dense(s, column, t, w->S));
    STEIF_TRY(slope(s, t, y, w->S, T->parameter[column], w->g));
  }
  for (int i = 0; i < w->count; i++) sum[i] += factor * w->g[i];
  return STEIF_OK;
}

/* sum += the integral from w->t to t along dense output of the last step. */
static int along(steif_solver *s, sunrealtype t, int column, sunrealtype *sum)
{
  stf_quadratures *w = s->quadratures;
  const sunrealtype h = t - w->t;
  for (int i = 0; i < GAUSS && h != 0; i++) {
    const sunrealtype at = w->t + w->node[i] * h;
    STEIF_TRY(stf_dense(s, at, w->y));
    STEIF_TRY(add(s, at, w->y, column, w->weight[i] * h, sum));
  }
  return STEIF_OK;
}

/* A step that ends at a break ends just before it, and so do its stages: g may jump there. */
static sunrealtype last_time(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const sunrealtype t = s->step.t;
  const bool breaks = s->next_break < p->break_count && t == p->breaks[s->next_break];
  return breaks && s->step.adaptive ? nextafter(t, -INFINITY) : t;
}

/* The same over the whole step by its stages; *served: there are some. */
static int by_stages(steif_solver *s, int column, sunrealtype *sum, bool *served)
{
  const stf_step *step = &s->step;
  const sunrealtype *c, *b = NULL;
  N_Vector *X;
  int count = 0;
  if (!s->engine && step->method->stages)
    STEIF_TRY(step->method->stages(step, &count, &c, &b, &X));
  *served = count > 0 && b;
  for (int i = 0; *served && i < count; i++)
    if (b[i] != 0)
      STEIF_TRY(add(s, fmin(step->t - step->h + c[i] * step->h, last_time(s)), X[i], column,
                    step->h * b[i], sum));
  return STEIF_OK;
}

static sunrealtype *sum_of(stf_quadratures *w, int column)
{
  return column < 0 ? w->q : w->dq + (size_t)column * (size_t)w->count;
}

int stf_quadrature_to(steif_solver *s, sunrealtype t)
{
  stf_quadratures *w = s->quadratures;
  for (int column = -1; column < w->columns; column++)
    STEIF_TRY(along(s, t, column, sum_of(w, column)));
  w->t = t;
  return STEIF_OK;
}

int stf_quadrature_step(steif_solver *s)
{
  stf_quadratures *w = s->quadratures;
  const stf_step *step = &s->step;
  const sunrealtype size = fmax(fabs(step->t), fabs(s->t1)); /* constant steps count from t1 */
  const bool whole =
    !s->engine && s->end == step->t && fabs(step->t - step->h - w->t) <= 8 * STF_EPS * size;
  for (int column = -1; column < w->columns; column++) {
    bool served = false;
    if (whole) STEIF_TRY(by_stages(s, column, sum_of(w, column), &served));
    if (!served) STEIF_TRY(along(s, s->end, column, sum_of(w, column)));
  }
  w->t = s->end;
  return stf_quadrature_orders(s);
}

/* ---- test ------------------------------------------------------------------------------------- */

/* Weights of the polynomial through 0 and the nodes c but the last, all different, which is of lower order than the
 * method: of 0 in weight[0], of c_j in weight[j + 1]. */
static void interpolatory(const stf_quadratures *w, int count, const sunrealtype *c,
                          sunrealtype *weight)
{
  sunrealtype node[STEIF_STAGES + 1] = {0}, value_of[STEIF_STAGES + 1];
  int at[STEIF_STAGES + 1] = {0}, nodes = 1;
  for (int j = 0; j + 1 < count; j++) {
    bool seen = false;
    for (int i = 0; i < nodes; i++) seen = seen || c[j] == node[i];
    if (!seen) node[nodes] = c[j], at[nodes++] = j + 1;
  }
  for (int j = 0; j <= count; j++) weight[j] = 0;
  for (int i = 0; i < GAUSS; i++) {
    stf_interpolate(nodes - 1, node, w->node[i], value_of);
    for (int j = 0; j < nodes; j++) weight[at[j]] += w->weight[i] * value_of[j];
  }
}

int stf_quadrature_test(steif_solver *s, sunrealtype h, sunrealtype *e)
{
  stf_quadratures *w = s->quadratures;
  const stf_step *step = &s->step;
  const sunrealtype *c, *b;
  sunrealtype weight[STEIF_STAGES + 1], sum = 0;
  N_Vector *X;
  int count = 0;
  STEIF_TRY(step->method->trial(step, &count, &c, &b, &X));
  interpolatory(w, count, c, weight);
  memset(w->shown, 0, (size_t)w->count * sizeof *w->shown);
  STEIF_TRY(add(s, step->t, step->y, -1, -h * weight[0], w->shown));
  for (int j = 0; j < count; j++)
    if (b[j] != 0 || weight[j + 1] != 0)
      STEIF_TRY(add(s, step->t + c[j] * h, X[j], -1, h * (b[j] - weight[j + 1]), w->shown));
  for (int i = 0; i < w->count; i++) {
    const sunrealtype part = w->shown[i] / (s->options.rtol * fabs(w->q[i]) + s->options.atol);
    sum += part * part / w->count;
  }
  *e = fmax(*e, sqrt(sum));
  return STEIF_OK;
}

/* ---- events ----------------------------------------------------------------------------------- */

int stf_quadrature_before(steif_solver *s, sunrealtype t, N_Vector y)
{
  return s->quadratures ? value(s, nextafter(t, -INFINITY), y, s->quadratures->before)
                        : STEIF_OK;
}

/* The integral up to the event is added by stf_quadrature_step. */
int stf_quadrature_after(steif_solver *s, sunrealtype t, N_Vector y, const sunrealtype *tau)
{
  stf_quadratures *w = s->quadratures;
  if (!w) return STEIF_OK;
  STEIF_TRY(value(s, nextafter(t, INFINITY), y, w->g));
  for (int column = 0; column < w->columns; column++)
    for (int i = 0; i < w->count; i++)
      sum_of(w, column)[i] += (w->before[i] - w->g[i]) * tau[column];
  return STEIF_OK;
}

/* ---- what is shown ---------------------------------------------------------------------------- */

static int inside(const steif_solver *s, sunrealtype t, const sunrealtype *out)
{
  const sunrealtype h = s->engine ? s->run.stats.h_last : s->step.h;
  const sunrealtype slack = 1e-12 * (fabs(s->end) + h);
  STEIF_CHECK(out && t >= s->quadratures->t - h - slack && t <= s->end + slack, s->ctx,
              STEIF_BAD_INPUT, "t = %.17g lies outside the last step, which ends at %.17g", t,
              s->end);
  return STEIF_OK;
}

static int show(steif_solver *s, sunrealtype t, int column, sunrealtype *out)
{
  stf_quadratures *w = s->quadratures;
  STEIF_TRY(stf_agreed_begin(s, inside(s, t, out), "steif_quadrature_values", t));
  memcpy(out, sum_of(w, column), (size_t)w->count * sizeof *out);
  return t == w->t ? STEIF_OK : along(s, t, column, out);
}

static int has(const steif_solver *s)
{
  if (!s) return STEIF_BAD_INPUT;
  STEIF_CHECK(s->quadratures, s->ctx, STEIF_BAD_INPUT, "problem '%s' has no quadrature",
              s->problem->name);
  return STEIF_OK;
}

int steif_quadrature_values(steif_solver *s, sunrealtype t, sunrealtype *q)
{
  STEIF_TRY(has(s));
  return show(s, t, -1, q);
}

int steif_quadrature_sensitivity(steif_solver *s, sunrealtype t, int k, sunrealtype *dq)
{
  int i = 0;
  STEIF_TRY(has(s));
  STEIF_CHECK(!s->engine || !s->run.columns.count, s->ctx, STEIF_UNSUPPORTED,
              "'%s' carries no integrals beside derivatives by parameters: take radau:s=3 for "
              "the quadrature of problem '%s' (--functional)",
              s->spec, s->problem->name);
  STEIF_TRY(stf_column(s, k, &i));
  return show(s, t, i, dq);
}
