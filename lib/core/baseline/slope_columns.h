/* slope_columns.h: derivatives by parameters as CVODES and IDAS want them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SLOPE_COLUMNS_H
#define STF_SLOPE_COLUMNS_H

#include "baseline.h"
#include "problem.h"

typedef struct stf_slope_columns {
  stf_slopes *slopes;
  stf_baseline *base;
  SUNMatrix J[2]; /* with c = 0 and 1; of ODEs the first alone, df/dy */
  N_Vector work[3];
  long made; /* evaluations of all columns */
} stf_slope_columns;

/* Room for what follows; exact: the problem has what these need, else the package takes its own differences. */
int stf_slope_open(stf_slope_columns *c, stf_baseline *base, bool *exact);
/* STEIF_UNSUPPORTED where a run with columns has come to a break. */
int stf_slope_unbroken(const stf_baseline *base);
/* out_k = df/dy S_k + df/dp_k of y' = f, for all columns. */
int stf_slope_rhs(stf_slope_columns *c, sunrealtype t, N_Vector y, N_Vector fy, N_Vector *S,
                  N_Vector *out);
/* out_k = F_y S_k + F_y' S'_k + F_p_k; S' NULL: 0. */
int stf_slope_residual(stf_slope_columns *c, sunrealtype t, N_Vector y, N_Vector yp,
                       N_Vector *S, N_Vector *Sp, N_Vector *out);
/* S' at the start: where F_y' = I from the equation, else of a very short step of the implicit Euler method, which
 * makes it consistent with algebraic equations, too. */
int stf_slope_start(stf_slope_columns *c, N_Vector *S, N_Vector *Sp);

#endif
