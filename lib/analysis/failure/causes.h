/* causes.h: the causes of a failed run, each looked for by a function of its own.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CAUSES_H
#define STF_CAUSES_H

#include "array_start.h"
#include <steif/failure.h>

/* -- causes of a failure ----------------------------------------------------------------- */

typedef struct stf_search {
  stf_point *point;           /* at the last accepted point */
  const steif_history *scene; /* NULL: the Jacobian alone is looked at */
  steif_cause *cause;
  sunrealtype *scale, *noise, *weight; /* n each: terms and noise of equations, error weights */
  stf_evidence evidence;               /* gathered when first needed */
  steif_diagnosis diagnosis;
  bool gathered;
} stf_search;
/* More unknowns than the dense tests serve. */
bool stf_cause_large(const stf_search *c);
/* Each looks for one cause and fills *cause if it is there. */
int stf_cause_blow_up(stf_search *c);
int stf_cause_impasse(stf_search *c);
int stf_cause_jump(stf_search *c);
int stf_cause_jacobian(stf_search *c);
int stf_cause_singular(stf_search *c);
int stf_cause_differences(stf_search *c);
int stf_cause_accuracy(stf_search *c);
int stf_cause_stiff(stf_search *c);
int stf_cause_start(stf_search *c);
int stf_cause_ringing(stf_search *c);
int stf_cause_index(stf_search *c);
/* Of the points kept alone: true when it is there. */
bool stf_cause_growth(stf_search *c);
/* The diagnosis at the last accepted point. */
int stf_cause_diagnose(stf_search *c);
/* Noise of F around the point (J. J. More and S. M. Wild, SIAM J. Sci. Comput. 33, 2011);
 * 0 where none is seen. */
int stf_cause_noise(stf_search *c);

#endif
