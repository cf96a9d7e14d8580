/* oscillator.h: van der Pol's equation, stiff, and a run of it that is under way.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef OSCILLATOR_H
#define OSCILLATOR_H

#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>
#include <unistd.h>

static int oscillator_f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = NV_DATA_S(y), mu = user ? *(const sunrealtype *)user : 50;
  (void)t;
  NV_Ith_S(r, 0) = u[1];
  NV_Ith_S(r, 1) = mu * ((1 - u[0] * u[0]) * u[1] - u[0]);
  return 0;
}

static const sunrealtype oscillator_y0[] = {2, -0.66};

static inline steif_problem oscillator(void)
{
  return (steif_problem){
    .name = "oscillator", .n = 2, .t1 = 3, .y0 = oscillator_y0, .f = oscillator_f};
}

/* A path of this process. */
static inline const char *scratch(const char *name)
{
  static char path[128];
  snprintf(path, sizeof path, "checkpoint_%s.%ld.ck", name, (long)getpid());
  return path;
}

/* After 20 steps; NULL where something failed. */
static inline steif_solver *under_way(steif_context *ctx, const steif_problem *p,
                                      const char *method, const steif_options *o)
{
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  for (int k = 0; s && k < 20; k++)
    if (steif_solve_step(s)) steif_solver_free(&s);
  return s;
}

#endif
