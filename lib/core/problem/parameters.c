/* parameters.c: derivatives of the residual and of the start by parameters.
 *
 * A difference moves p_k by eps^(1/3) of its scale: truncation and rounding of the quotient are then both
 * of the order eps^(2/3).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
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
} point;

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

/* Values on both sides, or on one and here: their quotient. what(data, out) is the function of p. */
static int differ(const steif_parameters *q, int k, int (*what)(const point *at, N_Vector out),
                  const point *at, N_Vector out)
{
  N_Vector other = at->other;
  const sunrealtype p = q->value[k], d = stf_slopes_increment(q, k);
  volatile sunrealtype up = p + d, down = p - d;
  int code = with(q, k, up, what, at, out);
  if (code > 0) code = with(q, k, up = p, what, at, out);
  if (!code) code = with(q, k, down, what, at, other);
  if (code > 0 && up > p) code = with(q, k, down = p, what, at, other);
  if (!code) N_VLinearSum(1 / (up - down), out, -1 / (up - down), other, out);
  return code;
}

static int start_values(const point *at, N_Vector out)
{
  return at->problem->start(at->problem->t0, out, at->work, at->problem->user);
}

/* ---- names and calls -------------------------------------------------------------------------- */

static int check(steif_context *ctx, const steif_problem *p, int k)
{
  STEIF_CHECK(p && p->parameters && p->parameters->count > 0 && p->parameters->value, ctx,
              STEIF_BAD_INPUT, "problem '%s' has no parameters: set .parameters",
              p && p->name ? p->name : "NULL");
  STEIF_CHECK(k >= 0 && k < p->parameters->count, ctx, STEIF_BAD_INPUT,
              "parameter %d of problem '%s' must lie in 0 .. %d", k, p->name,
              p->parameters->count - 1);
  STEIF_CHECK(isfinite(p->parameters->value[k]), ctx, STEIF_NOT_FINITE,
              "parameter %d of problem '%s' is %g", k, p->name, p->parameters->value[k]);
  return STEIF_OK;
}

int steif_parameter_find(steif_context *ctx, const steif_problem *p, const char *name)
{
  STF_NAMED(p);
  if (check(ctx, p, 0) || !name) return -1;
  const steif_parameters *q = p->parameters;
  for (int k = 0; q->name && k < q->count; k++)
    if (!strcmp(q->name[k], name)) return k;
  char own[STEIF_SPEC_WORD];
  for (int k = 0; !q->name && k < q->count; k++) {
    snprintf(own, sizeof own, "p%d", k + 1);
    if (!strcmp(own, name)) return k;
  }
  char guess[STF_GUESS] = "; they are p1, p2, ...";
  if (q->name) stf_guess(name, q->name, (size_t)q->count, sizeof *q->name, guess);
  if (q->name && !*guess) snprintf(guess, sizeof guess, "; the first one is '%.40s'", *q->name);
  STEIF_FAIL(ctx, STEIF_UNKNOWN_NAME, "problem '%s' has no parameter '%s'%s", p->name, name,
             guess);
  return -1;
}

int steif_parameter_set(steif_context *ctx, const steif_problem *p, int k, sunrealtype value)
{
  STF_NAMED(p);
  STEIF_TRY(check(ctx, p, k));
  STEIF_CHECK(isfinite(value), ctx, STEIF_NOT_FINITE, "parameter %d of problem '%s' is %g",
              k + 1, p->name, value);
  const steif_parameters *q = p->parameters;
  q->value[k] = value;
  const int returned = q->moved ? q->moved(p->user) : 0;
  STEIF_CHECK(returned == 0, ctx, STEIF_CALLBACK,
              "parameters.moved of problem '%s' returned %d for parameter %d = %g", p->name,
              returned, k + 1, value);
  return STEIF_OK;
}

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
  return at->other && at->work ? open_matrix(at, pool) : STEIF_NO_MEMORY;
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
  STEIF_TRY(check(ctx, p, k));
  STEIF_CHECK(y && yp && out, ctx, STEIF_BAD_INPUT, "y, yp and out are needed, got NULL");
  const long before = stf_failures(ctx);
  point at = {.ctx = ctx, .problem = p, .t = t, .y = y, .yp = yp};
  if (p->parameters->dFdp)
    return told(ctx, p, p->parameters->dFdp(t, y, yp, k, out, p->user), k, before);
  at.form = steif_problem_form(ctx, p);
  return at.form ? by_differences(&at, k, residual, out) : steif_status(ctx);
}

int stf_slopes_open(stf_pool *pool, steif_context *ctx, const steif_problem *p, int form,
                    N_Vector like, stf_slopes **slopes)
{
  point *at = *slopes = stf_pool_array(pool, 1, sizeof *at);
  if (!at) return STEIF_NO_MEMORY;
  *at = (point){.ctx = ctx, .problem = p, .form = form};
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
  return q->dFdp ? 0 : STF_EPS / stf_slopes_increment(q, k);
}

int steif_parameter_start(steif_context *ctx, const steif_problem *p, int k, N_Vector out)
{
  STF_NAMED(p);
  STEIF_TRY(check(ctx, p, k));
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
  STEIF_TRY(check(ctx, p, 0));
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
