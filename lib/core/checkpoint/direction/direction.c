/* direction.c: derivatives along a line p + theta v, y0 + theta u, made of those by each parameter.
 *
 * All are affine in what they are asked along: out(dy, k) = L dy + b_k, and along the line L dy + sum_k v_k b_k.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direction_inside.h"
#include <math.h>
#include <string.h>

static const steif_parameters *given(const steif_direction *d) { return d->given->parameters; }

static int scratch(steif_direction *d, N_Vector like)
{
  if (!d->work) d->work = N_VClone(like);
  if (!d->zero) d->zero = N_VClone(like);
  if (!d->work || !d->zero) return -1;
  N_VConst(0, d->zero);
  return 0;
}

/* ---- the callbacks by theta ---------------------------------------------------------------------- */

static int slope_of_F(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  steif_direction *d = user;
  (void)k;
  if (scratch(d, out)) return -1;
  N_VConst(0, out);
  for (int i = 0; i < d->count; i++) {
    if (d->v[i] == 0) continue;
    const int code = given(d)->dFdp(t, y, yp, i, d->work, d->given->user);
    if (code) return code;
    N_VLinearSum(1, out, d->v[i], d->work, out);
  }
  return 0;
}

static int slope_of_start(int k, N_Vector S0, void *user)
{
  steif_direction *d = user;
  (void)k;
  if (scratch(d, S0)) return -1;
  N_VConst(0, S0);
  for (int i = 0; i < d->count; i++) {
    if (d->v[i] == 0) continue;
    const int code = steif_parameter_start(d->ctx, d->given, i, d->work);
    if (code) return code;
    N_VLinearSum(1, S0, d->v[i], d->work, S0);
  }
  sunindextype rows = 0;
  sunrealtype *x = d->u ? stf_own_rows(S0, &rows) : NULL;
  for (sunindextype i = 0; x && i < rows; i++) x[i] += d->u[i];
  return 0;
}

static int slope_of_reset(sunrealtype t, N_Vector y, const int *fired, N_Vector dy,
                          sunrealtype dt, int k, N_Vector out, void *user)
{
  steif_direction *d = user;
  void *own = d->given->user;
  (void)k;
  if (scratch(d, out)) return -1;
  int code = given(d)->reset(t, y, fired, dy, dt, 0, out, own);
  for (int i = 0; !code && i < d->count; i++) {
    const sunrealtype c = d->v[i] - (i == 0);
    if (c == 0) continue;
    code = given(d)->reset(t, y, fired, d->zero, 0, i, d->work, own);
    N_VLinearSum(1, out, c, d->work, out);
  }
  return code;
}

static int slope_of_break(int i, int k, sunrealtype *slope, void *user)
{
  const steif_direction *d = user;
  (void)k;
  *slope = 0;
  for (int j = 0; j < d->count; j++) {
    sunrealtype one = 0;
    const int code = d->v[j] != 0 ? given(d)->break_slope(i, j, &one, d->given->user) : 0;
    if (code) return code;
    *slope += d->v[j] * one;
  }
  return 0;
}

static void *user_of_quadrature(const steif_direction *d)
{
  return d->given->quadrature->user ? d->given->quadrature->user : d->given->user;
}

static int integrand(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const steif_direction *d = user;
  return d->given->quadrature->value(t, y, value, user_of_quadrature(d));
}

static int slope_of_integrand(sunrealtype t, N_Vector y, N_Vector dy, int k, sunrealtype *out,
                              void *user)
{
  steif_direction *d = user;
  const steif_quadrature *q = d->given->quadrature;
  (void)k;
  if (scratch(d, dy)) return -1;
  int code = q->slope(t, y, dy, 0, out, user_of_quadrature(d));
  for (int i = 0; !code && i < d->count; i++) {
    const sunrealtype c = d->v[i] - (i == 0);
    if (c == 0) continue;
    code = q->slope(t, y, d->zero, i, d->term, user_of_quadrature(d));
    for (int j = 0; j < q->count; j++) out[j] += c * d->term[j];
  }
  return code;
}

/* theta has another value: p follows; back at 0 it has its values again, bit for bit. */
static int moved(void *user)
{
  steif_direction *d = user;
  const steif_parameters *q = given(d);
  const size_t size = (size_t)d->count * sizeof *d->home;
  if (!q || (d->theta == 0 && !d->away)) return 0;
  if (!d->away) memcpy(d->home, q->value, size);
  for (int k = 0; k < d->count; k++) q->value[k] = d->home[k] + d->theta * d->v[k];
  if (d->theta == 0) memcpy(q->value, d->home, size);
  d->away = d->theta != 0;
  return q->moved ? q->moved(d->given->user) : 0;
}

/* ---- opening ------------------------------------------------------------------------------------- */

static int check_entries(steif_context *ctx, const steif_problem *p, const sunrealtype *x,
                         sunindextype count, const char *what)
{
  for (sunindextype i = 0; x && i < count; i++)
    STEIF_CHECK(isfinite(x[i]), ctx, STEIF_NOT_FINITE,
                "entry %lld of the direction of %s of problem '%s' is %g", (long long)i + 1,
                what, p->name, x[i]);
  return STEIF_OK;
}

static int check(steif_context *ctx, const steif_problem *p, const sunrealtype *v,
                 const sunrealtype *u)
{
  STEIF_CHECK(p && (v || u), ctx, STEIF_BAD_INPUT,
              "a direction needs a problem, and v of its parameters or u of its start values");
  const steif_parameters *q = p->parameters;
  STEIF_CHECK(!v || (q && q->count > 0 && q->value), ctx, STEIF_BAD_INPUT,
              "problem '%s' has no parameters to go along: set .parameters, or give u alone",
              p->name);
  STEIF_CHECK(!u || p->y0 || !p->start, ctx, STEIF_BAD_INPUT,
              "a direction of start values of problem '%s' needs .y0 in host memory", p->name);
  STEIF_TRY(check_entries(ctx, p, v, q ? q->count : 0, "parameters"));
  return check_entries(ctx, p, u, p->n, "start values");
}

/* theta of this size moves parameters and start values by their own size. */
static sunrealtype typical(steif_direction *d)
{
  const steif_parameters *q = given(d);
  sunrealtype most = 0, size = 0, along = 0;
  for (int k = 0; k < d->count; k++) {
    const sunrealtype p = q->scale ? fabs(q->scale[k]) : fabs(q->value[k]);
    most = fmax(most, fabs(d->v[k]) / (p > 0 ? p : 1));
  }
  d->reach = most;
  for (sunindextype i = 0; d->u && i < d->given->n; i++) {
    along = fmax(along, fabs(d->u[i]));
    if (d->given->y0) size = fmax(size, fabs(d->given->y0[i]));
  }
  most = fmax(most, along / (size > 0 ? size : 1));
  return most > 0 ? 1 / most : 1;
}

static int copy(steif_context *ctx, const sunrealtype *x, size_t count, sunrealtype **to)
{
  *to = stf_allocate(ctx, count + 1, sizeof **to);
  if (!*to) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < count; i++) (*to)[i] = x ? x[i] : 0;
  return STEIF_OK;
}

static int fill(steif_direction *d, const sunrealtype *v, const sunrealtype *u)
{
  const size_t count = (size_t)d->count;
  const steif_quadrature *q = d->given->quadrature;
  STEIF_TRY(copy(d->ctx, v, count, &d->v));
  STEIF_TRY(copy(d->ctx, NULL, count, &d->home));
  if (u) STEIF_TRY(copy(d->ctx, u, (size_t)d->given->n, &d->u));
  if (q) STEIF_TRY(copy(d->ctx, NULL, (size_t)q->count, &d->term));
  return STEIF_OK;
}

static void redirect_quadrature(steif_direction *d)
{
  const steif_quadrature *q = d->given->quadrature;
  if (!q) return;
  d->quadrature = *q;
  d->quadrature.value = integrand, d->quadrature.user = d;
  if (q->slope && d->count) d->quadrature.slope = slope_of_integrand;
  d->problem.quadrature = &d->quadrature;
}

/* A problem without parameters has dF/dtheta = 0: the sum of none. */
static void redirect_parameters(steif_direction *d)
{
  static const char *const along[] = {"along"};
  const steif_parameters *q = given(d);
  steif_parameters *own = &d->parameters;
  d->scale = typical(d);
  own->count = 1, own->value = &d->theta, own->scale = &d->scale, own->name = along;
  own->start = slope_of_start, own->moved = moved;
  if (!q || q->dFdp) own->dFdp = slope_of_F;
  if (q && q->reset) own->reset = slope_of_reset;
  if (q && q->break_slope) own->break_slope = slope_of_break;
  if (q) own->obstacle = q->obstacle;
  d->problem.parameters = own;
}

steif_direction *steif_direction_new(steif_context *ctx, const steif_problem *problem,
                                     const sunrealtype *v, const sunrealtype *u)
{
  if (!ctx) return NULL;
  steif_forget(ctx);
  if (check(ctx, problem, v, u)) return NULL;
  steif_direction *d = stf_allocate(ctx, 1, sizeof *d);
  if (!d) return NULL;
  *d = (steif_direction){.ctx = ctx, .given = problem};
  d->count = problem->parameters ? problem->parameters->count : 0;
  if (fill(d, v, u)) {
    steif_direction_free(&d);
    return NULL;
  }
  stf_redirect(d);
  redirect_quadrature(d);
  redirect_parameters(d);
  return d;
}

const steif_problem *steif_direction_problem(const steif_direction *d)
{
  return d ? &d->problem : NULL;
}

void steif_direction_free(steif_direction **where)
{
  steif_direction *d = where ? *where : NULL;
  if (!d) return;
  sunrealtype *block[] = {d->v, d->home, d->u, d->term};
  for (size_t i = 0; i < sizeof block / sizeof *block; i++) stf_release(d->ctx, block[i]);
  if (d->work) N_VDestroy(d->work);
  if (d->zero) N_VDestroy(d->zero);
  stf_release(d->ctx, d);
  *where = NULL;
}
