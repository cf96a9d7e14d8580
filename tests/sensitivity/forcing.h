/* forcing.h: x' = -a x + b sin 10 t, x(0) = c, with p = (a, b, c): derivatives in closed form.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FORCING_H
#define FORCING_H

#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/data.h>
#include <steif/steif.h>

struct forcing {
  sunrealtype p[3], y0[1];
  steif_parameters parameters;
  steif_problem problem;
};
/* `differences`: dF/dp is left to them. */
void forcing_open(struct forcing *f, int differences);

/* x' = -z, 0 = z - p x as y' = f of a mass form, user: p. */
int constrained_f(sunrealtype t, N_Vector y, N_Vector ydot, void *user);
int constrained_mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user);

/* dy/dp_k at the end of a run on [t0, t1]; a failure is asserted. */
void sensitivity_at(steif_context *ctx, const steif_problem *p, const char *method,
                    const steif_options *o, int k, sunrealtype t, sunrealtype *S,
                    steif_sensitivity_cost *cost);

#endif
