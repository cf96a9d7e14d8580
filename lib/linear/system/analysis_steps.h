/* analysis_steps.h: a system E x' + F x = f under analysis, and the steps of an algorithm that makes it.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ANALYSIS_STEPS_H
#define STF_ANALYSIS_STEPS_H

#include "linear_system.h"

typedef struct stf_descriptor {
  steif_context *ctx;
  stf_pool *pool;
  SUNMatrix E, F;             /* as given */
  steif_analysis options;     /* the algorithm chosen */
  steif_structure *structure; /* found by the analysis, or known before it */
  bool structure_known;
  const sunrealtype *x0;  /* n values x(0-); NULL: the structure alone is wanted */
  stf_sources sources;    /* with x0: E x0, f, f', ... as far as the index asks */
  steif_impulse *impulse; /* with x0: the answer */
  sunrealtype *apart; /* with x0: how far its comparisons are apart, n, in the units given */
  void *state;        /* of the algorithm, in the pool */
} stf_descriptor;

/* The steps of an analysis, in the order in which they are called. */
typedef struct stf_algorithm {
  /* Units of equations and unknowns in which no entry hides another. */
  int (*scale)(stf_descriptor *d);
  /* Is the pencil regular; its index, its finite and infinite eigenvalues. */
  int (*structure)(stf_descriptor *d);
  /* Of a singular pencil, instead of all that follows: is it singular exactly, equations and unknowns
   * to blame, the sentence. */
  int (*singular)(stf_descriptor *d);
  /* x(0+) and the impulses, way 0 and 1; without x0 those of a random start, or nothing where they
   * are not needed to certify the structure. */
  int (*solve)(stf_descriptor *d, int way);
  /* How far both ways, and counts of eigenvalues, are apart. */
  int (*compare)(stf_descriptor *d);
  /* Is the answer certified; what cannot be decided is set to be so. */
  int (*certify)(stf_descriptor *d);
  /* The sentence. */
  int (*say)(stf_descriptor *d);
  void (*close)(stf_descriptor *d);
} stf_algorithm;

#endif
