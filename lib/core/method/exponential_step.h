/* exponential_step.h: the step of exponential methods, from their coefficients.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_EXPO_H
#define STF_EXPO_H

#include "exponential_data.h"
#include "method.h"
#include "phi_step.h"

typedef struct stf_exponential_step {
  const stf_exponential *x;
  bool renews; /* L is the Jacobian of every step: Rosenbrock type */
  stf_phis phis;
  N_Vector f0, slope_t;         /* f and df/dt at the accepted point */
  N_Vector before, slope, end;  /* y and f at the last one; f at the end, for dense output */
  N_Vector drift;               /* df/dt at the last one */
  N_Vector flow[STF_EXP_NODES]; /* Y - y_n of a linear equation at the nodes */
  N_Vector D[STF_EXP_STAGES];
  N_Vector b[STF_EXP_ORDER + 1], Y, dY, work;
  bool known, fresh;          /* f0 and slope_t are; L is that of this point */
  bool held;                  /* L is there of the start of the last step */
  bool flowed[STF_EXP_NODES]; /* flow is that of the attempt */
} stf_exponential_step;

int stf_exponential_step_open(stf_step *s, const stf_exponential *x, bool renews);
int stf_exponential_step_attempt(stf_step *s, sunrealtype h);
void stf_exponential_step_commit(stf_step *s);
/* The cubic; a shorter step of a Rosenbrock method from the start of the last one, whose steps are as long as the linear
 * part is exact, far too long for a cubic. */
int stf_exponential_step_dense(stf_step *s, sunrealtype t, N_Vector y);
int stf_exponential_step_again(stf_step *s, sunrealtype t, N_Vector y);
void stf_exponential_step_keep(stf_step *s, stf_image *m);
/* e^z: without N nothing is left to be approximated. */
int stf_exponential_step_propagator(steif_context *ctx, const steif_spec *spec,
                                    const steif_table *table, const sunrealtype z[2], int *r,
                                    sunrealtype *M);
int stf_exponential_step_describe(steif_context *ctx, const steif_spec *spec,
                                  const stf_exponential *x, const char *family,
                                  steif_method_info *info);

#endif
