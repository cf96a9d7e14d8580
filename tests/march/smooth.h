/* smooth.h: a smooth nonlinear pair with a closed solution, and a run of it.
 *
 *   y0' = -2 t y0^2,                     y0 = 1 / (1 + t^2)
 *   y1' = cos t + sin^2 t - y1^2,        y1 = sin t
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SMOOTH_H
#define SMOOTH_H

#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

/* On [0.25, 2]. */
extern const steif_problem smooth;

/* Largest distance of y from the solution at t. */
double smooth_error(double t, N_Vector y);

/* A solver, or NULL with a failed assertion and the message printed. */
steif_solver *smooth_open(steif_context *ctx, const steif_problem *p, const char *method,
                          const steif_options *o);

/* Making the solver fails with this code and these words. */
void smooth_refused(const steif_problem *p, const char *method, const steif_options *o,
                    int code, const char *words);

#endif
