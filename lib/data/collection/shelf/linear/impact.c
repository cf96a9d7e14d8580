/* impact.c: two masses joined by a rigid massless bar hang from a spring and a damper; at t = 0-
 * the first one moves with speed=3, the second one does not, and gap=0 is the excess of their
 * distance over the length of the bar. Index 3, unknowns q1, q2, v1, v2, lambda:
 *
 *   q1' = v1,  m1 v1' + d v1 + k q1 - lambda = m1 G,
 *   q2' = v2,  m2 v2'               + lambda = m2 G,   q2 - q1 = 0.
 *
 * The bar acts by impulses that keep the centre of mass and, but for the damper, the momentum.
 * With M = m1 + m2 and mu = m1 m2/M:
 *   c_1(lambda) = mu gap,   c_0(v1) = c_1/m1,  c_0(v2) = -c_1/m2,   q(0+) = (m1 q1 + m2 q2)/M,
 *   c_0(lambda) = mu (v2 - v1 + d c_0(v1)/m1),
 *   v(0+) = (m1 v1 + m2 v2 - d c_0(v1))/M,   lambda = m2 (G - q'').
 * Afterwards M q'' + d q' + k q = M G.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

enum { M1, M2, GAP, PARAMETERS };

static const char *const parameter[] = {"m1", "m2", "gap"};
static const sunrealtype k = 40, d = 0.6, G = 9.81;

/* All unknowns from those of the pair. */
static void spread(const stf_linear *l, sunrealtype q, sunrealtype v, sunrealtype *x)
{
  const sunrealtype m1 = l->p[M1], m2 = l->p[M2];
  x[0] = x[1] = q;
  x[2] = x[3] = v;
  x[4] = m2 * (d * v + k * q) / (m1 + m2);
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const sunrealtype m1 = l->p[M1], m2 = l->p[M2], M = m1 + m2, mu = m1 * m2 / M;
  (void)ctx;
  sunrealtype *c0 = out->c, *c1 = c0 + 5;
  c1[4] = mu * (x0[1] - x0[0]);
  c0[2] = c1[4] / m1;
  c0[3] = -c1[4] / m2;
  c0[4] = mu * (x0[3] - x0[2] + d * c0[2] / m1);
  spread(l, (m1 * x0[0] + m2 * x0[1]) / M, (m1 * x0[2] + m2 * x0[3] - d * c0[2]) / M,
         out->x_plus);
  return STEIF_OK;
}

/* The damped oscillation of the pair about its rest, from x(0+). */
static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const stf_linear *l = user;
  const sunrealtype M = l->p[M1] + l->p[M2], rest = M * G / k, a = d / (2 * M),
                    w = sqrt(k / M - a * a);
  sunrealtype x0[5], c[10] = {0};
  jump(NULL, l, l->start, &(stf_exact_start){.x_plus = x0, .c = c});
  const sunrealtype p = x0[0] - rest, s = (x0[2] + a * p) / w;
  const sunrealtype cosine = exp(-a * t) * cos(w * t), sine = exp(-a * t) * sin(w * t);
  const sunrealtype q = p * cosine + s * sine;
  const sunrealtype v = (s * w - a * p) * cosine - (p * w + a * s) * sine;
  spread(l, rest + q, v, N_VGetArrayPointer(y));
  if (yp) spread(l, v, -(d * v + k * q) / M, N_VGetArrayPointer(yp));
  return 0;
}

static void mechanics(stf_linear *l)
{
  const sunrealtype mass[] = {l->p[M1], l->p[M2]}, *speed = l->data;
  const sunrealtype start[] = {0.4, 0.4 + l->p[GAP], *speed, 0, 0};
  for (sunindextype i = 0; i < 2; i++) {
    const sunrealtype sign = i == 0 ? -1 : 1;
    stf_linear_put(&l->E, i, i, 1);
    stf_linear_put(&l->E, 2 + i, 2 + i, mass[i]);
    stf_linear_put(&l->F, i, 2 + i, -1);
    stf_linear_put(&l->F, 2 + i, 4, sign);
    stf_linear_put(&l->F, 4, i, sign);
    stf_linear_wave(l, 2 + i, mass[i] * G, 0, 0);
    l->index[2 + i] = 2;
  }
  stf_linear_put(&l->F, 2, 0, k);
  stf_linear_put(&l->F, 2, 2, d);
  l->index[4] = 3;
  memcpy(l->start, start, sizeof start);
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"speed", "gap", "case", "storage", NULL};
  sunrealtype speed, gap;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_real(ctx, spec, "speed", -1e6, 1e6, 3, &speed));
  STEIF_TRY(stf_spec_real(ctx, spec, "gap", -1e6, 1e6, 0, &gap));
  stf_linear *l = stf_linear_open(ctx, self, 5, 4, 8, 2);
  if (!l) return STEIF_NO_MEMORY;
  sunrealtype *struck = stf_pool_array(l->pool, 1, sizeof *struck);
  if (!struck) return STEIF_NO_MEMORY;
  *struck = speed, l->data = struck;
  l->p[M1] = 1.5, l->p[M2] = 0.7, l->p[GAP] = gap;
  stf_linear_depend(l, self, PARAMETERS, parameter, mechanics);
  l->dae_index = 3;
  l->finite = 2;
  l->jump = jump;
  return stf_linear_finish(ctx, spec, self);
}

static const steif_names names = {
  (const char *const[]){"velocity 1", "velocity 2", "motion 1", "motion 2", "bar"},
  (const char *const[]){"q1", "q2", "v1", "v2", "lambda"}};

const steif_problem steif_problem_impact = {
  .about = "two masses joined by a rigid bar hang from a spring, one of them struck to "
           "speed=3: impulse "
           "in the bar, momentum kept (case=inc), index 3; on impacts as jumps of velocity: B. "
           "Brogliato, "
           "Nonsmooth Mechanics, Springer 1999",
  .n = 5,
  .names = &names,
  .t1 = 5,
  .storage = STEIF_DENSE,
  .exact = exact,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
