/* schemes.c: errors of discretisations of q'' + q'/2 + k q = sin 2t, y = q, from rest.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/discrete.h>
#include <stdio.h>

static int drive(double t, double *u, void *user)
{
  (void)user;
  *u = sin(2 * t);
  return 0;
}

/* max |q - exact| over the grid; exact: room for the solution. */
static int largest(const steif_problem *p, double dt, long steps, const double *h,
                   N_Vector exact, double *most)
{
  *most = 0;
  for (long k = 0; k <= steps; k++) {
    STEIF_TRY(p->exact((double)k * dt, exact, NULL, p->user));
    *most = fmax(*most, fabs(h[2 * k] - NV_Ith_S(exact, 0)));
  }
  return STEIF_OK;
}

static int error_of(stf_trial *t, const steif_problem *p, const char *scheme, double dt,
                    double *most)
{
  const stf_schemes *d = t->data;
  const double A[] = {0, -d->k, 1, -0.5}, B[] = {0, 1};
  const steif_state_space s = {.n = 2, .m = 1, .A = A, .B = B};
  const long steps = lround(p->t1 / dt);
  double *h = stf_pool_array(t->pool, 2 * (size_t)(steps + 1), sizeof *h);
  N_Vector exact = N_VNew_Serial(2, steif_sundials(t->ctx));
  steif_discrete discrete = {0};
  int code = h && exact ? steif_c2d(t->ctx, &s, scheme, dt, &discrete) : STEIF_NO_MEMORY;
  if (code == STEIF_OK)
    code = steif_discrete_run(t->ctx, &discrete, drive, NULL, 0, NULL, steps, h);
  if (code == STEIF_OK) code = largest(p, dt, steps, h, exact, most);
  steif_discrete_clear(t->ctx, &discrete);
  if (exact) N_VDestroy(exact);
  return code;
}

static int line(stf_trial *t, const steif_problem *p, const stf_scheme_line *l)
{
  STEIF_TRY(stf_curve(t, l->scheme, 1));
  for (int i = 0; i < 5; i++) {
    const double dt = ldexp(0.4, -i);
    double error = NAN;
    STEIF_TRY(error_of(t, p, l->scheme, dt, &error));
    const sunrealtype known = l->error[i];
    STEIF_TRY(
      stf_find(t, l->scheme, dt, "error", error, known > 0 ? known : NAN, 1e-9 * known));
    STEIF_TRY(stf_curve_point(t, dt, error));
  }
  return STEIF_OK;
}

int stf_scheme_table(stf_trial *t)
{
  const stf_schemes *d = t->data;
  char name[40];
  steif_problem p;
  snprintf(name, sizeof name, "forced:k=%.17g", d->k);
  int code = steif_problem_find(t->ctx, name, &p);
  for (size_t i = 0; code == STEIF_OK && i < d->lines; i++) code = line(t, &p, d->line + i);
  steif_problem_clear(t->ctx, &p);
  return code;
}
