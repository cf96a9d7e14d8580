/* rodas_small.h: Rosenbrock methods for up to eight unknowns: a stage is one pass over registers.
 *
 *   (M/(gamma h) - J) u_i = f(t + alpha_i h, Y_i) + M sum_{j<i} (c_ij/h) u_j + gamma_i h f_t
 *
 * and the argument of the next stage.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RODAS_SMALL_H
#define STF_RODAS_SMALL_H

#include "base.h"
#include "rodas.h"

enum { STF_RODAS_SMALL = 8 };

struct stf_rodas_kernels;

typedef struct stf_rodas_small {
  const struct stf_rodas_kernels *kernels; /* of the instruction set there is */
  int n, order[STF_RODAS_SMALL];           /* rows in the order of elimination */
  const double *M;                         /* by columns; NULL: identity */
  /* L with unit diagonal below, U divided by its diagonal above, and 1 / that diagonal. */
  double lu[STF_RODAS_SMALL * STF_RODAS_SMALL], pivot[STF_RODAS_SMALL];
} stf_rodas_small;

typedef struct stf_rodas_stage {
  int i;
  const double *a, *c;        /* row i + 1 and row i of the tables; a NULL: Y += u_i */
  double h, slope;            /* slope: gamma_i h, 0 where f_t is not asked for */
  const double *f, *ft, *y;   /* f at Y_i; y_n */
  double *u[STF_RODAS_STAGES]; /* u_0 .. u_i */
  double *Y;
} stf_rodas_stage;

void stf_rodas_small_open(stf_rodas_small *R, int n, const double *M);
/* LU of shift M - J, J n x n by columns. 0, or 1 + the column whose pivot vanished. */
int stf_rodas_small_factor(stf_rodas_small *R, const double *J, double shift);
/* u_i, and Y of the stage after it. */
void stf_rodas_small_stage(const stf_rodas_small *R, const stf_rodas_stage *g);

#endif
