/* parameters.c: derivatives of the residual and of the start by parameters.
 *
 * A difference moves p_k by eps^(1/3) of its scale: truncation and rounding of the quotient are then both
 * of the order eps^(2/3), where F is smooth over such a length. That is looked at in the first evaluation, the 4th and the
 * 16th, and then in one of 64 (slope_length.h).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include "slope_length.h"
#include <math.h>
#include <steif/parameters.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* What the residual at other parameters is computed with. */
typedef struct stf_slopes {
  steif_context *ctx;
  const steif_problem *problem;
  int form;
  sunrealtype t;
  N_Vector y, yp, work, other;
  SUNMatrix M;
  N_Vector now, half, bar, moved; /* where differences are looked at */
  long *count;                    /* of differences by each parameter; NULL: one alone */
  sunrealtype *length;            /* of each; 0: the increment */
} point;

enum { OFTEN = 64 };

/* ---- the residual ----------------------------------------------------------------------------- */

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static int open_matrix(point *at, stf_pool *pool)
{
  const steif_problem *p = at->problem;
  SUNContext sun = steif_sundials(at->ctx);
  const sunindextype room = p->nnz > p->nnz_E ? p->nnz : p->nnz_E;
  if (at->form == STEIF_ODE || at->form == STEIF_IMPLICIT || p->storage == STEIF_KRYLOV)
    return STEIF_OK;
  at->M = p->storage == STEIF_DENSE ? SUNDenseMatrix(p->n, p->n, sun)
          : p->storage == STEIF_BAND
            ? SUNBandMatrix(p->n, p->upper, p->lower, sun)
            : SUNSparseMatrix(p->n, p->n, room > 1 ? room : 1, CSC_MAT, sun);
  STEIF_CHECK(at->M, at->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)p->n);
  return stf_pool_adopt(pool, at->M, destroy_matrix);
}

/* work = E x or A x. */
static int times(const point *at, steif_matrix_fill fill, steif_product product, N_Vector x)
{
  const steif_problem *p = at->problem;
  if (!at->M || !fill)
    return product ? product(at->t, at->y, at->yp, x, at->work, p->user) : -1;
  if (SUNMatGetID(at->M) != SUNMATRIX_SPARSE) SUNMatZero(at->M);
  const int returned = fill(at->t, at->y, at->yp, at->M, p->user);
  return returned ? returned : SUNMatMatvec(at->M, x, at->work) ? -1 : 0;
}

static int residual(const point *at, N_Vector r)
{
  const steif_problem *p = at->problem;
  if (at->form == STEIF_IMPLICIT) return p->F(at->t, at->y, at->yp, r, p->user);
  N_VConst(0, r);
  int code = at->form != STEIF_DESCRIPTOR ? p->f(at->t, at->y, r, p->user)
             : p->g                       ? p->g(at->t, 0, r, p->user)
                                          : 0;
  if (code) return code;
  if (at->form == STEIF_DESCRIPTOR) {
    code = times(at, p->A, p->Av, at->y);
    N_VLinearSum(1, r, 1, at->work, r);
  }
  if (!code && at->form != STEIF_ODE) code = times(at, p->E, p->Ev, at->yp);
  N_VLinearSum(1, at->form == STEIF_ODE ? at->yp : at->work, -1, r, r);
  return code;
}

/* ---- differences ------------------------------------------------------------------------------ */

sunrealtype stf_slopes_increment(const steif_parameters *q, int k)
{
  const sunrealtype typical = q->scale ? fabs(q->scale[k]) : fabs(q->value[k]);
  return cbrt(STF_EPS) * (typical > 0 ? typical : 1);
}

/* what(p_k = value) into out. */
static int with(const steif_parameters *q, int k, sunrealtype value,
                int (*what)(const point *at, N_Vector out), const point *at, N_Vector out)
{
  const sunrealtype p = q->value[k];
  q->value[k] = value;
  int code = q->moved ? q->moved(at->problem->user) : 0;
  if (!code) code = what(at, out);
  q->value[k] = p;
  return q->moved && q->moved(at->problem->user) ? -1 : code;
}

/* What is differentiated: a function of p_k. */
typedef struct difference {
  const point *at;
  int k;
  int (*what)(const point *at, N_Vector out);
} difference;

/* Values on both sides, or on one and here: their quotient. */
static int quotient(sunrealtype d, N_Vector out, void *user)
{
  const difference *f = user;
  const point *at = f->at;
  const steif_parameters *q = at->problem->parameters;
  N_Vector other = at->other;
  const sunrealtype p = q->value[f->k];
  volatile sunrealtype up = p + d, down = p - d;
  int code = with(q, f->k, up, f->what, at, out);
  if (code > 0) code = with(q, f->k, up = p, f->what, at, out);
  if (!code) code = with(q, f->k, down, f->what, at, other);
  if (code > 0 && up > p) code = with(q, f->k, down = p, f->what, at, other);
  if (!code) N_VLinearSum(1 / (up - down), out, -1 / (up - down), other, out);
  return code;
}

/* What some units of rounding of y and y' make of the function, and those of its values. */
static int noise(N_Vector bar, void *user)
{
  const difference *f = user;
  point moved = *f->at;
  const sunrealtype units = 8 * STF_EPS;
  int code = f->what(f->at, bar);
  if (code) return code;
  if (moved.y) {
    N_VScale(1 + units, moved.y, moved.now), N_VScale(1 - units, moved.yp, moved.moved);
    moved.y = moved.now, moved.yp = moved.moved;
  }
  code = f->what(&moved, moved.other);
  sunrealtype *b = stf_array(bar);
  const sunrealtype *c = stf_array(moved.other);
  for (sunindextype i = 0; i < N_VGetLength(bar); i++)
    b[i] = fabs(b[i] - c[i]) + units * fabs(b[i]);
  return code;
}

/* No length can be trusted. */
static int sharp(const difference *f, const stf_trusted *found, sunrealtype d)
{
  const steif_problem *p = f->at->problem;
  const steif_parameters *q = p->parameters;
  const char *name = q->name ? q->name[f->k] : NULL;
  char row[STEIF_SPEC_WORD];
  return STEIF_FAIL(f->at->ctx, STEIF_UNSUPPORTED,
                    "the derivative of problem '%s' by parameter %d%s%.40s%s = %.12g cannot be "
                    "had by differences: over "
                    "p -+ %.3g and half of that they are %.6g and %.6g in equation %s at t = "
                    "%.12g, and shorter ones agree "
                    "no better before they drown in rounding: give parameters.dFdp, or write "
                    "the problem as a model",
                    p->name, f->k + 1, name ? " ('" : "", name ? name : "", name ? "')" : "",
                    q->value[f->k], d, found->quotient[0], found->quotient[1],
                    stf_equation(p, found->component, row), f->at->t);
}

/* out is the quotient over d. */
static int look(const difference *f, sunrealtype d, N_Vector out)
{
  const point *at = f->at;
  stf_trusted found;
  const sunrealtype p = at->problem->parameters->value[f->k];
  const stf_quotients q = {.length = d,
                           .least = 64 * STF_EPS * fabs(p),
                           .quotient = quotient,
                           .noise = noise,
                           .user = (void *)f,
                           .now = at->now,
                           .half = at->half,
                           .bar = at->bar};
  const int code = stf_trust(&q, out, &found);
  if (code) return code < 0 ? code : 0; /* shorter ones cannot be evaluated */
  if (found.length == 0) return sharp(f, &found, d);
  if (at->length) at->length[f->k] = found.length;
  return found.length < d ? quotient(found.length, out, (void *)f) : 0;
}

static bool due(const point *at, int k)
{
  const long count = at->count ? at->count[k]++ : 0;
  return at->bar && (count % OFTEN == 0 || count == 3 || count == 15);
}

/* what(p) is differentiated by p_k. */
static int differ(const steif_parameters *q, int k, int (*what)(const point *at, N_Vector out),
                  const point *at, N_Vector out)
{
  const sunrealtype d = stf_slopes_increment(q, k);
  const bool looks = due(at, k);
  const bool known = !looks && at->length && at->length[k] > 0;
  difference f = {at, k, what};
  const int code = quotient(known ? at->length[k] : d, out, &f);
  return code || !looks ? code : look(&f, d, out);
}

static int start_values(const point *at, N_Vector out)
{
  return at->problem->start(at->problem->t0, out, at->work, at->problem->user);
}

/* ---- calls -------------------------------------------------------------------------- */

/* A failure of the library in the callback, of which there have been more than `before`, is told by it. */
static int told(steif_context *ctx, const steif_problem *p, int returned, int k, long before)
{
  if (!returned) return STEIF_OK;
  if (stf_failures(ctx) > before) return returned > 0 ? STEIF_RETRY : steif_status(ctx);
  if (returned > 0)
    return STEIF_RECOVER(
      ctx, STEIF_CALLBACK,
      "the derivative of problem '%s' by parameter %d could not be evaluated "
      "(a callback returned %d)",
      p->name, k, returned);
  return STEIF_FAIL(
    ctx, STEIF_CALLBACK,
    "the derivative of problem '%s' by parameter %d failed: a callback returned %d", p->name, k,
    returned);
}

static int claim(point *at, stf_pool *pool, N_Vector like)
{
  at->other = stf_pool_vector(pool, like);
  at->work = stf_pool_vector(pool, like);
  if (!at->other || !at->work) return STEIF_NO_MEMORY;
  N_Vector *const more[] = {&at->now, &at->half, &at->moved, &at->bar};
  const steif_parameters *q = at->problem->parameters;
  for (int i = 0; i < 4 && stf_array(like) && q && !q->dFdp; i++)
    if (!(*more[i] = stf_pool_vector(pool, like))) return STEIF_NO_MEMORY;
  return open_matrix(at, pool);
}

/* A derivative by differences of `what`, with memory of its own. */
static int by_differences(point *at, int k, int (*what)(const point *at, N_Vector out),
                          N_Vector out)
{
  const long before = stf_failures(at->ctx);
  stf_pool *pool = stf_pool_new(at->ctx);
  int code = pool ? claim(at, pool, out) : STEIF_NO_MEMORY;
  if (!code)
    code =
      told(at->ctx, at->problem, differ(at->problem->parameters, k, what, at, out), k, before);
  stf_pool_free(&pool);
  return code;
}

int steif_parameter_slope(steif_context *ctx, const steif_problem *p, int k, sunrealtype t,
                          N_Vector y, N_Vector yp, N_Vector out)
{
  STF_NAMED(p);
  STEIF_TRY(stf_parameter_check(ctx, p, k));
  STEIF_CHECK(y && yp && out, ctx, STEIF_BAD_INPUT, "y, yp and out are needed, got NULL");
  const long before = stf_failures(ctx);
  point at = {.ctx = ctx, .problem = p, .t = t, .y = y, .yp = yp};
  if (p->parameters->dFdp) {
    STEIF_TRY(told(ctx, p, p->parameters->dFdp(t, y, yp, k, out, p->user), k, before));
  } else {
    at.form = steif_problem_form(ctx, p);
    if (!at.form) return steif_status(ctx);
    STEIF_TRY(by_differences(&at, k, residual, out));
  }
  return stf_not_finite(out) < 0 ? STEIF_OK : stf_slopes_not_finite(&at, k, t, out);
}

int stf_slopes_open(stf_pool *pool, steif_context *ctx, const steif_problem *p, int form,
                    N_Vector like, stf_slopes **slopes)
{
  point *at = *slopes = stf_pool_array(pool, 1, sizeof *at);
  if (!at) return STEIF_NO_MEMORY;
  const steif_parameters *q = p->parameters;
  *at = (point){.ctx = ctx, .problem = p, .form = form};
  if (q && !q->dFdp && q->count > 0) {
    at->count = stf_pool_array(pool, (size_t)q->count, sizeof *at->count);
    at->length = stf_pool_array(pool, (size_t)q->count, sizeof *at->length);
    if (!at->count || !at->length) return STEIF_NO_MEMORY;
  }
  return claim(at, pool, like);
}

int stf_slopes_at(stf_slopes *at, int k, sunrealtype t, N_Vector y, N_Vector yp, N_Vector out)
{
  const steif_problem *p = at->problem;
  const steif_parameters *q = p->parameters;
  const long before = stf_failures(at->ctx);
  at->t = t, at->y = y, at->yp = yp;
  const int returned =
    q->dFdp ? q->dFdp(t, y, yp, k, out, p->user) : differ(q, k, residual, at, out);
  return told(at->ctx, p, returned, k, before);
}

int stf_slopes_not_finite(const stf_slopes *at, int k, sunrealtype t, N_Vector slope)
{
  const steif_problem *p = at->problem;
  const steif_parameters *q = p->parameters;
  const sunindextype i = stf_not_finite(slope);
  char row[STEIF_SPEC_WORD];
  return STEIF_FAIL(at->ctx, STEIF_NOT_FINITE,
                    "dF/dp of parameter %d%s%.40s%s of problem '%s' is %g in equation %s at "
                    "t = %.12g: this parameter has no derivative there",
                    k + 1, q->name ? " ('" : "", q->name ? q->name[k] : "", q->name ? "')" : "",
                    p->name, i < 0 ? NAN : stf_array(slope)[i],
                    i < 0 ? "?" : stf_equation(p, i, row), t);
}

int stf_slopes_between(stf_slopes *at, int k, sunrealtype t, N_Vector y, N_Vector yp, int low,
                       int high, N_Vector out)
{
  const steif_parameters *q = at->problem->parameters;
  const long before = stf_failures(at->ctx);
  const sunrealtype p = q->value[k], d = stf_slopes_increment(q, k);
  const volatile sunrealtype up = p + high * d, down = p + low * d;
  at->t = t, at->y = y, at->yp = yp;
  int code = with(q, k, up, residual, at, out);
  if (!code) code = with(q, k, down, residual, at, at->other);
  if (!code) N_VLinearSum(1 / (up - down), out, -1 / (up - down), at->other, out);
  return told(at->ctx, at->problem, code, k, before);
}

sunrealtype stf_slopes_noise(const stf_slopes *at, int k)
{
  const steif_parameters *q = at->problem->parameters;
  const sunrealtype own = at->length ? at->length[k] : 0;
  return q->dFdp ? 0 : STF_EPS / (own > 0 ? own : stf_slopes_increment(q, k));
}

int steif_parameter_start(steif_context *ctx, const steif_problem *p, int k, N_Vector out)
{
  STF_NAMED(p);
  STEIF_TRY(stf_parameter_check(ctx, p, k));
  STEIF_CHECK(out, ctx, STEIF_BAD_INPUT, "a vector for dy0/dp is needed, got NULL");
  N_VConst(0, out);
  const long before = stf_failures(ctx);
  if (p->parameters->start)
    return told(ctx, p, p->parameters->start(k, out, p->user), k, before);
  point at = {.ctx = ctx, .problem = p, .form = STEIF_ODE};
  return p->start ? by_differences(&at, k, start_values, out) : STEIF_OK;
}

int steif_parameter_pull(steif_context *ctx, const steif_problem *p, sunrealtype t, N_Vector y,
                         N_Vector yp, N_Vector w, sunrealtype *out)
{
  STF_NAMED(p);
  STEIF_TRY(stf_parameter_check(ctx, p, 0));
  STEIF_CHECK(y && yp && w && out, ctx, STEIF_BAD_INPUT,
              "y, yp, w and out are needed, got NULL");
  const long before = stf_failures(ctx);
  for (int k = 0; k < p->parameters->count; k++) out[k] = 0;
  if (p->parameters->dFdp_transposed)
    return told(ctx, p, p->parameters->dFdp_transposed(t, y, yp, w, out, p->user), 0, before);
  stf_pool *pool = stf_pool_new(ctx);
  N_Vector column = pool ? stf_pool_vector(pool, w) : NULL;
  int code = column ? STEIF_OK : STEIF_NO_MEMORY;
  for (int k = 0; !code && k < p->parameters->count; k++) {
    code = steif_parameter_slope(ctx, p, k, t, y, yp, column);
    if (!code) out[k] = N_VDotProd(w, column);
  }
  stf_pool_free(&pool);
  return code;
}
