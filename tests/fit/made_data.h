/* made_data.h: measurements of a known solution with errors that anybody can make again: x_{i+1} = (1103515245 x_i +
 * 12345) mod 2^31 from 12345, e_i = x_i / 2^31 - 1/2, d = y(t; p*) + sd sqrt(12) e, component fastest.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MADE_DATA_H
#define MADE_DATA_H

#include <steif/fit.h>

enum { MADE = 64 };
typedef struct made_data {
  steif_measurements data;
  double t[MADE], value[MADE], sd[MADE];
  sunindextype component[MADE];
} made_data;

/* Of all components at the times, by a run of rtol 1e-12; sd: one for each component. */
void made_data_open(steif_context *ctx, const steif_problem *problem, size_t times,
                    const double *t, const double *sd, made_data *made);

/* x' = p1 x - p2 x y, y' = -p3 y + p4 x y from (1, 1), with sunrealtype p[4] as user. */
typedef struct prey {
  double p[4];
  steif_parameters parameters;
  steif_problem problem;
} prey;
void prey_open(prey *P, double a, double b, double c, double d);
/* Of p = (1.5, 1, 3, 1) at 0.5, 1, .., 10 with the standard deviation 0.05. */
void prey_data(steif_context *ctx, made_data *made);

/* x' = -a b x, x(0) = c; eight measurements of 3 exp(-rate t) with errors of at most 1e-3 and no sign. */
extern const char product[];
void decay(made_data *made, double rate);

#endif
