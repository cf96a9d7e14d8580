/* direct.h: whole runs of CVODE, IDA and ARKODE as a C program of one's own makes them, without steif.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef DIRECT_H
#define DIRECT_H

#include <stdbool.h>
#include <steif/problem.h>
#include <sundials/sundials_linearsolver.h>

/* One run of y' = f(t, y) from t0 to t1, from the creation of the integrator to its destruction: atol = rtol times
 * the scale of the problem, its own Jacobian, SUNDIALS' dense solver or its KLU with AMD, and a restart at
 * every break. The number of steps, or -1 where a call failed. */
typedef long direct_run(SUNContext sun, const steif_problem *p, sunrealtype rtol);
direct_run direct_cvode, direct_ida, direct_arkode;

/* What both share: a vector of the start values, a matrix of the problem's storage and its solver. */
typedef struct direct {
  const steif_problem *p;
  N_Vector y, yp;
  SUNMatrix J;
  SUNLinearSolver solver;
} direct;
int direct_open(SUNContext sun, const steif_problem *p, direct *d);
void direct_close(direct *d);
/* The last time before break k where f still has its old value, or t1. */
sunrealtype direct_until(const steif_problem *p, int k);

#endif
