/* jump.h: what is known of a jump while it is found and judged.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_JUMP_H
#define STF_JUMP_H

#include "array_start.h"
#include <steif/impulse.h>
#include <steif/jump.h>

enum { STF_TOLERANCES = 10 }; /* differences up to here are none */

typedef struct stf_jump_search {
  stf_point point; /* its point moves; t is that of the jump */
  stf_evidence evidence;
  steif_diagnosis diagnosis;
  const steif_jump_request *request;
  steif_jump *jump;
  SUNMatrix E, F;                /* frozen, E s + F */
  steif_impulse answer;          /* of that pencil to a start without forces */
  sunrealtype *from, *slope;     /* n: y(t-) and the slope that came with it */
  sunrealtype *d, *weight;       /* n: a displacement; 1 / size */
  sunrealtype rtol, *tolerance;  /* n tolerances */
  sunrealtype *noise;            /* as c: impulses that tolerances make */
  sunrealtype *E_before, *E_now; /* n x n by columns */
  bool *carried;                 /* n: E acts on the unknown */
} stf_jump_search;

/* Is the jump unique? Fills the verdict and the sentence, and applies the restitution. */
int stf_jump_judge(stf_jump_search *w);

#endif
