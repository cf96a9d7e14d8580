/* switchrlc.c: at t = 0 an ideal switch joins two capacitors charged to v1=5 and v2=1 volts; a
 * battery feeds the pair through a resistor and an inductor. Index 2 from then on:
 *
 *   C1 v1' - i_L + i = 0,   C2 v2' + v2/R2 - i = 0,   L i_L' + v1 - e = 0,
 *   e + R i_L = V,          v1 - v2 = 0               (unknowns v1, v2, i_L, e, i).
 *
 * The loop of capacitors evens out by an impulse of current that keeps the charge:
 *   v(0+) = (C1 v1 + C2 v2)/(C1 + C2),   c_0(i) = C1 C2/(C1 + C2) (v1 - v2).
 * Afterwards w = (v - V R2/(R + R2), i_L - V/(R + R2)) obeys w' = B w,
 *   exp(tB) = e^{at} (cos bt I + sin bt (B - aI)/b),   a = tr B/2,  b^2 = det B - a^2.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

enum { C1, C2, L, R, R2, V, PARAMETERS };

static const sunrealtype usual[PARAMETERS] = {2e-6, 3e-6, 1e-3, 10, 200, 6};
static const char *const parameter[] = {"C1", "C2", "L", "R", "R2", "V"};

/* e and i from v and i_L: V = R i_L + e, and v1' = v2'. */
static void algebraic(const sunrealtype *p, sunrealtype *x)
{
  x[3] = p[V] - p[R] * x[2];
  x[4] = (p[C2] * x[2] + p[C1] * x[1] / p[R2]) / (p[C1] + p[C2]);
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const sunrealtype *p = l->p;
  sunrealtype *x = out->x_plus;
  (void)ctx;
  x[0] = x[1] = (p[C1] * x0[0] + p[C2] * x0[1]) / (p[C1] + p[C2]);
  x[2] = x0[2];
  algebraic(p, x);
  out->c[4] = p[C1] * p[C2] / (p[C1] + p[C2]) * (x0[0] - x0[1]);
  return STEIF_OK;
}

/* (v, i_L)' with the switch closed, without the battery. */
static void rates(const sunrealtype *p, const sunrealtype *w, sunrealtype *out)
{
  out[0] = (w[1] - w[0] / p[R2]) / (p[C1] + p[C2]);
  out[1] = -(w[0] + p[R] * w[1]) / p[L];
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const stf_linear *l = user;
  const sunrealtype *x0 = l->start, *p = l->p;
  const sunrealtype a = -(1 / (p[R2] * (p[C1] + p[C2])) + p[R] / p[L]) / 2;
  const sunrealtype b = sqrt((1 + p[R] / p[R2]) / (p[L] * (p[C1] + p[C2])) - a * a);
  const sunrealtype rest[] = {p[V] * p[R2] / (p[R] + p[R2]), p[V] / (p[R] + p[R2])};
  const sunrealtype w0[] = {(p[C1] * x0[0] + p[C2] * x0[1]) / (p[C1] + p[C2]) - rest[0],
                            x0[2] - rest[1]};
  sunrealtype *x = N_VGetArrayPointer(y), w[2], slope[2];
  rates(p, w0, slope);
  for (int k = 0; k < 2; k++)
    w[k] = exp(a * t) * (cos(b * t) * w0[k] + sin(b * t) / b * (slope[k] - a * w0[k]));
  x[0] = x[1] = w[0] + rest[0];
  x[2] = w[1] + rest[1];
  algebraic(p, x);
  if (!yp) return 0;
  sunrealtype *d = N_VGetArrayPointer(yp);
  rates(p, w, slope);
  d[0] = d[1] = slope[0];
  d[2] = slope[1];
  d[3] = -p[R] * d[2];
  d[4] = (p[C2] * d[2] + p[C1] * d[0] / p[R2]) / (p[C1] + p[C2]);
  return 0;
}

static void circuit(stf_linear *l)
{
  const sunrealtype *p = l->p;
  static const struct {
    int i, j;
    sunrealtype value;
  } F[] = {{0, 2, -1}, {0, 4, 1}, {1, 4, -1}, {2, 0, 1},
           {2, 3, -1}, {3, 3, 1}, {4, 0, 1},  {4, 1, -1}};
  for (size_t k = 0; k < sizeof F / sizeof *F; k++)
    stf_linear_put(&l->F, F[k].i, F[k].j, F[k].value);
  stf_linear_put(&l->F, 1, 1, 1 / p[R2]);
  stf_linear_put(&l->F, 3, 2, p[R]);
  stf_linear_put(&l->E, 0, 0, p[C1]);
  stf_linear_put(&l->E, 1, 1, p[C2]);
  stf_linear_put(&l->E, 2, 2, p[L]);
  stf_linear_wave(l, 3, p[V], 0, 0);
  const sunrealtype *charged = l->data;
  const sunrealtype start[] = {charged[0], charged[1], 0, p[V], 0};
  memcpy(l->start, start, sizeof start);
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  static const char *const keys[] = {"v1", "v2", "case", "storage", NULL};
  sunrealtype v1, v2;
  STEIF_TRY(stf_spec_only(ctx, spec, keys));
  STEIF_TRY(stf_spec_real(ctx, spec, "v1", -1e6, 1e6, 5, &v1));
  STEIF_TRY(stf_spec_real(ctx, spec, "v2", -1e6, 1e6, 1, &v2));
  stf_linear *l = stf_linear_open(ctx, self, 5, 3, 10, 1);
  if (!l) return STEIF_NO_MEMORY;
  sunrealtype *charged = stf_pool_array(l->pool, 2, sizeof *charged);
  if (!charged) return STEIF_NO_MEMORY;
  charged[0] = v1, charged[1] = v2, l->data = charged;
  memcpy(l->p, usual, sizeof usual);
  stf_linear_depend(l, self, PARAMETERS, parameter, circuit);
  l->index[4] = 2;
  l->dae_index = 2;
  l->finite = 2;
  l->jump = jump;
  return stf_linear_finish(ctx, spec, self);
}

static const steif_names names = {
  (const char *const[]){"node of C1", "node of C2", "inductor", "battery", "switch"},
  (const char *const[]){"v1", "v2", "i_L", "e", "i"}};

const steif_problem steif_problem_switchrlc = {
  .about = "a switch joins capacitors charged to v1=5 and v2=1 volts, fed by a battery through "
           "R and L: "
           "impulse of current, charge kept (case=inc), index 2; on such starts: J. Vlach and "
           "K. Singhal, "
           "Computer Methods for Circuit Analysis and Design, Van Nostrand Reinhold 1983",
  .n = 5,
  .names = &names,
  .t1 = 1e-3,
  .storage = STEIF_DENSE,
  .exact = exact,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
