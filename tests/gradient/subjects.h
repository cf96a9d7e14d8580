/* subjects.h: problems with parameters whose gradients are known.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SUBJECTS_H
#define SUBJECTS_H

#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/steif.h>

/* Robertson, p = (0.04, 1e4, 3e7); Lotka and Volterra, p = (1.5, 1, 3, 1); both ode, with Jacobians. */
struct subject {
  steif_problem problem;
  steif_parameters parameters;
  sunrealtype p[8], y0[64];
};
void subject_robertson(struct subject *s);
void subject_lotka(struct subject *s);
/* Van der Pol, y1' = y2, eps y2' = (1 - y1^2) y2 - y1. */
void subject_vanderpol(struct subject *s);
/* Pendulum of index 3, implicit form, p = (L, g, phi0, omega0); its start is consistent for all p. */
void subject_pendulum(struct subject *s);
/* Brusselator on 20 inner points, p = (A, B, alpha), in the storage given. */
void subject_brusselator(struct subject *s, enum steif_storage storage);

/* The gradient by `method` at relative tolerance rtol, to t1; failures are asserted. */
void gradient_of(steif_context *ctx, const struct subject *s, const char *method,
                 sunrealtype rtol, sunrealtype t1, const steif_functional *J,
                 steif_gradient *g);

/* w . y with w_i = cos(1 + i), counted from 0: an integrand, or .end; and its .slopes. */
int weighted_sum(sunrealtype t, N_Vector y, sunrealtype *g, void *user);
int weighted_slopes(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                    void *user);

/* Gradients whose request k for memory fails, k = 2, 3, ..., until one is not refused: a code, and nothing is lost. */
void requests_fail(const steif_problem *p, const char *method, const steif_options *o,
                   const steif_functional *J, int checkpoints);

#endif
