/* agreed.h: a run over ranks, inside.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_AGREED_H
#define STF_AGREED_H

#include "integrator.h"
#include <steif/quadrature.h>

typedef struct stf_agreed {
  steif_problem problem;      /* with our callbacks ... */
  const steif_problem *p;     /* ... around these */
  steif_quadrature integrals; /* with ours, too */
  int (*ewt)(N_Vector y, N_Vector ewt, void *user);
  N_Vector like;
  steif_context *ctx;
  stf_deferred *deferred;
} stf_agreed;

/* agreed.c: our callbacks in place of those of a->p and of the options. */
void stf_agreed_wrap(stf_agreed *a, steif_options *o);
/* Of one that failed last, as deferred codes have it. */
const char *stf_agreed_name(long id);

/* same_input.c: STEIF_BAD_INPUT with the first member of the problem, the options or what these point to, or the
 * method, that is not the same on all ranks. */
int stf_same_input(steif_context *ctx, N_Vector like, const steif_problem *problem,
                   const char *method, const steif_options *options);

#endif
