/* glm_state.h: what a general linear method remembers, and what it makes of the data of a step (glm.c), for y and,
 * in carry/carry_glm.c, for its derivatives by parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_GLM_STATE_H
#define STF_GLM_STATE_H

#include "general.h"
#include "stage_chain.h"
#include "starting_values.h"
#include "step_error.h"

enum { STF_GLM_DATA = STF_LEAST, STF_GLM_POWERS = STEIF_PAST + 1 };

typedef struct stf_glm_state {
  const steif_glm *g;
  int k, r, p, data; /* data: 2 k + r */
  stf_chain chain;
  stf_begin begin;
  N_Vector *at, *past, *slopes; /* X_n, X_{n-1} scaled as in the last step, its F */
  N_Vector *from, *to;          /* trial: X_n for another h, X_{n+1} */
  N_Vector *x;                  /* X_n of the trial: at or from */
  N_Vector before;
  N_Vector *power; /* the last coefficients of a polynomial */
  stf_carried carried;
  sunrealtype wanted, explicit_share; /* what the error may be where nothing is forgotten */
  sunrealtype scale;                  /* h that belongs to at */
  long seen, since;                   /* Jacobians counted, and the step since which */
  sunrealtype *first;                 /* k x (p + 1): X_0 from the values of the start */
  sunrealtype z[STF_GLM_POWERS * STF_GLM_DATA], finish[STF_GLM_DATA],
    error[STF_GLM_DATA];                               /* rows of weights */
  bool known[STF_GLM_POWERS], estimates, dense, begun; /* begun: the trial is a first step */
} stf_glm_state;

/* X_{n+1}, F and X_n of a step of length h. */
typedef struct stf_glm_step {
  N_Vector *X, *F, *before;
  sunrealtype h;
} stf_glm_step;

/* out = sum of d (X_{n+1}; h F; X_n). */
void stf_glm_combine(const stf_step *s, const sunrealtype *d, const stf_glm_step *of,
                     N_Vector out);
/* X for steps of length h from the data of the last one. */
void stf_glm_rescale(const stf_step *s, sunrealtype h, const stf_glm_step *last, N_Vector *X);
/* X_{n+1} and the solution from F and X_n. */
void stf_glm_advance(const stf_step *s, const stf_glm_step *now, N_Vector next);
/* error h^{p+1} y^{(p+1)}: by the combination that gives it, else from h^p y^(p) at both ends. */
void stf_glm_error(const stf_step *s, const stf_glm_step *now, const stf_glm_step *last,
                   N_Vector work, N_Vector out);
/* At t inside the last step, from y at its beginning and its end. */
void stf_glm_dense(const stf_step *s, sunrealtype t, const stf_glm_step *last, N_Vector before,
                   N_Vector y, N_Vector out);

/* at_infinity.c: by how much a step multiplies errors of algebraic unknowns in the long run; infinite: without bound. */
int stf_glm_at_infinity(steif_context *ctx, const steif_glm *glm, sunrealtype *radius);

/* carry_glm.c. */
extern const stf_carrier stf_glm_carrier;

#endif
