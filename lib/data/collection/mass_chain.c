/* mass_chain.c: n masses in a row between two walls, joined by springs and dampers, under c linear
 * constraints, index 3:
 *
 *   q' - v = a,   M v' + K q + D v + G^T lambda = b,   G q = g,
 *
 * constraint j a lever on the anchors s_j = floor(j n/c): q_{s_j} + beta_j q_{s_{j+1}}, the last
 * one alone. With S = G M^{-1} G^T the start is
 *   c_1 = (0, 0, mu),  mu = S^{-1} (G q_0 - g),        w = -M^{-1} G^T mu,   q(0+) = q_0 + w,
 *   c_0 = (0, w, nu),  nu = S^{-1} (G (v_0 - M^{-1} D w + a) - g'),
 *   v(0+) = v_0 - M^{-1} (D w + G^T nu),
 *   lambda(0+) = S^{-1} (G (M^{-1} (b - K q - D v) + a') - g'')    at q(0+), v(0+).
 * All a, b, g are waves.
 *
 * With a hidden mode one more unknown pushes the first mass: ... + rate r u = b_1 and
 * u' + rate u + s q_2 = h. It is continuous, u(0+) = u_0, yet decays within 1/rate by an impulse
 * r u_0 that is easily taken for a part of c_0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <string.h>

typedef struct chain {
  sunindextype n, c;
  sunrealtype *lightness; /* 1 / mass */
  sunrealtype rate;       /* of the hidden mode; 0: none */
} chain;

static const sunrealtype PUSH = 0.5, FEEL = 0.3, RAISED = 0.7; /* r, s, u_0 */

/* lambda += S^{-1} (G z - g^(order)), z in the place of q. */
static int constrain(stf_schur *s, const stf_linear *l, const sunrealtype *z, int order,
                     sunrealtype *lambda, sunrealtype *work)
{
  const chain *h = l->data;
  stf_linear_defect(l, z, order, work);
  memcpy(lambda, work + 2 * h->n, (size_t)h->c * sizeof *work);
  return stf_schur_solve(s, lambda);
}

/* Row v of F x, divided by the masses. */
static void accelerate(const stf_linear *l, const sunrealtype *x, sunrealtype *work,
                       sunrealtype *out)
{
  const chain *h = l->data;
  stf_linear_times(l, x, work);
  for (sunindextype i = 0; i < h->n; i++) out[i] = h->lightness[i] * work[h->n + i];
}

static int positions(stf_schur *s, const stf_linear *l, stf_exact_start *out, sunrealtype *work,
                     sunrealtype *z)
{
  const chain *h = l->data;
  sunrealtype *x = out->x_plus, *c0 = out->c, *c1 = out->c + l->n;
  STEIF_TRY(constrain(s, l, x, 0, c1 + 2 * h->n, work));
  accelerate(l, c1, work, z);
  for (sunindextype i = 0; i < h->n; i++) {
    c0[h->n + i] = -z[i];
    x[i] -= z[i];
  }
  return STEIF_OK;
}

static int velocities(stf_schur *s, const stf_linear *l, stf_exact_start *out,
                      sunrealtype *work, sunrealtype *z)
{
  const chain *h = l->data;
  sunrealtype *x = out->x_plus, *c0 = out->c;
  memset(z, 0, (size_t)l->n * sizeof *z);
  accelerate(l, c0, work, z);
  stf_linear_force(l, 0, 0, work);
  for (sunindextype i = 0; i < h->n; i++) z[i] = x[h->n + i] - z[i] + work[i];
  STEIF_TRY(constrain(s, l, z, 1, c0 + 2 * h->n, work));
  accelerate(l, c0, work, z);
  for (sunindextype i = 0; i < h->n; i++) x[h->n + i] -= z[i];
  return STEIF_OK;
}

static int multipliers(stf_schur *s, const stf_linear *l, sunrealtype *x, sunrealtype *work,
                       sunrealtype *z)
{
  const chain *h = l->data;
  stf_linear_defect(l, x, 0, work);
  memset(z, 0, (size_t)l->n * sizeof *z);
  for (sunindextype i = 0; i < h->n; i++) z[i] = -h->lightness[i] * work[h->n + i];
  stf_linear_force(l, 0, 1, work);
  for (sunindextype i = 0; i < h->n; i++) z[i] += work[i];
  return constrain(s, l, z, 2, x + 2 * h->n, work);
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const chain *h = l->data;
  stf_schur *s = NULL;
  sunrealtype *work = stf_allocate(ctx, 2 * (size_t)l->n, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  sunrealtype *z = work + l->n;
  memcpy(out->x_plus, x0, (size_t)l->n * sizeof *x0);
  memset(out->x_plus + 2 * h->n, 0, (size_t)h->c * sizeof *x0);
  int code = stf_schur_open(ctx, &l->F, 2 * h->n, h->c, 0, h->n, h->lightness, &s);
  if (!code) code = positions(s, l, out, work, z);
  if (!code) code = velocities(s, l, out, work, z);
  if (!code) code = multipliers(s, l, out->x_plus, work, z);
  stf_schur_close(&s);
  stf_release(ctx, work);
  return code;
}

/* A spring or damper between masses i - 1 and i, walls at -1 and n, into the block of F whose
 * first column is `base`. */
static void link(stf_linear *l, sunindextype i, sunindextype base, sunrealtype value)
{
  const chain *h = l->data;
  const sunindextype n = h->n;
  if (i < n) stf_linear_put(&l->F, n + i, base + i, value);
  if (i > 0) stf_linear_put(&l->F, n + i - 1, base + i - 1, value);
  if (i > 0 && i < n) {
    stf_linear_put(&l->F, n + i, base + i - 1, -value);
    stf_linear_put(&l->F, n + i - 1, base + i, -value);
  }
}

static void lever(stf_linear *l, sunindextype j, sunindextype mass, sunrealtype weight)
{
  const chain *h = l->data;
  stf_linear_put(&l->F, 2 * h->n + j, mass, weight);
  stf_linear_put(&l->F, h->n + mass, 2 * h->n + j, weight);
}

static void mechanics(stf_linear *l, stf_random *r)
{
  const chain *h = l->data;
  const sunindextype n = h->n;
  for (sunindextype i = 0; i <= n; i++) {
    link(l, i, 0, stf_random_in(r, 3, 5));
    link(l, i, n, stf_random_in(r, 0.05, 0.15));
  }
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype mass = stf_random_in(r, 1, 2);
    h->lightness[i] = 1 / mass;
    stf_linear_put(&l->E, i, i, 1);
    stf_linear_put(&l->E, n + i, n + i, mass);
    stf_linear_put(&l->F, i, n + i, -1);
  }
  for (sunindextype j = 0; j < h->c; j++) {
    lever(l, j, j * n / h->c, 1);
    if (j < h->c - 1) lever(l, j, (j + 1) * n / h->c, stf_random_in(r, 0.25, 0.75));
  }
}

static void motion(stf_linear *l, stf_random *r)
{
  const chain *h = l->data;
  for (sunindextype i = 0; i < 2 * h->n + h->c; i++) {
    const int kind = i < h->n ? 0 : i < 2 * h->n ? 1 : 2;
    const sunrealtype most = kind == 0 ? 0.1 : kind == 1 ? 1 : 0.3;
    const sunrealtype size = stf_random_in(r, -most, most), pace = stf_random_in(r, 0.5, 2.5);
    stf_linear_wave(l, i, size, pace, stf_random_in(r, 0, 6));
    l->index[i] = kind + 1;
    l->start[i] = stf_random_in(r, -1, 1);
  }
}

static void mode(stf_linear *l)
{
  const chain *h = l->data;
  const sunindextype u = 2 * h->n + h->c;
  stf_linear_put(&l->E, u, u, 1);
  stf_linear_put(&l->F, u, u, h->rate);
  stf_linear_put(&l->F, u, 1, FEEL);
  stf_linear_put(&l->F, h->n, u, h->rate * PUSH);
  stf_linear_wave(l, u, 0.9, 1.3, 0.4);
  l->start[u] = RAISED;
}

static int data(stf_linear *l, sunindextype n, sunindextype c, sunrealtype rate)
{
  chain *h = stf_pool_array(l->pool, 1, sizeof *h);
  if (!h) return STEIF_NO_MEMORY;
  *h = (chain){.n = n, .c = c, .rate = rate};
  h->lightness = stf_pool_array(l->pool, (size_t)n, sizeof *h->lightness);
  l->data = h;
  return h->lightness ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_chain_build(steif_context *ctx, const steif_spec *spec, steif_problem *self,
                    sunrealtype lambda)
{
  int n, c;
  stf_random r;
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 2, 10000000, 200, &n));
  STEIF_TRY(stf_spec_int(ctx, spec, "c", 1, n, n < 10 ? 1 : n / 10, &c));
  STEIF_TRY(stf_random_seed(ctx, spec, &r));
  const sunindextype own = 2 * (sunindextype)n + c, all = own + (lambda > 0);
  stf_linear *l =
    stf_linear_open(ctx, self, all, all, 8 * ((sunindextype)n + 1) + n + 4 * c + 3, all);
  if (!l || data(l, n, c, lambda)) return STEIF_NO_MEMORY;
  mechanics(l, &r);
  motion(l, &r);
  if (lambda > 0) mode(l);
  l->dae_index = 3;
  l->finite = 2 * ((sunindextype)n - c) + (lambda > 0);
  l->jump = jump;
  return stf_linear_finish(ctx, spec, self);
}
