/* direction_inside.h: a problem on a line of parameters and start values.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DIRECTION_INSIDE_H
#define STF_DIRECTION_INSIDE_H

#include "integrator.h"
#include <steif/direction.h>
#include <steif/quadrature.h>

struct steif_direction {
  steif_context *ctx;
  const steif_problem *given;
  steif_problem problem; /* with callbacks that hand on to those given */
  steif_parameters parameters;
  steif_quadrature quadrature;
  int count; /* parameters given */
  sunrealtype theta, scale;
  sunrealtype reach;     /* largest |v_k| in sizes of p_k */
  sunrealtype *v, *home; /* of the parameters given; their values while theta is not 0 */
  sunrealtype *u;        /* NULL: 0 */
  sunrealtype *term;     /* of quadratures */
  N_Vector work, zero;   /* made when first needed, at the opening of a run */
  bool away;             /* theta is not 0 */
};

/* Callbacks of d->problem, whose user is d. */
void stf_redirect(steif_direction *d);

#endif
