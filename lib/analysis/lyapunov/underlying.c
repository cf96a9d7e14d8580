/* underlying.c: the one-step map under a general linear method on a linear problem, in the
 * coordinate that parasitic modes leave alone and in the solution itself. U. Kirchgraber,
 * Numer. Math. 48 (1986); D. Stoffer, Computing 51 (1993).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "variation.h"
#include <math.h>
#include <string.h>

typedef struct underlying {
  stf_variation v, flow;
  int d;
  sunrealtype *W, *Z, *work, *R; /* d x d each */
} underlying;

/* Twice the n from where on second^n < 1e-15: at h > 0 the parasitic modes decay more slowly.
 * */
long stf_burn_in(const steif_glm *g)
{
  enum { LEAST = 64 };
  const long n = g->second > 0 ? 2 * (long)ceil(log(STF_PARASITIC_GONE) / log(g->second)) : 0;
  return n > LEAST ? n : LEAST;
}

static int open(stf_pool *pool, steif_context *ctx, const steif_problem *p, const char *method,
                sunrealtype h, underlying *u)
{
  STEIF_CHECK(p && method, ctx, STEIF_BAD_INPUT, "a problem and a method are needed");
  STEIF_CHECK(h > 0 && isfinite(h), ctx, STEIF_BAD_INPUT, "the step h = %g must be positive",
              h);
  STEIF_CHECK(p->n <= STF_DENSE_MOST, ctx, STEIF_UNSUPPORTED,
              "'%s' with n = %lld: maps of a step are dense and are found up to n = %d",
              p->name, (long long)p->n, STF_DENSE_MOST);
  const int n = p->n > 0 ? (int)p->n : 1;
  const size_t d = (size_t)n;
  STEIF_TRY(stf_variation_open(pool, ctx, p, method, h, p->t0 + h, n, 0, &u->v));
  STEIF_TRY(stf_variation_open(pool, ctx, p, "gauss:s=6", h, p->t0 + h, n, 1, &u->flow));
  STEIF_CHECK(
    u->v.linear, ctx, STEIF_UNSUPPORTED,
    "the Jacobian of '%s' depends on y: underlying maps are found for linear problems",
    p->name);
  u->d = n;
  u->W = stf_pool_array(pool, 4 * d * d, sizeof *u->W);
  if (!u->W) return STEIF_NO_MEMORY;
  u->Z = u->W + d * d;
  u->work = u->Z + d * d;
  u->R = u->work + d * d;
  return STEIF_OK;
}

/* Steps with X made smaller from the right, which changes no map. */
static int burn(underlying *u, long steps)
{
  stf_variation *v = &u->v;
  for (long n = 0; n < steps; n++) {
    STEIF_TRY(stf_variation_step(v));
    stf_variation_principal(v, u->work);
    STEIF_CHECK(
      stf_triangle(v->d, v->m, u->work, u->work, u->R, &v->algebra), v->ctx, STEIF_NOT_FINITE,
      "a direction vanished or overflowed in the step of %s to t = %.12g: begin with other "
      "columns, or take a smaller h",
      v->method, v->t);
    stf_renormalise(v->g->k * v->d, v->m, u->R, v->X, &v->algebra);
  }
  return STEIF_OK;
}

/* Phi = after before^{-1}, by Phi^T = before^{-T} after^T. */
static int quotient(underlying *u, const sunrealtype *after, sunrealtype *before,
                    sunrealtype *Phi)
{
  const int d = u->d;
  for (int i = 0; i < d; i++)
    for (int j = 0; j < i; j++) {
      const sunrealtype x = before[i * d + j];
      before[i * d + j] = before[j * d + i];
      before[j * d + i] = x;
    }
  for (int i = 0; i < d; i++)
    for (int j = 0; j < d; j++) u->R[j * d + i] = after[i * d + j];
  STEIF_CHECK(stf_factor(d, before, &u->v.algebra), u->v.ctx, STEIF_SINGULAR,
              "the %d columns of %s depend on each other at t = %.12g: begin with others", d,
              u->v.method, u->v.t);
  stf_substitute(d, d, before, u->R, &u->v.algebra);
  for (int i = 0; i < d; i++)
    for (int j = 0; j < d; j++) Phi[i * d + j] = u->R[j * d + i];
  return STEIF_OK;
}

static int maps(underlying *u, steif_underlying *out)
{
  stf_variation *v = &u->v;
  const int d = u->d;
  STEIF_TRY(burn(u, out->burn_in - 1));
  STEIF_TRY(stf_variation_step(v));
  const sunrealtype t = v->t;
  stf_variation_principal(v, u->W);
  stf_variation_solution(v, u->Z);
  STEIF_TRY(stf_variation_step(v));
  stf_variation_principal(v, u->work);
  STEIF_TRY(quotient(u, u->work, u->W, out->Phi_w));
  stf_variation_solution(v, u->work);
  STEIF_TRY(quotient(u, u->work, u->Z, out->Phi_f));
  for (int i = 0; i < d * d; i++) out->exact[i] = i % (d + 1) == 0;
  return stf_variation_carry(&u->flow, t, v->h, stf_variation_substeps(v, v->h), out->exact);
}

int stf_period_map(stf_pool *pool, steif_context *ctx, const steif_problem *p,
                   const char *method, sunrealtype h, long steps, sunrealtype *Phi)
{
  underlying u = {.d = 0};
  STEIF_TRY(open(pool, ctx, p, method, h, &u));
  STEIF_TRY(burn(&u, stf_burn_in(u.v.g)));
  stf_variation_principal(&u.v, u.W);
  for (long n = 0; n < steps; n++) STEIF_TRY(stf_variation_step(&u.v));
  stf_variation_principal(&u.v, u.work);
  return quotient(&u, u.work, u.W, Phi);
}

int steif_underlying_find(steif_context *ctx, const steif_problem *problem, const char *method,
                          sunrealtype h, const sunrealtype *start, steif_underlying *out)
{
  STF_NAMED(problem);
  underlying u = {.d = 0};
  STEIF_CHECK(out && out->Phi_w && out->Phi_f && out->exact && out->burn_in >= 0, ctx,
              STEIF_BAD_INPUT,
              "room for Phi_w, Phi_f and the exact map, and a number of steps >= 0 are needed");
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = open(pool, ctx, problem, method, h, &u);
  if (code == STEIF_OK) {
    const size_t bytes = (size_t)(u.v.g->k * u.d * u.d) * sizeof *start;
    if (start) memcpy(u.v.X, start, bytes);
    if (out->burn_in == 0) out->burn_in = stf_burn_in(u.v.g);
    code = maps(&u, out);
  }
  stf_pool_free(&pool);
  return code;
}
