/* fit.c: parameters by least squares: what is asked is looked at, descents are made, the best one is kept.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descent.h"
#include <limits.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is asked --------------------------------------------------------------------------- */

static int check_datum(const stf_descent *d, size_t j)
{
  const steif_measurements *data = d->data;
  const steif_problem *p = d->problem;
  const sunrealtype t1 = stf_fit_end(p, d->run.t1), t = data->t[j];
  STEIF_CHECK(isfinite(t) && isfinite(data->value[j]), d->ctx, STEIF_NOT_FINITE,
              "measurement %zu is %g at t = %g and must be finite", j + 1, data->value[j], t);
  STEIF_CHECK(t >= p->t0 && t <= t1, d->ctx, STEIF_BAD_INPUT,
              "measurement %zu at t = %.9g lies outside the interval [%.9g, %.9g] of problem "
              "'%s': raise options.run->t1",
              j + 1, t, p->t0, t1, p->name);
  const long long most = (long long)p->n + (long long)stf_fit_outputs(p);
  STEIF_CHECK(data->component[j] >= 0 && data->component[j] < most, d->ctx, STEIF_BAD_INPUT,
              "measurement %zu is of component %lld, and problem '%s' has 0 .. %lld", j + 1,
              (long long)data->component[j], p->name, most - 1);
  STEIF_CHECK(!data->sd || (data->sd[j] > 0 && isfinite(data->sd[j])), d->ctx, STEIF_BAD_INPUT,
              "the standard deviation %g of measurement %zu must be positive", data->sd[j],
              j + 1);
  return STEIF_OK;
}

static int check_parameter(const stf_descent *d, int i)
{
  char room[STEIF_SPEC_WORD];
  const int count = d->problem->parameters->count, k = d->parameter[i];
  STEIF_CHECK(k >= 0 && k < count, d->ctx, STEIF_BAD_INPUT,
              "parameter[%d] = %d must lie in 0 .. %d", i, k, count - 1);
  const char *name = stf_fit_name(d, i, room);
  for (int j = 0; j < i; j++)
    STEIF_CHECK(d->parameter[j] != k, d->ctx, STEIF_BAD_INPUT, "parameter %s is named twice",
                name);
  STEIF_CHECK(isfinite(d->p0[i]), d->ctx, STEIF_NOT_FINITE,
              "the start value %g of %s must be finite", d->p0[i], name);
  STEIF_CHECK(d->low[i] < d->high[i], d->ctx, STEIF_BAD_INPUT,
              "the bounds %g and %g of %s must ascend", d->low[i], d->high[i], name);
  STEIF_CHECK(d->p0[i] >= d->low[i] && d->p0[i] <= d->high[i], d->ctx, STEIF_BAD_INPUT,
              "the start value %g of %s lies outside its bounds %g and %g", d->p0[i], name,
              d->low[i], d->high[i]);
  return STEIF_OK;
}

/* theta = log p wherever it can be. */
static int choose_scale(stf_descent *d, const steif_fit_options *o)
{
  const int scale = (int)o->scale;
  bool positive = true;
  STEIF_CHECK(scale >= STEIF_FIT_AUTO && scale <= STEIF_FIT_LINEAR, d->ctx, STEIF_BAD_INPUT,
              "options.scale = %d is none of STEIF_FIT_AUTO, STEIF_FIT_LOG and "
              "STEIF_FIT_LINEAR",
              scale);
  for (int i = 0; i < d->P; i++)
    positive &= d->p0[i] > 0 && (d->low[i] == -INFINITY || d->low[i] > 0);
  STEIF_CHECK(positive || o->scale != STEIF_FIT_LOG, d->ctx, STEIF_BAD_INPUT,
              "logarithms of parameters need start values and bounds above 0: take the linear "
              "scale");
  d->log = positive && o->scale != STEIF_FIT_LINEAR;
  return STEIF_OK;
}

static int check(stf_descent *d, const steif_fit_options *o)
{
  STEIF_CHECK(d->data->count >= (size_t)d->P, d->ctx, STEIF_BAD_INPUT,
              "%zu measurements do not determine %d parameters: fit fewer, or measure more",
              d->data->count, d->P);
  STEIF_CHECK(d->data->count < INT_MAX / ((size_t)d->P + 1), d->ctx, STEIF_BAD_INPUT,
              "%zu measurements are too many", d->data->count);
  STEIF_CHECK(o->starts >= 0 && o->evaluations >= 0, d->ctx, STEIF_BAD_INPUT,
              "starts = %d and evaluations = %d must not be negative", o->starts,
              o->evaluations);
  for (int i = 0; i < d->P; i++) STEIF_TRY(check_parameter(d, i));
  for (size_t j = 0; j < d->data->count; j++) STEIF_TRY(check_datum(d, j));
  return choose_scale(d, o);
}

/* ---- opening --------------------------------------------------------------------------------- */

static int by_time(const void *a, const void *b)
{
  const stf_datum *u = a, *v = b;
  return u->t != v->t ? (u->t > v->t) - (u->t < v->t)
                      : (u->place > v->place) - (u->place < v->place);
}

static sunrealtype *copy(stf_descent *d, const sunrealtype *from, sunrealtype otherwise)
{
  sunrealtype *to = stf_pool_array(d->pool, (size_t)d->P, sizeof *to);
  for (int i = 0; to && i < d->P; i++) to[i] = from ? from[i] : otherwise;
  return to;
}

static int name_parameters(stf_descent *d, const steif_fit_options *o)
{
  const steif_parameters *q = d->problem->parameters;
  STEIF_CHECK(q && q->count > 0 && q->value, d->ctx, STEIF_BAD_INPUT,
              "problem '%s' has no parameters: set .parameters", d->problem->name);
  STEIF_CHECK(!o->parameter || o->count > 0, d->ctx, STEIF_BAD_INPUT,
              "options.count = %d must be positive", o->count);
  STEIF_CHECK(o->parameter || o->count == 0 || o->count == q->count, d->ctx, STEIF_BAD_INPUT,
              "options.count = %d without options.parameter: name the parameters, or set 0 for "
              "all %d of them",
              o->count, q->count);
  d->P = o->parameter ? o->count : q->count;
  int *parameter = stf_pool_array(d->pool, (size_t)d->P, sizeof *parameter);
  if (!parameter) return STEIF_NO_MEMORY;
  for (int i = 0; i < d->P; i++) parameter[i] = o->parameter ? o->parameter[i] : i;
  d->parameter = parameter;
  d->p0 = copy(d, o->start, 0), d->p = copy(d, NULL, 0), d->at = copy(d, NULL, 0);
  d->from = copy(d, NULL, 0), d->column = copy(d, NULL, 0);
  d->fate = stf_pool_array(d->pool, (size_t)d->P, sizeof *d->fate);
  d->low = copy(d, o->low, -INFINITY), d->high = copy(d, o->high, INFINITY);
  d->values = stf_pool_array(d->pool, (size_t)q->count, sizeof *d->values);
  sunrealtype *unit = copy(d, NULL, 1);
  if (!d->from || !d->column || !d->fate || !d->p0 || !d->p || !d->at || !d->low || !d->high ||
      !d->values || !unit)
    return STEIF_NO_MEMORY;
  memcpy(d->values, q->value, (size_t)q->count * sizeof *q->value);
  for (int i = 0; i < d->P; i++) {
    const int k = parameter[i];
    if (k < 0 || k >= q->count) continue; /* told by check */
    if (!o->start) d->p0[i] = q->value[k];
    const sunrealtype typical = q->scale ? q->scale[k] : fabs(d->p0[i]);
    unit[i] = typical > 0 ? typical : 1;
  }
  d->unit = unit;
  return STEIF_OK;
}

/* Room for outputs, where some are measured. */
static int open_outputs(stf_descent *d)
{
  for (size_t j = 0; j < d->data->count && !d->outputs; j++)
    if (d->data->component[j] >= d->problem->n) d->outputs = stf_fit_outputs(d->problem);
  if (!d->outputs) return STEIF_OK;
  const size_t parameters = (size_t)d->problem->parameters->count;
  d->output = stf_pool_array(d->pool, d->outputs, sizeof *d->output);
  d->slope = stf_pool_array(d->pool, d->outputs, sizeof *d->slope);
  d->toward = stf_pool_array(d->pool, parameters, sizeof *d->toward);
  return d->output && d->slope && d->toward ? STEIF_OK : STEIF_NO_MEMORY;
}

static int sort(stf_descent *d)
{
  const size_t m = d->data->count;
  d->sorted = stf_pool_array(d->pool, m, sizeof *d->sorted);
  d->r = stf_pool_array(d->pool, m, sizeof *d->r);
  d->J = stf_pool_array(d->pool, m * (size_t)d->P, sizeof *d->J);
  d->best = stf_pool_array(d->pool, (size_t)d->P + m * ((size_t)d->P + 1), sizeof *d->best);
  d->least = INFINITY;
  N_Vector like = N_VNewEmpty_Serial(d->problem->n, steif_sundials(d->ctx));
  d->S = like ? stf_pool_vector(d->pool, like) : NULL;
  if (like) N_VDestroy(like);
  if (!d->sorted || !d->r || !d->J || !d->best || !d->S) return STEIF_NO_MEMORY;
  for (size_t j = 0; j < m; j++) d->sorted[j] = (stf_datum){d->data->t[j], j};
  qsort(d->sorted, m, sizeof *d->sorted, by_time);
  return STEIF_OK;
}

static int open(stf_descent *d, const steif_fit_options *o)
{
  STEIF_CHECK(d->data && d->data->count > 0 && d->data->t && d->data->value &&
                d->data->component,
              d->ctx, STEIF_BAD_INPUT, "there are no measurements");
  STEIF_TRY(name_parameters(d, o));
  d->run = o->run ? *o->run : steif_defaults();
  if (!o->run) d->run.rtol = 1e-8;
  if (d->run.rtol == 0) d->run.rtol = 1e-6;
  STEIF_TRY(check(d, o));
  STEIF_TRY(sort(d));
  STEIF_TRY(open_outputs(d));
  d->run.sensitivities = 1, d->run.active = d->parameter, d->run.active_count = d->P;
  if (d->sorted[d->data->count - 1].t > d->problem->t0)
    d->run.t1 = d->sorted[d->data->count - 1].t;
  d->evaluations = o->evaluations ? o->evaluations : 200;
  return STEIF_OK;
}

/* ---- several descents ------------------------------------------------------------------------ */

static const int primes[] = {2,  3,  5,  7,  11, 13, 17, 19, 23, 29, 31,  37,  41,  43,  47,
                             53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109, 113};

/* Digits of k in base b, mirrored at the point. Beyond the thirtieth parameter the primes come again, further on. */
static sunrealtype mirrored(long k, int b)
{
  sunrealtype x = 0, weight = 1;
  for (; k; k /= b) x += (sunrealtype)(k % b) * (weight /= b);
  return x;
}

static void begin_at(stf_descent *d, const sunrealtype *start, int descent)
{
  const int known = (int)(sizeof primes / sizeof *primes);
  for (int i = 0; i < d->P; i++) {
    const sunrealtype u = mirrored(descent + 409L * (i / known), primes[i % known]);
    sunrealtype a = d->low[i], b = d->high[i];
    if (a == -INFINITY)
      a = d->log ? fmin(start[i], b) / 10 : fmin(start[i], b) - 10 * d->unit[i];
    if (b == INFINITY)
      b = d->log ? fmax(start[i], a) * 10 : fmax(start[i], a) + 10 * d->unit[i];
    d->p0[i] = descent == 0 ? start[i] : d->log ? a * pow(b / a, u) : a + u * (b - a);
  }
}

/* A search that was stopped, from outside or by max_seconds, ends with the best run it made. */
static int cut_short(stf_descent *d, steif_fit *f, int code)
{
  if (!isfinite(d->least) || (code != STEIF_STOPPED && code != STEIF_TIME_LIMIT)) return code;
  stf_fit_recall(d);
  d->failed--; /* the run that was stopped */
  f->best = d->best_descent, f->chi2 = d->least, f->exhausted = code;
  for (int k = d->descent; k < f->starts; k++) f->chi2_of[k] = INFINITY;
  f->chi2_of[f->best] = d->least;
  if (f->best == d->descent) f->iterations = d->iterations;
  return STEIF_OK;
}

static int descend_all(stf_descent *d, steif_fit *f)
{
  sunrealtype *start = copy(d, d->p0, 0), *best = copy(d, d->p0, 0);
  if (!start || !best) return STEIF_NO_MEMORY;
  f->best = -1, f->chi2 = INFINITY;
  long blocked = 0;
  for (int k = 0; k < f->starts; k++) {
    const long failed = d->failed;
    int exhausted;
    begin_at(d, start, k);
    d->descent = k;
    const int code = stf_fit_descend(d, &exhausted);
    if (code < 0) return cut_short(d, f, code);
    f->chi2_of[k] = code ? INFINITY : d->chi2;
    if (code || !(d->chi2 < f->chi2)) continue;
    f->best = k, f->chi2 = d->chi2, f->exhausted = exhausted, f->iterations = d->iterations;
    blocked = d->failed - failed;
    memcpy(best, d->p0, (size_t)d->P * sizeof *best);
  }
  if (f->best < 0) return steif_status(d->ctx); /* the sentence of the last run */
  begin_at(d, start, f->best);
  memcpy(d->from, d->p0, (size_t)d->P * sizeof *best);
  memcpy(d->p0, best, (size_t)d->P * sizeof *best);
  memset(best, 0, (size_t)d->P * sizeof *best);
  d->blocked = blocked;
  int code = stf_fit_run(d, best);
  if (!code && !f->exhausted) code = stf_fit_look_around(d);
  return code == STEIF_RETRY ? cut_short(d, f, steif_status(d->ctx)) : code;
}

/* ---- the result ------------------------------------------------------------------------------ */

static sunrealtype *room(stf_pool *pool, size_t count)
{
  return stf_pool_array(pool, count, sizeof(sunrealtype));
}

/* The arrays of the result, in a pool of its own. */
static int prepare(stf_descent *d, const steif_fit_options *o, steif_fit *f)
{
  const size_t P = (size_t)d->P;
  stf_pool *pool = stf_pool_new(d->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  f->reserved[0] = pool;
  f->count = d->P, f->log = d->log, f->residuals = d->data->count;
  f->starts = o->starts > 0 ? o->starts : 1;
  sunrealtype **const array[] = {
    &f->p,         &f->sd,         &f->low,         &f->high,
    &f->singular,  &f->covariance, &f->correlation, &f->covariance_theta,
    &f->direction, &f->residual,   &f->chi2_of};
  const size_t S = P * P, size[] = {P, P, P, P, P, S, S, S, S, f->residuals, (size_t)f->starts};
  for (size_t i = 0; i < sizeof array / sizeof *array; i++)
    if (!(*array[i] = room(pool, size[i]))) return STEIF_NO_MEMORY;
  f->bound = stf_pool_array(pool, P, sizeof *f->bound);
  return f->bound ? STEIF_OK : STEIF_NO_MEMORY;
}

static int find(stf_descent *d, const steif_fit_options *o, steif_fit *f)
{
  STEIF_TRY(open(d, o));
  STEIF_TRY(prepare(d, o, f));
  const int code = descend_all(d, f);
  f->runs = d->runs, f->failed = d->failed;
  memcpy(f->failure, d->failure, sizeof f->failure);
  memcpy(f->used, d->used, sizeof f->used);
  if (!code) STEIF_TRY(stf_fit_judge(d, f));
  if (!code) stf_fit_say(d, f);
  return code;
}

int steif_fit_find(steif_context *ctx, steif_problem *problem, const char *method,
                   const steif_measurements *data, const steif_fit_options *options,
                   steif_fit *fit)
{
  const steif_fit_options none = {0};
  STEIF_CHECK(fit, ctx, STEIF_BAD_INPUT, "no place for the fit: it is NULL");
  *fit = (steif_fit){0};
  if (!ctx) return STEIF_BAD_INPUT;
  STEIF_CHECK(problem && method && data, ctx, STEIF_BAD_INPUT,
              "a problem, a method and measurements are needed, got NULL");
  stf_descent d = {.ctx = ctx, .problem = problem, .method = method, .data = data};
  if (!(d.pool = stf_pool_new(ctx))) return STEIF_NO_MEMORY;
  const char *name = problem->name;
  if (!name) problem->name = "unnamed"; /* in messages */
  int code = find(&d, options ? options : &none, fit);
  if (d.values) {
    const int restored = stf_fit_restore(&d);
    if (!code) code = restored;
  }
  problem->name = name;
  stf_pool_free(&d.pool);
  if (code) steif_fit_free(ctx, fit);
  STEIF_TRY(code);
  STEIF_CHECK(fit->exhausted >= 0, ctx, fit->exhausted, "%s", fit->message);
  STEIF_CHECK(!fit->exhausted, ctx, STEIF_NO_CONVERGENCE, "%s", fit->message);
  steif_forget(ctx);
  return STEIF_OK;
}

void steif_fit_free(steif_context *ctx, steif_fit *fit)
{
  (void)ctx;
  if (!fit) return;
  stf_pool *pool = fit->reserved[0];
  stf_pool_free(&pool);
  *fit = (steif_fit){0};
}
