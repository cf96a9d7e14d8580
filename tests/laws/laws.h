/* laws.h: what the laws share: lists of methods, small problems, a context.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef LAWS_H
#define LAWS_H

#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

/* One method of each family and kind, implicit ones first. */
extern const char *const law_methods[];
extern const int law_method_count, law_implicit_count;

/* A stiff nonlinear pair: y1' = -21.3 y1 + y2^2 + sin t, y2' = -0.83 y2 + 0.31 y1 y2,
 * y(0) = (0.37, 1.18), with analytic Jacobian, dense; integrated to t = 1.7. */
extern const steif_problem law_problem;

/* End value of a run of `problem`, or NULL with the message in ctx; destroy it. */
N_Vector law_run(steif_context *ctx, const steif_problem *problem, const char *method,
                 const steif_options *options);

/* Exponential methods solve linear equations exactly: M(z) = e^z. */
int law_exponential(const steif_method_info *info);

/* Largest difference of two vectors relative to the largest entry of the first. */
double law_distance(N_Vector a, N_Vector b);

#endif
